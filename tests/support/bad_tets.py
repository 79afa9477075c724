"""Tet meshes that are refused, in every format. Gmsh reads .msh and .mesh and takes a second to load, so there are few cases of those."""
import copy
import os

import numpy as np

import foreign_arm
import tet_texts
from bad_case import Case


def turned_outward(points, tets):
    def six_volumes(tet):
        a, b, c = (np.subtract(points[vertex], points[tet[0]]) for vertex in tet[1:])
        return np.dot(np.cross(a, b), c)
    return [tet if six_volumes(tet) > 0.0 else [tet[1], tet[0], *tet[2:]] for tet in map(list, tets)]


POINTS, TETS = foreign_arm.mesh((4, 2, 2))
TETS = turned_outward(POINTS, TETS)
NOISE = bytes((i * i * 7919 + i * 31) % 256 for i in range(4000))


def sparse(path):
    """64 GB of zeros that occupy no space on disk."""
    path.touch()
    os.truncate(path, 1 << 36)


def set_point(vertex, value):
    return lambda points, tets: points[vertex].__setitem__(1, value)


def set_corner(value):
    return lambda points, tets: tets[2].__setitem__(1, value)


def scaled(points, factor):
    points[:] = [[factor * x for x in point] for point in points]


def both(words):
    return {".vtk": words, ".vtu": words}


TOO_SHORT = "Cannot read points array from Points in piece 0"
INDEX, VOLUME = "expected an index from 0 to ", "expected a volume; its four vertices are in one plane"
NAN, INFINITY = (f"vertex 3 = (0.75, {word}, -0.069999999999999993): expected finite coordinates" for word in ("nan", "inf"))
# name: (change of points and tets, stated counts, words by format)
DEFECTS = {
    "nan": (set_point(3, "nan"), {}, {".vtk": "Unrecognized keyword: nan", ".vtu": NAN, ".msh": NAN}),
    "infinity": (set_point(3, "inf"), {}, {".vtk": "Unrecognized keyword: inf", ".vtu": INFINITY}),
    "a_word": (set_point(3, "east"), {},
               {".vtk": "Unrecognized keyword: east", ".vtu": TOO_SHORT, ".mesh": ":8: word = east: expected a number"}),
    "negative_index": (set_corner(-5), {}, both("tet 2 vertex = -5: " + INDEX + "44")),
    "index_out_of_range": (set_corner(4000), {}, both("tet 2 vertex = 4000: " + INDEX + "44") | {".mesh": "Wrong node index 4000"}),
    "index_beyond_int": (set_corner(99999999999), {},
                         {".vtk": "Error reading ascii cell data", ".vtu": "tet 2 vertex = 99999999999: " + INDEX + "44"}),
    "huge_vertex_count": (lambda points, tets: None, {"vertices": 4000000000},
                          {".vtk": "Unable to allocate", ".vtu": "damaged: asks for more memory"}),
    "impossible_vertex_count": (lambda points, tets: None, {"vertices": 4 * 10**18},
                                {".vtk": "damaged: the reader broke down on it: ", ".vtu": TOO_SHORT}),
    "huge_tet_count": (lambda points, tets: None, {"tets_told": 4000000000},
                       {".vtk": "the file is damaged", ".vtu": "damaged: asks for more memory"}),
    "fewer_vertices_told": (lambda points, tets: None, {"vertices": 44},
                            {".vtk": "Unrecognized keyword: 1.0", ".vtu": "tet 90 vertex = 44: " + INDEX + "43"}),
    "duplicate_vertex": (lambda points, tets: points.__setitem__(7, list(points[6])), {}, both("tet 26 = (6, 1, 7, 22): " + VOLUME)),
    "flat_tet": (lambda points, tets: tets.append([0, 1, 2, 3]), {}, both("tet 96 = (0, 1, 2, 3): " + VOLUME)),
    "corner_twice": (lambda points, tets: tets[2].__setitem__(1, tets[2][0]), {}, both("tet 2 = (5, 5, 6, 21): " + VOLUME)),
    "tet_twice": (lambda points, tets: tets.append(list(tets[0])), {}, both("tet 96 = (0, 1, 6, 21): expected to lie beside tet 0")),
    "beyond_range": (lambda points, tets: scaled(points, 1e300), {}, both("expected within 1e9 m")),
    "below_range": (lambda points, tets: scaled(points, 1e-300), {}, both("e-300: expected at least 1e-9 m")),
    "no_tets": (lambda points, tets: tets.clear(), {}, both("tets = 0: expected at least one tetrahedron")),
    "no_points": (lambda points, tets: points.clear(), {}, both("points = 0: expected at least one point")),
    "a_number_of_100000_digits": (set_point(3, "1" * 100000), {},
                                  {".vtk": "Unrecognized keyword: -0.06999999999999999", ".vtu": TOO_SHORT}),
}
# name: words by format, if the whole file is invalid
MAGIC = {".msh": ":1: expected a Gmsh file beginning with $MeshFormat",
         ".mesh": ":1: expected a MEDIT file beginning with MeshVersionFormatted",
         ".vtk": "Error parsing XML in stream at line 1, column 0", ".vtu": "Error parsing XML in stream at line 1, column 0"}
