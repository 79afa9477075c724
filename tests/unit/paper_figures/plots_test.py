"""Reference: the definition. A plot shows the rows that it names, with their numbers in the CSV behind it and under the
pointer. A still shows tets in the colours of its bar and hides nothing in front of them, and a clip plays at the speed
of the records. VTK needs a display; xvfb-run provides one."""
import re
import unittest
import unittest.mock
from xml.etree import ElementTree

import numpy
from PIL import Image

from results_case import ResultsTest
import synthetic_frames
import synthetic_records
from drawing import bodies, rendering, style
from figures import mechanics, stills, volume
from records import recorded_frames
from words import looks

svg = "{http://www.w3.org/2000/svg}"
still = (120, 90)  # size of a picture [px]


class Plots(ResultsTest):
    def drawn(self, name):
        self.stem = self.results / "figures" / name
        return super().drawn(name)

    def titles(self, x_label):
        """The titles under the pointer in the panels with this x axis."""
        page = ElementTree.parse(self.stem.with_suffix(".svg"))
        return [title.text for group in page.iter(svg + "g") if group.get("data-x") == x_label
                for title in group.iter(svg + "title")]

    def test_titles_of_a_line_are_its_numbers(self):
        synthetic_records.write_study(self.results)
        rows = [row for row in self.drawn("volume_over_angle") if row["deformer"] == "lbs"
                and row["scene"] == "limb_twist"]
        shown = [title for title in self.titles("") if title.startswith("LBS: ")]  # the label of the axis is below
        expected = ["LBS: {:.6g}, {:.6g}".format(float(row["angle_deg"]), float(row["volume_change_pct"]))
                    for row in rows]
        self.assertEqual(shown[:len(expected)], expected)

    def test_titles_lie_where_matplotlib_puts_the_marks(self):
        synthetic_records.write_study(self.results)
        self.drawn("volume_over_clip")
        page = self.stem.with_suffix(".svg").read_text()
        circles = [tuple(map(float, place)) for place in re.findall(r'<circle cx="([-.\d]+)" cy="([-.\d]+)"', page)]
        panels = page[page.index('id="axes_1"'):page.index('id="legend_1"')]
        marks = re.findall(rf'x="([-.\d]+)" y="([-.\d]+)" style="fill: {looks.of("pbs").color.lower()}', panels)
        colored = [tuple(map(float, place)) for place in marks]
        self.assertGreater(len(colored), 10)
        for x, y in colored:
            self.assertLess(min(abs(x - u) + abs(y - v) for u, v in circles), 0.2)

    def test_convergence(self):
        synthetic_records.write_convergence(self.results / "convergence")
        rows = self.drawn("convergence_iterations")
        self.assertEqual(len(rows), 3 * 2 * 4 * 4)  # cases, measures, initial guesses, iterations
        values = {(row["case"], row["start"], row["measure"], float(row["iteration"])): float(row["value"])
                  for row in rows}
        self.assertEqual(values["human", "lbs", "error_joint_pct", 24.0], 60.0 / 25)
        self.assertEqual(values["limb_twist", "rest_pose", "combined", 0.0], 3.0)
        rows = self.drawn("convergence_mesh")
        self.assertEqual([row["vertices"] for row in rows], ["500", "1000", "2000"] * 2)
        self.assertIn("twist 90\u00b0, reached: 1000, 100", self.titles("vertices of the limb"))
        self.assertIn("twist 90\u00b0, not reached: 500, 1000", self.titles("vertices of the limb"))

    def test_an_attachment_that_was_not_reached_keeps_its_place_and_says_so(self):
        synthetic_records.write_error_split(self.results / "ensemble")
        axes, save = [], style.save

        def kept(figure, *others, **options):
            axes.extend(figure.axes)
            save(figure, *others, **options)

        with unittest.mock.patch.object(style, "save", kept):
            rows = self.drawn("error_split")
        self.assertEqual([row["value_pct"] for row in rows if row["at"] == "bind constraint"], ["80.0", "nan"])
        for panel in axes[2:4]:
            names = [text.get_text() for text in panel.get_yticklabels()]
            self.assertEqual(names, ["linear smooth", "bind constraint", "embedded", "q 10, core 0.7"])
            self.assertEqual(panel.get_ylim(), (-0.5, 3.5))
        self.assertEqual([text.xy[1] for text in axes[3].texts], [1])
        self.assertEqual(self.stem.with_suffix(".svg").read_text().count("not reached"), 1)

    def test_sections_are_of_one_mesh_and_the_best_elements(self):
        synthetic_records.write_artefacts(self.results / "artefacts")
        rows = self.drawn("section_profiles")
        self.assertEqual(len(rows), 6 * 4 * 3)  # panels, deformers, sections
        self.assertEqual({(row["deformer"], round(float(row["area_over_rest_pct"]), 6)) for row in rows},
                         {("lbs", 50.0), ("dqs", 110.0), ("pbs", 100.0), ("nh_p2", 100.0)})
        self.assertEqual([float(row["offset_cm"]) for row in rows[:3]], [-10.0, 0.0, 10.0])

    def test_stability(self):
        synthetic_records.write_stability(self.results / "stability")
        self.assertEqual(len(self.drawn("stability_maps")), 2 * 6)
        shown = self.titles("iterations")
        self.assertIn("diverged: 10, 90", shown)  # the names of the cell as on the axes
        self.assertIn("converged: at rest, as if undisturbed: 1, 0", shown)
        self.assertEqual(len(shown), 6)
        rows = self.drawn("stability_cells")
        self.assertEqual([(row["model"], row["value"]) for row in rows],
                         [("pbs", "10"), ("pbs", "1"), ("xpbd", "10"), ("xpbd", "1")])
        self.assertIn("gravity: 1 g to 10 g", self.stem.with_suffix(".svg").read_text())

    def test_jiggle_leaves_out_swings_that_were_not_found(self):
        synthetic_records.write_jiggle(self.results / "jiggle")
        rows = [row for row in self.drawn("jiggle_response") if row["varied"] == "k_stretch"]
        self.assertEqual([(float(row["k_stretch"]), float(row["frequency_hz"])) for row in rows],
                         [(0.1, 10.0), (0.4, 20.0)])
        shown = [title for title in self.titles("k_stretch [1]") if title.startswith("neo-Hookean FEM")]
        self.assertEqual(shown, ["neo-Hookean FEM, linear elements, in time, limb: 0.1, 0.5"])
        self.assertEqual([title for title in self.titles("") if "FEM" in title], [])  # their frequency was chosen

    def test_stiffness_is_of_answers_that_converged_and_that_of_xpbd_of_one_material(self):
        synthetic_records.write_stiffness(self.results / "stiffness")
        drawn = self.drawn("stiffness")
        rows = [row for row in drawn if (row["body"], row["varied"], row["method"]) == ("limb", "time_step_ms", "pbs")]
        self.assertEqual([(row["time_step_ms"], float(row["stiffness_n_m"])) for row in rows],
                         [("5", 960.0), ("10", 240.0)])
        rows = [row for row in drawn if row["method"] == "xpbd"]
        self.assertEqual({float(row["young_pa"]) for row in rows}, {30e3})
        self.assertEqual({float(row["stiffness_n_m"]) for row in rows}, {50.0})
        with unittest.mock.patch.object(mechanics, "stiffest_n_m", 500.0):  # beyond rounding: not shown, and counted
            rows = self.drawn("stiffness")
        rows = [row for row in rows if (row["body"], row["varied"], row["method"]) == ("limb", "time_step_ms", "pbs")]
        self.assertEqual([row["time_step_ms"] for row in rows], ["10"])
        self.assertEqual(self.stem.with_suffix(".svg").read_text().count("1 stiffer, not shown"), 3)  # once per body

    def test_momentum(self):
        synthetic_records.write_momentum(self.results / "momentum")
        rows = self.drawn("momentum_drift")
        # bodies, masses, classes, momenta, precisions, without the rows of a whole pass.
        self.assertEqual(len(rows), 2 * 3 * 3 * 2 * 2)
        unweighted = [row for row in rows if row["constraints"] == "volume" and row["masses"] == "unequal_by_eq_8_9"]
        self.assertEqual({row["drift"] for row in unweighted}, {"0.25"})
        self.assertIn("limb, f32: 0.25, stretch, unequal masses, Eq. 8\u20139",
                      self.titles("change over the momentum exchanged [1]"))

    def test_regions(self):
        synthetic_records.write_study(self.results)
        self.drawn("volume_by_region")
        self.assertIn("LBS: -1, spine\u2013chest", self.titles("change [% of the body's volume]"))
        self.assertEqual([volume.in_words(bones) for bones in (("upper_arm.L",), ("chest", "clavicle.R"),
                                                               ("thigh.R", "shin.R"))],
                         ["left upper arm", "chest\u2013right clavicle", "right thigh\u2013shin"])

    def test_timing(self):
        synthetic_records.write_timing_of_sizes(self.results / "timing")
        rows = self.drawn("timing_sizes")
        stretch_ms = next(float(row["stretch_ms"]) for row in rows
                          if (row["variant"], row["mesh"]) == ("plain", "man_1654"))
        # The time of stretch is without LBS and bind.
        self.assertIn(f"stretch: {stretch_ms:.6g}, man, 1,654", self.titles("processor time [ms]"))
        expected = {"ordered, f32: 20000, 2.5", "paper, by frame rate: 1654, 11", "paper, by CT: 1654, 0.52"}
        self.assertLessEqual(expected, set(self.titles("vertices")))

    def test_costs_of_features(self):
        synthetic_records.write_features(self.results / "timing")
        self.assertEqual(len(self.drawn("features_cost")), 3)
        shown = self.titles("time per frame, with over without [1]")
        self.assertEqual(shown, ["limb: 0.5, sleep", "human: 0.5, sleep", "human: 1.5, rendered surface"])

    def test_a_clip_and_the_initial_guess_of_its_frames(self):
        synthetic_records.write_temporal(self.results / "temporal")
        self.assertEqual({row["motion"] for row in self.drawn("clip_temporal")}, {"01_01"})
        self.assertIn("PBS: 25, 0.5", self.titles("frame, 60 per second"))
        self.assertIn("worse in 1 of 1", self.stem.with_suffix(".svg").read_text())


