"""The report: the records and the figures drawn from them, as one HTML file that opens from disk and loads nothing.

    import report
    status = report.main(results)  # writes results/report.html
"""
import sys

import records
from records import kept, whole_file
from report import page, record_set, run_page

most_mb = 25


def main(results, quiet=False):
    """Returns the exit status: 2 if there are no records, damaged ones, or the page cannot be written; 1 if the page is too large."""
    file = results / "report.html"
    try:
        is_run = (results / "run.json").is_file()
        text, missing = run_page.page(results) if is_run else page.page(record_set.RecordSet(kept.opened(results)))
    except records.RecordsMissing as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return 2
    except whole_file.CannotBeWritten as error:
        print(f"pbskin: {file}: cannot be written: {error}", file=sys.stderr)
        return 2
    try:
        with whole_file.beside(file) as part:
            part.write_text(text)
    except whole_file.CannotBeWritten as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return 2
    megabytes = file.stat().st_size / 1e6
    if not quiet:
        for line in missing:
            print(f"missing: {line}")
        print(f"{file}: {megabytes:.1f} MB")
    if megabytes > most_mb:
        print(f"pbskin: {file}: {megabytes:.1f} MB: expected at most {most_mb}", file=sys.stderr)
        return 1
    return 0


def picture(folder):
    """Writes folder/picture.png, the values of a single run over its frames. Returns the exit status: 2 if it cannot be read or written."""
    try:
        figure = run_page.over_frames(run_page.RunRecords(folder))
        with whole_file.beside(folder / "picture.png") as part:
            figure.savefig(part, dpi=150)
    except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return 2
    return 0
