"""Surfaces on which the mesher would go on without end, and work that is interrupted: each ends soon, and leaves
nothing half-written. Reference: the bounds in experiments/meshes/meshing_surface.cpp and the exit statuses in
experiments/command_line/README.md."""
import os
import signal
import subprocess
import time
import unittest

import numpy

import program
import rig_files
import run_records

LONG = bool(os.environ.get("PBS_LONG"))
LARGE = ("--vertices", "99900")  # meshing takes minutes


def open_tube():
    """A tube that lacks a third of its triangles. The layer along a thicker one has more tets."""
    points, triangles = rig_files.tube()
    return points * [1.0, 0.7, 0.7], triangles[:2 * len(triangles) // 3]


def flat_tube():
    """The wrap of this closed surface is a thin layer too."""
    points, triangles = rig_files.tube()
    return points * [1.0, 1.0, 0.01], triangles


def open_boxes():
    """A robot: 36 boxes side by side, each without two of its faces."""
    corners = numpy.array([[x, y, z] for x in (0.0, 0.07) for y in (-0.05, 0.05) for z in (-0.05, 0.05)])
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3)]
    box = numpy.array([triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))])
    places = [(x / 12, y, 0.0) for x in range(12) for y in (-0.12, 0.0, 0.12)]
    return (numpy.concatenate([corners + place for place in places]),
            numpy.concatenate([box + 8 * number for number in range(len(places))]))


class MeshingEnds(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.environment = {**os.environ, "PBSKIN_CACHE": self.path("cache"), "NO_COLOR": "1"}

    def rig(self, surface=None):
        return rig_files.write("plain", self.path("rig.glb"), surface=surface)

    def ends_soon(self, expected, surface, *arguments):
        """The process of `pbskin try` with this surface, which ends with the status `expected`."""
        start_s = program.processor_s()
        process = self.ends(expected, "try", self.rig(surface), "-o", self.path("out"), "--no-reference", "--frames",
                            "2", *arguments, env=self.environment)
        # All attempts make up to 60,000 vertices, which take 1 ms each, and up to twice as long where other work fills
        # the caches.
        self.assertLess(program.processor_s() - start_s, 2 * 60.0)
        self.assertLess(program.most_memory_bytes(), program.MOST_BYTES)
        return process

    def test_an_open_tube_becomes_a_layer_and_the_warning_states_what_to_do(self):
        process = self.ends_soon(0, open_tube())
        self.assertIn("3 of 3 bones lie outside the body: root, elbow, tip; the surface is open, and the tets fill a "
                      "layer along it: close it", process.stderr)

    def test_a_body_thinner_than_its_tets_is_enclosed_at_a_distance(self):
        process = self.ends_soon(0, flat_tube(), "--vertices", "300")
        self.assertIn("parts of the body are thinner than the tets, which enclose it at a distance of 1.2 % of "
                      "its size", process.stderr)

    @unittest.skipUnless(LONG, "takes 40 s")
    def test_open_boxes_that_reach_the_bounds(self):
        self.ends_soon(0, open_boxes())

    def interrupted(self, kill, *arguments):
        """What was printed by a program that got the signal in the stage `filling the wrap`, whose line it had
        printed."""
        process = subprocess.Popen([program.PBSKIN, *arguments], stderr=subprocess.PIPE, text=True,
                                   env=self.environment)
        printed = ""
        while "filling the wrap with tets, attempt 1 ...\n" not in printed:
            line = process.stderr.readline()
            self.assertNotEqual(line, "", f"it ended: {printed}")
            printed += line
        start_s = time.monotonic()
        process.send_signal(kill)
        _, rest = process.communicate(timeout=60)
        # Within a second, which other work on the processor stretches.
        self.assertLess(time.monotonic() - start_s, 1.0 + 0.3 * os.getloadavg()[0] / os.cpu_count())
        self.assertEqual(process.returncode, 130, printed + rest)
        self.assertEqual(rest.splitlines()[-1], "pbskin: interrupted; what was finished is kept")

    def test_a_signal_ends_meshing(self):
        self.interrupted(signal.SIGTERM, "try", self.rig(), "-o", self.path("out"), "--no-reference", *LARGE)
        # The lock stays in the cache.
        left = [path for path in run_records.files(self.folder) if path.name != "making.lock"]
        self.assertEqual([path for path in left if run_records.is_temporary(path) or run_records.what_is_torn(path)],
                         [])
        points, triangles = rig_files.tube()
        lines = [f"v {x} {y} {z}" for x, y, z in points] + [f"f {a} {b} {c}" for a, b, c in triangles + 1]
        self.interrupted(signal.SIGINT, "mesh", self.write("tube.obj", "\n".join(lines)), "-o", self.path("tets.msh"),
                         *LARGE)
        self.assertFalse(os.path.exists(self.path("tets.msh")))


if __name__ == "__main__":
    unittest.main()
