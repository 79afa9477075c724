"""`pbskin references export` and `pbskin measure --reference`, on the limb twisted by 60 degrees. References: VTK's own
reader; the errors and the springs by the formulas of the exported manual; and a solver that shares no code with the
program (own_solver.py), whose linear elements must lie as far from the reference as the linear solution of the
program's finite elements did when it was solved."""
import importlib.util
import math
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

import numpy
from vtk.util.numpy_support import vtk_to_numpy

import program
import run_records
import written_frames

POSE = "limb_twist_60"
KEPT = pathlib.Path(os.environ.get("PBSKIN_REFERENCES") or pathlib.Path(program.SOURCE, "experiments", "references"),
                    POSE + ".ref")


def point_fields(grid):
    data = grid.GetPointData()
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def rows_of(path):
    return numpy.loadtxt(path, delimiter=",", skiprows=1)


@unittest.skipUnless(KEPT.exists(), f"{KEPT} is not kept")
class References(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        """The one pose that is kept in a folder of its own, and its export."""
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)
        cls.kept, cls.kit = pathlib.Path(cls.shared.name, "kept"), pathlib.Path(cls.shared.name, "kit")
        cls.kept.mkdir()
        shutil.copy(KEPT, cls.kept)
        if (KEPT.parent / "tets").exists():
            (cls.kept / "tets").symlink_to(KEPT.parent / "tets")
        cls.environment = {**os.environ, "PBSKIN_REFERENCES": str(cls.kept)}
        cls.exported = program.run("references", "export", POSE, "-o", cls.kit, env=cls.environment)
        cls.rest = cls.kit / "bodies" / "limb.vtu"

    def setUp(self):
        super().setUp()
        self.assertEqual(self.exported.returncode, 0, self.exported.stderr)
        self.pose = tomllib.loads((self.kit / POSE / "pose.toml").read_text())
        self.members = {member["name"]: member for member in self.pose["member"]}

    def reference(self, member="smooth"):
        return self.kit / POSE / self.members[member]["file"]

    def export(self, status, *arguments, kept=None, **options):
        environment = {**self.environment, "PBSKIN_REFERENCES": str(kept or self.kept)}
        return self.ends(status, "references", "export", *arguments, "-o", self.path("kit"), env=environment, **options)

    def changed(self, name, old, new):
        """A copy of a reference with another text."""
        text = self.reference().read_text()
        self.assertIn(old, text)
        return self.write(name, text.replace(old, new, 1))

    def errors(self, *frames, reference=None):
        self.succeeds("measure", self.rest, *frames, "--reference", reference or self.reference(), "--csv",
                      self.path("errors.csv"))
        return self.rows("errors.csv")

    def test_every_file_is_whole_and_named_in_the_manual(self):
        manual = (self.kit / "README.md").read_text()
        files = [path.relative_to(self.kit) for path in run_records.files(self.kit)]
        for name in ("limb.vtu", "limb.skeleton.toml", "limb.weights.csv", "limb.capsules.csv", "pose.toml",
                     "own_solver.py", "README.md"):
            self.assertIn(name, [path.name for path in files])
            self.assertIn(name.replace("limb", "BODY"), manual + "README.md")
        self.assertIn(f"| `{POSE}` | limb | movement | 8 of 8 |", manual)
        body, body_fields = written_frames.read(self.rest), point_fields(written_frames.read(self.rest))
        self.assertGreater(written_frames.signed_volumes(body).min(), 0.0)
        for member in self.members.values():
            self.assertTrue((self.kit / POSE / member["springs"]).is_file())
            grid = written_frames.read(self.kit / POSE / member["file"])
            fields = point_fields(grid)
            numpy.testing.assert_array_equal(written_frames.tets(grid), written_frames.tets(body))
            numpy.testing.assert_allclose(written_frames.points(grid), written_frames.points(body), atol=1e-9)
            for name in ("blended", "bone_distance_m", "lumped_volume_m3"):
                numpy.testing.assert_allclose(fields[name], body_fields[name], atol=1e-9)
            self.assertEqual(fields["displacement"].shape, (grid.GetNumberOfPoints(), 3))
            for fact in ("own_error_pct", "energy_j"):
                self.assertEqual(grid.GetFieldData().GetArray(fact).GetValue(0), member[fact])
            self.assertAlmostEqual(member["own_error_pct"], 0.6 * member["linear_distance_pct"])

    def test_the_springs_add_up_to_those_of_the_manual(self):
        """pi q L times the mean density over 40 discs of a centre and eight rings of 24 points. All lie in the limb,
        and barycentric coordinates add up to 1. Sums of positive numbers are rounded to 1e-12, and K to that times the
        condition of a tet."""
        s_squared, count = numpy.array([0.0, *((1 + 24 * (numpy.arange(8) + 0.5)) / 193)]), numpy.array([1, *[24] * 8])
        across = (count * (1 - s_squared) ** 2).sum() / 193
        both = numpy.where([i == j for i in range(4) for j in range(i, 4)], 1.0, 2.0)
        for bone, *ends, limb_radius_m in rows_of(self.kit / "bodies" / "limb.capsules.csv"):
            length_m = math.dist(ends[:3], ends[3:])
            along_m = (numpy.arange(40) + 0.5) / 40 * length_m
            for name, member in self.members.items():
                rows = rows_of(self.kit / POSE / member["springs"])
                t = numpy.minimum(1,
                                  numpy.minimum(along_m, length_m - along_m) / (member["core_radius"] * limb_radius_m))
                density = 1 if member["attachment"] == "embedded" else across * ((3 - 2 * t) * t ** 2).mean()
                expected_m = math.pi * member["spring_factor"] * length_m * density
                sum_m = (rows[rows[:, 1] == bone, 2:] @ both).sum()
                if member["attachment"] == "held":
                    body = written_frames.read(self.rest)
                    held = vtk_to_numpy(body.GetCellData().GetArray("held_by_bone")) == bone
                    expected_m += 1e4 / (0.35 * limb_radius_m) ** 2 * written_frames.signed_volumes(body)[held].sum()
                self.assertAlmostEqual(sum_m / expected_m, 1.0, delta=1e-9, msg=name)

    def test_a_reference_has_no_error_against_itself(self):
        error, = self.errors(self.reference())
        self.assertEqual([float(error[name]) for name in ("error_l2_pct", "error_joint_pct", "error_linf_m",
                                                          "skin_rms_mm")], [0.0] * 4)
        self.assertEqual((error["reference"], error["error_above_own_error"]), ("smooth.vtu", "0"))
        self.assertEqual(float(error["own_error_pct"]), self.members["smooth"]["own_error_pct"])

    def test_the_errors_are_those_of_the_manual(self):
        """Numbers are written to a nanometre, 1e-7 of the distance of the two members. A plain .vtk without fields is
        any frame."""
        rest, fields = written_frames.points_of(self.rest), point_fields(written_frames.read(self.reference()))
        other = point_fields(written_frames.read(self.reference("rigid_capsules")))["displacement"]
        square, mass = ((other - fields["displacement"]) ** 2).sum(1), fields["lumped_volume_m3"]
        measured, joints = fields["at_tips"] == 0, (fields["at_tips"] == 0) & (fields["blended"] == 1)
        rms_m = lambda where: math.sqrt((mass * square)[where].sum() / mass[where].sum())
        expected = {"error_l2_pct": 100.0 * rms_m(measured) / numpy.linalg.norm(rest.max(0) - rest.min(0)),
                    "error_joint_pct": 100.0 * rms_m(joints) * mass[joints].sum() / (mass * fields["bone_distance_m"])[
                        joints].sum(),
                    "error_linf_m": math.sqrt(square[measured].max())}
        lines = ["# vtk DataFile Version 3.0", "a frame", "ASCII", "DATASET UNSTRUCTURED_GRID",
                 f"POINTS {len(rest)} double"]
        lines += [" ".join(map(repr, map(float, point))) for point in rest + other]
        tets = written_frames.tets(written_frames.read(self.rest))
        lines += [f"CELLS {len(tets)} {5 * len(tets)}", *("4 " + " ".join(map(str, tet)) for tet in tets)]
        frame = self.write("mine.vtk", "\n".join([*lines, f"CELL_TYPES {len(tets)}", *["10"] * len(tets), ""]))
        for error in self.errors(frame, self.reference("rigid_capsules")):
            for name, value in expected.items():
                self.assertAlmostEqual(float(error[name]) / value, 1.0, delta=1e-5)
            self.assertEqual(error["error_above_own_error"], "1")
        plain, = self.errors(self.reference(), reference=frame)  # which says nothing of joints
        self.assertEqual((plain["error_joint_pct"], plain["own_error_pct"], plain["error_above_own_error"]),
                         ("", "", ""))
        self.assertAlmostEqual(float(plain["error_linf_m"]) / expected["error_linf_m"], 1.0, delta=1e-5)

    def test_a_reference_for_each_frame(self):
        for number, member in enumerate(("smooth", "nu_0.3")):
            shutil.copy(self.reference(member), self.path(f"reference_{number}.vtu"))
        errors = self.errors(self.reference("smooth"), self.reference("nu_0.3"),
                             reference=self.path("reference_%d.vtu"))
        self.assertEqual([float(error["error_linf_m"]) for error in errors], [0.0, 0.0])
        self.refuses("references = 2: expected one, or one for each of the 1 frames", "measure", self.rest,
                     self.reference(), "--reference", self.path("reference_%d.vtu"))

    def test_references_that_are_refused(self):
        text = self.reference().read_text()
        numbers = text[text.index('Name="displacement"'):].splitlines()[1]
        other = self.kit / "bodies" / "limb.capsules.csv"
        fewer = self.path("fewer.msh")
        program.run("mesh", pathlib.Path(program.SOURCE, "experiments", "scenes", "arm", "arm.obj"), "-o", fewer,
                    "--vertices", "200", "--wrap-alpha", "0.05")
        for reference, message in ((fewer, "expected the rest mesh's"),
                                   (self.rest, "limb.vtu: displacement: missing: its points are those of the "
                                               "rest mesh"),
                                   (self.changed("velocity.vtu", "displacement", "velocity"),
                                    "velocity.vtu: displacement: missing"),
                                   (self.changed("nan.vtu", numbers, "0.0 nan 0.0"), "nan.vtu: "),
                                   (self.changed("word.vtu", numbers, "0.0 x 0.0"), "word.vtu: "),
                                   (self.changed("less.vtu", numbers, "0.0 0.0"), "less.vtu: "),
                                   (self.changed("more.vtu", numbers, "0.0 " + numbers),
                                    " numbers: expected 3 for each of the "),
                                   (self.write("cut.vtu", text[:len(text) // 2]), "cut.vtu: "),
                                   (other, "limb.capsules.csv: "), (self.path("none.vtu"), "none.vtu")):
            with self.subTest(message):
                self.refuses(message, "measure", self.rest, self.reference(), "--reference", reference, "--csv",
                             self.path("errors.csv"))
                self.assertFalse(os.path.exists(self.path("errors.csv")))

    def test_the_exported_body_is_a_character(self):
        """Its tets, bones and weights are read back as those of a scene."""
        body = self.kit / "bodies" / "limb"
        scene = self.write("limb.toml", f'schema = 1\n[character]\nmesh = "{body}.vtu"\nskeleton = '
                                        f'"{body}.skeleton.toml"\n'
                           '[motion]\njoint = "forearm"\naxis = [1.0, 0.0, 0.0]\nangle_deg = 60.0\nframes = 3\n'
                           f'[skinning]\nweights = "{body}.weights.csv"\n[deformers]\nuse = ["lbs"]\n[output]\n'
                           'frames_every = 2\n')
        self.succeeds("run", scene, "-o", self.path("out"))
        self.succeeds("run", scene, "-o", self.path("built_in"), "--set", "character.mesh=", "--set",
                      "character.skeleton=", "--set", "character.body=limb", "--set", "skinning.weights=paper")
        frames = [written_frames.points_of(self.path(run, "frames", "lbs_000002.vtu")) for run in ("out", "built_in")]
        numpy.testing.assert_allclose(*frames, atol=1e-12)

    def test_all_that_is_kept(self):
        """Without names, what is not kept or not installed is named once."""
        elsewhere = {**self.environment, "PBSKIN_CACHE": self.path("cache")}  # where neither man nor lady is installed
        process = self.succeeds("references", "export", "-o", self.path("all"), env=elsewhere)
        self.assertRegex(process.stderr, r"\d+ poses are left out: character.body = lady: not installed: "
                                         r".*`pbskin fetch lady`")
        self.assertRegex(process.stderr, r"warning: \d+ poses are left out: no references of them are kept; "
                                         r"`pbskin reproduce references")
        self.assertEqual(self.read("all", POSE, "pose.toml"), (self.kit / POSE / "pose.toml").read_text())
        self.refuses("character.body = lady: not installed: needs", "references", "export", "lady_neck_extension", "-o",
                     self.path("kit"), env=elsewhere)

    def test_what_is_refused_leaves_nothing(self):
        damaged = pathlib.Path(self.path("damaged"))
        damaged.mkdir()
        (damaged / KEPT.name).write_bytes(KEPT.read_bytes()[:1000])
        self.export(2, "limb_twist_6", says="pose = limb_twist_6: unknown name; the nearest known one is limb_twist_60")
        self.export(2, "limb_twist_45", says="limb_twist_45.ref: does not exist: solve the references of this "
                                             "pose with")
        self.export(2, POSE, kept=damaged, says=f"{POSE}.ref: is no file of references, or damaged")
        self.export(2, kept=self.path("nowhere"), says="nowhere: has no reference of an installed body")
        self.refuses("action: exprot not in {export}", "references", "exprot", "-o", self.path("kit"))
        self.assertFalse(os.path.exists(self.path("kit")))

    def test_a_changed_file_is_kept_and_named(self):
        self.export(0, POSE)
        solver, rest = (pathlib.Path(self.path("kit", *path)) for path in (["own_solver.py"], ["bodies", "limb.vtu"]))
        for file in (solver, rest):
            file.write_text(file.read_text() + "<!-- mine -->\n")
        mine = solver.read_text()
        said = self.export(0, POSE, says="not replaced: differs from what this program writes").stderr
        self.assertIn("bodies/limb.vtu, " + str(solver) + ": not replaced", said)
        self.assertEqual(solver.read_text(), mine)

    def test_notes_in_the_manual_are_kept_and_its_tables_follow_the_poses(self):
        self.export(0, POSE)
        manual = pathlib.Path(self.path("kit", "README.md"))
        text = manual.read_text()
        manual.write_text(text.replace(f"| `{POSE}` ", "| `a_pose_that_left` "))
        self.export(0, POSE)
        self.assertEqual(manual.read_text(), text)
        manual.write_text(text + "My solver needs 4 steps here.\n")
        self.export(0, POSE, says="README.md: not replaced: differs from what this program writes")
        self.assertEqual(manual.read_text(), text + "My solver needs 4 steps here.\n")

    def test_a_full_disk(self):
        sizes = sorted({path.stat().st_size for path in run_records.files(self.kit)})
        for size in (100, 9 * sizes[-1] // 10):
            self.export(2, POSE, says="File too large",
                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
            self.assertFalse(os.path.exists(self.path("kit", "README.md")))
            self.assertEqual([path for path in run_records.files(self.path("kit")) if run_records.is_temporary(path)],
                             [])
        self.export(0, POSE)
        for path in run_records.files(self.kit):
            self.assertEqual((pathlib.Path(self.path("kit")) / path.relative_to(self.kit)).read_bytes(),
                             path.read_bytes())

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "scipy is not installed (python3-scipy)")
    def test_a_solver_of_another_hand(self):
        """The kept distance is that of the program's own linear solution of the same problem. The example solves it to
        1e-7 m, and the kept positions are rounded to 1e-5 m: less than 1e-3 of the distance, 7e-4 m, since the
        roundings of vertices are independent."""
        for member in ("smooth", "held_parts"):
            frame = self.path(member + ".vtu")
            subprocess.run([sys.executable, self.kit / "own_solver.py", self.kit, POSE, member, frame], check=True,
                           capture_output=True)
            error, = self.errors(frame, reference=self.reference(member))
            self.assertAlmostEqual(float(error["error_joint_pct"]) / self.members[member]["linear_distance_pct"], 1.0,
                                   delta=2e-3)


if __name__ == "__main__":
    unittest.main()
