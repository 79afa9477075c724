"""The study `frames` without the human: whole scene runs, with state hashes and frames on disk, in seconds. It has no option for that: in a
mount namespace of its own it sees an empty folder where the motions are installed."""
import functools
import os
import subprocess
import tempfile
import unittest

MOTIONS = "/usr/share/assimp/models/BVH"
HIDE = f'mount --bind "$0" {MOTIONS} && exec "$@"'
NAMESPACES = [["unshare", "--mount"], ["unshare", "--map-root-user", "--mount"]]


@functools.cache
def empty_folder():
    return tempfile.TemporaryDirectory()


@functools.cache
def before():
    """The words that go before those of pbskin, which takes over their process; the test is skipped where none can be had."""
    if not os.path.isdir(MOTIONS):
        return []
    for namespace in NAMESPACES:
        words = [*namespace, "sh", "-c", HIDE, empty_folder().name]
        try:
            if subprocess.run([*words, "true"], capture_output=True).returncode == 0:
                return words
        except FileNotFoundError:
            pass
    raise unittest.SkipTest("no mount namespace can be had here, and the whole study takes minutes")


def state_hashes(records):
    """`RUN/run.json DEFORMER` -> hash, of the records of a folder."""
    return {f"{name} {label}": state for name, record in records.items() if name.endswith("run.json")
            for label, state in record.get("state_hash", {}).items()}
