"""A file whose seal stands beside it is HDF5 from its first byte on, and damage is found all the same.

Usage: detached_seal.py PROGRAM_DIR SOURCE_DIR
"""

import shutil
import struct
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import run

SIGNATURE = b"\x89HDF\r\n\x1a\n"

failures = []


def expect(claim, good):
    print(f"{'ok    ' if good else 'FAILED'} {claim}")
    if not good:
        failures.append(claim)


def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if hasattr(item, "shape") else None)
    return found


def reads_without_looking_further(data):
    """What a reader without libhdf5 does first: addresses count from the byte where the superblock says HDF5 begins."""
    begin, _, end, _ = struct.unpack_from("<4Q", data, 24)
    root = struct.unpack_from("<Q", data, 64)[0]
    version_of_object_header = data[begin + root]
    return data.startswith(SIGNATURE) and begin == 0 and end == len(data) and version_of_object_header == 1


programs, source = Path(sys.argv[1]), Path(sys.argv[2])
with tempfile.TemporaryDirectory() as name:
    path = Path(name) / "disc.body.h5"
    beside = Path(name) / "disc.body.h5.seal"
    shutil.copy(source / "tests/data/version_1.body.h5", path)
    run(programs / "squeal", "seal", path)
    sealed, before, said = path.read_bytes(), datasets(path), run(programs / "squeal", "info", path)
    expect("with the seal inside byte 0 is none of HDF5's", not sealed.startswith(SIGNATURE))

    run(programs / "squeal", "seal", "--detach", path)
    plain = path.read_bytes()
    expect("with the seal beside it is", reads_without_looking_further(plain))
    after = datasets(path)
    expect("h5py reads the same from both", before.keys() == after.keys() and all(
        np.array_equal(before[key], after[key]) for key in before))  # fmt: skip
    expect("and so does squeal", run(programs / "squeal", "info", path) == said)
    expect("the seal is text", beside.read_text().startswith(f"Chladni seal 1\nbytes {len(plain)}\nxxh64 "))

    damaged = bytearray(plain)
    damaged[len(plain) // 2] ^= 1
    path.write_bytes(damaged)
    refusal = run(programs / "squeal", "info", path, code=1)
    expect("a changed byte is found", "is not as it was written" in refusal and "seal --detach" in refusal)

    path.write_bytes(plain)
    run(programs / "squeal", "seal", path)
    expect("and back", path.read_bytes() == sealed and not beside.exists())
if failures:
    sys.exit(f"{len(failures)} claims failed")
