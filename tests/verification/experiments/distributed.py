"""The linear reference on one and two processes compared with the serial solution by CHOLMOD, node by node.

Reference: the same discrete problem, assembled and solved by other code. Tolerance: with a residual r, the error is K^-1 r, at most |r|
over the lowest eigenvalue; the solution of a load f is at least its share in the softest mode over that eigenvalue. A cantilever's first
bending mode has 0.78 of a uniform load across it, so |error| <= 1.3 |r| / |f| |solution|. Both solutions record their own residuals."""
import concurrent.futures
import csv
import json
import os
import pathlib
import subprocess
import time
import unittest

import numpy

import foreign_arm
import program

PROGRAM = os.environ["PBSKIN_DISTRIBUTED"]
MPIRUN = [os.environ["MPIEXEC"], "--oversubscribe", "-n"]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_btl_vader_single_copy_mechanism="none",
                   OMPI_MCA_mpi_yield_when_idle="1", OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
MODE_SHARE = 0.78  # share of a uniform transverse load in a cantilever's first mode
LIMB = pathlib.Path(__file__).with_name("distributed_limb.toml").read_text()
ACROSS = ("--gravity", 0, 0, -9.81, "--traction", 0, 0, -1000)


def run(ranks, *arguments, **environment):
    """The finished process; 0 ranks: started without mpirun. environment: variables beside those of ENVIRONMENT."""
    start = MPIRUN + [str(ranks)] if ranks else []
    return subprocess.run([*start, PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=200,
                          env=ENVIRONMENT | environment)


def of_residuals(serial, record):
    return (serial["relative_residual"] + record["relative_residual"]) / MODE_SHARE


class Distributed(program.ProgramTest):
    # OpenBLAS's core type in the first run. The later runs of this class get it in their environment, so that they do not start twice.
    kernels = {}

    def solve(self, ranks, *arguments):
        """Record, nodes (two vertices each) and displacements [m]."""
        folder = self.path("out")
        process = run(ranks, *arguments, "--nodes", "-o", folder, **self.kernels)
        self.assertEqual(process.returncode, 0, process.stderr)
        record = self.json("out", "record.json")
        if blas := record["provenance"].get("blas"):
            type(self).kernels = {"OPENBLAS_CORETYPE": blas["core_type"]}
        self.assertEqual(record, json.loads(process.stdout))
        with open(self.path("out", "nodes.csv"), encoding="utf-8") as file:
            rows = numpy.array(list(csv.reader(file))[1:], dtype=float)
        self.assertEqual(3 * len(rows), record["dofs"])
        return record, rows[:, :2].astype(int), rows[:, 2:]

    def compare(self, arguments, tolerance_of):
        serial, nodes, expected = self.solve(0, *arguments, "--solver", "cholmod")
        for ranks in (0, 2):
            with self.subTest(ranks=ranks):
                record, distributed_nodes, found = self.solve(ranks, *arguments)
                self.assertEqual(record["ranks"], max(ranks, 1))
                self.assertGreater(record["tets_of_rank_min"], 0.4 * record["tets"] / record["ranks"])
                self.assertTrue(record["converged"])
                self.assertTrue((distributed_nodes == nodes).all())
                error = numpy.linalg.norm(found - expected) / numpy.linalg.norm(expected)
                self.assertLess(error, tolerance_of(serial, record))
                self.assertAlmostEqual(record["compliance_j"] / serial["compliance_j"], 1.0, delta=tolerance_of(serial, record))

    def test_cantilevers_of_linear_and_quadratic_elements_and_the_mesh_of_a_file(self):
        foreign_arm.write_msh(self.path("arm.msh"), *foreign_arm.mesh())
        for body in (("--bar", 6000), ("--bar", 1500, "--order", 2), ("--mesh", self.path("arm.msh"), "--order", 2)):
            self.compare((*body, *ACROSS), of_residuals)

    def test_limb_has_the_smooth_attachment_of_the_reference(self):
        """Reference: the same attachment and linear model in a scene of pbskin, whose record states the attachment."""
        self.write("limb.toml", LIMB)
        self.succeeds("run", self.path("limb.toml"), "-o", self.path("scene"))
        expected = self.json("scene", "run.json")["deformers"]["fem"]["attachment"]
        record, _, _ = self.solve(0, "--limb", 300, "--bend", 10, "--solver", "cholmod")
        self.assertEqual(record["attachment"], {key: value for key, value in expected.items() if key != "bones"})
        self.assertEqual(record["attachment"]["kind"], "smooth")
        self.assertEqual(record["springs"], sum(bone["samples"] for bone in expected["bones"]))
        self.assertIsNone(self.solve(0, "--bar", 600, *ACROSS)[0]["attachment"])

    def test_limb_held_by_its_skeleton(self):
        """The force of the springs is some q = 10 times the forces in the flesh, and the residual is relative to it: q times the
        tolerance, and as much again of the rounding that the condition of the matrix (some 1e5) enlarges."""
        limb = ("--limb", 1775, "--bend", 10, "--poisson", 0.45, "--tolerance")
        self.compare((*limb, 1e-12), lambda serial, record: 10 * 1e-12 + 1e5 * 2.2e-16)
        _, _, expected = self.solve(0, *limb, 1e-12, "--solver", "cholmod")
        _, _, coarse = self.solve(2, *limb, 1e-6)
        # shows that the tolerance determines the difference
        self.assertGreater(numpy.linalg.norm(coarse - expected) / numpy.linalg.norm(expected), 1e-8)


class Scaling(program.ProgramTest):
    def test_sweep_writes_what_every_run_agrees_on(self):
        script = os.path.join(program.SOURCE, "experiments", "sweeps", "distributed_scaling.py")
        subprocess.run([script, "--program", PROGRAM, "--tets", "600", "--launch", " ".join(MPIRUN) + " {ranks}", "-o", self.path("s.csv")],
                       check=True, stdout=subprocess.DEVNULL, env=ENVIRONMENT, timeout=200)
        rows = list(csv.DictReader(self.read("s.csv").splitlines()))
        self.assertEqual([(row["solver"], row["ranks"]) for row in rows], [("cholmod", "1"), ("cg_ml", "1"), ("cg_ml", "2")])
        serial, *others = [{key: float(row[key]) for key in ("relative_residual", "compliance_j")} for row in rows]
        for record in others:
            self.assertAlmostEqual(record["compliance_j"] / serial["compliance_j"], 1.0, delta=of_residuals(serial, record))


class Outcomes(program.ProgramTest):
    def test_not_converging_is_an_outcome(self):
        process = run(2, "--bar", 6000, *ACROSS, "--most-iterations", 3)
        self.assertEqual(process.returncode, 3)
        record = json.loads(process.stdout)
        self.assertFalse(record["converged"])
        self.assertEqual(record["iterations"], 3)
        self.assertGreater(record["relative_residual"], 1e-10)

    def test_mpirun_ends_with_the_program_that_started_it(self):
        """A stand-in for mpirun, which would go on for a minute."""
        self.script("mpirun", f"echo $$ > {self.path('process')}\nexec sleep 60\n")
        path = f"{self.folder}:{os.environ['PATH']}"
        with subprocess.Popen([program.PBSKIN, "reproduce", "verification", "--only", "distributed", "-o", self.path("out"), "--quiet"],
                              env=ENVIRONMENT | {"PATH": path}) as process:
            while process.poll() is None and not (os.path.exists(self.path("process")) and self.read("process")):
                time.sleep(0.01)
            process.terminate()
        deadline = time.monotonic() + 5
        while (left := int(self.read("process")) in program.statuses()) and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertFalse(left)

    def test_bad_input_is_refused_by_all_ranks(self):
        damaged = self.write("damaged.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n")
        cases = ((2, ("--mesh", damaged), "damaged.msh"),
                 (2, ("--bar", 100, "--held-below", -1), "expected three held points"),
                 (2, ("--bar", 100, "--solver", "cholmod"), "expected cg_ml without --serial"),
                 (0, ("--bar", 100, "--limb", 300), "expected one of --bar, --limb and --mesh"),
                 (0, ("--bar", "many"), "--bar"))
        with concurrent.futures.ThreadPoolExecutor() as pool:  # mpirun waits for a second before it ends the other rank
            processes = list(pool.map(lambda case: run(case[0], *case[1]), cases))
        for process, (_, arguments, message) in zip(processes, cases):
            with self.subTest(arguments=arguments):
                self.assertEqual(process.returncode, 2, process.stderr)
                self.assertEqual(process.stderr.count("pbskin_distributed: "), 1, process.stderr)
                self.assertIn(message, process.stderr)


if __name__ == "__main__":
    unittest.main()
