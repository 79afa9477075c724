"""The report: the records and the figures drawn from them, as one HTML file that opens from disk and loads nothing.

    import report
    status = report.main(results)  # writes results/report.html
"""
import functools
import sys

import records
from records import kept, whole_file
from report import page, record_set, run_page

most_mb = 12


def refusing(write):
    """The function, which returns 2 and prints the reason if records are missing or damaged, or a file cannot be
    written."""
    @functools.wraps(write)
    def status_of(*arguments, **options):
        try:
            return write(*arguments, **options)
        except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
            print(f"pbskin: {error}", file=sys.stderr)
            return 2
    return status_of


@refusing
def main(results, quiet=False, needs_model=False):
    """Writes the page. Returns the exit status: 1 if it is too large, 3 if it lacks the moving model that it needs."""
    is_run, file = (results / "run.json").is_file(), results / "report.html"
    try:
        text, missing = run_page.page(results) if is_run else page.page(record_set.RecordSet(kept.opened(results)))
    except whole_file.CannotBeWritten as error:
        raise whole_file.CannotBeWritten(f"{file}: cannot be written: {error}") from error
    with whole_file.beside(file) as part:
        part.write_text(text)
    megabytes = file.stat().st_size / 1e6
    if not quiet:
        for line in missing:
            print(f"missing: {line}")
        print(f"{file}: {megabytes:.1f} MB")
    if megabytes > most_mb:
        print(f"pbskin: {file}: {megabytes:.1f} MB: expected at most {most_mb}", file=sys.stderr)
        return 1
    return 3 if needs_model and run_page.MODEL not in text else 0


@refusing
def picture(folder):
    """Writes folder/picture.png, the values of a single run over its frames. Returns the exit status."""
    figure = run_page.over_frames(run_page.RunRecords(folder))
    with whole_file.beside(folder / "picture.png") as part:
        figure.savefig(part, dpi=150)
    return 0
