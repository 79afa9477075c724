"""Surfaces with valid numbers and an invalid shape: several parts, flat, open, too small; and COLLADA files written in other
ways."""
from bad_case import Case
from bad_surfaces import FACES, POINTS, dae, off

FLAT, EXTENT = "expected a closed surface round a volume, neither flat nor open", "expected at least 1e-9 m"
NEGATIVE = "0 2 1 0 1 3 0 3 2 1 2 -5"
NEGATIVE_RULE = "p = -5: expected indices from 0"


def two_parts():
    return [*POINTS, *[(x + 9, y, z) for x, y, z in POINTS]], [*FACES, *[tuple(vertex + 4 for vertex in face) for face in FACES]]


def shapes():
    yield "two_parts", off(*two_parts()), "Euler number of the wrapped surface = 4: expected 2"
    yield "flat", off([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.3, 0.3, 0)]), FLAT
    yield "corner_twice", off(faces=[*FACES[:3], (1, 1, 3)]), "triangles = 3: expected a closed surface"
    yield "all_at_one_place", off([(1, 1, 1)] * 4), "extent = 0: " + EXTENT
    yield "below_range", off([[1e-300 * x for x in point] for point in POINTS]), "extent = 1.73205e-300: " + EXTENT


def colladas():
    yield "negative_index_behind_an_attribute", dae(faces=NEGATIVE).replace("<p>", '<p id="a">'), NEGATIVE_RULE
    yield "negative_index_behind_a_space", dae(faces=NEGATIVE).replace("<p>", "<p >"), NEGATIVE_RULE
    yield "a_prefix", dae().replace("<p>", "<c:p>").replace("</p>", "</c:p>"), "assimp: Unexpected sub element <c:p>"


def cases():
    for extension, defects in ((".off", shapes), (".dae", colladas)):
        file = "bad" + extension
        for name, content, words in defects():
            yield Case(f"surface {name}{extension}", {file: content}, ["mesh", file, "-o", "tets.vtu", "--vertices", "200"],
                       (file + ":", words))
