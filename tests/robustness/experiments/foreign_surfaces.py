"""`pbskin measure` on surfaces that other programs export. Reference: a box stretched by s along one axis encloses 1 +
s times its volume."""
import itertools
import os
import unittest

import numpy
import vtk

import program
import rig_files
import run_records
import written_frames

# The six faces of a box, outward; corner 4 x + 2 y + z.
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def box(low=(0, 0, 0), edge=1.0):
    """Corners, 8 x 3."""
    return numpy.array(low) + edge * numpy.array(list(itertools.product((0.0, 1.0), repeat=3)))


def stretched(points, percent):
    return points * [1.0 + percent / 100.0, 1.0, 1.0]


def triangles_of(faces):
    return [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]


def inward(faces):
    return [face[::-1] for face in faces]


def joined(*parts):
    """Points and faces of several parts."""
    points, faces = [], []
    for part_points, part_faces in parts:
        faces += [tuple(index + len(points) for index in face) for face in part_faces]
        points += list(part_points)
    return numpy.array(points), faces


def write_vtp(path, points, faces, vector=None):
    surface = written_frames.surface(points, faces)
    if vector is not None:
        array = vtk.vtkDoubleArray()
        array.SetName("u")
        array.SetNumberOfComponents(3)
        for row in vector:
            array.InsertNextTuple(row)
        surface.GetPointData().AddArray(array)
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(surface)
    writer.Write()


def obj(points, faces):
    rows = "".join("v %.17g %.17g %.17g\n" % tuple(point) for point in points)
    return rows + "".join("f " + " ".join(str(index + 1) for index in face) + "\n" for face in faces)


def off(points, faces):
    rows = "".join("%.17g %.17g %.17g\n" % tuple(point) for point in points)
    return f"OFF\n{len(points)} {len(faces)} 0\n" + rows + "".join(f"{len(face)} {' '.join(map(str, face))}\n"
                                                                   for face in faces)


