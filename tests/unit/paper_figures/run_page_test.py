"""The page of a single run. Reference: its records, which are written here with numbers that can be predicted. Each
number of a table is that of a record, warnings are shown, and except the frames nothing is missing that the run was not
asked for."""
import json
import math
import re
import sys
import unittest
import unittest.mock

from results_case import ResultsTest, listening, tables_of
import report
from report import run_page
from synthetic_records import write_table
from words import looks

FRAMES = 5
# volume change [%], inverted tets, step [ms] and error at the joints [%] in frame i
numbers = {"lbs": lambda i: (-2.0 * i, i, 0.01 * (i + 1), 5.0 + i),
           "pbs": lambda i: (-0.25 * i, 0, 1.0 + i, 1.0 + i / 2), "mine": lambda i: (0.5 * i, i, 20.0 - i, 3.0 - i / 4),
           "nh_p1": lambda i: (0.125 * i, 0, 300.0, 0.0)}
MODEL = {"file": "hero.glb", "meshes": ["body", "hat"], "extent_m": 1.75, "metres_per_unit": 0.01,
         "containers": ["Armature"], "joints_dropped": [{"name": "IK <target>", "reason": "no weight"}],
         "bind_pose_deg": 12.5, "animations": ["Walk", "Run"], "joints": ["hips", "knee"],
         "weights_transferred_pct": 98.7}

figures = {}  # most pages here have the same section of figures, which is made once


def figures_once(found, section=run_page.figures_section):
    """Makes the section of figures anew where anything differs that it shows."""
    shown = ((found.folder / "metrics.csv").read_bytes(),
             json.dumps([found.record["scene"], found.record["provenance"]]), str(found.name), found.judges_volume())
    if shown not in figures:
        figures[shown] = section(found)
    return figures[shown]


run_page.figures_section = figures_once


