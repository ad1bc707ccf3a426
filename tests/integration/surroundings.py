"""The folder in which a program is run neither lends it libraries nor chooses its solvers.

Usage: surroundings.py PROGRAM_DIR SOURCE_DIR
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py

from running import start

OPTIONS = "-cms_modes_solver by-magic\n"  # refused where it is read


def provenance(file):
    with h5py.File(file) as reduced:
        return reduced["provenance/options"][()].decode()


def wrong(programs, source, folder):
    libraries = subprocess.run(["ldd", programs / "squeal"], capture_output=True, text=True, check=True).stdout
    library = folder / re.search(r"libfmt\.so\S*", libraries)[0]
    library.write_text("no library\n")
    for name in ("squeal", "chladni"):
        done = start(programs / name, "--version", cwd=folder)
        if done.returncode:
            yield f"{name} takes its libraries from the folder it is run in: {done.stderr.strip()}"
    library.unlink()

    for name in ("petscrc", ".petscrc"):
        (folder / name).write_text(OPTIONS)
    scene = source / "examples" / "beam" / "cantilever.toml"
    reduce = (programs / "chladni", "reduce", scene, "--output", folder)
    file = folder / "cantilever.reduced.h5"
    surroundings = {name: value for name, value in os.environ.items() if name != "PETSC_OPTIONS"}
    done = start(*reduce, cwd=folder, env=surroundings)
    if done.returncode:
        yield f"options of the folder are obeyed: {done.stderr.strip()}"
    elif provenance(file):
        yield f"provenance of a run without options: {provenance(file)}"

    said = surroundings | {"PETSC_OPTIONS": "-cms_lanczos_block_size 4"}
    done = start(*reduce, "--", "-cms_lanczos_tolerance", "1e-10", cwd=folder, env=said)
    expected = "-cms_lanczos_block_size 4 -cms_lanczos_tolerance 1e-10"
    if done.returncode or provenance(file) != expected:
        yield f"provenance {provenance(file)!r} instead of {expected!r}: {done.stderr.strip()}"
    if "nothing here used" in done.stderr:
        yield f"a note of options that were used: {done.stderr.strip()}"
    done = start(*reduce, "--", "-cms_lanczos_tolerence", "1e-10", "-log_view", cwd=folder, env=surroundings)
    if done.returncode or "used the PETSc option -cms_lanczos_tolerence;" not in done.stderr:
        yield f"no note of an option that there is not: {done.stderr.strip()}"


def descendants(pid):
    """The names of all processes that a process has started, and those have."""
    names = []
    for task in Path(f"/proc/{pid}/task").iterdir():
        for child in (task / "children").read_text().split():
            names += [(Path("/proc") / child / "comm").read_text().strip(), *descendants(child)]
    return names


def left_behind(programs, source, folder):
    """A killed program leaves no process behind: none that it starts outlives it. Nor does it load what knows of networks."""
    ours = ("OMPI_MCA_ess", "OMPI_MCA_pml")
    surroundings = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    scene = source / "examples" / "thesis_disc" / "scene.toml"
    command = [programs / "chladni", "reduce", scene, "--output", folder]
    process = subprocess.Popen(command, env=surroundings, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    started, loaded = set(), ""
    end = time.monotonic() + 60.0  # a busy machine is slow
    while "mca_btl_self" not in loaded and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
        started |= set(descendants(process.pid))
        loaded += Path(f"/proc/{process.pid}/maps").read_text()
    for _ in range(20):  # what would come beside it
        time.sleep(0.01)
        started |= set(descendants(process.pid)) if process.poll() is None else set()
        loaded += Path(f"/proc/{process.pid}/maps").read_text() if process.poll() is None else ""
    process.kill()
    process.wait()
    if "orted" in started:
        yield "a daemon of Open MPI is started for one process"
    if "mca_btl_self" not in loaded or "mca_mtl" in loaded:
        yield "one process loads the networks of Open MPI, one of which sleeps for 0.2 s, or none of it"


# Half a minute's work for Gmsh.
SLOW = """size = 0.001;
Point(1) = {0, 0, 0, size};
Point(2) = {1, 0, 0, size};
Point(3) = {1, 1, 0, size};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Physical Surface("plate") = {1};
"""


def children(pid):
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def is_at_work(pid):
    try:
        return re.search(r"State:\s+(\w)", Path(f"/proc/{pid}/status").read_text())[1] not in "ZX"
    except FileNotFoundError:
        return False


def reader_left_behind(programs, _, folder):
    """The process that reads a mesh file ends with a program that is killed or terminated."""
    (folder / "slow.geo").write_text(SLOW)
    for number in (signal.SIGKILL, signal.SIGTERM):
        command = [programs / "chladni", "mesh", folder / "slow.geo", "--output", folder]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        readers = []
        while not readers and process.poll() is None:
            time.sleep(0.05)
            readers = children(process.pid)
        time.sleep(0.3)  # it has begun
        if not any(map(is_at_work, readers)):
            yield "no process reads the mesh file"
        process.send_signal(number)
        process.wait()
        for _ in range(100):  # it takes a tenth of a second, longer where the machine is busy
            if not any(map(is_at_work, readers)):
                break
            time.sleep(0.05)
        else:
            yield f"the reader of a mesh outlives its program after signal {number}"


def main(programs, source):
    with tempfile.TemporaryDirectory() as name:
        case = (Path(programs), Path(source), Path(name))
        failures = [*wrong(*case), *left_behind(*case), *reader_left_behind(*case)]
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