def ply(points, faces):
    rows = "".join("%.17g %.17g %.17g\n" % tuple(point) for point in points)
    return (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\nproperty "
            "double z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n" + rows
            + "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces))


def stl(points, faces):
    corners = lambda face: "".join("vertex %.9g %.9g %.9g\n" % tuple(points[index]) for index in face)
    return "solid box\n" + "".join(f"facet normal 0 0 0\nouter loop\n{corners(face)}endloop\nendfacet\n"
                                   for face in triangles_of(faces)) + "endsolid box\n"


def write_glb_with_lines(path, points, faces):
    gltf = rig_files.Gltf()
    place = gltf.put(points, "VEC3", rig_files.FLOAT)
    indices = gltf.put(numpy.array(faces).reshape(-1, 1), "SCALAR", rig_files.UNSIGNED_INT)
    primitive = {"attributes": {"POSITION": place}, "indices": indices}
    lines = {"attributes": {"POSITION": place}, "mode": 1}
    gltf.document["meshes"].append({"primitives": [primitive, lines]})
    gltf.node(mesh=0)
    rig_files.write_glb(path, *gltf.written())


TEXTS = {".obj": obj, ".off": off, ".ply": ply, ".stl": stl}


class ForeignSurfaces(program.ProgramTest):
    def write_surface(self, name, points, faces, **options):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        extension = os.path.splitext(name)[1]
        if extension == ".vtp":
            write_vtp(self.path(name), points, faces, **options)
        else:
            self.write(name, TEXTS[extension](points, faces))

    def measure(self, status, *arguments, **expected):
        return self.ends(status, "measure", *arguments, cwd=self.folder, **expected,
                         env={name: value for name, value in os.environ.items() if not name.startswith("GITHUB_")})

    def changes(self, *arguments, column="volume_change_pct", file="v.csv"):
        """The column of the table, after a measurement without bounds."""
        self.measure(0, *arguments, "--csv", "v.csv", "--shells", "s.csv")
        return [float(row[column]) for row in self.rows(file)]

    def test_each_format_as_a_sequence(self):
        for extension in (*TEXTS, ".vtp"):
            with self.subTest(extension):
                self.write_surface("rest" + extension, box(), QUADS)
                for number, percent in enumerate((0.0, 10.0, -5.0)):
                    self.write_surface(f"{extension[1:]}/f_{number}{extension}", stretched(box(), percent), QUADS)
                for frames in (f"{extension[1:]}/f_%d{extension}", extension[1:]):  # a pattern and a folder
                    for value, percent in zip(self.changes("rest" + extension, frames), (0.0, 10.0, -5.0), strict=True):
                        self.assertAlmostEqual(value, percent, places=4)  # in single precision

    def test_a_sequence_whose_polygons_are_cut_in_another_way(self):
        """Nearly flat octagons as caps: the readers take other diagonals where one corner rises."""
        angles = 2 * numpy.pi * numpy.arange(8) / 8
        ring = numpy.stack([numpy.cos(angles), numpy.sin(angles), 0 * angles], axis=1)
        points = numpy.vstack([ring, ring + [0, 0, 1]])
        faces = [tuple(range(7, -1, -1)), tuple(range(8, 16))] + [(k, (k + 1) % 8, 8 + (k + 1) % 8, 8 + k)
                                                                  for k in range(8)]
        for extension in (".obj", ".ply", ".vtp"):
            self.write_surface("rest" + extension, points, faces)
            for corner in range(8, 16):
                moved = points.copy()
                moved[corner] *= [1.2, 1.2, 1.1]
                self.write_surface("frame" + extension, moved, faces)
                self.changes("rest" + extension, "frame" + extension)

    def test_another_order_number_or_unit_is_refused(self):
        points, faces = joined((box(), QUADS))
        self.write_surface("rest.obj", points, triangles_of(faces))
        swapped = points[[1, 0, *range(2, 8)]]
        self.write_surface("order.ply", swapped, [tuple({0: 1, 1: 0}.get(i, i) for i in face)
                                                  for face in triangles_of(faces)])
        self.write_surface("rest.ply", points, triangles_of(faces))
        self.measure(2, "rest.ply", "order.ply", says="was the order of the vertices kept on export?")
        self.write_surface("fewer.ply", *joined((box()[:7], [face for face in triangles_of(faces) if 7 not in face])))
        self.measure(2, "rest.ply", "fewer.ply", says="vertices = 7: expected the rest mesh's 8")
        self.write_surface("units.ply", 1000 * points, triangles_of(faces))
        self.measure(2, "rest.ply", "units.ply", says="factor of 1000, as of millimetres against metres")

    def test_seams_cavities_nested_bodies_and_open_shells(self):
        """The same numbers with and without seams: each face with points of its own."""
        hair = ([(5, 0, 0), (6, 0, 0), (5, 1, 0)], [(0, 1, 2)])
        points, faces = joined((box(edge=4.0), QUADS), (box((1, 1, 1), 2.0), inward(QUADS)), (box((10, 0, 0)), QUADS),
                               hair)
        split = joined(*[(points[list(face)], [tuple(range(len(face)))]) for face in faces])
        for name, (rest, rest_faces) in (("shared", (points, faces)), ("split", split)):
            with self.subTest(name):
                frame = rest.copy()
                inside = ((rest > 0.5) & (rest < 3.5)).all(axis=1)
                frame[inside] = 2 + 0.5 * (rest[inside] - 2)  # the cavity of 8 shrinks to 1
                self.write_surface("rest.ply", rest, rest_faces)
                self.write_surface("frame.ply", frame, rest_faces)
                process = self.measure(0, "rest.ply", "frame.ply", "--csv", "v.csv", "--shells", "s.csv",
                                       says="open shells = 1 of 4 shells (4 of 1 triangles): excluded")
                self.assertIn("cavities = 1 of 4 shells (2 of 12 triangles): their volume is subtracted",
                              process.stderr)
                row, = self.rows("v.csv")
                self.assertAlmostEqual(float(row["volume_m3"]), 64 - 1 + 1, places=9)
                self.assertAlmostEqual(float(row["volume_change_pct"]), 100 * 7 / (64 - 8 + 1), places=9)
                self.assertAlmostEqual(float(row["volume_abs_change_pct"]), 100 * 7 / (64 - 8 + 1), places=9)
                shells = [(row["shell"], row["role"], round(float(row["volume_m3"]), 9)) for row in self.rows("s.csv")]
                self.assertEqual(shells, [("1", "body", 64), ("2", "cavity", -1), ("3", "body", 1)])

    def test_a_surface_without_a_closed_shell_is_refused(self):
        self.write_surface("open.obj", box(), QUADS[:1])
        self.measure(2, "open.obj", "open.obj", says="closed shells = 0 of 1: expected a surface that encloses a "
                                                     "volume; its largest shell, 1, has 4 edges that do not lie "
                                                     "between two triangles, first from")

    def test_a_small_closed_part_of_an_open_surface_is_named(self):
        # A sheet of 100 m^2 and a box of 6.
        points, faces = joined((box(edge=10.0), QUADS[:1]), (box((20, 0, 0)), QUADS))
        self.write_surface("rest.obj", points, faces)
        self.measure(0, "rest.obj", "rest.obj", says="closed shells = 6 % of the surface's area")

    def test_a_limit_does_not_hold_for_what_was_not_measured(self):
        """A box without its lid is capped; a sheet next to it cannot be. The lid's rim is stretched with the box."""
        sheet = box((5, 0, 0), edge=2.0), QUADS[:1]
        for name, parts in (("box", [QUADS[:5]]), ("with_sheet", [QUADS[:5], sheet])):
            rest = joined(*[(box(), part) if part is not sheet else part for part in parts])
            self.write_surface(f"{name}.obj", *rest)
            self.write_surface(f"{name}_moved.obj", rest[0] + 3.0, rest[1])
            self.write_surface(f"{name}_wider.obj", stretched(rest[0], 10.0), rest[1])
        self.assertAlmostEqual(self.changes("box.obj", "box_wider.obj")[0], 10.0, places=6)
        # The corners of the rim are 5 % of the edge from a rigid motion, and the cap has 1.1 of a face's area: 4.5 to
        # 15.5 %.
        for most, status in (("4.4", 1), ("4.6", 2), ("9.9", 2), ("10.1", 2), ("15.4", 2), ("15.6", 0)):
            self.measure(status, "box.obj", "box_wider.obj", "--max-volume-change", most)
        limit = "--max-volume-change", "11"
        self.measure(0, "box.obj", "box_moved.obj", *limit, "--junit", "r.xml")  # rigidly
        self.assertIn('name="measured_share_of_area_pct" value="100.0"', self.read("r.xml"))
        self.measure(2, "with_sheet.obj", "with_sheet_moved.obj", *limit, "--junit", "r.xml",
                     says="the whole body was not judged: closed "
                     "and capped shells are 56 % of the surface's area, and 1 open shell is excluded")
        self.assertIn('errors="1"', self.read("r.xml"))
        self.write_surface("box_and_closed.obj", *joined((box(), QUADS[:5]), (box((5, 0, 0)), QUADS)))
        self.measure(0, "box_and_closed.obj", "box_and_closed.obj", *limit, "--closed-only",
                     says="open shells = 1 of 2")

    def test_an_output_that_is_an_input_is_refused(self):
        self.write_surface("rest.obj", box(), QUADS)
        before = self.read("rest.obj")
        os.link(self.path("rest.obj"), self.path("link.obj"))
        for output in ("rest.obj", "./rest.obj", "link.obj"):
            self.measure(2, "rest.obj", "rest.obj", "--csv", output, says=f"--csv = {output}: expected another file "
                                                                          "than the input")
        self.measure(2, "rest.obj", "rest.obj", "--csv", "x", "--junit", "./x",
                     says="expected another file than that of --csv")
        self.assertEqual(self.read("rest.obj"), before)

    def test_coordinates_of_single_precision_far_from_the_origin_are_named(self):
        """At 2^22 m the step between floats is 0.5 m."""
        far = box() + [2.0 ** 22, 0, 0]
        self.write_surface("far.obj", far, QUADS)
        self.measure(0, "far.obj", "far.obj", says="coordinates in single precision up to 4.19e+06 from the origin, "
                                                   "where they are multiples of 0.5")
        self.measure(0, "far.obj", "far.obj", says="has only 3 steps, and the volume is not known")
        self.write_surface("exact.obj", far + [0.1, 0.1, 0.1], QUADS)
        self.assertNotIn("single precision", self.measure(0, "exact.obj", "exact.obj").stderr)

    def test_every_column_is_explained(self):
        self.write_surface("rest.vtp", box(), QUADS)
        self.measure(0, "rest.vtp", "rest.vtp", "--csv", "v.csv", "--shells", "shells.csv")
        self.explains_columns("v.csv", "shells.csv", labels=["frame", "shell", "mesh", "role"])

    def test_self_intersections_are_counted_and_bounded(self):
        """One box moves into another, whose surface its own then crosses."""
        self.write_surface("rest.obj", *joined((box(), QUADS), (box((3, 0, 0)), QUADS)))
        self.write_surface("inside.obj", *joined((box(), QUADS), (box((0.5, 0.4, 0.3)), QUADS)))
        self.assertEqual(self.changes("rest.obj", "rest.obj", column="self_intersections"), [0])
        self.assertGreater(self.changes("rest.obj", "inside.obj", column="self_intersections")[0], 0)
        self.measure(0, "rest.obj", "rest.obj", "--max-self-intersections", "0")
        self.measure(1, "rest.obj", "inside.obj", "--max-self-intersections", "0", says="self_intersections = ")

    def test_bounds_reports_and_the_last_line(self):
        self.write_surface("rest.obj", box(), QUADS)
        for number, percent in enumerate((0.1, -8.5, 2.0, 0.4)):
            self.write_surface(f"f_{number}.obj", stretched(box(), percent), QUADS)
        process = self.measure(1, "rest.obj", "f_%d.obj", "--max-volume-change", "0.5", "--junit", "v.xml",
                               says="pbskin: f_1.obj: |volume_change_pct| = 8.5")
        self.assertEqual(process.stdout.splitlines()[-1], "fails: 2 of 4 frames beyond 0.5 %, worst -8.5 % in "
                                                          "frame f_1.obj")
        self.assertEqual(run_records.failed_cases(self.path("v.xml")), {("rest.obj", "--max-volume-change 0.5")})
        self.assertNotIn("--max-volume-change", process.stderr.splitlines()[-1])
        process = self.measure(0, "rest.obj", "f_%d.obj", "--max-volume-change", "9")
        self.assertEqual(process.stdout.splitlines()[-1], "holds: 4 frames within 9 %, worst -8.5 % in frame f_1.obj")
        process = self.measure(0, "rest.obj", "f_%d.obj", says="--max-volume-change 0.5 holds the volume to a bound")
        self.assertEqual(process.stdout.splitlines()[-1], "measured: 4 frames, volume -8.5 % in frame f_1.obj to 2 % "
                                                          "in frame f_2.obj")
        self.measure(2, "rest.obj", "f_%d.obj", "--max-inverted", "0", says="--max-inverted = 0: a surface has no tets")

    def test_a_displacement_of_the_points(self):
        rest, frame = box(), stretched(box(), 7.0)
        self.write_surface("rest.vtp", rest, QUADS)
        self.write_surface("frame.vtp", rest, QUADS, vector=frame - rest)
        self.measure(2, "rest.vtp", "frame.vtp", says="add --displacement u, or --displacement none")
        self.assertAlmostEqual(self.changes("rest.vtp", "frame.vtp", "--displacement", "u")[0], 7.0, places=9)
        self.measure(0, "rest.vtp", "frame.vtp", "--displacement", "none", says="nothing moves")
        self.measure(2, "rest.vtp", "frame.vtp", "--displacement", "v", says="expected a vector of the points: "
                                                                             "it has u")

    def test_a_frame_with_a_skin_is_refused(self):
        """Its points are those of the bind pose, whatever its nodes' pose."""
        rig_files.write("plain", self.path("hero.glb"))
        rig_files.write("plain", self.path("posed.glb"), rest_deg=40.0)
        self.measure(2, "hero.glb", "posed.glb", says="(pbskin measure MODEL), or export the posed points")

    def test_a_remark_that_frames_share_is_shown_once(self):
        self.write_surface("rest.obj", box(), triangles_of(QUADS))
        for number in range(3):
            write_glb_with_lines(self.path(f"f_{number}.glb"), stretched(box(), number), triangles_of(QUADS))
        process = self.measure(0, "rest.obj", "f_%d.glb")
        self.assertEqual(process.stderr.count("points and lines"), 1)


if __name__ == "__main__":
    unittest.main()