class Stills(ResultsTest):
    def write(self, scene):
        synthetic_frames.write_frames(self.results, scene)
        return recorded_frames.Frames(self.results, scene)

    def shot(self, actors, shift_m=0.0):
        """One metre around the first tet, whose first corner faces the camera."""
        view = rendering.Camera((0.2 + shift_m, 0.2, 0.2), 0.5, (-1.0, -1.0, -1.0))
        return rendering.Stage(*still, background=(0.0, 0.0, 1.0)).shot(actors, view)

    def test_tets_have_the_colours_of_the_bar(self):
        frames = self.write("limb_twist")
        for frame in (0, 2, 3):  # it is inverted in frame 2
            ratio = synthetic_frames.ratios_of("lbs", frame)[0]
            color = rendering.inverted_color if ratio < 0 else rendering.ratio_colors(rendering.ratio_scale(ratio))[:3]
            around = self.shot([rendering.tets(frames.tets("lbs", frame))], 0.3 * frame)[30:60, 45:75].reshape(-1, 3)
            pixel = around[around.sum(axis=1).argmax()]  # the brightest: a highlight would change its hue
            # The quotients are without shading.
            numpy.testing.assert_allclose(pixel / pixel.max(), numpy.array(color) / max(color), atol=0.05)

    def test_the_scale_reads_in_grey_and_inverted_is_darker_than_all_of_it(self):
        colors = numpy.array([*rendering.ratio_colors(numpy.linspace(0, 1, 50))[:, :3], rendering.inverted_color])
        linear = numpy.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
        *scale, inverted = linear @ (0.2126, 0.7152, 0.0722)
        self.assertTrue((numpy.diff(scale) > 0).all())
        self.assertLess(2 * inverted, scale[0])

    def test_bones_moved_towards_the_camera_stay_where_they_are_in_the_still(self):
        bone = recorded_frames.Bone("bone", numpy.array([0.2, 0.2, 0.2]), numpy.array([0.2, 0.4, 0.2]))
        plain = self.shot(bodies.bones([bone], 0.02))
        moved = self.shot(bodies.bones([bone], 0.02, towards=(-1.0, -1.0, -1.0)))
        self.assertLess(numpy.count_nonzero((plain != moved).any(axis=2)), 10)
        self.assertGreater(numpy.count_nonzero((plain != [0, 0, 255]).any(axis=2)), 100)
        hidden = self.shot([*bodies.bones([bone], 0.02), bodies.skin(self.write("limb_bend").tets("lbs", 0))])
        # The bone, which is black, lies within the tet.
        self.assertTrue((hidden[still[1] // 2, still[0] // 2] > 60).any())

    def test_the_cut_keeps_the_tets_behind_it(self):
        data = rendering.read(self.write("limb_bend").tets("lbs", 0))
        ahead_m = numpy.array([-1.0, -0.1, -0.1, -0.1, 2.0])  # the second tet extends far in front of the cut
        kept = bodies.cut_open(data, ahead_m).GetMapper().GetInput()
        self.assertEqual(kept.GetNumberOfCells(), 4)
        self.assertEqual(kept.GetBounds(), (0, 1, 0, 1, 0, 1))
        self.assertEqual(bodies.cut_open(data, ahead_m - 2).GetMapper().GetInput().GetNumberOfCells(), 6)

    def test_the_clip_plays_at_the_records_speed_and_says_its_source(self):
        frames = self.write("human_jump")
        file = self.results / "clip.webp"
        origin = {"version": "0.1.0", "git_revision": "abc", "rights": "whose it is"}
        stills.draw_clip(file, frames, origin)
        with Image.open(file) as clip:
            self.assertEqual((clip.n_frames, clip.width), (4, 3 * stills.pixels[0]))
            clip.seek(1)
            clip.load()
            self.assertEqual(clip.info["duration"], 10)  # frames at intervals of 0.01 s
        self.assertIn(b"abc", file.read_bytes())
        self.assertIn(b"whose it is", file.read_bytes())


if __name__ == "__main__":
    unittest.main()
