"""SLEPc's own symmetric EPS programs, with blocklanczos in place of krylovschur. Their sources are those that the distribution installs
(Debian: libslepc3.18-dev-examples); without them the test is skipped, and plugin_test has programs of the same kinds.

Usage: slepc_programs.py BUILD_DIR [FOLDER OF examples/src/eps]
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SKIPPED = 77
INSTALLED = "/usr/share/slepc/*/share/slepc/examples/src/eps"
# Each program with its arguments; a list: words of the refusal instead of values; a tuple: LAPACK's values, where
# krylovschur finds others.
PROGRAMS = (
    ("tutorials/ex1", "-n 120 -eps_nev 4"),
    ("tutorials/ex2", "-n 72 -eps_nev 4 -eps_ncv 20 -terse"),
    ("tutorials/ex2", "-n 30 -m 30 -eps_interval 3.9,4.15 -terse -st_type sinvert -st_pc_type cholesky"),
    ("tutorials/ex2", "-n 45 -m 46 -eps_interval 4.54,4.57 -eps_ncv 24 -terse -st_type sinvert -st_pc_type cholesky"),
    ("tutorials/ex2", "-n 30 -terse -rg_type ellipse -rg_ellipse_center 1.175 -rg_ellipse_radius 0.075", ["refuses regions"]),
    ("tutorials/ex3", "-n 72 -eps_nev 4 -eps_ncv 20 -terse"),
    ("tutorials/ex10", "-eps_nev 5 -eps_hermitian -terse -st_type sinvert"),
    ("tutorials/ex10", "-eps_nev 5 -eps_hermitian -terse -st_type shell"),
    ("tutorials/ex11", "-eps_nev 4 -terse"),
    ("tutorials/ex11", "-eps_nev 4 -terse -eps_ncv 20 -eps_target 0 -st_type sinvert -st_ksp_type cg -st_pc_type jacobi"),
    ("tutorials/ex12", "-showinertia 0 -eps_error_relative"),
    ("tutorials/ex13", "-eps_nev 4 -eps_ncv 22 -eps_tol 1e-5 -st_type sinvert -terse"),
    ("tutorials/ex13", "-n 110 -nulldim 6 -eps_nev 4 -eps_ncv 18 -eps_tol 1e-5 -eps_purify 1 -st_type sinvert -terse"),
    ("tutorials/ex13", "-eps_nev 3 -eps_tol 1e-5 -mat_type sbaij -st_type sinvert -terse"),
    ("tutorials/ex19", "-da_grid_x 8 -da_grid_y 8 -da_grid_z 8 -eps_nev 8 -eps_ncv 64"),
    ("tutorials/ex24", "-n 15 -eps_nev 1 -eps_ncv 12 -eps_max_it 1000 -eps_tol 1e-5 -terse"),
    ("tutorials/ex25", "-terse"),
    ("tutorials/ex35", "-m 11 -eps_nev 4 -terse", (0.95823, 1.08101, 1.23732, 1.27606)),
    ("tutorials/ex46", "-eps_nev 4 -terse"),
    ("tutorials/ex46", "-eps_nev 4 -terse -st_ksp_type bcgs -st_pc_type bjacobi"),
    ("tutorials/ex47", "-eps_nev 4 -terse"),
    ("tutorials/ex49", "-eps_nev 4 -terse"),
    ("tests/test1", "-type X"),
    ("tests/test2", "-n 32 -eps_nev 4 -eps_ncv 18"),
    ("tests/test3", "-eps_nev 4 -eps_smallest_real -eps_max_it 500"),
    ("tests/test4", "-type X"),
    ("tests/test6", "-eps_nev 4"),
    ("tests/test8", "-eps_nev 4 -eps_smallest_real -eps_max_it 600"),
    ("tests/test8", "-eps_nev 12 -eps_mpd 9 -eps_smallest_real -eps_max_it 1000"),
    ("tests/test10", "-eps_nev 4 -m 11 -eps_max_it 500"),
    ("tests/test12", "-eps_nev 4"),
    ("tests/test13", "-eps_max_it 5000 -st_pc_type jacobi", ["refuses arbitrary selection"]),
    ("tests/test14", "-eps_ncv 14", ["refuses balancing"]),
    ("tests/test16", "-n 200 -eps_nev 6 -eps_ncv 24 -eps_smallest_magnitude"),
    ("tests/test17", "-showinertia 0", ["EPSKrylovSchur"]),
    ("tests/test18", "-eps_nev 4", ["refuses an indefinite B"]),
    ("tests/test19", "-check_myprefix_eps_nev 2 -check_myprefix_st_type sinvert"),
    ("tests/test20", "-n 18 -eps_max_it 1500"),
    ("tests/test27", "-terse"),
    ("tests/test28", "-terse"),
    ("tests/test28", "-eps_target 8 -st_type sinvert -terse"),
    ("tests/test28", "-eps_interval 0.5,0.67 -terse -st_type sinvert -st_pc_type cholesky"),
    ("tests/test31", "-terse", ["refuses transformations other than"]),
    ("tests/test32", "-eps_nev 4 -terse"),
)


def build(source, folder):
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "slepc", "petsc"], capture_output=True, text=True, check=True).stdout.split()
    program = Path(folder) / source.stem
    subprocess.run(["mpicc", "-O0", "-w", "-o", program, source, *flags, "-lm"], check=True)
    return program


def told(program, words, folder):
    run = subprocess.run([program, *words], capture_output=True, text=True, cwd=folder, timeout=100, check=False)
    return run.returncode, run.stdout, run.stderr


def values(text):
    """The eigenvalues of each solve, in their order, a copy once: krylovschur may lack some."""
    solves = re.findall(r"required tolerance:\n((?:[ \d.,e+-]*\n)+)", text)
    lists = [[float(word) for word in re.findall(r"-?\d+\.\d+(?:e[+-]\d+)?", solve)] for solve in solves]
    if not lists:  # a table of values and errors
        lists = [[float(value) for value in re.findall(r"^ +(-?\d+\.\d+(?:e[+-]\d+)?)(?: +\d\S*)+\s*$", text, re.M)]]
    return [[value for i, value in enumerate(list_) if i == 0 or abs(value - list_[i - 1]) > 2e-5] for list_ in lists]


def is_same(ours, theirs):
    """Whether ours begins as theirs do; with more copies it shows fewer different ones."""
    return len(ours) == len(theirs) and all(
        a and b and all(abs(x - y) < 2e-5 * max(1.0, abs(y)) for x, y in zip(a, b)) for a, b in zip(ours, theirs)
    )


def compare(program, arguments, due, library, folder):
    """'same', 'refused', or what is wrong."""
    load = ["-dll_append", library]
    with_type = lambda name: [name if word == "X" else word for word in arguments.split()]  # noqa: E731
    code, text, errors = told(program, [*load, *with_type("blocklanczos"), "-eps_type", "blocklanczos"], folder)
    if isinstance(due, list):
        return "refused" if code and due[0] in errors else f"is not refused: {text[-500:]}{errors[:800]}"
    if due:
        return "same" if is_same(values(text), [due]) else f"has other values:\n{text[-700:]}{errors[:800]}"
    code_theirs, theirs, errors_theirs = told(program, [*with_type("krylovschur"), "-eps_type", "krylovschur"], folder)
    if code or code_theirs:
        return f"ends with {code} and {code_theirs}: {errors[:800]}{errors_theirs[:800]}"
    if re.sub("blocklanczos", "krylovschur", text) == theirs or is_same(values(text), values(theirs)):
        return "same"
    return f"has other values:\n{text[-700:]}\ninstead of\n{theirs[-700:]}"


def main(build_dir, folder=None):
    installed = [folder] if folder else glob.glob(INSTALLED)
    if not installed or not shutil.which("mpicc"):
        print("skipped: no sources of SLEPc's programs (Debian: libslepc3.18-dev-examples)")
        return SKIPPED
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    sources = Path(installed[0]).resolve()
    library = build_dir / "lib/libchladni_petsc.so"
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        names = sorted({name for name, *_ in PROGRAMS})
        programs = dict(zip(names, pool.map(lambda name: build((sources / name).with_suffix(".c"), folder), names)))
        cases = [(name, arguments, *(rest or [None])) for name, arguments, *rest in PROGRAMS]
        results = list(pool.map(lambda case: compare(programs[case[0]], case[1], case[2], library, folder), cases))
    for (name, arguments, _), result in zip(cases, results):
        print(f"{result if result in ('same', 'refused') else 'FAILED':8}{name} {arguments}", *([] if result in ("same", "refused") else [result]))
    wrong = [result for result in results if result not in ("same", "refused")]
    print(f"{results.count('same')} the same, {results.count('refused')} refused, {len(wrong)} wrong, of {len(names)} programs")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), *sys.argv[2:]))
