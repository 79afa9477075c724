"""What a sweep of many runs would take, on paper, from some runs of it that are measured now:

    core-hours = runs x processor seconds a run / 3600 + jobs x seconds a job starts / 3600,   jobs = runs / batch
    wall hours = core-hours / cores, where the jobs are many more than the cores; at least one job's time
    storage = runs x bytes a run, in whole blocks; files = runs x files a run + jobs

Means over the measured runs, with the dearest beside. A job's start (--job-start-s) is
snakemake's own, twice on Slurm: 3 to 5 s were seen."""
import math
import pathlib
import random
import sys
import tempfile

import sweep_runs


def add_options(parser):
    parser.add_argument("--runs", type=int, default=10_000)
    parser.add_argument("--cores", type=int, default=64, help="of all nodes together")
    parser.add_argument("--batch", type=int, help="runs a job; output.batch by default")
    parser.add_argument("--sample", type=int, default=5, help="runs measured, picked at random; kept in DIR/runs, if any")
    parser.add_argument("--job-start-s", type=float, default=5.0)


def paper(costs, runs, batch, cores, job_start_s):
    """Totals; costs: (processor seconds, bytes, files) of each measured run."""
    mean = [sum(column) / len(costs) for column in zip(*costs)]
    jobs = math.ceil(runs / batch)
    core_s = runs * mean[0] + jobs * job_start_s
    return {"jobs": jobs, "core_hours": core_s / 3600, "wall_hours": max(core_s / cores, batch * mean[0] + job_start_s) / 3600,
            "storage_gb": runs * mean[1] / 1e9, "files": round(runs * mean[2]) + jobs, "mean_s": mean[0], "most_s": max(costs)[0],
            "mean_mb": mean[1] / 1e6, "mean_files": mean[2]}


def heaviest(folder):
    """The bytes of a run's folder by what can be switched off."""
    sizes = {}
    for path in folder.rglob("*"):
        part = path.relative_to(folder).parts[0]
        sizes[part] = sizes.get(part, 0) + path.lstat().st_blocks * 512
    return sorted(sizes.items(), key=lambda entry: -entry[1])


def measured(sweep, options, folder):
    sample = random.Random(1).sample(range(len(sweep.runs)), min(options.sample, len(sweep.runs)))  # no stride, which a grid could share
    for run in (sweep.runs[i] for i in sorted(sample)):
        outcome = sweep_runs.finish(sweep, run, folder, options.pbskin)
        print("%s: %.2f processor seconds, %.3f MB, %d files: %s" % (
            run.name, outcome["cpu_seconds"], outcome["stored_bytes"] / 1e6, outcome["files"],
            ", ".join("%s %.3f MB" % (name, size / 1e6) for name, size in heaviest(pathlib.Path(folder, "runs", run.name)))))
        yield outcome["cpu_seconds"], outcome["stored_bytes"], outcome["files"]


def size(sweep, options):
    batch = options.batch or sweep.batch
    if min(options.runs, options.cores, batch, options.sample) < 1 or not options.job_start_s >= 0:
        print("sweep: --runs, --cores, --batch, --sample: expected at least 1; --job-start-s: at least 0", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as scratch:
        costs = list(measured(sweep, options, options.output or scratch))
    total = paper(costs, options.runs, batch, options.cores, options.job_start_s)
    print("a run: %(mean_s).2f processor seconds (the dearest %(most_s).2f), %(mean_mb).3f MB, %(mean_files).1f files" % total)
    print("%d runs in %d jobs: %.1f core-hours, %.1f minutes on %d cores, %.2f GB, %d files" % (
        options.runs, total["jobs"], total["core_hours"], 60 * total["wall_hours"], options.cores, total["storage_gb"], total["files"]))
    print("starts of jobs: %.1f core-hours of these; more runs a job (output.batch) make them fewer" % (
        total["jobs"] * options.job_start_s / 3600))
    print("to switch off: frames/ by `output.frames_every = 0`, `output.frames = []`, `output.frame_names = []`; "
          "columns by `output.metrics`")
    return 0
