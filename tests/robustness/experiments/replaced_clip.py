"""A clip that vanishes or is replaced while its motion is played: the run ends normally, and its record states the bytes that were read.
Reference: the hash that an undisturbed run of the same bytes records."""
import os
import signal
import subprocess
import time
import unittest

import foreign_arm
import program

STEPS = 3000  # some seconds of work after the first frame is on disk


class ReplacedClip(foreign_arm.ArmTest):
    scene_text = foreign_arm.CLIP_SCENE % 100.0

    def setUp(self):
        super().setUp()
        foreign_arm.write_bvh(self.path("arm.bvh"), [step % 90 for step in range(STEPS)])
        self.succeeds("run", self.scene, "-o", self.path("whole"), "--set", "motion.duration_s=0.05")
        self.recorded = self.hash_in("whole")

    def hash_in(self, folder):
        return self.json(folder, "run.json")["provenance"]["input_hashes"]["arm.bvh"]

    def ends_after(self, change):
        """The run is stopped once its first frame is on disk, and continues after the change."""
        out = self.path("out")
        process = subprocess.Popen([program.PBSKIN, "run", self.scene, "-o", out, "--set", "output.frames=[0]",
                                    "--set", "output.frames_every=0"], stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not os.path.exists(os.path.join(out, "frames", "pbs_000000.vtu")):
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        self.assertFalse(os.path.exists(os.path.join(out, "run.json")), "the run was over before the change")
        change()
        process.send_signal(signal.SIGCONT)
        _, told = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0, told)
        self.assertEqual(self.hash_in("out"), self.recorded)

    def test_a_clip_that_is_gone(self):
        self.ends_after(lambda: os.unlink(self.path("arm.bvh")))

    def test_a_clip_that_is_replaced(self):
        def replace():
            foreign_arm.write_bvh(self.path("other.bvh"), [0.0, 1.0])
            os.replace(self.path("other.bvh"), self.path("arm.bvh"))

        self.ends_after(replace)


if __name__ == "__main__":
    unittest.main()
