"""The report: what is on record and the figures drawn from it, as one HTML file that opens from disk and loads nothing.

    import report
    status = report.main(results)  # writes results/report.html
"""
import sys

import records
import whole_file
from report import page, record_set

usual_most_mb = 25


def main(results, quiet=False):
    """The exit status: 2 where there are no records, or damaged ones, or the page cannot be written."""
    try:
        text, missing = page.page(record_set.RecordSet(results))
    except records.RecordsMissing as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return 2
    file = results / "report.html"
    try:
        with whole_file.beside(file) as part:
            part.write_text(text)
    except whole_file.CannotBeWritten as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return 2
    if not quiet:
        for line in missing:
            print(f"missing: {line}")
        megabytes = file.stat().st_size / 1e6
        print(f"{file}: {megabytes:.1f} MB" + (f", more than {usual_most_mb}" if megabytes > usual_most_mb else ""))
    return 0
