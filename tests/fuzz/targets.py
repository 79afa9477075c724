"""Runs each fuzz target for PBS_FUZZ_SECONDS (60) from the seeds, past findings and the inputs that earlier runs
generated; none may find anything. A finding is a file in PBS_FUZZ_FOLDER/NAME, to be copied to tests/fuzz/findings/NAME
once it is fixed. Reference: libFuzzer's exit status, the sanitizers, and each target's definition of a valid result."""
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
IN_CHILDREN = ["assimp", "content"]  # a process per run: library_child.hpp
LEAST_RUNS_PER_S, LEAST_CHILDREN_PER_S = 20, 5  # shows that it fuzzed at all


def fuzz(name):
    """(runs executed, breakdowns of libraries in child processes, errors); new inputs are kept in the first folder,
    failing ones next to them."""
    grown, failed = FOLDER / name / "grown", FOLDER / name
    grown.mkdir(parents=True, exist_ok=True)
    seeds = [folder for folder in (SOURCE / "corpus" / name, SOURCE / "findings" / name) if folder.exists()]
    words = [f"-dict={path}" for path in [SOURCE / f"{name}.dict"] if path.exists()]
    process = subprocess.run(
        [PROGRAMS / f"fuzz_{name}", f"-max_total_time={SECONDS}", "-max_len=65536", "-timeout=10", "-rss_limit_mb=2048",
         "-print_final_stats=1", *words, f"-artifact_prefix={failed}/", grown, *seeds],
        capture_output=True, text=True, errors="replace")
    runs = re.search(r"stat::number_of_executed_units:\s*(\d+)", process.stderr)
    library = re.search(r"^library: .*, (\d+) ended by a signal, (\d+) at the time limit, (\d+) ended otherwise",
                        process.stderr, re.M)
    broken = sum(int(count) for count in library.groups()) if library else 0
    return int(runs[1]) if runs else 0, broken, "" if process.returncode == 0 else f"{name}: {process.stderr[-3000:]}"


class Targets(unittest.TestCase):
    def test_none_finds_anything(self):
        names = NAMES + IN_CHILDREN
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            results = list(pool.map(fuzz, names))
        runs, wrong = [run for run, _, _ in results], [text for _, _, text in results if text]
        broken = sum(broken for _, broken, _ in results)
        counts = ", ".join(f"{name} {count:,}" for name, count in zip(names, runs))
        reliability.tell("fuzz", f"fuzz targets without a finding in {SECONDS} s", len(names) - len(wrong), len(names),
                         note=f"runs: {counts}; assimp and VTK broke down in {broken}, contained by their process")
        self.assertEqual(wrong, [], "\n".join(wrong))
        for name, count in zip(names, runs):
            self.assertGreater(count, SECONDS * (LEAST_CHILDREN_PER_S if name in IN_CHILDREN else LEAST_RUNS_PER_S),
                               name)


if __name__ == "__main__":
    unittest.main()
