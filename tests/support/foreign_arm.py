"""A tet mesh, skeleton and scene that no part of the project has generated: a tapered box with two bones, written as Gmsh 2.2."""
import itertools
import pathlib

import mesh_texts
import program

FOLDER = pathlib.Path(__file__).with_name("arm")
SCENE, SKELETON = (FOLDER / "arm.toml").read_text(), (FOLDER / "arm.skeleton.toml").read_text()
PBS = SCENE[SCENE.index("[pbs]"):SCENE.index("[deformers]")]  # what the paper leaves unstated, so that each scene with PBS states it
MOTION = SCENE[SCENE.index("joint ="):SCENE.index("[pbs]")]
# The scene states the frames per second; a step takes 0.01 s, like the clip's frames.
CLIP_SCENE = SCENE.replace(MOTION, 'clip = "arm.bvh"\nrate_hz = %.1f\n').replace('["lbs", "dqs", "pbs"]', '["pbs"]')


def mesh(cells=(20, 4, 4)):
    """Points [m] and tets of a box [0, 1] x [-0.1, 0.1]^2 that tapers to 60 %; each cell is split into six tets along its diagonal."""
    nx, ny, nz = cells
    points = []
    for k, j, i in itertools.product(range(nz + 1), range(ny + 1), range(nx + 1)):
        thickness = 1.0 - 0.4 * i / nx
        points.append((i / nx, (j / ny - 0.5) * 0.2 * thickness, (k / nz - 0.5) * 0.2 * thickness))
    index = lambda i, j, k: (k * (ny + 1) + j) * (nx + 1) + i
    tets = []
    for i, j, k in itertools.product(range(nx), range(ny), range(nz)):
        for order in itertools.permutations(range(3)):
            corner, tet = [i, j, k], [index(i, j, k)]
            for axis in order:
                corner[axis] += 1
                tet.append(index(*corner))
            tets.append(tet)
    return points, tets


def write_msh(path, points, tets):
    with open(path, "w", encoding="ascii") as file:
        file.write(mesh_texts.msh(points, tets))


def write_bvh(path, elbow_deg):
    """Writes a clip at 100 Hz with these angles of the elbow about z, after a frame in the T pose."""
    with open(path, "w", encoding="ascii") as file:
        file.write((FOLDER / "arm.bvh").read_text() % (len(elbow_deg) + 1))
        for angle in [0.0, *elbow_deg]:
            file.write("0 0 0 0 0 0 %.17g 0 0\n" % angle)


class ArmTest(program.ProgramTest):
    """A folder with the arm's mesh, skeleton and scene."""
    cells, scene_text = (10, 2, 2), SCENE

    def setUp(self):
        super().setUp()
        self.points, self.tets = mesh(self.cells)
        write_msh(self.path("arm.msh"), self.points, self.tets)
        self.write("arm.skeleton.toml", SKELETON)
        self.scene = self.write("arm.toml", self.scene_text)
