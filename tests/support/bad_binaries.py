"""Tet meshes and surfaces in binary, and MSH 4.1, that are refused."""
import itertools
import math

import binary_bytes
from bad_case import Case
from bad_surfaces import FACES, NEGATIVE, OUT
from bad_surfaces import POINTS as CORNERS
from bad_tets import POINTS, TETS

NAN = float("nan")
NAN_POINTS = [(x, NAN, z) if vertex == 3 else (x, y, z) for vertex, (x, y, z) in enumerate(POINTS)]
TOO_MUCH, BROKE_DOWN = "damaged: asks for more memory than such a file can need", "damaged: the reader broke down on it"
CUT = "truncated: $EndElements is missing"
NOT_FINITE = "vertex 3 = (0.75, nan, -0.069999999999999993): expected finite coordinates"
UNKNOWN_NODE = "Gmsh: Unknown node 4001 in element 3"


def with_corner(vertex):
    return [[*tet[:1], vertex, *tet[2:]] if number == 2 else tet for number, tet in enumerate(TETS)]


def half(whole):
    return whole[: len(whole) // 2]


def msh22():
    write = binary_bytes.msh22
    yield "nan", write(NAN_POINTS, TETS), NOT_FINITE
    yield "index_out_of_range", write(POINTS, with_corner(4000)), "Gmsh: Wrong node index 4001"
    yield "negative_index", write(POINTS, with_corner(-5)), "Gmsh: Wrong node index -4"
    yield "truncated", half(write(POINTS, TETS)), CUT
    yield "huge_vertex_count", write(POINTS, TETS, vertices_told=4000000000), "Gmsh: Wrong node index"
    yield "huge_tet_count", write(POINTS, TETS, tets_told=2000000000), "Gmsh: Error loading"
    yield "fewer_vertices_told", write(POINTS, TETS, vertices_told=44), BROKE_DOWN
    yield "fewer_tets_told", write(POINTS, TETS, tets_told=90), "vertices = 45: expected all in elements"
    yield "bytes_of_another_machine", write(POINTS, TETS, one=1 << 24), "Gmsh: Unknown type of element"


def msh41():
    write = binary_bytes.msh41
    yield "nan", write(NAN_POINTS, TETS), NOT_FINITE
    yield "index_out_of_range", write(POINTS, with_corner(4000)), UNKNOWN_NODE
    yield "negative_index", write(POINTS, with_corner(-5)), BROKE_DOWN
    yield "truncated", half(write(POINTS, TETS)), CUT
    yield "huge_vertex_count", write(POINTS, TETS, vertices_told=4000000000), TOO_MUCH
    yield "huge_tet_count", write(POINTS, TETS, tets_told=2000000000), TOO_MUCH
    yield "fewer_vertices_told", write(POINTS, TETS, vertices_told=44), "Gmsh: Unknown node 45 in element 91"
    yield "huge_tag", write(POINTS, TETS, last_tag=4000000000), BROKE_DOWN
    yield "tag_beyond_long", write(POINTS, TETS, last_tag=2**64 - 1), BROKE_DOWN
    yield "tag_twice", write(POINTS, TETS, last_tag=1), "node = 1: expected each tag once"
    yield "unknown_version", write(POINTS, TETS).replace("4.1", "9.9", 1), "Gmsh: Unknown MSH file version 9.9"
    yield "text_called_binary", write(POINTS, TETS).replace("4.1 0", "4.1 1", 1), "tets = 0: expected at least one tetrahedron"


def msh41_binary():
    write = binary_bytes.msh41_binary
    yield "nan", write(NAN_POINTS, TETS), NOT_FINITE
    yield "index_out_of_range", write(POINTS, with_corner(4000)), UNKNOWN_NODE
    yield "truncated", half(write(POINTS, TETS)), CUT
    yield "huge_vertex_count", write(POINTS, TETS, vertices_told=4000000000), TOO_MUCH
    yield "huge_tet_count", write(POINTS, TETS, tets_told=2000000000), TOO_MUCH
    yield "fewer_vertices_told", write(POINTS, TETS, vertices_told=44), "Gmsh: Unknown node 45 in element 91"


NO_FURTHER, NO_READER = "damaged: CGAL read {} points and {} faces, and no further", "assimp: No suitable reader found"
NAN_CORNERS, NAN_CORNER = [(NAN, 0, 0), *CORNERS[1:]], "vertex 0: expected finite coordinates within 1e9 m"
OPEN, INDEX = "triangles = 3: expected a closed surface", "face 3 vertex = {}: expected an index from 0 to 3"


def plys():
    write = binary_bytes.ply
    whole = write(CORNERS, FACES)
    yield "nan", write(NAN_CORNERS, FACES), NAN_CORNER
    yield "truncated", whole[:-20], NO_FURTHER.format(4, 2)
    yield "truncated_header", half(whole), NO_FURTHER.format(0, 0)
    yield "index_out_of_range", write(CORNERS, OUT), INDEX.format(9)
    yield "negative_index", write(CORNERS, NEGATIVE), INDEX.format(-9)
    yield "huge_vertex_count", write(CORNERS, FACES, vertices_told=4000000000), NO_FURTHER.format(8, 0)
    yield "huge_face_count", write(CORNERS, FACES, faces_told=4000000000), NO_FURTHER.format(4, 4)
    yield "faces_of_255_corners", write(CORNERS, FACES, corners=255), NO_FURTHER.format(4, 0)
    yield "faces_without_corners", write(CORNERS, FACES, corners=0), "triangles = 0: expected at least one triangle"


def stls():
    write = binary_bytes.stl
    whole = write(CORNERS, FACES)
    yield "nan", write(NAN_CORNERS, FACES), NAN_CORNER
    yield "truncated", whole[:-20], NO_FURTHER.format(4, 3)
    yield "one_face_more_told", write(CORNERS, FACES, faces_told=5), NO_FURTHER.format(4, 4)
    yield "one_face_fewer_told", write(CORNERS, FACES, faces_told=3), OPEN
    yield "no_faces_told", write(CORNERS, FACES, faces_told=0), "triangles = 0: expected at least one triangle"
    yield "huge_face_count", write(CORNERS, FACES, faces_told=4000000000), NO_FURTHER.format(4, 4)


# assimp ignores these errors, and a body with so many triangles would seem nearly closed
GOLDEN = (1 + 5**0.5) / 2
TWELVE = [point for a in (-1, 1) for b in (-GOLDEN, GOLDEN) for point in ((0, a, b), (a, b, 0), (b, 0, a))]
TWENTY = [corners for corners in itertools.combinations(range(12), 3)
          if all(math.dist(TWELVE[a], TWELVE[b]) < 2.1 for a, b in itertools.combinations(corners, 2))]
DROPPED, NOT_WHOLE = "assimp: Some faces had out-of-range indices. Those faces were dropped.", "Some vertices were dropped."


def dropped(write):
    yield "one_index_of_sixty_out_of_range", write(TWELVE, [*TWENTY[:-1], (*TWENTY[-1][:2], 12)]), DROPPED
    yield "fifty_nine_indices", write(TWELVE, TWENTY, corners_told=59), NOT_WHOLE


def gltfs():
    yield from dropped(binary_bytes.gltf)


def glbs():
    write = binary_bytes.glb
    whole = write(CORNERS, FACES)
    yield "nan", write(NAN_CORNERS, FACES), NAN_CORNER
    yield "truncated", whole[:-20], "GLTF: Unable to read gltf file"
    yield "truncated_document", half(whole), NO_READER
    yield "index_out_of_range", write(CORNERS, OUT), DROPPED
    yield from dropped(write)
    yield "unknown_version", write(CORNERS, FACES, version=9), NO_READER
    yield "huge_document", write(CORNERS, FACES, json_length=4000000000), NO_READER
    yield "empty_document", write(CORNERS, FACES, json_length=0), NO_READER
    yield "shorter_than_told", write(CORNERS, FACES, length=20), "(48/24) is out of range"


def cases():
    for kind, defects in (("2.2 binary", msh22), ("4.1", msh41), ("4.1 binary", msh41_binary)):
        for name, content, words in defects():
            yield Case(f"tets {name}.msh {kind}", {"bad.msh": content}, ["measure", "bad.msh", "bad.msh"], ("bad.msh: ", words))
    for extension, defects in ((".ply", plys), (".stl", stls), (".glb", glbs), (".gltf", gltfs)):
        file = "bad" + extension
        for name, content, words in defects():
            yield Case(f"surface {name}{extension} binary", {file: content}, ["mesh", file, "-o", "tets.vtu", "--vertices", "200"],
                       (file + ": ", words))
