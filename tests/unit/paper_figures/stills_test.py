"""Reference: the definition. A still shows tets in the colours of its bar and hides nothing in front of them, and a clip plays at the speed
of the records. VTK needs a display; xvfb-run provides one."""
import unittest

import numpy
from PIL import Image

from results_case import ResultsTest
import synthetic_frames
from drawing import bodies, rendering
from figures import stills
from records import recorded_frames

size = (120, 90)


class Stills(ResultsTest):
    def write(self, scene):
        synthetic_frames.write_frames(self.results, scene)
        return recorded_frames.Frames(self.results, scene)

    def shot(self, actors, shift_m=0.0):
        """One metre around the first tet, whose first corner faces the camera."""
        view = rendering.Camera((0.2 + shift_m, 0.2, 0.2), 0.5, (-1.0, -1.0, -1.0))
        return rendering.Stage(*size, background=(0.0, 0.0, 1.0)).shot(actors, view)

    def assert_hue(self, pixel, color):
        """Compares hues without shading: the channels have the proportions of the colour."""
        numpy.testing.assert_allclose(pixel / pixel.max(), numpy.array(color) / max(color), atol=0.05)

    def test_tets_have_the_colours_of_the_bar(self):
        frames = self.write("limb_twist")
        for frame in (0, 2, 3):  # it is inverted in frame 2
            ratio = synthetic_frames.ratios_of("lbs", frame)[0]
            color = rendering.inverted_color if ratio < 0 else rendering.ratio_colors(rendering.ratio_scale(ratio))[:3]
            around = self.shot([rendering.tets(frames.tets("lbs", frame))], 0.3 * frame)[30:60, 45:75].reshape(-1, 3)
            self.assert_hue(around[around.sum(axis=1).argmax()], color)  # the brightest pixel: a highlight would change its hue

    def test_the_scale_reads_in_grey_and_inverted_is_darker_than_all_of_it(self):
        colors = numpy.array([*rendering.ratio_colors(numpy.linspace(0, 1, 50))[:, :3], rendering.inverted_color])
        linear = numpy.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
        *scale, inverted = linear @ (0.2126, 0.7152, 0.0722)
        self.assertTrue((numpy.diff(scale) > 0).all())
        self.assertLess(2 * inverted, scale[0])

    def test_what_is_beside_the_body_is_background(self):
        frames = self.write("limb_twist")
        self.assertEqual(self.shot([bodies.skin(frames.tets("lbs", 0))])[0, 0].tolist(), [0, 0, 255])

    def test_bones_moved_towards_the_camera_stay_where_they_are_in_the_still(self):
        bone = recorded_frames.Bone("bone", numpy.array([0.2, 0.2, 0.2]), numpy.array([0.2, 0.4, 0.2]))
        plain = self.shot(bodies.bones([bone], 0.02))
        moved = self.shot(bodies.bones([bone], 0.02, towards=(-1.0, -1.0, -1.0)))
        self.assertLess(numpy.count_nonzero((plain != moved).any(axis=2)), 10)
        self.assertGreater(numpy.count_nonzero((plain != [0, 0, 255]).any(axis=2)), 100)
        hidden = self.shot([*bodies.bones([bone], 0.02), bodies.skin(self.write("limb_bend").tets("lbs", 0))])
        self.assertTrue((hidden[size[1] // 2, size[0] // 2] > 60).any())  # the bone, which is black, lies within the tet

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