class RunPage(ResultsTest):
    def write(self, labels=("lbs", "pbs", "mine", "nh_p1"), reference="nh_p1", outcome=None, model=None, angles=True,
              **cells):
        """cells: a value for all rows of a column."""
        runs = [{"label": label, "name": label, "variant": "default"} for label in labels]
        scene = {"name": "walk", "runs": runs, "reference": {"name": reference}}
        record = {"scene": scene, "provenance": {"version": "1", "git_revision": "0" * 40, "git_dirty": False},
                  "outcome": {"frames": FRAMES, "warnings": [], **(outcome or {})},
                  "character": {"model": model} if model else {}}
        (self.results / "run.json").write_text(json.dumps(record))
        rows = []
        for frame in range(FRAMES):
            for label in labels:
                change, inverted, ms, error = numbers[label](frame)
                row = {"scene": "walk", "deformer": label, "variant": "default", "iterations": "", "frame": frame,
                       "time_s": frame / 25, "volume_change_pct": change, "inverted_tets": inverted, "step_ms": ms,
                       "error_joint_pct": error if reference else "", "angle_deg": 10 * frame if angles else ""}
                rows.append(row | cells)
        write_table(self.results / "metrics.csv", rows)

    def page(self):
        """Of a run or trial without frames: the page states that, and how to get them."""
        text, missing = run_page.page(self.results)
        is_trial = (self.results / "try.json").exists()
        self.assertEqual(missing, ["viewer: frames/*.vtu: do not exist: `pbskin try --paraview` keeps them" if is_trial
                                   else
                                   "viewer: no frames/*.vtu; run the scene again with `--set output.frames_every=1`"])
        self.assertRegex(text, r"The moving model is missing: viewer.*<code>(pbskin try --paraview|--set "
                               r"output.frames_every=1)</code>")
        return text

    # The tables.

    def test_each_number_of_the_summary_is_that_of_the_records(self):
        self.write()
        header, *rows = tables_of(self.page())["Over all frames"]
        self.assertEqual(header, ["method", "error [%]", "volume [%]", "ms per frame", "inverted tets"])
        self.assertEqual(rows, [["PBS", "2 (3)", "\u22121 to 0", "3", "0"], ["mine", "2.5 (3)", "0 to 2", "18", "4"],
                                ["LBS", "7 (9)", "\u22128 to 0", "0.03", "4"],
                                ["FEM", "the reference", "0 to 0.5", "300", "0"]])

    def test_the_nearest_method_is_named_first(self):
        self.write()
        self.assertIn("<p>PBS is nearest to FEM in 3 of 5 frames, 2 %, before mine, 2.5 %; it loses 1 % of the volume, "
                      "mine gains 2 % of the volume.</p>", self.page())

    def test_a_trial_states_its_nearest_method_itself(self):
        self.write()
        trial = {"summary": "Mine is nearest. On hero.glb, PBS is slow.", "nearest_sentence": "Mine is nearest. ",
                 "warnings": [], "inverting": {"lbs": {"is_excluded": True}, "mine": {"is_excluded": False}}}
        (self.results / "try.json").write_text(json.dumps(trial))
        text = self.page()
        self.assertIn("<p>Mine is nearest. </p>", text)
        self.assertIn(">On hero.glb, PBS is slow.<", text)
        self.assertNotIn("LBS is the fastest", text)

    def test_the_table_and_the_figure_have_the_ranking_of_a_trial(self):
        """Which differs here from that of the rows."""
        self.write(error_l2_pct=3.0)
        methods = [{"deformer": label, "median_pct": error, "nearest_in": 1}
                   for label, error in (("mine", 0.75), ("lbs", 4.5))]
        trial = {"summary": "", "warnings": [], "nearest": {"place": "body", "methods": methods},
                 "inverting": {"pbs": {}}}
        (self.results / "try.json").write_text(json.dumps(trial))
        text = self.page()
        rows = tables_of(text)["Over all frames"][1:]
        self.assertEqual([row[:2] for row in rows], [["mine", "0.75 (3)"], ["PBS", "3 (3)"], ["LBS", "4.5 (3)"],
                                                     ["FEM", "the reference"]])
        self.assertIn("Error over the body: its median", text)
        self.assertIn("Mine has the least error, 0.75 %", text)

    def test_frames_that_one_method_lacks_do_not_count(self):
        """LBS would be nearest by its first frame alone."""
        self.addCleanup(numbers.update, dict(numbers))
        numbers["lbs"] = lambda i: (0.0, 0, 0.01, 0.1 if i == 0 else 50.0)
        numbers["pbs"] = lambda i: (0.0, 0, 1.0, "" if i == 0 else 2.0)
        self.write(labels=("lbs", "pbs", "nh_p1"))
        self.assertIn("<p>PBS is nearest to FEM in all 4 frames, 2 %, before LBS, 50 %", self.page())

    def test_joints_are_sorted_by_the_loss_of_the_first_deformer(self):
        self.write()
        kinds = [("joint", "hips", "knee", {"lbs": -3.5, "pbs": -0.5}),
                 ("joint", "chest", "arm", {"lbs": -7.25, "pbs": 0.25}), ("joint", "knee", "arm", {"lbs": -1.0}),
                 ("bone", "hips", "", {"lbs": -99.0})]
        write_table(self.results / "regions.csv",
                    [{"deformer": label, "kind": kind, "bone": bone, "second_bone": second, "own_change_pct": change}
                     for kind, bone, second, changes in kinds for label, change in changes.items()])
        write_table(self.results / "bones_rest.csv",
                    [{"bone": bone, "parent": parent}
                     for bone, parent in (("hips", ""), ("knee", "hips"), ("chest", "hips"), ("arm", "chest"))])
        tables = tables_of(self.page())
        self.assertEqual(tables["Mean change of the volume of the tets at a joint [% of their volume at rest]"],
                         [["joint", "LBS", "PBS"], ["chest \u2013 arm", "\u22127.25", "0.25"],
                          ["hips \u2013 knee", "\u22123.5", "\u22120.5"]])
        self.assertEqual(tables["Mean change of the volume of the tets where two bones meet [% of their volume "
                                "at rest]"],
                         [["bones", "LBS"], ["knee \u2013 arm", "\u22121"]])
        (self.results / "bones_rest.csv").unlink()  # now nothing states which pairs are bone and parent
        tables = {name: rows for name, rows in tables_of(self.page()).items() if name.startswith("Mean change")}
        self.assertEqual([(name.split(" of the tets ")[1][:10], len(rows)) for name, rows in tables.items()],
                         [("at a joint", 4)])

    def test_distances_are_the_median_and_the_largest_over_the_frames(self):
        self.write()
        write_table(self.results / "distances.csv",
                    [{"deformer": "lbs", "other": "pbs", "of": "surface", "frame": frame, "rms_mm": rms,
                      "largest_mm": 10 * rms}
                     for frame, rms in enumerate((1.5, 4.0, 2.5))])
        rows = tables_of(self.page())["Distances between the same points of two deformers, at the size of this body"]
        self.assertEqual(rows[1], ["LBS and PBS", "surface", "2.5", "40", "3"])

    def test_the_model_is_what_the_run_took_from_it(self):
        self.write(model=MODEL, outcome={"motion": {"clip_joints": 31, "matched_joints": 30}})
        text = self.page()
        for words in ("File: hero.glb; 2 meshes: body, hat.", "Largest extent: 1.75 m, with 0.01 m per unit of "
                                                              "the file.",
                      "Joints dropped: IK &lt;target&gt; (no weight).", "Armature", "bones turn by up to 12.5\u00b0",
                      "Animations: Walk, Run.", "98.7 % of the artist", "2 joints that are bones", "<li>knee</li>",
                      "30 of the clip&#x27;s 31 moving joints match, without fingers and the like."):
            self.assertIn(words, text)

    def test_a_trial_lists_the_animations_of_the_model_and_marks_the_one_that_is_shown(self):
        self.write(model=MODEL | {"animation": "Run"})
        found = [{"name": name, "duration_s": seconds, "largest_rotation_deg": degrees}
                 for name, seconds, degrees in (("Walk", 2.5, 0.25), ("Run", 1, 60))]
        (self.results / "try.json").write_text(json.dumps({"summary": "", "warnings": [], "animations": found}))
        rows = tables_of(self.page())["Animations of the model; --animation NAME takes another one"]
        self.assertEqual(rows[1:], [["Walk", "2.5", "0.25", ""], ["Run", "1", "60", "yes"]])

    # What the run was not asked for.

    def test_no_section_is_there_for_what_the_run_was_not_asked_for(self):
        self.write(reference="")
        text = self.page()
        for anchor in ("warnings", "notes", "joints", "distances", "model", "figure-error-against-time"):
            self.assertNotIn(f'id="{anchor}"', text)
        self.assertIn('id="figure-over-frames"', text)
        self.assertEqual(tables_of(text)["Over all frames"][1], ["LBS", "\u22128 to 0", "0.03", "4"])
        self.assertNotIn("not on record", text)

    def test_a_body_without_a_joint_has_no_column_of_errors_there(self):
        self.write(labels=("lbs", "nh_p1"), error_joint_pct="nan")
        header, first, _ = tables_of(self.page())["Over all frames"]
        self.assertEqual(len(header), len(first))
        self.assertFalse([name for name in header if "error" in name])
        names = [axes.get_ylabel() for axes in run_page.over_frames(run_page.RunRecords(self.results)).axes]
        self.assertEqual(names, ["volume change [%]", "inverted tets"])

    def test_written_frames_without_a_viewer_are_missing(self):
        self.write()
        (self.results / "frames").mkdir()
        (self.results / "frames" / "lbs_000000.vtu").write_text("")
        with unittest.mock.patch.dict(sys.modules, {"viewer.page": None}):
            text, missing = run_page.page(self.results)
        self.assertEqual(len(missing), 1)
        self.assertTrue(missing[0].startswith("viewer: "), missing)
        self.assertRegex(text, r'id="viewer"(.|\n)*The moving model is missing: ')

    def test_without_frames_the_viewer_is_that_of_the_earlier_page(self):
        self.write()
        viewer = ('<div id="frame-viewer">a</div>\n<p class="missing">PBS is not shown</p>\n<script '
                  'type="b">{}</script>\n'
                  '<script id="viewer-block">c</script>\n<script type="module">d</script>')
        for is_trial in (False, True):
            if is_trial:
                (self.results / "try.json").write_text(json.dumps({"summary": "PBS keeps it.", "warnings": []}))
            self.page()  # without an earlier page it is missing
            (self.results / "report.html").write_text(f"<html>{viewer}\n<script>e</script></html>")
            text, missing = run_page.page(self.results)
            self.assertEqual((text.count(viewer), text.count("<script>e"), missing), (1, 0, []))
            (self.results / "report.html").unlink()

    # Warnings and sentences.

    def test_warnings_are_shown(self):
        self.write(outcome={"warnings": ["no joint moves", "<b> is outside"],
                            "bad_frame": "pose not reached: nh_p1 in frame 3",
                            "breakdown": "pbs is not finite in frame 2"})
        text = self.page()
        shown = re.search(r'id="warnings".*?</section>', text, re.DOTALL)[0]
        for words in ("no joint moves", "&lt;b&gt; is outside", "pose not reached: nh_p1 in frame 3",
                      "pbs is not finite in frame 2"):
            self.assertIn(words, shown)
        self.assertLess(text.index('id="warnings"'), text.index('id="frames"'))

    def test_the_sentence_and_the_warnings_of_a_trial_come_first(self):
        self.write(outcome={"warnings": ["of the run"]})
        self.assertNotIn("PBS keeps it", self.page())
        (self.results / "try.json").write_text(json.dumps({"summary": "PBS keeps it.",
                                                           "warnings": ["of the trial", "of the run"]}))
        text = self.page()
        self.assertIn("<h2>What changes?</h2><p>PBS keeps it.</p>", re.sub("</?a[^>]*>", "", text))
        self.assertEqual((text.count("of the trial"), text.count("of the run")), (1, 1))
        links, ids = (set(re.findall(pattern, text)) for pattern in (r'href="#([^"]+)"', r'id="([^"]+)"'))
        self.assertTrue(links and links <= ids, links - ids)

    def test_where_bones_are_stretched_volume_is_not_judged(self):
        """A warning states why, so that the page only leaves it out."""
        self.write(outcome={"motion": {"stretched_bones": [{"bone": "top", "change_pct": 53.0, "frame": 2}]}},
                   model=MODEL)
        write_table(self.results / "regions.csv",
                    [{"deformer": "lbs", "kind": "joint", "bone": "hips", "second_bone": "knee",
                      "own_change_pct": -3.5}])
        text = self.page()
        self.assertEqual(tables_of(text)["Over all frames"][0],
                         ["method", "error [%]", "ms per frame", "inverted tets"])
        self.assertIn("<p>PBS is nearest to FEM in 3 of 5 frames, 2 %, before mine, 2.5 %.</p>", text)
        self.assertIn("Joints move apart, so that volume is not judged.", text)
        self.assertIn("Bones whose distance from their parent changes by more than 10 %: top by +53 % in frame 2.",
                      text)
        self.assertNotIn('id="joints"', text)
        self.assertNotIn("volume change [%]", text)

    def test_a_few_inverted_tets_do_not_decide_which_method_is_nearest(self):
        """mine has 2 i inverted tets in frame i, and LBS half as many."""
        self.addCleanup(numbers.update, dict(numbers))
        numbers["mine"] = lambda i: (0.5 * i, 2 * i, 20.0 - i, 0.5)
        self.write()
        self.assertIn("<p>Mine is nearest to FEM in all 5 frames, 0.5 %, before PBS, 2 %; it gains 2 % of the volume, "
                      "PBS loses 1 % of the volume.</p>", self.page())

    def test_what_the_viewer_would_show_is_kept_until_its_program_is_built(self):
        self.write()
        (self.results / "try.json").write_text(json.dumps({"summary": "", "warnings": []}))
        kept = ('<div id="frame-viewer"></div>\n<script type="application/json" id="viewer-header">{}</script>\n'
                '<script type="application/octet-stream;base64" id="viewer-block">AAAA</script>')
        with unittest.mock.patch.dict("os.environ", {"PBS_VIEWER_BUILD": str(self.results)}):
            for is_built in (False, True, True):
                (self.results / "report.html").write_text(kept if not is_built else text)
                if is_built:
                    (self.results / "viewer.js").write_text("// a viewer")
                text, missing = run_page.page(self.results)
                self.assertIn(kept, text)
                self.assertEqual(text.count("// a viewer"), is_built)
                self.assertEqual(missing, [] if is_built else
                                 ["viewer: viewer.js is not built: npm ci && npm run build, in paper_figures/viewer; "
                                  "then `pbskin report` adds it to this page"])

    def test_notes_are_apart_from_warnings(self):
        self.write(outcome={"notes": ["nothing is wrong"]})
        text = self.page()
        self.assertNotIn('id="warnings"', text)
        self.assertRegex(text, r'id="notes"(.|\n)*nothing is wrong')

    def test_a_damaged_record_is_refused_by_name(self):
        self.write()
        (self.results / "try.json").write_text('{"summary": 3, "warnings": []}')
        with listening() as (_, complaints):
            self.assertEqual(report.main(self.results, quiet=True), 2)
        self.assertIn("try.json: summary = 3: expected a text", complaints.getvalue())
        self.assertFalse((self.results / "report.html").exists())

    # The figures.

    def test_error_against_time_has_the_medians_of_each_deformer(self):
        self.write()
        axes = run_page.error_against_time(run_page.methods_of(run_page.RunRecords(self.results)),
                                           "at the joints").axes[0]
        points = {line.get_label(): (line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines}
        self.assertEqual(points, {"LBS": (0.03, 7.0), "PBS": (3.0, 2.0), "mine": (18.0, 2.5)})

    def test_the_lines_over_the_frames_are_the_columns(self):
        for angles, x, unit in ((True, [0, 10, 20, 30, 40], "angle [degrees]"),
                                (False, [0, 0.04, 0.08, 0.12, 0.16], "time [s]")):
            self.write(angles=angles)
            figure = run_page.over_frames(run_page.RunRecords(self.results))
            self.assertEqual(figure.axes[-1].get_xlabel(), unit)
            for axes, at in zip(figure.axes, (0, 3, 1)):  # volume, error, inverted tets
                lines = {line.get_label(): line for line in axes.lines}
                self.assertEqual(list(lines["mine"].get_xdata()), x)
                self.assertEqual(list(lines["mine"].get_ydata()),
                                 [numbers["mine"](frame)[at] for frame in range(FRAMES)])

    def test_no_line_joins_points_over_frames_without_a_value(self):
        self.addCleanup(numbers.update, dict(numbers))
        numbers["mine"] = lambda i: (0.5, 0, 20.0, 3.0 if i in (1, 3, 4) else "")
        self.write()
        lines = {line.get_label(): line
                 for line in run_page.over_frames(run_page.RunRecords(self.results)).axes[1].lines}
        self.assertEqual([math.isfinite(y) for y in lines["mine"].get_ydata()], [False, True, False, True, True])
        self.assertEqual(lines["mine"].get_markevery(), 1)

    def test_deformers_that_are_not_of_this_project_look_different(self):
        with unittest.mock.patch.dict(numbers, {"one": numbers["mine"], "two": numbers["mine"]}):
            self.write(labels=("lbs", "one", "two"), reference="")
            found = run_page.RunRecords(self.results)
        shown = [looks.of(label) for label in found.labels()]
        self.assertEqual(len({(look.color, look.marker) for look in shown}), 3)
        self.assertEqual([look.name for look in shown], ["LBS", "one", "two"])

    def test_the_picture_of_a_run_is_written_next_to_its_records(self):
        self.write()
        self.assertEqual(report.picture(self.results), 0)
        self.assertTrue((self.results / "picture.png").read_bytes().startswith(b"\x89PNG"))
        (self.results / "metrics.csv").unlink()
        with listening() as (_, complaints):
            self.assertEqual(report.picture(self.results), 2)
        self.assertIn("metrics.csv", complaints.getvalue())

    # Runs in which nothing happens, or nothing is left.

    def test_a_run_in_which_every_number_is_zero(self):
        with unittest.mock.patch.dict(numbers, {"lbs": lambda i: (0.0, 0, 0.01, 0.0)}):
            self.write(labels=("lbs",), reference="")
        self.assertEqual(tables_of(self.page())["Over all frames"][1][1], "0")

    def test_a_deformer_that_broke_down_in_every_frame(self):
        for value in ("", "nan"):
            self.write(reference="", labels=("lbs",), volume_change_pct=value, step_ms=value)
            self.assertEqual(tables_of(self.page())["Over all frames"][1], ["LBS", "\u2013", "\u2013", "4"])


if __name__ == "__main__":
    unittest.main()
