"""A tet mesh, skeleton and scene that no part of the project has generated: a tapered box with two bones, written as
Gmsh 2.2."""
import itertools
import pathlib

import mesh_texts
import program

FOLDER = pathlib.Path(__file__).with_name("arm")
SCENE, SKELETON = (FOLDER / "arm.toml").read_text(), (FOLDER / "arm.skeleton.toml").read_text()
# What the paper leaves unstated, so that each scene with PBS states it.
PBS = SCENE[SCENE.index("[pbs]"):SCENE.index("[deformers]")]
MOTION = SCENE[SCENE.index("joint ="):SCENE.index("[pbs]")]
# The scene states the frames per second; a step takes 0.01 s, like the clip's frames.
CLIP_SCENE = SCENE.replace(MOTION, 'clip = "arm.bvh"\nrate_hz = %.1f\n').replace('["lbs", "dqs", "pbs"]', '["pbs"]')


def mesh(cells=(20, 4, 4)):
    """Points [m] and tets of a box [0, 1] x [-0.1, 0.1]^2 that tapers to 60 %; each cell is split into six tets along
    its diagonal."""
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
    pathlib.Path(path).write_text(mesh_texts.msh(points, tets), encoding="ascii")


def bvh(names, frames, time_s=0.01, length_m=0.5):
    """A clip of a chain of joints; frames: the position of the first joint and the angles of each, about z, x and y
    [degrees]."""
    inner = f"End Site\n{{\nOFFSET {length_m} 0 0\n}}\n"
    for name in reversed(names[1:]):
        inner = f"JOINT {name}\n{{\nOFFSET {length_m} 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n{inner}}}\n"
    rows = "".join(" ".join(frame) + "\n" for frame in frames)
    channels = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    return (f"HIERARCHY\nROOT {names[0]}\n{{\nOFFSET 0 0 0\nCHANNELS {channels}\n{inner}}}\n"
            f"MOTION\nFrames: {len(frames)}\nFrame Time: {time_s}\n{rows}")


def write_bvh(path, elbow_deg):
    """Writes a clip at 100 Hz with these angles of the elbow about z, after a frame in the T pose."""
    frames = [["0 0 0", "0 0 0", f"{angle:.17g} 0 0"] for angle in [0.0, *elbow_deg]]
    pathlib.Path(path).write_text(bvh(["shoulder", "elbow"], frames), encoding="ascii")


class ArmTest(program.ProgramTest):
    """A folder with the arm's mesh, skeleton and scene."""
    cells, scene_text = (10, 2, 2), SCENE

    def setUp(self):
        super().setUp()
        self.points, self.tets = mesh(self.cells)
        write_msh(self.path("arm.msh"), self.points, self.tets)
        self.write("arm.skeleton.toml", SKELETON)
        self.scene = self.write("arm.toml", self.scene_text)
