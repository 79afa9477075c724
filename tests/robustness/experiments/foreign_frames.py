"""`pbskin measure` on frames that VTK's Python has written (.vtu, .vtk). Reference: a body stretched by s along one
axis has 1 + s times its volume."""
import itertools
import os
import unittest

import vtk

import foreign_arm
import program
import run_records

POINTS, TETS = foreign_arm.mesh((6, 2, 2))


def stretched(percent, scale=1.0):
    return [(scale * x * (1.0 + percent / 100.0), scale * y, scale * z) for x, y, z in POINTS]


def write_vtk(path, points, tets, vectors=None):
    grid, cloud = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    cloud.SetDataTypeToDouble()
    for point in points:
        cloud.InsertNextPoint(point)
    grid.SetPoints(cloud)
    for tet in tets:
        grid.InsertNextCell(vtk.VTK_TETRA, 4, tet)
    for name, rows in (vectors or {}).items():
        array = vtk.vtkDoubleArray()
        array.SetName(name)
        array.SetNumberOfComponents(len(rows[0]))
        for row in rows:
            array.InsertNextTuple(row)
        grid.GetPointData().AddArray(array)
    writer = vtk.vtkXMLUnstructuredGridWriter() if path.endswith(".vtu") else vtk.vtkUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    writer.Write()


