"""Reference: the definition. The page's sentences and tables agree with small records, it loads nothing, and it names
what is missing. Records of another shape, in which each value takes every other kind, are refused with file, field,
value and rule, and exit status 2."""
import base64
import html.parser
import io
import json
import os
import pathlib
import re
import shutil
import sys
import tomllib
import types
import unittest.mock

from PIL import Image
import matplotlib.colors

from results_case import ReportTest, listening, root, tables_of
import make_report
import report
import synthetic_records
from records import entries
from report import answers, axis, errors, figures, markup, origin, record_set


class Page(html.parser.HTMLParser):
    """The contents of a page: ids, links, what would be loaded, headings, unclosed elements."""

    void = {"meta", "link", "img", "br", "input"}

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads, self.headings, self.open, self.badly_nested = [], [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids += [attributes["id"]] if "id" in attributes else []
        self.links += [attributes["href"]] if tag == "a" and "href" in attributes else []
        self.loads += [value for name, value in attributes.items() if name in ("src", "srcset", "poster", "data")]
        self.loads += [attributes["href"]] if tag not in ("a",) and "href" in attributes else []
        self.headings += [int(tag[1])] if re.fullmatch("h[1-6]", tag) else []
        if tag not in self.void:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.badly_nested.append(tag)


def words_of(text):
    """The page without tags, since terms link to the glossary."""
    return re.sub(r"<[^>]+>", "", text)


class Report(ReportTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_study(self.results)

    def found(self):
        return record_set.RecordSet(self.results)

    def test_a_damaged_table_of_a_study_leaves_the_report(self):
        jiggle = self.results / "jiggle"
        synthetic_records.write_jiggle(jiggle)
        synthetic_records.write_table(jiggle / "limb_jolt" / "zone.csv", [
            {"share_of_vertices": "much", "share_on_skin": "1", "pieces": "1", "bone": "upper", "share_of_zone": "1"}])
        (jiggle / "plan.json").write_text(json.dumps({"runs": [{"name": "limb_jolt"}]}))
        with listening() as (_, complaints):
            self.assertEqual(make_report.main(self.results), 2)
        self.assertIn("limb_jolt/zone.csv:2: share_of_vertices = much: expected a number", complaints.getvalue())
        self.assertTrue((self.results / "report.html").is_file())

    def page(self):
        status, text, _, complaints = self.report()
        self.assertEqual((status, complaints), (0, ""))
        return text

    def write_svg(self, name, body=""):
        folder = self.results / "figures"
        folder.mkdir(exist_ok=True)
        (folder / f"{name}.svg").write_text(
            '<?xml version="1.0"?>\n<!DOCTYPE svg PUBLIC "x" "http://www.w3.org/x.dtd">\n'
            '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 9 9">'
            '<metadata><rdf resource="http://purl.org/x"/></metadata><defs><path id="m1" d="M0 0"/></defs>'
            f'<g clip-path="url(#p1)"><use xlink:href="#m1"/></g>{body}</svg>')
        (folder / f"{name}.csv").write_text("a\n1\n")
        (folder / f"{name}.title.txt").write_text(f"{name} is shown\n")

    def test_no_records_no_page(self):
        shutil.rmtree(self.results / "volume")
        status, text, _, complaints = self.report()
        self.assertEqual((status, text), (2, ""))
        self.assertIn("no records", complaints)
        self.assertEqual(list(self.results.iterdir()), [])
        self.results = self.results / "nowhere"
        self.assertEqual(self.report()[0], 2)

    def test_verdicts_are_counted_and_open_to_their_runs(self):
        synthetic_records.write_claims(self.results)
        text = self.page()
        self.assertIn("There are 5 claims: 1 holds, 1 fails, 1 is inconsistent in print, 1 is inconclusive, "
                      "1 cannot be tested.",
                      words_of(text))
        judged = [("C02a", "fails"), ("C10a", "holds"), ("C13", "inconsistent in print"), ("C14", "inconclusive"),
                  ("C16", "cannot be tested")]
        table = re.findall(r'<td class="name"><a href="#(\w+)".*?<span class="chip \w+">.*?</span> ([\w ]+)</span>',
                           text)
        self.assertEqual(sorted(table), judged)  # by topic
        lines = re.findall(r'<details class="claim" id="(\w+)"><summary>.*?<span class="mark \w+">.*?</span> ([\w '
                           r']+)</span>', text)
        self.assertEqual(lines, judged)
        self.assertIn('<td class="measured">107 to 233 frames/s<span class="under">asked: 30 or more</span></td>', text)
        self.assertIn('<a href="volume/limb_twist/">volume/limb_twist</a>', text)
        self.assertIn("<li>1 of 3 cases hold, share 0.333 [0.01, 0.91]</li>", text)
        self.assertIn("<li>frames per second: 107 to 233 1/s, threshold 30 or more</li>", text)
        self.assertNotIn("<p></p>", text)
        self.assertIn('<th scope="row">human, clip 01_03</th><td>0.4</td><td>0.1 to 0.4</td><td>0.95 or '
                      'more</td><td>\u2718 no</td>', text)
        row = ('<th scope="row">LBS (ratio)</th><td>negative control</td><td>0 of 1 case, '
               'share 0</td><td>0.01</td><td>yes</td>')
        self.assertIn(row, text)
        self.assertIn("no record of the control DQS", text)
        self.assertIn("<code>", markup.inline("`x`"))

    def test_without_verdicts_it_is_said(self):
        _, text, said, _ = self.report()
        self.assertIn("No verdict is on record", words_of(text))
        self.assertIn("missing: verdicts: claims.json does not exist", said)

    def test_distance_and_cost_are_those_of_the_records(self):
        synthetic_records.write_work_precision(self.results)
        synthetic_records.write_timing(self.results)
        text = self.page()
        self.assertIn("PBS leaves 51 to 68 % of the error of LBS at the joints", words_of(text))
        name = "Error at the joints in per cent of that of LBS, with known flesh [range over the reference variants]"
        self.assertEqual([tables_of(text)[name][row] for row in (0, 1, 9)], [
            ["method", "takes", "0.1 ms", "1 ms", "10 ms"],
            ["quasi-Newton", "material, springs, initial guess", "", "32 [29, 38] a\u2020", "19 [17, 23] a\u2020"],
            ["LBS", "nothing", "100 [90, 120] b", "100 [90, 120] i", "100 [90, 120] i"]])
        self.assertIn("0.5 to 1 ms per frame</b> in single precision and ordered (1000 to 2000 frames per second); "
                      "plain loops in double precision take 4 to 8 ms (125 to 250 frames per second; Table 1 prints "
                      "65.8 to 90.5)", text)

    def test_the_nearest_method_has_a_line_for_each_time(self):
        synthetic_records.write_work_precision(self.results)
        lines = str(answers.which_method(self.found())).split("<br>")
        self.assertEqual(len(lines), 5)
        self.assertIn("<p>With 1 ms per frame, quasi-Newton has the least error", lines[0])
        self.assertTrue(lines[2].startswith("Within 1 ms, quasi-Newton leaves 32 % with the flesh known"), lines[2])

    def test_the_axis_has_the_cases_the_threshold_and_the_controls(self):
        synthetic_records.write_claims(self.results)
        claims = {claim["id"]: claim for claim in self.found().claims}
        drawn = axis.drawn(claims["C02a"]
                           | {"controls": [claims["C02a"] | {"name": "LBS", "role": "negative_control"}]})
        parts = '<circle class="holds"', '<circle class="fails"', '<rect class="threshold"', '<path class="control"'
        self.assertEqual([drawn.count(part) for part in parts], [1, 2, 1, 1])
        self.assertRegex(drawn, 'aria-label="[^"]*; threshold: 0.95 or more; control LBS, negative control: 0.4"')
        self.assertEqual(axis.drawn(claims["C13"]), "")  # each printed value has a threshold of its own
        self.assertEqual([axis.Scale([1, 1000]).is_log, axis.Scale([0, 1000]).is_log], [True, False])
        places = [axis.Scale([1, 10, 100]).place(number) for number in (1, 10, 100, 1e9, -1)]
        self.assertAlmostEqual(places[1], axis.width / 2)
        self.assertTrue(axis.margin <= places[0] < places[1] < places[2] <= places[3] == axis.width - axis.margin)

    def test_a_study_that_was_not_run_is_named(self):
        _, text, said, _ = self.report()
        for study in ("work_precision", "timing", "verification"):
            self.assertIn(f"the study {study} was not run", text)
        self.assertIn("missing: figure error_split: the study ensemble was not run", said)

    def test_a_study_that_has_not_ended_is_not_called_one_that_was_not_run(self):
        (self.results / "timing").mkdir()
        _, text, said, _ = self.report()
        self.assertIn("the study timing was started and has not ended", text)
        self.assertNotIn("the study timing was not run", text + said)

    def test_a_verdict_has_one_name_on_the_page(self):
        synthetic_records.write_claims(self.results)
        text = self.page()
        body = re.sub(r"<style>.*?</style>|<script.*?</script>", "", text, flags=re.S)
        self.assertEqual(len(re.findall("(?i)inconsistent in print", body)), 3)  # count, chip, line
        for other in ("inconsistent_in_print", "untestable", "negative_control", "control_without_record"):
            self.assertNotIn(other, body)

    def test_a_page_beyond_its_size_is_written_and_refused(self):
        with unittest.mock.patch.object(report, "most_mb", 0.01):
            status, text, _, complaints = self.report()
        self.assertEqual((status, text != ""), (1, True))
        self.assertRegex(complaints, r"report\.html: 0\.\d MB: expected at most 0\.01")
        self.assertEqual((self.report()[0], self.report()[3]), (0, ""))

    def test_links_that_leave_the_page_say_so_beside_them(self):
        synthetic_records.write_claims(self.results)
        self.write_svg("volume_over_angle")
        words = markup.beside_the_page("files")
        self.assertNotIn(words, self.page())
        with unittest.mock.patch.object(figures, "most_inline_kb", 0):
            self.assertIn(f'href="figures/volume_over_angle.csv">numbers (CSV)</a> ({words})', self.page())
        self.assertIn(f'Runs ({markup.beside_the_page("folders")}): <a href="volume/limb_twist/">', self.page())

    def test_the_viewer_s_program_is_named_where_it_is_shown(self):
        self.assertIn("three.js, MIT licence", origin.section(self.found(), with_viewer=True))
        self.assertNotIn("three.js", origin.section(self.found()))

    def test_costs_are_summed_beside_wall_time_and_the_size_of_the_study(self):
        (self.results / "volume" / "costs.csv").write_text("run,expected_cpu_s,cpu_s\na,10,60\nb,20,120\n")
        self.assertEqual(origin.costs_sentence(self.found()), "These records took 3 min of processor time (1 study).")
        # an earlier version recorded no wall time
        self.assertIn("<td>30</td><td>180</td><td>\u2013</td>", origin.costs_section(self.found()))
        (self.results / "volume" / "costs.csv").write_text("run,expected_cpu_s,cpu_s,wall_s\na,10,60,70\n"
                                                           "b,20,120,125\n")
        (self.results / "volume" / "plan.json").write_text(json.dumps({"extent": "quick", "runs": [], "left_out": []}))
        self.assertIn("<td>quick</td><td>2</td><td>30</td><td>180</td><td>195</td>", origin.costs_section(self.found()))

    def test_errors_over_whole_runs_are_the_recorded_order_statistics(self):
        run = self.results / "volume" / "limb_twist"
        fem = {"name": "nh_p2", "model": "neo_hookean", "element_order": 2}
        record = json.loads((run / "run.json").read_text()) | {"outcome": {"frames": 37}}
        record["scene"] = {"reference": {"name": "nh_p2"}, "fem": [fem]}
        (run / "run.json").write_text(json.dumps(record))
        _, missing = errors.section(self.found())
        refused = ("volume/limb_twist/frame_statistics.csv: does not exist: the run is of an earlier version and has "
                   "to be made again")
        self.assertEqual(missing, [refused])
        _, text, said, _ = self.report()
        self.assertIn(f"missing: {refused}", said)
        self.assertIn(f"<li>{refused}</li>", text)
        self.assertNotIn("have none of it (pbskin reproduce volume)", text)
        synthetic_records.write_frame_statistics(run, "pbs", 24, error_joint_least_pct=1.5, error_joint_median_pct=12,
                                                 error_joint_most_pct=40)
        shown, missing = errors.section(self.found())
        self.assertIn("<td>12 (1.5 to 40)</td>", shown)
        self.assertEqual(missing, [])

    def test_the_reference_s_verification(self):
        synthetic_records.write_verification(self.results)
        text = self.page()
        self.assertIn('<th scope="row">beam</th><td>largest deflection</td><td>P1</td>', text)
        self.assertIn("1 of 2 values with a threshold fixed beforehand lie within it; 16 more have no threshold", text)
        self.assertIn("<li>closed form: a beam</li>", text)

    def test_this_machine_s_repetition_stands_beside_the_verdict_on_the_record(self):
        synthetic_records.write_claims(self.results)
        self.assertNotIn("on this machine", self.page())
        synthetic_records.write_repeated(self.results)
        text = self.page()
        self.assertIn("1 cannot be tested. This machine does NOT repeat the record: 1 of 5 numbers differ.",
                      words_of(text))
        self.assertIn('<th scope="col">on this machine</th>', text)
        rows = dict(re.findall(r'<td class="name"><a href="#(\w+)">.*?<span class="chip \w+">.*?</span> ([\w '
                               r']+</span>.*?)</tr>', text))
        for name, verdict, here in (("C02a", "fails", "1 of 3 numbers differ"), ("C10a", "holds", "83.5 to 176 1/s"),
                                    ("C14", "inconclusive", "")):
            self.assertTrue(rows[name].startswith(f"{verdict}</span>"), rows[name])
            self.assertTrue(rows[name].endswith(f'<td class="here">{here}</td>'), rows[name])

    def test_what_this_machine_repeats_is_told_of_records_that_serve_no_claim(self):
        (self.results / "claims.json").write_text('{"schema": 4, "quantities": {}, "claims": []}')
        synthetic_records.write_repeated(self.results)
        _, text, said, _ = self.report()
        self.assertIn("This machine does NOT repeat the record: 1 of 5 numbers differ.", words_of(text))
        self.assertNotIn("claims.json does not exist", said)

    def test_provenance_and_records_of_two_revisions(self):
        self.assertIn(synthetic_records.revision, self.page())
        file = self.results / "volume" / "limb_bend" / "run.json"
        file.write_text(file.read_text().replace(synthetic_records.revision, "f" * 40))
        self.assertIn("the records are of 2 revisions", self.page())

    def test_figures_are_inline_each_with_ids_of_its_own(self):
        picture = (root / "paper_figures" / "readme" / "same_pose.png").read_bytes()
        self.write_svg("volume_over_angle", '<g class="values"><circle r="1"><title>PBS, "k" &lt; 1: 1, '
                                            '2</title></circle></g>')
        self.write_svg("volume_over_clip",
                       f'<image xlink:href="data:image/png;base64,\n{base64.b64encode(picture).decode()}"/>')
        _, text, said, _ = self.report()
        shown = base64.b64decode(re.search(r'<image href="data:image/webp;base64,([^"]*)"/>', text)[1])
        one, other = (Image.open(io.BytesIO(of)).convert("RGBA").tobytes() for of in (picture, shown))
        self.assertTrue(one == other, "the picture has other pixels")
        for part in ('<use href="#volume_over_angle-m1"/>', "url(#volume_over_clip-p1)",
                     'download="volume_over_angle.csv"', '<circle r="1" data-value="PBS, &quot;k&quot; &lt; 1: 1, 2"/>',
                     "<b>Figure 12: volume_over_clip is shown. </b>"):
            self.assertIn(part, text)
        self.assertIn("missing: figures volume_over_iterations, volume_by_region: does not exist yet", said)

    def test_a_caption_tells_the_numbers_of_the_figure_that_was_drawn(self):
        self.write_svg("volume_over_iterations")
        _, text, said, _ = self.report()
        self.assertIn("missing: figure volume_over_iterations: figures/volume_over_iterations.caption.txt: "
                      "does not exist", said)
        self.assertNotIn('id="figure-volume_over_iterations"', text)
        (self.results / "figures" / "volume_over_iterations.caption.txt").write_text("24 leave \u22120.53 %.\n")
        text = self.page()
        self.assertIn("volume_over_iterations is shown. </b>24 leave \u22120.53 %. Claims: ", text)
        self.assertNotIn("{human_24}", text)

    def test_a_figure_without_its_records_or_older_than_they_is_refused(self):
        self.write_svg("volume_over_angle")
        os.utime(self.results / "figures" / "volume_over_angle.svg", (1e9, 1e9))
        self.assertIn("figure volume_over_angle: stale", self.report()[2])
        self.write_svg("volume_over_angle")
        (self.results / "volume" / "limb_bend" / "metrics.csv").unlink()
        _, text, said, _ = self.report()
        self.assertIn("figures volume_over_angle, volume_over_iterations: volume/limb_bend/metrics.csv: does not exist",
                      said)
        self.assertNotIn('id="figure-volume_over_angle"', text)

    def test_the_viewer_or_why_there_is_none(self):
        synthetic_records.write_claims(self.results)
        refused = entries.records.RecordsMissing("no frames on record")
        for fragment, expected in (({"return_value": "<p>turn me</p>"}, "<p>turn me</p>"),
                                   ({"side_effect": refused}, "The viewer is missing: no frames on record")):
            module = types.ModuleType("viewer.page")
            module.fragment = unittest.mock.Mock(**fragment)
            module.claim_links = lambda results: {"C02a": "#run=limb"}
            with unittest.mock.patch.dict(sys.modules, {"viewer.page": module}):
                text = self.page()
            self.assertIn(expected, text)
            self.assertEqual('href="#run=limb"' in text, "turn me" in expected)

    def test_nothing_is_loaded_and_the_page_is_whole(self):
        synthetic_records.write_claims(self.results)
        synthetic_records.write_work_precision(self.results)
        self.write_svg("volume_over_angle")
        found = Page(self.page())
        self.assertEqual([load for load in found.loads if not load.startswith(("data:", "#"))], [])
        self.assertEqual([link for link in found.links if link.startswith(("http:", "//"))], [])
        self.assertEqual([link for link in found.links if link.startswith("#") and link[1:] not in found.ids], [])
        self.assertEqual([link for link in found.links if not link.startswith(("#", "data:", "https:"))
                          and not (self.results / link).exists()], [])
        self.assertEqual(len(found.ids), len(set(found.ids)))
        self.assertEqual((found.badly_nested, found.open), ([], []))
        self.assertEqual(found.headings[0], 1)
        self.assertTrue(all(after <= before + 1 for before, after in zip(found.headings, found.headings[1:])))

    def test_style_and_script_load_nothing(self):
        for file in (root / "paper_figures" / "report").glob("page.[cj]s*"):
            self.assertIsNone(re.search(r"https?:|@import|url\(|fetch\(|XMLHttpRequest|import\s", file.read_text()),
                              file)

    def test_texts_of_records_are_escaped(self):
        synthetic_records.write_claims(self.results, statement="a < b & <script>alert(1)</script>")
        text = self.page()
        self.assertIn("a &lt; b &amp; &lt;script&gt;", text)
        self.assertNotIn("<script>alert", text)


class Contrast(unittest.TestCase):
    """WCAG 2.1, 1.4.3: a contrast of text against its background of 4.5 or more."""

    def luminance(self, color):
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
                  for part in matplotlib.colors.to_rgb(color)]
        return sum(weight * channel for weight, channel in zip((0.2126, 0.7152, 0.0722), linear))

    def test_every_colour_of_text(self):
        style = (root / "paper_figures" / "report" / "page.css").read_text()
        for theme in re.findall(r":root \{(.*?)\}", style, re.DOTALL):  # light, dark
            colors = dict(re.findall(r"--(\w+): (#[0-9a-f]{3,6})", theme))
            for name in ("ink", "soft", "link", "holds", "partly", "fails", "print", "untested"):
                for ground in ("ground", "shade"):
                    dark, light = sorted((self.luminance(colors[ground]), self.luminance(colors[name])))
                    self.assertGreaterEqual((light + 0.05) / (dark + 0.05), 4.5, (name, ground))


RUN, PLAN, CLAIMS, REPEATED = "volume/limb_twist/run.json", "volume/plan.json", "claims.json", "repeated.json"
ANYTHING = (None, True, 3, -1e300, "x", "", [], [3], ["x"], {}, {"x": 3})

REFUSED = tomllib.loads(pathlib.Path(__file__).with_name("refused_records.toml").read_text())["rows"]


def parts(value, place=()):
    """Each place in a record; in a list the first and the last."""
    yield place
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from parts(inner, (*place, key))
    elif isinstance(value, list):
        for at in sorted({0, len(value) - 1} if value else ()):
            yield from parts(value[at], (*place, at))


def changed(record, place, value):
    if not place:
        return value
    record = json.loads(json.dumps(record))
    inner = record
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    return record


class ReportRecords(ReportTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_study(self.results)
        synthetic_records.write_claims(self.results)
        synthetic_records.write_repeated(self.results)
        run = {**json.loads((self.results / RUN).read_text()), "outcome": {"frames": 37, "frames_with_overlap": 0},
               "scene": {"reference": {"name": "snh"},
                         "fem": [{"name": "snh", "model": "stable_neo_hookean", "element_order": 1}]},
               "work": {"settings": {}}}
        run["provenance"] |= {"libraries": {"Eigen": "3.4.0"}, "input_hashes": {"limb": "0123"}, "threads": 1}
        self.put(RUN, run)
        self.put(PLAN, {"extent": "quick", "runs": [{"name": "limb_twist"}],
                        "left_out": [{"scene": "walk", "reason": "no clip"}]})

    def put(self, name, record):
        (self.results / name).write_text(json.dumps(record))

    def record(self, name):
        return json.loads((self.results / name).read_text())

    def made(self):
        """Exit status, error messages, whether there is a page."""
        status, text, _, complaints = self.report()
        return status, complaints, text != ""

    def test_what_the_cases_are_made_of_is_accepted(self):
        self.assertEqual(self.made(), (0, "", True))

    def test_a_value_of_another_kind_is_refused_by_file_field_value_and_rule(self):
        self.assertEqual(len(REFUSED), 25)
        for name, place, value, words in REFUSED:
            with self.subTest(f"{name} {place} {value[:40]}"):
                whole, keys = self.record(name), [int(key) if key.isdigit() else key for key in place.split(".") if key]
                self.put(name, changed(whole, keys, json.loads(value.replace("ZEROS", 400 * "0"))))
                status, said, there = self.made()
                self.put(name, whole)
                self.assertEqual((status, there), (2, False))
                self.assertIn(f"pbskin: {self.results / name}: {words}", said)

    def test_no_value_of_any_kind_ends_in_a_traceback(self):
        """PBS_LONG tries all values in every place. Otherwise each place has every third value, and neighbours have
        others."""
        step = 1 if os.environ.get("PBS_LONG") else 3
        for name in (RUN, PLAN, CLAIMS, REPEATED):
            whole = self.record(name)
            for number, place in enumerate(parts(whole)):
                for value in ANYTHING[number % step::step]:
                    with self.subTest(f"{name} {place} {value}"):
                        self.put(name, changed(whole, place, value))
                        status, said, there = self.made()
                        self.assertEqual((status, there), (2, False) if said else (0, True))
                        self.assertTrue(not said or f"pbskin: {self.results / name}: " in said, said)
            self.put(name, whole)

    def test_numbers_without_an_end_and_text_without_one_are_no_json(self):
        for content in ("9" * 5000, "[" * 100000, '{"scene": NaN'):
            (self.results / RUN).write_text(content)
            status, said, there = self.made()
            self.assertEqual((status, there), (2, False))
            self.assertIn("not JSON", said)

    def test_a_run_against_a_reference_without_its_outcome_is_named_in_the_page(self):
        run = self.record(RUN)
        del run["outcome"]
        self.put(RUN, run)
        self.assertIn("volume/limb_twist/run.json: outcome: missing", self.report()[2])

    def test_cells_of_tables_are_refused_alike(self):
        synthetic_records.write_work_precision(self.results)
        methods = self.results / "work_precision" / "methods.csv"
        whole = methods.read_text()
        first = whole.splitlines()[1]
        methods.write_text(whole.replace(first, first.replace(",0.86,", ",east,", 1), 1))
        status, said, there = self.made()
        self.assertEqual((status, there), (2, False))
        self.assertIn(f"pbskin: {methods}:2: share = east: expected a number", said)
        methods.write_text(whole.replace("takes", "gets", 1))
        self.assertIn(f"pbskin: {methods}: no column takes", self.made()[1])


if __name__ == "__main__":
    unittest.main()
