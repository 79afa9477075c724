#!/usr/bin/python3 -B
"""Parameter sweeps: many runs of one scene, by Snakemake, on this machine or on a Slurm cluster, and one table of all of them.

    experiments/sweeps/sweep.py check SWEEP.toml                            the runs that it makes
    experiments/sweeps/sweep.py size SWEEP.toml --runs 10000 --cores 64     what that takes, from some runs that are measured
    experiments/sweeps/sweep.py run SWEEP.toml -o results/stiffness -j 2    DIR/sweep.csv, costs.csv, sweep.json, runs/NAME/
    experiments/sweeps/sweep.py run SWEEP.toml -o results/stiffness --slurm

`run` goes on where it was stopped. More options of snakemake follow after `--`. sweep_file.py describes the sweep file. Installed, this is
`pbskin-sweep`. The pbskin of a checkout is its build's, that of an installation the one beside, where they are there, else the PATH's.
Exit status: 0 finished (runs that broke down numerically are in the table), 1 snakemake or a program failed, 2 bad input or usage,
130 interrupted."""
import argparse
import pathlib
import sys

import pbskin_program
import sweep_file
import sweep_merge
import sweep_runs
import sweep_size
import sweep_start


def arguments(given):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    made = {}
    for name, about in (("check", "reads a sweep and lists its runs"), ("run", "all runs, then the tables"),
                        ("size", "what many runs would take"), ("batch", "one job (started by snakemake)"),
                        ("merge", "the tables of runs that are there (started by snakemake)")):
        made[name] = verb = verbs.add_parser(name, help=about)
        verb.add_argument("sweep")
        verb.add_argument("--pbskin", type=pathlib.Path, default=pbskin_program.found())
        verb.add_argument("-o", "--output", type=pathlib.Path, required=name in ("run", "batch", "merge"))
    made["run"].add_argument("-j", "--jobs", type=int, default=1, help="runs at once; on Slurm the profile says")
    made["run"].add_argument("--slurm", action="store_true", help="as Slurm jobs, by the profile slurm beside this script")
    made["batch"].add_argument("name")
    sweep_size.add_options(made["size"])
    own, rest = (given[:given.index("--")], given[given.index("--") + 1:]) if "--" in given else (given, [])
    options = parser.parse_args(own)
    if rest and options.verb != "run":
        parser.error("only run takes options of snakemake")
    return options, rest


def check(sweep):
    for run in sweep.runs:
        print(run.name, *(f"{key}={value}" for key, value in run.varied.items()))
    print(f"{len(sweep.runs)} runs in {len(sweep.batches())} jobs")


def act(options, more):
    sweep = sweep_file.read(options.sweep)
    if options.verb == "check":
        check(sweep)
    elif options.verb == "run":
        return sweep_start.run(sweep, options, more)
    elif options.verb == "size":
        return sweep_size.size(sweep, options)
    elif options.verb == "batch":
        sweep_runs.finish_batch(sweep, options.name, options.output, options.pbskin)
    else:
        told = sweep_merge.merge(sweep, options.output)
        if len(told["provenance"]["git_revision"]) > 1:
            print("sweep: the runs are of several revisions, see sweep.json", file=sys.stderr)
    return 0


def main():
    try:
        return act(*arguments(sys.argv[1:]))
    except (sweep_file.SweepError, sweep_start.StartError) as error:
        print(f"sweep: {error}", file=sys.stderr)
        return 2
    except sweep_runs.RunFailed as error:
        print(error, file=sys.stderr)
        return 2 if error.status == 2 else 1
    except (sweep_merge.MergeError, OSError) as error:
        print(f"sweep: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return sweep_start.INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
