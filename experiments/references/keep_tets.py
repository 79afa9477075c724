#!/usr/bin/env python3
"""Keeps the tets of the bodies that may be redistributed: those that runs of the studies left in the cache of meshes.
The files are written anew with a better compression (LZMA in place of zlib), since they stay in the repository; what
they hold is the same to the bit.

    PBSKIN_CACHE=cache PBSKIN_REFERENCES=/none pbskin reproduce --full -o results/full
    python3 experiments/references/keep_tets.py cache
"""
import ctypes
import ctypes.util
import pathlib
import sys

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

BODIES = ("bar", "frankie", "human", "limb", "ring")
KEPT = pathlib.Path(__file__).resolve().parent / "tets"


class Hash128(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


def content_hash(content):
    """As pbs::content_hash: XXH3 with 128 bits."""
    xxhash = ctypes.CDLL(ctypes.util.find_library("xxhash"))
    xxhash.XXH3_128bits.restype, xxhash.XXH3_128bits.argtypes = Hash128, (ctypes.c_char_p, ctypes.c_size_t)
    hashed = xxhash.XXH3_128bits(content, len(content))
    return f"{hashed.high:016x}{hashed.low:016x}"


def compressed(file):
    reader, writer = vtkXMLUnstructuredGridReader(), vtkXMLUnstructuredGridWriter()
    reader.SetFileName(str(file))
    reader.Update()
    writer.SetInputData(reader.GetOutput())
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToLZMA()
    writer.SetCompressionLevel(9)
    writer.SetBlockSize(1 << 26)  # bytes that are compressed at once
    part = KEPT / "part"
    writer.SetFileName(str(part))
    if not writer.Write():
        sys.exit(f"keep_tets: {part}: cannot be written")
    content = part.read_bytes()
    part.unlink()
    return content


def keep(cache):
    for file in sorted(cache.glob("*.vtu")):
        key, _, content = file.stem.rpartition("-")
        if key.split("-")[0] not in BODIES:
            continue
        if content_hash(file.read_bytes()) != content:
            sys.exit(f"keep_tets: {file}: damaged")
        for old in KEPT.glob(f"{key}-????????????????????????????????.vtu"):
            old.unlink()
        content = compressed(file)
        (KEPT / f"{key}-{content_hash(content)}.vtu").write_bytes(content)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    keep(pathlib.Path(sys.argv[1]))