class ForeignFrames(program.ProgramTest):
    def setUp(self):
        super().setUp()
        foreign_arm.write_msh(self.path("rest.msh"), POINTS, TETS)

    def frames(self, percents, pattern="arm_%04d.vtu"):
        os.makedirs(os.path.dirname(self.path(pattern)), exist_ok=True)
        for number, percent in percents.items():
            write_vtk(self.path(pattern % number), stretched(percent), TETS)

    def measured_frames(self):
        return [row["frame"] for row in self.rows("volume.csv")]

    def measure(self, status, *arguments, **expected):
        return self.ends(status, "measure", "rest.msh", *arguments, cwd=self.folder, **expected,
                         env={name: value for name, value in os.environ.items() if not name.startswith("GITHUB_")})

    def refuses(self, message, *arguments):
        self.measure(2, *arguments, says=message)

    def test_a_numbered_sequence_a_glob_and_a_folder(self):
        self.frames({number: 0.1 * number for number in range(8, 12)})
        self.frames({number: 0.1 * number for number in range(8, 12)}, "out/arm_%d.vtk")
        for frames in ("arm_%04d.vtu", "arm_*.vtu", "out"):
            self.measure(0, frames, "--csv", "volume.csv")
            change = [float(row["volume_change_pct"]) for row in self.rows("volume.csv")]
            # The .vtu has single precision, 1e-7.
            self.assertEqual([round(value, 5) for value in change], [0.8, 0.9, 1.0, 1.1])

    def test_a_bound_that_fails_names_the_frame(self):
        self.frames({1: 0.2, 2: -0.9, 3: 0.6})
        process = self.measure(1, "arm_%04d.vtu", "--max-volume-change", "0.5", "--max-inverted", "0", "--junit",
                               "volume.xml", "--github")
        self.assertIn("pbskin: arm_0002.vtu: |volume_change_pct| = 0.9 > 0.5", process.stderr)
        message = "frame arm_0002.vtu: |volume_change_pct| = 0.9, expected at most 0.5 (2 of 3 frames outside)"
        cases = {name: case for (_, name), case in run_records.junit_cases(self.path("volume.xml")).items()}
        self.assertEqual(cases["--max-volume-change 0.5"].find("failure").get("message"), message)
        self.assertIsNone(cases["--max-inverted 0"].find("failure"))
        self.assertIn("::error title=rest.msh --max-volume-change 0.5::" + message, process.stdout)

    def test_every_bound_holds_at_its_value_and_fails_beyond(self):
        write_vtk(self.path("arm.vtk"), stretched(10.0), TETS)
        for bound, holds, fails in (("--max-volume-change", 10.001, 9.999), ("--max-volume-abs-change", 10.001, 9.999),
                                    ("--min-j", 1.099, 1.101), ("--max-j", 1.101, 1.099),
                                    ("--max-edge-strain", 0.1001, 0.0999), ("--max-stretch-rms", 0.1, 0.01)):
            self.measure(0, "arm.vtk", bound, str(holds))
            self.measure(1, "arm.vtk", bound, str(fails))
        write_vtk(self.path("folded.vtk"), [(-x, y, z) if x == 1.0 else (x, y, z) for x, y, z in POINTS], TETS)
        self.measure(1, "folded.vtk", "--max-inverted", "0")

    def test_frames_that_are_no_sequence(self):
        """Two frames show no step, and the number may stand anywhere in the name."""
        for written, given, message in (
                ({"arm_%04d.vtu": (1, 2, 3, 5)}, ("arm_%04d.vtu", "arm_*.vtu"),
                 "arm_0004.vtu: frame = 4: missing: the sequence goes from 1 to 5 by 1"),
                ({}, ("leg_%04d.vtu",), "no such frames"),
                ({"s/f_%d_v2.vtu": (1, 2, 3, 5, 10)}, ("s/f_%d_v2.vtu", "s/f_*.vtu", "s"),
                 "f_4_v2.vtu: frame = 4: missing: the sequence goes from 1 to 10 by 1"),
                ({"two/arm_%04d.vtu": (1, 3)}, ("two/arm_%04d.vtu", "two/arm_*.vtu"),
                 "arm_0002.vtu: frame = 2: missing: the sequence goes from 1 to 3 by 1"),
                ({f"differ/f_%d_t0.{4 - number}.vtu": (number,) for number in (1, 2, 3)}, ("differ/f_*.vtu", "differ"),
                 "expected frames that differ in one number"),
                ({"out/lbs_%04d.vtu": (1, 2), "out/pbs_%04d.vtu": (1, 2)}, ("out",),
                 "expected one sequence of frames")):
            for pattern, numbers in written.items():
                self.frames(dict.fromkeys(numbers, 0.1), pattern)
            for frames in given:
                with self.subTest(frames):
                    self.refuses(message, frames)
        self.measure(0, "two/arm_0001.vtu", "two/arm_0003.vtu")
        self.frames({5: 0.1}, "two/arm_%04d.vtu")
        self.measure(0, "two/arm_%04d.vtu")

    def test_parts_that_touch_in_an_edge(self):
        """The middle one of three layers of 2 x 2 cells lacks two cells, so that the other two touch in the edge 17-18
        alone."""
        points, tets = foreign_arm.mesh((3, 2, 2))
        cells = [tets[6 * cell:6 * cell + 6] for cell in range(12)]
        kept = [tet for cell, of_cell in enumerate(cells) if cell not in (5, 6) for tet in of_cell]
        foreign_arm.write_msh(self.path("rest.msh"), points, kept)
        write_vtk(self.path("arm.vtk"), [(1.01 * x, y, z) for x, y, z in points], kept)
        process = self.measure(0, "arm.vtk", "--csv", "volume.csv", "--max-volume-change", "1.001",
                               says="edges at which parts touch = 1 (17-18): kept: no metric needs a manifold boundary")
        self.assertNotIn("split", process.stderr)
        self.assertAlmostEqual(float(self.rows("volume.csv")[0]["volume_change_pct"]), 1.0, places=5)

    def test_a_number_that_is_not_the_last_of_the_name(self):
        self.frames({number: 0.1 * number for number in range(1, 11)}, "s/f_%d_v2.vtu")
        for frames in ("s/f_%d_v2.vtu", "./s//f_%d_v2.vtu", "s/f_*.vtu", "s"):
            self.measure(0, frames, "--csv", "volume.csv")
            self.assertEqual(self.measured_frames(), ["f_%d_v2.vtu" % number for number in range(1, 11)])

    def test_one_name_in_two_folders(self):
        for folder in ("a", "b"):
            self.frames({1: 0.1, 2: 0.9}, folder + "/f_%d.vtu")
        self.frames({3: 0.1}, "f_%d.vtu")
        process = self.measure(1, "a", "b/f_%d.vtu", "f_3.vtu", "--csv", "volume.csv", "--max-volume-change", "0.5",
                               "--github")
        self.assertEqual(self.measured_frames(), ["a/f_1.vtu", "a/f_2.vtu", "b/f_1.vtu", "b/f_2.vtu", "f_3.vtu"])
        self.assertIn("frame a/f_2.vtu: |volume_change_pct|", process.stdout)

    def test_a_frame_that_cannot_be_read_hides_no_other(self):
        self.frames({1: 0.1, 2: 0.9, 3: 0.9, 4: 0.1})
        self.write("arm_0003.vtu", "no VTK")
        self.measure(2, "arm_%04d.vtu", "--csv", "volume.csv", "--max-volume-change", "0.5", "--junit", "volume.xml",
                     says="pbskin: arm_0003.vtu")
        self.assertEqual(self.measured_frames(), ["arm_0001.vtu", "arm_0002.vtu", "arm_0004.vtu"])
        cases = {name: case for (_, name), case in run_records.junit_cases(self.path("volume.xml")).items()}
        self.assertEqual(list(cases), ["--max-volume-change 0.5", "frame arm_0003.vtu"])
        self.assertIn("frame arm_0002.vtu", cases["--max-volume-change 0.5"].find("failure").get("message"))
        self.assertIn("arm_0003.vtu", cases["frame arm_0003.vtu"].find("error").get("message"))
        self.measure(2, "arm_0003.vtu", "--max-volume-change", "0.5", "--junit", "volume.xml")
        self.assertEqual(run_records.failed_cases(self.path("volume.xml")), {("rest.msh", "frame arm_0003.vtu")})

    def test_quiet_is_quiet(self):
        self.frames({1: 0.9})
        self.assertEqual(self.measure(0, "arm_0001.vtu", "--quiet").stdout, "")
        process = self.measure(1, "arm_0001.vtu", "--quiet", "--max-volume-change", "0.5",
                               says="|volume_change_pct| = 0.9 > 0.5")
        self.assertEqual(process.stdout, "")

    def test_every_column_is_explained(self):
        self.frames({1: 0.9})
        self.measure(0, "arm_0001.vtu", "--reference", "arm_0001.vtu", "--csv", "v.csv")
        self.explains_columns("v.csv", labels=["frame", "reference"])

    def test_bounds_that_all_or_nothing_meets(self):
        self.frames({1: 0.1})
        not_negative = ("--max-volume-change", "--max-volume-abs-change", "--max-inverted", "--max-edge-strain",
                        "--max-stretch-rms")
        for bounds, values, rule in ((not_negative, ("nan", "inf", "-1"), " >= 0"),
                                     (("--min-j", "--max-j"), ("nan", "inf", "-inf"), "")):
            for bound, value in itertools.product(bounds, values):
                self.refuses(f"{bound} = {value}: expected a finite number{rule}", "arm_0001.vtu", f"{bound}={value}")
        self.measure(0, "arm_0001.vtu", "--min-j=-1")

    def test_undeformed_points_and_a_displacement(self):
        """As programs of finite elements write them: without the name of the vector such a frame would not differ from
        the rest mesh."""
        shift = lambda percent: [tuple(a - b for a, b in zip(moved, rest))
                                 for moved, rest in zip(stretched(percent), POINTS)]
        for name, file in (("displacement", "arm.vtk"), ("u", "arm.vtu"), ("Displacement_Vector", "arm.vtk")):
            with self.subTest(name):
                write_vtk(self.path(file), POINTS, TETS, {name: shift(-26.0), "velocity": shift(1.0)})
                self.refuses("expected deformed points, but the deformation seems to be in the points' vector "
                             f"{name}: add --displacement {name}", file, "--max-volume-change", "0.5")
                self.measure(1, file, "--displacement", name, "--max-volume-change", "0.5", "--csv", "volume.csv")
                self.assertAlmostEqual(float(self.rows("volume.csv")[0]["volume_change_pct"]), -26.0, places=5)
                self.refuses(f"--displacement = v: expected a vector of the points: it has {name}, velocity", file,
                             "--displacement", "v")
        write_vtk(self.path("scalars.vtk"), POINTS, TETS)
        with open(self.path("scalars.vtk"), "a", encoding="utf-8") as file:
            file.write(f"\nPOINT_DATA {len(POINTS)}\nSCALARS s double 1\nLOOKUP_TABLE default\n" + "0\n" * len(POINTS)
                       + "SCALARS u double 3\nLOOKUP_TABLE default\n" + "".join(f"{x} {y} {z}\n"
                                                                                for x, y, z in shift(-26.0)))
        self.refuses("the deformation seems to be in the points' vector u: add --displacement u", "scalars.vtk")
        write_vtk(self.path("rest.vtk"), POINTS, TETS, {"displacement": shift(0.0), "velocity": shift(1.0),
                                                        "rest_position": POINTS})
        self.measure(0, "rest.vtk", "--max-volume-change", "0.001")
        write_vtk(self.path("moved.vtk"), stretched(1.0), TETS, {"displacement": shift(1.0)})
        self.measure(0, "moved.vtk", "--max-volume-change", "1.001")
        self.refuses("points that are deformed already need no such option", "moved.vtk", "--displacement",
                     "displacement")

    def expect_stretched(self, file, displacement):
        self.measure(1, file, "--displacement", displacement, "--max-volume-change", "0.5", "--csv", "volume.csv")
        self.assertAlmostEqual(float(self.rows("volume.csv")[0]["volume_change_pct"]), -26.0, places=5)

    def test_three_scalars_that_are_the_components_of_a_displacement(self):
        shift = [tuple(a - b for a, b in zip(moved, rest)) for moved, rest in zip(stretched(-26.0), POINTS)]
        for stem, names in (("u", ("ux", "uy", "uz")), ("u", ("u_x", "u_y", "u_z")), ("U", ("U1", "U2", "U3")),
                            ("D", ("DX", "DY", "DZ")), ("u", ("u", "v", "w")),
                            ("displacement", ("displacement_x", "displacement_y", "displacement_z")),
                            ("disp", ("disp:0", "disp:1", "disp:2"))):
            for file in ("scalars.vtu", "scalars.vtk"):
                with self.subTest(names[0], file=file):
                    scalars = {name: [(row[axis],) for row in shift] for axis, name in enumerate(names)}
                    write_vtk(self.path(file), POINTS, TETS,
                              scalars | {f"RF{k}": [(7.0,)] * len(POINTS) for k in (1, 2, 3)})
                    self.refuses(f"seems to be in the points' vector {stem} ({', '.join(names)}): "
                                 f"add --displacement {stem}", file)
                    self.expect_stretched(file, stem)
        self.refuses("--displacement = w: expected a vector of the points: it has RF, disp", file, "--displacement",
                     "w")
        write_vtk(self.path("forces.vtu"), POINTS, TETS, {f"RF{k}": [(7.0,)] * len(POINTS) for k in (1, 2, 3)})
        self.measure(0, "forces.vtu", says="nothing moves")
        write_vtk(self.path("forces.vtu"), POINTS, TETS, {"RF": [(7.0, 0.0, 0.0)] * len(POINTS), "u": shift})
        self.refuses("the points' vector u or RF: add --displacement u", "forces.vtu")

    def write_msh_with_node_data(self, data, quote='"'):
        foreign_arm.write_msh(self.path("nodes.msh"), POINTS, TETS)
        with open(self.path("nodes.msh"), "a", encoding="utf-8") as file:
            for name, rows in data:
                file.write(f"$NodeData\n1\n{quote}{name}{quote}\n1\n0\n3\n0\n{len(rows[0])}\n{len(rows)}\n")
                for tag, row in reversed(list(enumerate(rows, 1))):
                    file.write(f"{tag} {' '.join(map(repr, row))}\n")
                file.write("$EndNodeData\n")

    def test_node_data_of_gmsh(self):
        shift = [tuple(a - b for a, b in zip(moved, rest)) for moved, rest in zip(stretched(-26.0), POINTS)]
        self.write_msh_with_node_data([("step 1", shift), ("T", [(300.0,)] * len(POINTS))])
        self.refuses("seems to be in the points' vector step 1: add --displacement 'step 1'", "nodes.msh")
        self.measure(0, "nodes.msh", "--displacement", "none", says="nothing moves")
        self.expect_stretched("nodes.msh", "step 1")
        self.write_msh_with_node_data([(f"u{axis}", [(row[k],) for row in shift]) for k, axis in enumerate("xyz")])
        self.expect_stretched("nodes.msh", "u")
        self.write_msh_with_node_data([("u", shift[1:])])
        self.refuses(f"nodes of $NodeData u = {len(POINTS) - 1}: expected each of the {len(POINTS)}", "nodes.msh")
        self.write_msh_with_node_data([("u", shift), ("u", shift)])
        self.refuses("$NodeData = u: expected one of each name", "nodes.msh")
        # Unrelated views.
        unrelated = [("von Mises", [(1.0,)]), ("von Mises", [(2.0,)] * len(POINTS)),
                     ("velocity", [(1.0, 0.0, 0.0)] * 2), ("sum", [(1.0, 2.0)])]
        self.write_msh_with_node_data(unrelated + [("u", shift)])
        self.refuses("seems to be in the points' vector u: add --displacement u", "nodes.msh")
        self.expect_stretched("nodes.msh", "u")
        self.refuses(f"nodes of $NodeData velocity = 2: expected each of the {len(POINTS)}", "nodes.msh",
                     "--displacement", "velocity")
        self.write_msh_with_node_data(unrelated)
        self.measure(0, "nodes.msh", says="nothing moves")
        self.write_msh_with_node_data([("disp", shift[1:])] + [(f"u{axis}", [(row[k],) for row in shift])
                                                               for k, axis in enumerate("xyz")])
        self.expect_stretched("nodes.msh", "u")
        self.write_msh_with_node_data([(f"u{axis}", [(row[k],) for row in shift[1:]]) for k, axis in enumerate("xyz")])
        for arguments in ((), ("--displacement", "u")):
            self.refuses("u = ux, uy, uz: expected one value of each point", "nodes.msh", *arguments)
        # Some programs write names without quotation marks.
        self.write_msh_with_node_data([("displacement field", shift)], quote="")
        self.expect_stretched("nodes.msh", "displacement field")
        self.write_msh_with_node_data([("u", shift), ("u", shift)])
        with open(self.path("nodes.msh"), encoding="utf-8") as file:
            text = file.read()
        with open(self.path("nodes.msh"), "w", encoding="utf-8") as file:
            file.write(text.replace(f"\n{len(POINTS)} ", "\n99999 "))
        self.measure(2, "nodes.msh")

    def test_doubled_nodes_and_bodies_that_overlap(self):
        """A crack, bodies in contact and a body within another: each counts with its own tets."""
        half = lambda low, high: [tet for tet in TETS if all(low <= POINTS[v][0] <= high for v in tet)]
        left, right = half(0.0, 0.5), half(0.5, 1.0)
        self.assertEqual(len(left) + len(right), len(TETS))
        points = [*POINTS, *POINTS]
        tets = left + [tuple(v + len(POINTS) for v in tet) for tet in right]
        for shift, words in ((0.0, "vertices in one place = 9 "),
                             (-0.2, "boundary that intersects itself, near vertex = ")):
            with self.subTest(words):
                rest = [*POINTS, *((x + shift, y, z) for x, y, z in POINTS)]
                foreign_arm.write_msh(self.path("rest.msh"), *self.used(rest, tets))
                write_vtk(self.path("arm.vtk"), *self.used([(1.03 * x, y, z) for x, y, z in rest], tets))
                self.measure(0, "arm.vtk", "--csv", "volume.csv", says=words)
                self.assertAlmostEqual(float(self.rows("volume.csv")[0]["volume_change_pct"]), 3.0, places=5)

    def used(self, points, tets):
        """The points of these tets, and the tets by their numbers."""
        kept = sorted({v for tet in tets for v in tet})
        return [points[v] for v in kept], [tuple(kept.index(v) for v in tet) for tet in tets]

    def test_numbers_are_sorted_as_numbers(self):
        for pattern, names in (("a/t_*.vtk", ("t_-1.5", "t_-1", "t_-0.25", "t_0.5", "t_1", "t_10")),
                               ("b/t*.vtk", ("t-10", "t-2", "t0", "t5")),
                               ("c/v1.2_f*.vtk", ("v1.2_f8", "v1.2_f9", "v1.2_f10")),
                               ("d/f-*.vtk", ("f-8", "f-9", "f-10")), ("e/*.vtk", ("0.05", "0.1", "0.15", "0.2")),
                               ("g/t_%g.vtk", ("t_-2", "t_0.5", "t_3")),
                               ("h/t_%g.vtk", ("t_0", "t_1e-05", "t_2e-05", "t_0.0001")),
                               ("i/t_*.vtk", ("t_0", "t_1e-05", "t_2e-05", "t_0.30000000000000004"))):
            with self.subTest(pattern):
                folder = os.path.dirname(pattern)
                os.makedirs(self.path(folder))
                for name in names:
                    write_vtk(self.path(folder, name + ".vtk"), stretched(0.1), TETS)
                self.measure(0, pattern, "--any-step", "--csv", "volume.csv")
                self.assertEqual(self.measured_frames(), [name + ".vtk" for name in names])

    def test_a_last_step_that_is_shorter_and_steps_that_differ(self):
        self.frames(dict.fromkeys((0, 10, 20, 25), 0.1))
        process = self.measure(0, "arm_*.vtu", "--csv", "volume.csv",
                               says="the last step of the sequence is 5 instead of 10")
        self.assertEqual(len(self.measured_frames()), 4, process.stderr)
        self.frames({45: 0.1})
        self.refuses("arm_0005.vtu: frame = 5: missing: the sequence goes from 0 to 45 by 5; --any-step measures the "
                     "frames that there are",
                     "arm_*.vtu")
        self.measure(0, "arm_*.vtu", "--any-step", "--csv", "volume.csv")
        self.assertEqual(len(self.measured_frames()), 5)

    def test_the_last_line_and_what_to_do_next(self):
        self.frames({1: 0.2, 2: -0.9, 3: 0.6})
        for bounds, status, line in (
                (("--max-volume-change", "0.5"), 1, "fails: 2 of 3 frames beyond 0.5 %, worst -0.9 % in frame "
                                                    "arm_0002.vtu"),
                (("--max-volume-change", "1"), 0, "holds: 3 frames within 1 %, worst -0.9 % in frame arm_0002.vtu"),
                (("--max-volume-change", "0.5", "--max-inverted", "0", "--min-j", "0.995"), 1,
                 "fails: 2 of 3 frames beyond 0.5 %, worst -0.9 % in frame arm_0002.vtu; j_min: 1 of 3 frames below "
                 "0.995, worst 0.991 in frame arm_0002.vtu"),
                ((), 0, "measured: 3 frames, volume -0.9 % in frame arm_0002.vtu to 0.6 % in frame arm_0003.vtu")):
            with self.subTest(bounds):
                process = self.measure(status, "arm_%04d.vtu", *bounds, "--junit", "volume.xml", says="next: ")
                self.assertEqual(process.stdout.splitlines()[-1], line)
                self.assertNotIn("--junit", process.stderr.splitlines()[-1])
                self.assertEqual("--max-volume-change" in process.stderr.splitlines()[-1], not bounds)
        self.write("arm_0002.vtu", "no VTK")
        process = self.measure(2, "arm_%04d.vtu", "--max-volume-change", "0.5")
        self.assertEqual(process.stdout.splitlines()[-1],
                         "fails: 1 of 2 frames beyond 0.5 %, worst 0.6 % in frame arm_0003.vtu; 1 of 3 frames could "
                         "not be measured")

    def test_other_vertices_order_and_units(self):
        write_vtk(self.path("fewer.vtu"), *foreign_arm.mesh((5, 2, 2)))
        self.refuses("fewer.vtu: vertices = 54: expected the rest mesh's 63", "fewer.vtu")
        turned = list(reversed(range(len(POINTS))))
        turned[0], turned[1] = turned[1], turned[0]  # turning all tets would give the same body
        write_vtk(self.path("order.vtu"), [POINTS[v] for v in turned], [[turned.index(v) for v in tet] for tet in TETS])
        self.refuses("was the order of the vertices kept on export?", "order.vtu")
        write_vtk(self.path("tets.vtu"), POINTS, TETS[::-1])
        self.measure(0, "tets.vtu", "--max-volume-change", "1e-9")
        for scale, factor in ((1000.0, "factor of 1000, as of millimetres against metres"),
                              (0.01, "factor of 0.01, as of centimetres against")):
            write_vtk(self.path("units.vtu"), stretched(1.0, scale), TETS)
            self.refuses(factor, "units.vtu")


if __name__ == "__main__":
    unittest.main()
