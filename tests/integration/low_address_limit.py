"""Under a low `ulimit -v`, `chladni` works or ends in one sentence; OpenBLAS and MPI looped or crashed there.

Usage: low_address_limit.py CHLADNI SOURCE_DIR MPIRUN
"""

import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from running import start

MiB = 1 << 20


def started(chladni, scene, folder, most, threads=4):
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (most, most))

    environment = {name: value for name, value in os.environ.items() if "NUM_THREADS" not in name}
    return start(chladni, "reduce", scene, "--output", folder, preexec_fn=limit, timeout=30,
                 env={**environment, "OPENBLAS_NUM_THREADS": str(threads)})  # fmt: skip


def sentences(done):
    """The lines that it ends with; a slow machine tells after ten seconds how far it is."""
    return [line for line in done.stderr.splitlines() if not re.match(r"\d+ s: +\d+ %", line)]


def wrong_later(chladni, scene, folder):
    """Where PETSc finds no more memory for its matrices; 3.18 gives the line of its source for the error."""
    for most in (684, 1074):
        done = started(chladni, scene, folder, most * MiB, threads=1)
        if done.returncode != 1 or len(sentences(done)) != 1 or "memory" not in done.stderr:
            yield f"{most} MiB: exit code {done.returncode}, {done.stderr}"


def wrong_with_scratch_files(chladni, scene, folder, mpirun):
    """Files in a folder that has room for them need addresses too."""
    for ranks, most in ((1, 600), (1, 800), (2, 700)):
        limited = ["sh", "-c", f'ulimit -v {most * 1024}; exec "$@"', "limited"]
        try:
            done = start(*limited, chladni, "reduce", scene, "--output", folder, "--", "-cms_scratch", folder,
                         mpirun=mpirun, ranks=ranks, timeout=60,
                         env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})  # fmt: skip
        except subprocess.TimeoutExpired:
            yield f"{most} MiB on {ranks} ranks with -cms_scratch: it does not end"
            continue
        is_told = "ulimit -v" in done.stderr and "no room" not in done.stderr
        if done.returncode != 1 or not is_told:
            yield f"{most} MiB on {ranks} ranks with -cms_scratch: exit code {done.returncode}, {done.stderr}"


def wrong(chladni, scene, folder):
    refused = 0
    for most in range(300, 900, 60):
        try:
            done = started(chladni, scene, folder, most * MiB)
        except subprocess.TimeoutExpired:
            yield f"{most} MiB: it does not end"
            continue
        if done.returncode == 127:  # the libraries themselves do not fit
            continue
        refused += done.returncode == 1 and "ulimit -v" in done.stderr
        if done.returncode not in (0, 1) or (done.returncode == 1 and len(sentences(done)) != 1):
            yield f"{most} MiB: exit code {done.returncode}, {done.stderr}"
    if not refused:
        yield "no limit was called too low"


def main(chladni, source, mpirun):
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(source) / "examples/beam/cantilever.toml"
        failures = list(wrong(chladni, scene, folder))
        thesis = Path(source) / "examples/thesis_disc/scene.toml"
        failures += wrong_later(chladni, thesis, folder)
        failures += wrong_with_scratch_files(chladni, thesis, folder, mpirun)
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
