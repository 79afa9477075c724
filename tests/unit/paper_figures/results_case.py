"""What the tests of figures and pages share. Importing this module makes the modules of paper_figures known."""
import contextlib
import csv
import functools
import html
import io
import os
import pathlib
import re
import sys
import tempfile
import unittest
import unittest.mock

root = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(root / "paper_figures"))

import records  # noqa: E402
import synthetic_records  # noqa: E402

ALL_FORMATS = ("pdf", "png", "svg")
FORMATS = ALL_FORMATS if os.environ.get("PBS_LONG") else ("svg",)  # figures_test.py draws three figures in all


@contextlib.contextmanager
def listening():
    """Two streams that contain what is printed meanwhile, as output and as errors."""
    said, complaints = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complaints):
        yield said, complaints


def tables_of(text):
    """The cells of each table by its caption, row by row."""
    def cells_of(row):
        return [html.unescape(re.sub("<[^>]+>", "", cell)) for cell in re.findall(r"<t[hd]\b[^>]*>(.*?)</t[hd]>", row,
                                                                                  re.DOTALL)]

    return {html.unescape(caption): [cells_of(row) for row in re.findall(r"<tr\b.*?</tr>", body, re.DOTALL)]
            for caption, body in re.findall(r"<caption>(.*?)</caption>(.*?)</table>", text, re.DOTALL)}


class ResultsTest(unittest.TestCase):
    """A folder for records and figures."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = pathlib.Path(folder.name)

    def refused(self, words):
        """A context in which records are refused with these words."""
        return self.assertRaisesRegex(records.RecordsMissing, re.escape(words))

    def rows(self, name):
        """The rows of the table behind a figure."""
        return list(csv.DictReader(io.StringIO((self.results / "figures" / f"{name}.csv").read_text(encoding="utf-8"))))

    def make_all(self, name=None, status=0, formats=ALL_FORMATS):
        """What the script of all figures prints, as output and as errors; deformers are drawn as looks.toml states."""
        import checked_looks  # noqa: F401
        from drawing import style
        import make_all
        with listening() as (said, complaints), unittest.mock.patch.object(style, "save",
                                                                           functools.partial(style.save,
                                                                                             formats=formats)):
            self.assertEqual(make_all.main(self.results, name), status, complaints.getvalue())
        return said.getvalue(), complaints.getvalue()

    def drawn(self, name):
        """The rows behind a figure that is drawn now, with the revision of its records in each file."""
        self.make_all(name, formats=FORMATS)
        for ending in FORMATS:
            file = self.results / "figures" / f"{name}.{ending}"
            self.assertIn(synthetic_records.revision.encode(), file.read_bytes())
        return self.rows(name)

    def refused_without(self, file, name=None):
        """No figure is drawn without this file of the records."""
        (self.results / file).unlink()
        self.assertIn(f"{pathlib.Path(file).name}: does not exist", self.make_all(name, status=1)[1])


class ReportTest(ResultsTest):
    """The report of a folder, without the viewer, which has tests of its own."""

    def setUp(self):
        super().setUp()
        without_viewer = unittest.mock.patch.dict(sys.modules, {"viewer.page": None})
        without_viewer.start()
        self.addCleanup(without_viewer.stop)

    def report(self):
        """Its exit status, its text, which is empty if there is none, and what was printed as output and as errors."""
        import report
        with listening() as (said, complaints):
            status = report.main(self.results)
        page = self.results / "report.html"
        text = page.read_text() if page.is_file() else ""
        page.unlink(missing_ok=True)
        return status, text, said.getvalue(), complaints.getvalue()
