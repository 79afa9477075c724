"""The artist's surface of a rigged model in every frame. Reference: the file format's own skinning formula, computed
from the bytes of the file by skin_formula.py and fbx_formula.py. The tolerance of 1e-6 of the model's size covers the
single precision in which the files store their numbers."""
import glob
import os
import pathlib
import unittest
import xml.etree.ElementTree
import zipfile

import numpy

import fbx_formula
import program
import rig_files
import skin_formula
from written_frames import points_of

SCENE = pathlib.Path(__file__).with_name("artist_skin.toml").read_text()
FRAMES = 5
INSTALLED = "/usr/share/assimp/models"
SIMPLE_SKIN = f"{INSTALLED}/glTF2/simple_skin/simple_skin.gltf"
FBX_SKIN = f"{INSTALLED}/FBX/animation_with_skeleton.fbx"
FBX_THREE_ANGLES = f"{INSTALLED}/FBX/huesitos.fbx"
HUMAN, CLIP = f"{INSTALLED}/Collada/human.zae", f"{INSTALLED}/BVH/01_01.bvh"
# These lead to the neighbours in a grid.
SHIFTS = [numpy.array([x, y, z]) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]


def nearest(points, others):
    """The index of the nearest of `points` for each of the others. Readers repeat points along seams, in any order."""
    return numpy.array([((points - other)**2).sum(axis=1).argmin() for other in others])


class SkinTest(program.ProgramTest):
    def compare(self, model_file, animation=None):
        model = skin_formula.Model(model_file)
        begin, end = model.span_s(animation)
        rate_hz = (FRAMES - 1) / (end - begin)
        name = animation if animation is not None else model.animation(None).get("name", "animation 0")
        self.run_scene(model_file, name, rate_hz)
        for frame in range(FRAMES):
            expected = model.points(animation, begin + frame / rate_hz)
            self.check_frame(frame, expected, numpy.linalg.norm(numpy.ptp(expected, axis=0)))
        self.assertEqual(len(glob.glob(self.path("run", "skin", "artist_*.vtp"))), FRAMES)

    def run_scene(self, model_file, animation, rate_hz):
        self.succeeds("run", self.write("scene.toml", SCENE % (model_file, animation, rate_hz)), "-o", self.path("run"))

    def artist(self, frame):
        return points_of(self.path("run", "skin", f"artist_{frame:06}.vtp"))

    def check_frame(self, frame, expected, size):
        artist = self.artist(frame)
        self.assertEqual(artist.shape, expected.shape)
        self.assertLess(abs(artist - expected).max(), 1e-6 * size, f"frame {frame}")
        self.check_carried(frame, expected)

    def check_carried(self, frame, expected):
        """The surface carried by the tets of lbs stays within 1.5 % of the size."""
        carried = points_of(self.path("run", "frames", f"lbs_surface_{frame:06}.vtp"))
        size = numpy.linalg.norm(numpy.ptp(expected, axis=0))
        self.assertLess(numpy.linalg.norm(carried - expected, axis=1).max(), 0.015 * size, f"frame {frame}")


class ArtistSkin(SkinTest):
    def test_each_rig_with_an_animation(self):
        for variant, options in rig_files.VARIANTS.items():
            if options.get("animations", ["Bend"]):
                with self.subTest(variant):
                    # The cache has one mesh for those with the same surface.
                    self.compare(rig_files.write(variant, self.path("rig.glb")))

    def test_the_second_animation(self):
        self.compare(rig_files.write("two_animations", self.path("rig.glb")), "Twist")

    def compare_fbx(self, file, rate_hz, frames):
        model = fbx_formula.Model(file)
        begin, _ = model.span_s()
        self.run_scene(file, model.animation(None)["name"], rate_hz)
        formula = [model.metres_per_unit * model.points(None, begin + frame / rate_hz) for frame in range(frames)]
        size = numpy.linalg.norm(numpy.ptp(formula[0], axis=0))
        taken = nearest(formula[0], self.artist(0))
        self.assertEqual(len(set(taken)), len(formula[0]))
        for frame, points in enumerate(formula):
            self.assertLess(numpy.linalg.norm(self.artist(frame) - points[taken], axis=1).max(), 1e-6 * size,
                            f"frame {frame}")

    @unittest.skipUnless(os.path.exists(FBX_THREE_ANGLES), "assimp-testmodels is not installed")
    def test_fbx_at_and_between_keys(self):
        """There are keys at every second of 48 and of 50 frames; three angles move in the second file."""
        for file, rate_hz, frames in (FBX_SKIN, 48.0, 41), (FBX_THREE_ANGLES, 50.0, 79):
            with self.subTest(file, rate_hz=rate_hz):
                self.compare_fbx(file, rate_hz, frames)
                if file == FBX_SKIN:
                    for frame in range(frames):
                        self.check_carried(frame, self.artist(frame))

    @unittest.skipUnless(os.path.exists(SIMPLE_SKIN), "assimp-testmodels is not installed")
    def test_simple_skin(self):
        self.compare(SIMPLE_SKIN)


def collada_points(path):
    """The positions of all geometries of a .zae whose nodes have identity transforms and whose unit is the metre, #P x
    3."""
    space = "{http://www.collada.org/2005/11/COLLADASchema}"
    with zipfile.ZipFile(path) as archive:
        root = xml.etree.ElementTree.fromstring(archive.read(next(name for name in archive.namelist()
                                                                  if name.endswith(".dae"))))
    identity = numpy.eye(4).ravel().tolist()
    assert all([float(x) for x in matrix.text.split()] == identity for matrix in root.iter(f"{space}matrix"))
    assert float(root.find(f"{space}asset/{space}unit").get("meter")) == 1.0
    points = []
    for mesh in root.iter(f"{space}mesh"):
        source = mesh.find(f"{space}vertices/{space}input[@semantic='POSITION']").get("source")[1:]
        array = mesh.find(f"{space}source[@id='{source}']/{space}float_array")
        points.append(numpy.array(array.text.split(), dtype=float).reshape(-1, 3))
    return numpy.concatenate(points)


@unittest.skipUnless(os.path.exists(HUMAN), "assimp-testmodels is not installed")
class Human(program.ProgramTest):
    """MakeHuman's body as its authors export it: a surface without joints, which takes the skeleton of the body
    `human`."""

    def test_the_surface_at_rest_is_that_of_the_file_and_the_clip_moves_it(self):
        self.succeeds("try", HUMAN, "--skeleton", "human", "--animation", CLIP, "-o", self.path("out"),
                      "--no-reference", "--frames", "3", "--vertices", "600", "--paraview")
        expected = collada_points(HUMAN)
        found = points_of(self.path("out", "surface_rest.vtp"))
        tolerance = 1e-6 * numpy.linalg.norm(numpy.ptp(expected, axis=0))
        rounded = {tuple(numpy.rint(point / tolerance / 4)) for point in expected}
        near = [any(tuple(numpy.rint(point / tolerance / 4) + shift) in rounded for shift in SHIFTS) for point in found]
        self.assertTrue(all(near))
        self.assertGreaterEqual(len(found), 0.95 * len(expected))  # some points belong to no triangle
        moved = points_of(self.path("out", "frames", "pbs_surface_000002.vtp"))
        self.assertGreater(abs(moved - found).max(), 0.1)
        with zipfile.ZipFile(HUMAN) as archive:
            texture = archive.read("textures/brown_eye.png")
        with open(self.path("out", "frames", "pbs.glb"), "rb") as file:
            self.assertIn(texture, file.read())


if __name__ == "__main__":
    unittest.main()
