#!/usr/bin/python3
"""Measures how the distributed linear reference scales: cantilevers of growing size on 1, 2, ... ranks, compared with
CHOLMOD where its factor fits.

    experiments/sweeps/distributed_scaling.py -o results/distributed_scaling.csv
    experiments/sweeps/distributed_scaling.py --tets 1000000 10000000 --ranks 16 64 --launch "srun -n {ranks}"     on a cluster

Each row is the fastest of `--repeats` runs. On a machine that others use, the columns of processor time, in which a waiting rank counts,
are more reliable. The default sizes take some 5 minutes (10,000, 100,000 and 1,000,000 tets, 2 ranks) on 2 cores."""
import argparse
import csv
import json
import os
import shlex
import subprocess
import sys

FROM_RECORD = ["element_order", "tets", "vertices", "dofs", "ranks", "iterations", "mesh_s", "assembly_s", "setup_s", "solve_s",
               "mesh_cpu_s", "assembly_cpu_s", "setup_cpu_s", "solve_cpu_s",
               "peak_mb_of_rank_max", "tets_of_rank_min", "tets_of_rank_max", "relative_residual", "compliance_j", "converged"]
COLUMNS = ["solver", *FROM_RECORD, "total_s", "git_revision"]
GRAVITY = ["--gravity", "0", "0", "-9.81"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/bin/pbskin_distributed")
    parser.add_argument("--tets", type=int, nargs="+", default=[10_000, 100_000, 1_000_000])
    parser.add_argument("--orders", type=int, nargs="+", default=[1])
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--launch", default="mpirun -n {ranks}", help="what starts the ranks; {ranks} is replaced")
    parser.add_argument("--direct-up-to", type=int, default=100_000, help="tets; CHOLMOD for these as well")
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("-o", "--output", default="results/distributed_scaling.csv")
    return parser.parse_args()


def run(command):
    """The record that the program prints, or nothing where it failed."""
    process = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
    if process.returncode not in (0, 3):
        print("failed with status %d: %s" % (process.returncode, shlex.join(command)), file=sys.stderr)
        return None
    return json.loads(process.stdout)


def row_of(solver, record):
    known = record["settings"]["elastic"] | record
    row = {key: known[key] for key in FROM_RECORD}
    row["solver"] = solver
    row["total_s"] = sum(record[key] for key in ("mesh_s", "assembly_s", "setup_s", "solve_s"))
    row["git_revision"] = record["provenance"]["git_revision"]
    return row


def fastest(solver, command, repeats):
    records = [record for record in (run(command) for _ in range(repeats)) if record]
    return min((row_of(solver, record) for record in records), key=lambda row: row["total_s"], default=None)


def sweep(options):
    for order in options.orders:
        for tets in options.tets:
            bar = [options.program, "--bar", str(tets), "--order", str(order), *GRAVITY]
            if tets <= options.direct_up_to:
                yield fastest("cholmod", [*bar, "--solver", "cholmod"], options.repeats)
            for ranks in options.ranks:
                launch = shlex.split(options.launch.format(ranks=ranks)) if ranks > 1 else []
                yield fastest("cg_ml", [*launch, *bar], options.repeats)


def write(path, rows):
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    part = f"{path}.part"  # renamed when it is whole
    with open(part, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    os.replace(part, path)


def main():
    options = arguments()
    rows = []
    for row in sweep(options):
        if not row:
            return 1
        rows.append(row)
        write(options.output, rows)
        print("P%(element_order)d %(tets)8d tets %(dofs)8d dofs %(solver)8s %(ranks)d ranks: %(iterations)3d iterations, "
              "mesh %(mesh_s).2f, assembly %(assembly_s).2f, setup %(setup_s).2f, solve %(solve_s).2f s "
              "(processor %(mesh_cpu_s).2f, %(assembly_cpu_s).2f, %(setup_cpu_s).2f, %(solve_cpu_s).2f), "
              "%(peak_mb_of_rank_max).0f MB a rank" % row, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
