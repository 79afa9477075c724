"""Writes the counts of the reliability tests for tests/README.md to FILE.json in the folder that PBS_RELIABILITY_DIR names; without it,
nothing is written.

    reliability.tell("kills", "kills survived", 20, 20, note="seed 2014")
"""
import json
import os
import pathlib
import subprocess
import sys


def revision():
    described = subprocess.run(["git", "-C", os.environ["PBS_SOURCE"], "rev-parse", "HEAD"], capture_output=True, text=True)
    return described.stdout.strip() or "unknown"


def tell(file, name, count, of, **facts):
    print(f"{name}: {count} of {of}", facts or "", file=sys.stderr)
    if not (folder := os.environ.get("PBS_RELIABILITY_DIR")):
        return
    told = pathlib.Path(folder, f"{file}.json")
    told.parent.mkdir(parents=True, exist_ok=True)
    command = ("PBS_LONG=1 " if os.environ.get("PBS_LONG") else "") + os.path.relpath(sys.argv[0], os.environ["PBS_SOURCE"])
    record = {"name": name, "count": count, "of": of, "command": command, "revision": revision(), **facts}
    beside = told.with_suffix(".part")
    beside.write_text(json.dumps(record, indent=2) + "\n")
    beside.replace(told)
