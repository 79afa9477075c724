"""Runs each fuzz target for PBS_FUZZ_SECONDS (60) from the seeds, past findings and the inputs that earlier runs generated; none may find
anything. A finding is a file in PBS_FUZZ_FOLDER/NAME, to be copied to tests/fuzz/findings/NAME once it is fixed. Reference: libFuzzer's
exit status, the sanitizers, and each target's definition of a valid result."""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import unittest

import reliability

SECONDS = int(os.environ.get("PBS_FUZZ_SECONDS", "60"))
PROGRAMS, FOLDER = pathlib.Path(os.environ["PBS_FUZZ_PROGRAMS"]), pathlib.Path(os.environ["PBS_FUZZ_FOLDER"])
SOURCE = pathlib.Path(os.environ["PBS_SOURCE"], "tests", "fuzz")
NAMES = ["scene", "mesh", "skeleton", "clip", "rig", "texts", "files"]


def fuzz(name):
    """(runs executed, errors); new inputs are kept in the first folder, failing ones next to them."""
    grown, failed = FOLDER / name / "grown", FOLDER / name
    grown.mkdir(parents=True, exist_ok=True)
    seeds = [folder for folder in (SOURCE / "corpus" / name, SOURCE / "findings" / name) if folder.exists()]
    words = [f"-dict={path}" for path in [SOURCE / f"{name}.dict"] if path.exists()]
    process = subprocess.run(
        [PROGRAMS / f"fuzz_{name}", f"-max_total_time={SECONDS}", "-max_len=65536", "-timeout=10", "-rss_limit_mb=2048",
         "-print_final_stats=1", *words,
         f"-artifact_prefix={failed}/", grown, *seeds],
        capture_output=True, text=True, errors="replace")
    runs = re.search(r"stat::number_of_executed_units:\s*(\d+)", process.stderr)
    return int(runs[1]) if runs else 0, "" if process.returncode == 0 else f"{name}: {process.stderr[-3000:]}"


class Targets(unittest.TestCase):
    def test_none_finds_anything(self):
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            results = list(pool.map(fuzz, NAMES))
        runs, wrong = [count for count, _ in results], [text for _, text in results if text]
        told = ", ".join(f"{name} {count:,}" for name, count in zip(NAMES, runs))
        reliability.tell("fuzz", f"fuzz targets without a finding in {SECONDS} s", len(NAMES) - len(wrong), len(NAMES),
                         note=f"runs: {told}")
        self.assertEqual(wrong, [], "\n".join(wrong))
        self.assertGreater(min(runs), 20 * SECONDS)  # shows that it fuzzed at all


if __name__ == "__main__":
    unittest.main()
