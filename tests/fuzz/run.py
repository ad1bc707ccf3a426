"""Runs the fuzzers one after the other and writes what they did, as a table.

Usage: run.py PROGRAM_DIR SECONDS TABLE.md [READER...]

Each reader gets so many seconds; what a reader may take is bounded by the files, which are small. Inputs
that are worth keeping stay in PROGRAM_DIR/../corpus for the next time; what breaks a reader stops it and
stands in PROGRAM_DIR. Put that into tests/fuzz/corpus, where the ordinary tests replay it: what takes a
reader seconds into a folder slow_READER, which no fuzzer starts from, since its children are as slow.
What leaks is libhdf5's own, a few hundred bytes for some damaged files.
"""

import os
import re
import resource
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
READERS = {
    "body": "damaged `*.body.h5`, then `check_body`",
    "reduced": "damaged `*.reduced.h5`, then `check_reduced`",
    "squeal": "damaged `*.squeal.h5`, then what `squeal info` and `squeal report` make of it",
    "radiation": "damaged `*.radiation.h5`, then the damping of a disc",
    "measured": "measured modes and functions in universal files (datasets 55 and 58, 58b), `chladni mac` and `chladni response`",
    "scene": "scene files",
    "geo": "what is asked of `.geo` files before Gmsh reads them",
    "deck": "decks of Nastran, Abaqus and Ansys, as meshes and as declarations",
    "exchange": "universal files and grids of VTK, as meshes",
    "med": "damaged MED files, as meshes",
    "mesh": "the check of `.msh` files before Gmsh reads them",
}
OPTIONS = ("-timeout=20", "-rss_limit_mb=1024", "-malloc_limit_mb=64", "-detect_leaks=0", "-max_len=65536",
           "-print_final_stats=1", "-verbosity=1")  # fmt: skip


def seeds(reader):
    """Whole files beside the small inputs of tests/fuzz/corpus."""
    if reader in ("body", "reduced", "squeal", "radiation"):
        return [ROOT / f"tests/data/version_1.{reader}.h5"]
    pattern = {"scene": "examples/*/*.toml", "geo": "examples/*/*.geo"}.get(reader)
    return sorted(ROOT.glob(pattern)) if pattern else []


def fuzz(programs, reader, seconds):
    """One row of the table."""
    kept = programs.parent / "corpus" / reader
    kept.mkdir(parents=True, exist_ok=True)
    for file in seeds(reader):
        shutil.copy(file, kept / f"{file.parent.name}_{file.name}")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [programs / f"fuzz_{reader}", f"-max_total_time={seconds}", *OPTIONS,
         f"-artifact_prefix={programs}/", kept, ROOT / "tests/fuzz/corpus" / reader],
        env=dict(os.environ, ASAN_OPTIONS="detect_leaks=0"), stderr=subprocess.PIPE, text=True,
        errors="replace", check=False)  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    runs = re.search(r"number_of_executed_units: *(\d+)", done.stderr)
    coverage = re.findall(r"cov: (\d+)", done.stderr)
    if done.returncode:
        print(done.stderr[-6000:])
    found = re.search(r"SUMMARY: (.*)", done.stderr)
    outcome = "nothing found" if done.returncode == 0 else found[1] if found else f"exit code {done.returncode}"
    return (f"| {READERS[reader]} | {runs[1] if runs else '?'} | {cpu:.0f} | {coverage[-1] if coverage else '?'} "
            f"| {outcome} |"), done.returncode == 0  # fmt: skip


def main(programs, seconds, table, *readers):
    rows, good = [], True
    for reader in readers or READERS:
        row, is_good = fuzz(programs, reader, seconds)
        print(row, flush=True)
        rows.append(row)
        good = good and is_good
    table.write_text(
        "# Fuzzing\n\nWritten by `./dev fuzz SECONDS`: libFuzzer with the address and undefined-behaviour sanitizers. A reader may "
        "return, or refuse with a\nclear error, and take no more than 64 MiB at once. What once broke a reader is in "
        "`tests/fuzz/corpus` and replayed by `DamagedFiles.*`,\n`DamagedResults.*` and `DamagedMed.*`, which also do some of the damage, always "
        "the same, in every run of the tests. Files of HDF5 are damaged dataset by\ndataset and sealed; a process of its own tries "
        "each of them first, since a seal gives no privileges, so that what is tested are our own checks.\n\n"
        "| reader of | inputs | CPU seconds | branches reached | outcome |\n| --- | --- | --- | --- | --- |\n"
        + "\n".join(rows) + "\n")  # fmt: skip
    return good


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]).resolve(), sys.argv[2], Path(sys.argv[3]), *sys.argv[4:]))