HALF = {".msh": "truncated: $EndElements is missing", ".vtk": "Error reading ascii cell data", ".vtu": "no element found"}


def text_with(defect, extension):
    spoil, told, _ = DEFECTS[defect]
    points, tets = [list(point) for point in POINTS], copy.deepcopy(TETS)
    spoil(points, tets)
    return tet_texts.FORMATS[extension](points, tets, **told)


def measured(name, file, content, *says):
    return Case(name, {file: content}, ["measure", file, file], (file, *says))


def cases():
    for defect, (_, _, words) in DEFECTS.items():
        for extension, word in words.items():
            yield measured(f"tets {defect}{extension}", "bad" + extension, text_with(defect, extension), word)
    for extension, write in tet_texts.FORMATS.items():
        whole, file = write(POINTS, TETS), "bad" + extension
        yield measured(f"tets empty{extension}", file, "", "the file is empty")
        yield measured(f"tets sparse{extension}", file, sparse, "bytes = 68719476736: expected at most ")
        yield measured(f"tets noise{extension}", file, NOISE, MAGIC[extension])
        yield measured(f"tets wrong_magic{extension}", file, "solid x\n" + whole, MAGIC[extension])
        if extension in HALF:  # for .mesh, only Gmsh detects the defect
            yield measured(f"tets truncated{extension}", file, whole[: len(whole) // 2], HALF[extension])
    yield from tetgen_cases()
    yield Case("frame of other vertices", {"other.vtu": tet_texts.vtu(*foreign_arm.mesh((5, 2, 2)))}, ["measure", "arm.vtu", "other.vtu"],
               ("other.vtu: vertices = 54: expected the rest mesh's 45",))
    swapped = [[7 - vertex if vertex in (0, 7) else vertex for vertex in tet] for tet in TETS]
    yield Case("frame of other tets", {"other.vtu": tet_texts.vtu(POINTS, swapped)}, ["measure", "arm.vtu", "other.vtu"],
               ("other.vtu: tets: expected the rest mesh's, on the same vertices",))
    yield Case("frame of 1e200 m", {"far.vtu": tet_texts.vtu([[1e200 * x for x in point] for point in POINTS], TETS)},
               ["measure", "arm.vtu", "far.vtu"], ("far.vtu: vertex ", "expected within 1e9 m of the origin"))
    yield Case("frame after a good one", {"bad.vtu": "<VTKFile>"},
               ["measure", "arm.vtu", "arm.vtu", "bad.vtu", "--csv", "figures.csv"], ("bad.vtu: ", "no element found"),
               leaves=("figures.csv",))
    yield Case("tets of an unknown kind", {"arm.step": "ISO-10303-21;"}, ["measure", "arm.step", "arm.step"],
               ("arm.step: extension = .step: expected a tet mesh",))
    yield Case("bench on a damaged mesh", {"bad.vtu": NOISE}, ["bench", "--quick", "--mesh", "bad.vtu"], ("bad.vtu: ", "not well-formed"))


def tetgen_cases():
    node = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
    element = "1 4 0\n1 1 2 3 4\n"
    for name, nodes, elements, words in (
            ("noise", "\x01\x02 noise", element, ("bad.node:1: header = ", "expected numbers")),
            ("huge_count", node.replace("4 3", "4000000000 3", 1), element,
             ("bad.node:1: #points = ", "expected a whole number from 0 to 49")),
            ("nan", node.replace("1 0 0 0", "1 nan 0 0"), element, ("bad.ele: ", "vertex 0 = (nan, 0, 0): expected finite")),
            ("truncated", node[:-4], element, ("bad.node:5: point = ", "expected at least 4 numbers")),
            ("index", node, element.replace("3 4\n", "3 9\n"), ("bad.ele:2: tet vertex = 9: expected a whole number from 1 to 4",)),
            ("two_dimensional", node.replace("4 3", "4 2", 1), element,
             ("bad.node:1: dimension = 2: expected 3",)),
            ("no_points", "0 3 0 0\n", element, ("bad.node: points = 0: expected at least one point",)),
            ("one_point", "1 3 0 0\n1 0 0 0\n", element, ("bad.ele:2: tet vertex = 2: expected 1",))):
        yield Case(f"tets {name}.node", {"bad.node": nodes, "bad.ele": elements}, ["measure", "bad.ele", "bad.ele"], words)
    for kind, make, words in (("folder", os.mkdir, "expected a file"), ("named pipe", os.mkfifo, "expected a file"),
                              ("symlink loop", lambda path: path.symlink_to(path.name), "no such file"),
                              ("device", lambda path: path.symlink_to("/dev/zero"), "expected a file"),
                              ("sparse file", sparse, "bytes = 68719476736: expected at most ")):
        yield Case(f"{kind} as .node", {"bad.node": make, "bad.ele": element}, ["measure", "bad.ele", "bad.ele"], (f"bad.node: {words}",))
        yield Case(f"{kind} as .ele", {"bad.node": node, "bad.ele": make}, ["measure", "bad.node", "bad.node"], (f"bad.ele: {words}",))
    yield Case("tets without .ele", {"bad.node": node}, ["measure", "bad.node", "bad.node"], ("bad.ele: no such file",))
