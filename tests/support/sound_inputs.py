"""Inputs that are accepted: the files from which the bad ones are made, with the line ends of other systems, and the remarks printed on
those whose properties the author may not have intended."""
import bad_characters
import bad_scenes
import bad_surfaces
import bad_tets
import binary_bytes
import foreign_arm
import tet_texts
from bad_case import Case
from bad_files import BYTE_ORDER_MARK

POINTS, TETS = bad_tets.POINTS, bad_tets.TETS
RUN = ["run", "arm.toml", "-o", "out", "--set"]
CORNERS, FACES = bad_surfaces.POINTS, bad_surfaces.FACES
BELOW = [(0, 4, 1), (0, 1, 5), (0, 5, 4), (1, 4, 5)]  # another body that shares the edge from 0 to 1


def accepted(name, files, command, *says):
    return Case(name, files, command, says, status=0, leaves=("out", "tets.vtu"))


def measured(name, file, content, *says):
    return accepted(name, {file: content}, ["measure", file, file], *says)


def surface(name, file, content, *says):
    return accepted(name, {file: content}, ["mesh", file, "-o", "tets.vtu", "--vertices", "200"], *says)


def texts():
    """(file, content, command) for every text that the program itself or a library reads."""
    yield "x.toml", bad_characters.SCENE, ["run", "x.toml", "-o", "out"]
    yield "x.skeleton.toml", foreign_arm.SKELETON, [*RUN, "character.skeleton=x.skeleton.toml"]
    yield "x.csv", bad_characters.WEIGHTS, [*RUN, "skinning.weights=x.csv"]
    yield "x.bvh", bad_scenes.CLIP, ["run", "clip.toml", "-o", "out", "--set", "motion.clip=x.bvh"]
    for extension, write in tet_texts.FORMATS.items():
        yield "x" + extension, write(POINTS, TETS), ["measure", "x" + extension, "x" + extension]
    yield "x.obj", bad_surfaces.obj(), ["mesh", "x.obj", "-o", "tets.vtu", "--vertices", "200"]


def sound():
    for file, content, command in texts():
        yield accepted(f"{file} with line ends of Windows", {file: content.replace("\n", "\r\n")}, command)
    yield measured("x.vtu with a byte-order mark", "x.vtu", BYTE_ORDER_MARK + tet_texts.vtu(POINTS, TETS))  # XML allows such a mark
    for name, write in (("msh 2.2, binary", binary_bytes.msh22), ("msh 4.1", binary_bytes.msh41),
                        ("msh 4.1, binary", binary_bytes.msh41_binary)):
        yield measured(name, "x.msh", write(POINTS, TETS))
    for extension, write in ((".ply", binary_bytes.ply), (".stl", binary_bytes.stl), (".glb", binary_bytes.glb)):
        yield surface("binary " + extension, "x" + extension, write(CORNERS, FACES))
    yield accepted("glTF clip", {"x.gltf": binary_bytes.gltf_clip()}, ["run", "clip.toml", "-o", "out", "--set", "motion.clip=x.gltf"])


def turned(tets):
    return [[tets[0][1], tets[0][0], *tets[0][2:]], *tets[1:]]


def two_parts():
    points = [*POINTS, *[(x + 3.0, y, z) for x, y, z in POINTS]]
    return points, [*TETS, *[[vertex + len(POINTS) for vertex in tet] for tet in TETS]]


def through_itself():
    """The skins of MakeHuman intersect themselves, at lips and lids."""
    return [*CORNERS, *[(x + 0.1, y + 0.1, z + 0.1) for x, y, z in CORNERS]], [*FACES, *[tuple(v + 4 for v in face) for face in FACES]]


def told():
    """Inputs that are accepted with a remark."""
    mesh = {"x.vtu": tet_texts.vtu(POINTS, turned(TETS))}
    yield accepted("turned tet, measure", mesh, ["measure", "x.vtu", "x.vtu"], "warning: x.vtu: inverted tets = 1: turned")
    yield accepted("turned tet, run", mesh, [*RUN, "character.mesh=x.vtu"], "warning: x.vtu: inverted tets = 1: turned")
    yield measured("two parts", "x.vtu", tet_texts.vtu(*two_parts()), "warning: x.vtu: parts = 2: kept")
    yield measured("1,700 m", "x.vtu", tet_texts.vtu([[1700.0 * x for x in point] for point in POINTS], TETS),
                   "warning: x.vtu: extent [m] = 1700: taken as it is")
    yield surface("surface with an unused vertex", "x.off", bad_surfaces.off([*CORNERS, (5, 5, 5)]), "unused points = 1: left out")
    yield surface("surface with a triangle without area", "x.off", bad_surfaces.off(faces=[*FACES, (0, 0, 1)]),
                  "triangles without area = 1: left out")
    yield surface("surface inside out", "x.off", bad_surfaces.off(faces=[face[::-1] for face in FACES]), "= -0.166667: inside out")
    yield surface("surface through itself", "x.off", bad_surfaces.off(*through_itself()),
                  "pairs of triangles that meet = 3: it intersects or touches itself, first at (")
    for name, points, faces in (("triangle twice", CORNERS, [*FACES, FACES[1]]),
                                ("bodies along an edge", [*CORNERS, (0, -1, 0), (0, 0, -1)], [*FACES, *BELOW])):
        yield surface(f"surface with {name}", "x.off", bad_surfaces.off(points, faces),
                      "not manifold there, first from (0, 0, 0) to (1, 0, 0); the surface is wrapped")
    for content, file in ((".msh", "x.vtu"), (".mesh", "x.txt")):
        yield measured(f"tets, {content} called {file}", file, tet_texts.FORMATS[content](POINTS, TETS),
                       f"warning: {file}: format of the content = {content}: read as such")
    yield surface("surface, .ply called x.obj", "x.obj", binary_bytes.ply(CORNERS, FACES), "format of the content = .ply: read as such")
    for extension in (".vtk", ".vtu"):
        content = tet_texts.FORMATS[extension]([*POINTS, (9, 9, 9)], TETS)
        yield measured(f"tets with an unused vertex{extension}", "x" + extension, content, "unused vertices = 1 (45): left out")
    for name, write in (("4.1", binary_bytes.msh41), ("4.1, binary", binary_bytes.msh41_binary)):
        content = write(POINTS, TETS, tets_told=90)
        yield measured(f"msh {name}, fewer tets told than there are", "x.msh", content, "unused vertices = 1 (44): left out")
    yield accepted("clip at a rate that no step of 10 ms divides", {}, [*RUN[:1], "clip.toml", *RUN[2:], "motion.rate_hz=33"])
    yield surface("surface of 1,700 m", "x.off", bad_surfaces.off([[1700 * x for x in point] for point in CORNERS]),
                  "extent [m] = 1700: taken as it is")
