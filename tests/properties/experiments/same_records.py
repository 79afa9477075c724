"""Runs repeat to the bit: state hashes and records do not depend on the number of threads, the environment, the folder
in which the program starts, the addresses of memory, or the number of concurrent runs. Reference: the same run,
repeated. Meshes: a foreign arm, which can be small or large enough to be shared among threads, and the human, where it
is installed."""
import itertools
import json
import os
import pathlib
import subprocess
import unittest

import foreign_arm
import program
import reliability
import run_records

LONG = bool(os.environ.get("PBS_LONG"))
ALL = ('["lbs", "dqs", "delta_mush", "direct_delta_mush", "pbs", "pbs_author", "xpbd", "xpbd_small_steps", '
       '"quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean", "projective_dynamics"]')
WITH_ORDERS = '["pbs", "xpbd", "xpbd_small_steps"]'
FEM = '[[fem]]\nname = "p1"\nmodel = "linear"\n[[fem]]\nname = "snh"\nmodel = "stable_neo_hookean"\n'
# Threads share the same vertices in each iteration; direct_delta_mush iterates before the first pose.
ITERATED = ("direct_delta_mush", "pbs", "quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean",
            "projective_dynamics")
ORDERS, PRECISIONS = ["plain", "ordered"], ["f32", "f64"]
BLAS_THREADS = [{"OPENBLAS_NUM_THREADS": n, "OMP_NUM_THREADS": n} for n in "124"]
ENVIRONMENTS = [{"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}, {"LC_ALL": "C"}, {"TZ": "Asia/Kathmandu"},
                {"HOME": None, "XDG_CACHE_HOME": None}, {"MALLOC_PERTURB_": "170"}]


class SameRecords(program.ProgramTest):
    compared = equal = 0  # number of hashes

    @classmethod
    def tearDownClass(cls):
        reliability.tell("hashes", "state hashes compared with those of another run and found equal", cls.equal,
                         cls.compared)

    def write_arm(self, cells, use, frames=3, more=""):
        foreign_arm.write_msh(self.path("arm.msh"), *foreign_arm.mesh(cells))
        self.write("arm.skeleton.toml", foreign_arm.SKELETON)
        text = foreign_arm.SCENE.replace('["lbs", "dqs", "pbs"]', use).replace("frames = 5", f"frames = {frames}")
        text = text.replace("angle_deg = 120.0", "angle_deg = 60.0")
        return self.write("arm.toml", text + "[output]\nframes_every = 2\n" + more)

    def run_once(self, *arguments, before=(), **options):
        """The results of the run; its folder is cleared first, so that nothing is left of the previous one."""
        folder = pathlib.Path(self.path("out"))
        command = [*before, program.PBSKIN, "run", *map(str, arguments), "-o", str(folder), "--quiet"]
        process = subprocess.run(command, capture_output=True, text=True, **options)
        self.assertEqual(process.returncode, 0, process.stderr)
        return run_records.records(folder)

    def hashes(self, records):
        return json.loads(json.dumps(records["run.json"]["state_hash"]))

    def expect_same(self, one, other, but_threads=False):
        first, second = self.hashes(one), self.hashes(other)
        self.count(first, second)
        self.assertEqual(first, second)
        if not but_threads:
            self.assertEqual(one, other)

    def count(self, first, second):
        type(self).compared += len(first)
        type(self).equal += sum(second.get(label) == state for label, state in first.items())

    def test_environments_places_and_addresses(self):
        scene = self.write_arm((10, 2, 2), '["lbs", "dqs", "delta_mush", "pbs", "xpbd", "p1", "snh"]', more=FEM)
        first = self.run_once(scene)
        self.assertEqual(len(set(self.hashes(first).values())), 7)  # no two of them are the same deformer
        for change in ENVIRONMENTS:
            environment = {name: value for name, value in {**os.environ, **change}.items() if value is not None}
            with self.subTest(change):
                self.expect_same(first, self.run_once(scene, env=environment))
        self.expect_same(first, self.run_once(os.path.basename(scene), cwd=self.folder))
        self.expect_same(first, self.run_once(scene, before=["setarch", "-R"]))  # no address-space randomisation

    def test_threads_on_a_mesh_that_is_shared_among_them(self):
        settings = list(itertools.product(ORDERS, PRECISIONS)) if LONG else [("ordered", "f32"), ("ordered", "f64")]
        for order, precision in settings:
            sets = [word for name in ITERATED for word in ("--set", f"{name}.iterations=3")]
            sets += ["--set", f'pbs.order="{order}"', "--set", f'pbs.precision="{precision}"',
                     "--set", f'xpbd.order="{order}"', "--set", f'xpbd.precision="{precision}"']
            all_once = ALL if (order, precision) == settings[0] else WITH_ORDERS
            # 16,704 vertices, since vbd shares 16,384 or more; slender, so that the factors of warped_newton have few
            # entries
            scene = self.write_arm((260, 7, 7), all_once, frames=2)
            alone = self.run_once(scene, *sets, "--threads", 1)
            for threads in (2, 4) if LONG else (4,):
                with self.subTest(order=order, precision=precision, threads=threads):
                    self.expect_same(alone, self.run_once(scene, *sets, "--threads", threads), but_threads=True)

    def test_the_reference_whatever_its_algebra_is_told(self):
        """On a mesh whose dense blocks OpenBLAS would share among threads; unit/reference_fem tests what that would
        change."""
        scene = self.write_arm((14, 4, 4), '["p1", "snh"]', more=FEM)  # 375 vertices
        first = self.run_once(scene, env=os.environ | BLAS_THREADS[0])
        for change in BLAS_THREADS[1:]:
            with self.subTest(change):
                self.expect_same(first, self.run_once(scene, env=os.environ | change))

    def test_the_human(self):
        overrides = [f"motion.duration_s={1.0 if LONG else 0.05}", "output.frames=[]", "output.frame_names=[]",
                     "reference.name=", 'deformers.use=["lbs", "dqs", "pbs", "xpbd"]']
        short = ["human_01_01", *(word for override in overrides for word in ("--set", override))]
        process = program.run("run", *short, "-o", self.path("out"))
        if "not installed" in process.stderr:
            self.skipTest("the human is not installed")
        self.assertEqual(process.returncode, 0, process.stderr)
        first = run_records.records(self.path("out"))
        self.expect_same(first, self.run_once(*short))
        self.expect_same(first, self.run_once(*short, "--threads", 4), but_threads=True)

    def records_of_jobs(self, jobs):
        """The records of two studies with this number of concurrent runs. Of `frames`, only the limb is run."""
        runs = ["limb", "human", "limb_bend", "limb_bend_rigid", *(["limb_twist"] if LONG else [])]
        folder = self.path(str(jobs))
        subprocess.run([program.PBSKIN, "reproduce", "momentum", "frames",
                        *(word for run in runs for word in ("--only", run)),
                        "-j", str(jobs), "-o", folder], check=True, capture_output=True)
        return run_records.records(folder)

    def test_runs_side_by_side(self):
        alone = self.records_of_jobs(1)
        first = run_records.state_hashes(alone)
        self.assertLessEqual({f"frames/limb_bend/run.json {label}" for label in ("dqs", "pbs_contact", "nh_p1")},
                             first.keys())
        self.assertIn("momentum/human/measurements.csv", alone)
        for jobs in (2, 4) if LONG else (4,):
            with self.subTest(jobs=jobs):
                records = self.records_of_jobs(jobs)
                self.count(first, run_records.state_hashes(records))
                self.assertEqual(records, alone)


if __name__ == "__main__":
    unittest.main()
