#!/bin/sh
# The linear reference on a mesh spread over nodes, as a Slurm job:
#   sbatch --nodes=4 --ntasks-per-node=16 experiments/sweeps/slurm/distributed.sh --bar 20000000 --gravity 0 0 -9.81 -o results/bar_20m
#SBATCH --job-name=pbskin_distributed --nodes=1 --ntasks-per-node=2 --cpus-per-task=1 --mem=0 --time=00:30:00
export OPENBLAS_NUM_THREADS=1
exec srun --mpi=pmix "${PBSKIN_DISTRIBUTED:-build/release/bin/pbskin_distributed}" "$@"
