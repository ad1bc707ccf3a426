"""The plugin in programs that are not recompiled, in the compiled examples, and in Python.

Usage: plugin.py BUILD_DIR MPIRUN
"""

import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

from running import start
from checked import failed_checks

SOURCE = Path(__file__).parents[2]
PYTHON = sys.executable


class Plugin:
    """The programs of a build, and what they should say."""

    def __init__(self, build, mpirun):
        self.examples = build / "examples"
        self.library = build / "lib/libchladni_petsc.so"
        self.chladni = build / "bin/chladni"
        self.mpirun = mpirun

    def run(self, command, ranks=1, options="", code=0, folder=None):
        """Output and errors of a run; words in `options` go the way of PETSC_OPTIONS."""
        environment = {**os.environ, "PETSC_OPTIONS": options}
        run = start(*command, mpirun=self.mpirun, ranks=ranks, cwd=folder, env=environment, timeout=100)
        if (run.returncode == 0) != (code == 0):
            sys.exit(f"FAILED: {command} ended with {run.returncode}\n{run.stdout}\n{run.stderr}")
        return run.stdout + run.stderr

    def load(self):
        return f"-dll_append {self.library}"


def numbers(text, columns=3):
    """The rows of numbers that the examples print, as an array, without the first column."""
    rows = [line.split() for line in text.splitlines() if re.match(r"\s*\d+ +[\d.e+-]+ ", line)]
    return np.array([[float(word) for word in row[1:columns]] for row in rows])


def square_laplacian(n, count):
    """The lowest eigenvalues of the five-point Laplacian, exactly."""
    s = 4.0 * np.sin(0.5 * math.pi * np.arange(1, n + 1) / (n + 1)) ** 2
    return np.sort(np.add.outer(s, s).ravel())[:count]


def expect(what, condition, *told):
    print(f"{'ok' if condition else 'FAILED':8}{what}", *told)
    return bool(condition)


def solver_type_of_an_alien_program(plugin):
    """`laplacian` is not linked against Chladni."""
    linked = subprocess.run(["ldd", plugin.examples / "laplacian"], capture_output=True, text=True)
    yield expect("laplacian knows nothing of chladni", "chladni" not in linked.stdout)
    exact = square_laplacian(30, 6)
    options = f"{plugin.load()} -eps_type blocklanczos -eps_nev 6 -eps_tol 1e-10"
    inner = "-st_type sinvert -eps_target 0"
    for ranks in (1, 2):
        found = numbers(plugin.run([plugin.examples / "laplacian"], ranks, f"{options} {inner}"))
        error = np.max(np.abs(found[:6, 0] / exact - 1))
        # The error of an eigenvalue is the square of the residual's: round-off times the condition.
        yield expect(f"six eigenvalues, {ranks} ranks", error < 1e-11, f"error {error:.1e}")
        yield expect("their residuals", np.max(found[:, 1]) < 1e-7, f"{np.max(found[:, 1]):.1e}")
        factor = "-st_ksp_type preonly -st_pc_type cholesky -st_pc_factor_mat_solver_type mumps-metis"
        text = plugin.run([plugin.examples / "laplacian", "-eps_view"], ranks,
                          f"{options} {inner} {factor}")  # fmt: skip
        error = np.max(np.abs(numbers(text)[:6, 0] / exact - 1))
        yield expect(f"with the factor of the plugin, {ranks} ranks",
                     error < 1e-11 and "ordering by METIS" in text, f"error {error:.1e}")  # fmt: skip
    between = 0.5 * (exact[2] + exact[3])
    found = numbers(plugin.run([plugin.examples / "laplacian"], 1,
                               f"{options} -eps_target {between} -st_type sinvert"))  # fmt: skip
    nearest = np.sort(np.abs(square_laplacian(30, 40) - between))[:6]
    yield expect("from an indefinite factor",
                 np.allclose(np.sort(np.abs(found[:6, 0] - between)), nearest, rtol=1e-9))  # fmt: skip
    massless = plugin.run([plugin.examples / "laplacian", "-generalised", "-massless"], 1,
                          f"{options} {inner}")  # fmt: skip
    yield expect("with a singular mass", np.max(numbers(massless)[:, 1]) < 1e-7)
    largest = plugin.run([plugin.examples / "laplacian"], 1, f"{options} -eps_max_it 500")
    yield expect("the largest without a factor",
                 np.allclose(numbers(largest)[:6, 0], 8.0 - exact, rtol=1e-10))  # fmt: skip
    restarted = plugin.run([plugin.examples / "laplacian"], 1,
                           f"{options} {inner} -eps_blocklanczos_blocksize 4 -eps_ncv 16")  # fmt: skip
    yield expect("with restarts", np.allclose(numbers(restarted)[:6, 0], exact, rtol=1e-11))


def answers_of_the_solver_type(plugin):
    view = plugin.run([plugin.examples / "laplacian"], 1,
                      f"{plugin.load()} -eps_type blocklanczos -eps_view -eps_monitor "
                      "-st_type sinvert -eps_target 0 -log_view -help")  # fmt: skip
    for words in ("type: blocklanczos", "block size 8", "EPS nconv=", "-eps_blocklanczos_blocksize"):
        yield expect(f"prints '{words}'", words in view)
    for options, words in (
        ("-eps_interval 0,1", "add -st_type sinvert"),
        ("-eps_interval 0,1 -st_type sinvert -st_ksp_type cg", "counted by the pivots of a factor"),
        ("-st_type filter -eps_interval 0,1", "blocklanczos refuses transformations other than"),
        ("-eps_nev 20 -eps_ncv 24 -eps_blocklanczos_blocksize 8", "-eps_ncv 24 is too small: give at least nev + 2 blocks = 36"),
        ("-eps_blocklanczos_restart 2", "give 0 to 0.9"),
    ):
        for ranks in (1, 2):
            text = plugin.run([plugin.examples / "laplacian"], ranks,
                              f"{plugin.load()} -eps_type blocklanczos {options}", code=1)  # fmt: skip
            yield expect(f"{options}: '{words}', {ranks} ranks", words in text)


def intervals(plugin):
    """All eigenvalues of an interval, whose ends may be eigenvalues of two copies."""
    exact = square_laplacian(30, 900)
    for low, high in ((0.1, 0.5), (exact[1], exact[4]), (-1.0, 0.0), (3.9, 4.1)):
        inside = exact[(exact > low - 1e-9) & (exact < high + 1e-9)]
        for ranks in (1, 2):
            for package in ("", "supernodal", "mumps") if high in (0.5, exact[4]) else ("",):
                chosen = f"-st_pc_type cholesky -st_pc_factor_mat_solver_type {package}" if package else ""
                text = plugin.run([plugin.examples / "laplacian", "-eps_view"], ranks,
                                  f"{plugin.load()} -eps_type blocklanczos -st_type sinvert -eps_interval {low!r},{high!r} {chosen}")  # fmt: skip
                found = numbers(text).reshape(-1, 2)
                named = f"{len(inside)} in {low:.3g} .. {high:.3g}, {package or 'by default'}, {ranks} ranks"
                yield expect(named, len(found) == len(inside) and np.allclose(found[:, 0], inside, rtol=1e-10, atol=1e-12))
                yield expect("their errors", np.all(found[:, 1] < 1e-8))
                counts = re.search(r"certified by (\d+) factors: (\d+) eigenvalues below \S+, (\d+) below", text)
                yield expect("and their counts", counts and int(counts[3]) - int(counts[2]) == len(inside), counts and counts[0])
    theirs = plugin.run([plugin.examples / "laplacian"], 1, f"{plugin.load()} -eps_interval 0.1,0.5 -st_type sinvert "
                        "-st_pc_type cholesky -st_pc_factor_mat_solver_type supernodal")  # fmt: skip
    inside = exact[(exact > 0.1) & (exact < 0.5)]
    yield expect("by krylovschur with supernodal", np.allclose(numbers(theirs)[:, 0], inside, rtol=1e-9))


def python(plugin):
    exact = 4.0 * np.sin(0.5 * math.pi * np.arange(1, 6) / 101) ** 2
    for ranks in (1, 2):
        found = numbers(plugin.run([PYTHON, SOURCE / "examples/plugin/laplacian.py"], ranks,
                                   plugin.load()))  # fmt: skip
        error = np.max(np.abs(found[:5, 0] / exact - 1))
        yield expect(f"slepc4py, {ranks} ranks", error < 1e-10, f"error {error:.1e}")


def memory_of_one_rank(plugin):
    def solved(little, code):
        options = ("-st_ksp_type preonly -st_pc_type cholesky -st_pc_factor_mat_solver_type supernodal "
                   f"-little {little}")  # fmt: skip
        try:
            return plugin.run([PYTHON, Path(__file__).with_name("rank_without_memory.py")], 2,
                              f"{plugin.load()} {options}", code=code)  # fmt: skip
        except subprocess.TimeoutExpired:
            return "hangs"

    text = solved(60_000_000, 1)  # too little for the blocks, of which the other rank does not know
    yield expect("memory that one rank lacks ends both",
                 "rank 1 has not enough memory" in text and "came to its end" not in text)  # fmt: skip
    text = solved(10_000_000, 0)  # too little for the basis, about which all ranks are asked
    yield expect("or is an error of both",
                 len(re.findall(r"no memory for \d+ vectors", text)) == 2
                 and text.count("came to its end") == 2)  # fmt: skip


def class_of_the_compiled_example(plugin):
    tables = []
    for ranks in (1, 2):
        text = plugin.run([plugin.examples / "membrane", "-cms_view", "-cms_sylvester",
                           "-cms_monitor"], ranks)  # fmt: skip
        yield expect(f"membrane, {ranks} ranks: no mode is missing",
                     "20 expected (Sylvester), 20 found, 0 missing" in text)  # fmt: skip
        # Open MPI 5 may say something of the network between.
        table = [line for line in text[text.index("true error") :].splitlines()[1:] if not line.startswith("[")]
        rows = np.array([[float(word) for word in line.split()] for line in table])
        tables.append(rows)
        effectivity = rows[:, 3] / rows[:, 2]  # eta^2 over the true error
        yield expect("eta^2 estimates the true errors",
                     np.all((effectivity > 0.7) & (effectivity < 1.01)), effectivity.round(2))  # fmt: skip
    yield expect("equal on 1 and 2 ranks", np.allclose(tables[0][:, 1], tables[1][:, 1], rtol=1e-6))
    helped = plugin.run([plugin.examples / "membrane", "-help", "-log_view", "-cms_sylvester",
                         "-cms_pc_factor_mat_solver_type", "mumps-metis",
                         "-cms_sylvester_pc_factor_mat_solver_type", "mumps"])  # fmt: skip
    for words in ("-cms_type", "-cms_nmodes", "-cms_cutoff", "-cms_tol", "-cms_view",
                  "-cms_monitor", "-cms_memory", "-cms_modes_solver", "-cms_lanczos_block_size",
                  "-cms_lanczos_subspace", "-cms_lanczos_tolerance", "-cms_pc_type",
                  "-cms_pc_factor_mat_solver_type", "-cms_mat_mumps_icntl_14",
                  "-cms_sylvester_mat_mumps_icntl_14", "CMSConstraint", "CMS solve"):  # fmt: skip
        yield expect(f"help and log name {words}", words in helped)


def sectors_of_the_compiled_example(plugin):
    for options, ranks in (("", 1), ("", 2), ("-eps_type krylovschur", 2), ("-sectors 7", 1)):
        text = plugin.run([plugin.examples / "wheel", *options.split(), "-cms_monitor", "-log_view"], ranks)
        named = f"wheel {options}, {ranks} ranks"
        rows = numbers(text[text.index("of whole") :], 6)
        yield expect(f"{named}: a row for each harmonic", len(rows) == (4 if "7" in options else 7), len(rows))
        of_whole, split, of_cms, eta2 = rows[:, 1:5].T
        yield expect("its lowest is one of the whole", np.max(of_whole) < 1e-9, np.max(of_whole))
        yield expect("pairs", np.max(np.abs(split)) < 1e-12, np.max(np.abs(split)))
        effectivity = eta2 / of_cms
        yield expect("reduced to what eta^2 says", np.all((effectivity > 0.7) & (effectivity < 1.01)), effectivity)
        n_found, n_whole, worst = re.search(r"(\d+) of (\d+) eigenvalues of the whole, .* (\S+)", text).groups()
        yield expect("all eigenvalues of the whole and no others",
                     n_found == n_whole and float(worst) < 1e-9, n_found, n_whole, worst)  # fmt: skip
        yield expect("log and monitor name the harmonic", "CMSHarmonic" in text and "harmonic matrices" in text)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plugin.run([plugin.examples / "wheel", "-cms_view", "hdf5:wheel.reduced.h5"], folder=folder)
        unsound = list(failed_checks(plugin.chladni.parent, folder))
        yield expect("the file of the last harmonic is sound", not unsound, *unsound)


# `chladni body` reads the reduced file and [body]; the mesh it does not open.
BODY_SCENE = """
name = "chain"
[mesh]
file = "somebodys.msh"
[material.unknown]
young = 1.0
poisson = 0.0
density = 1.0
[[section]]
group = "all"
type = "shell"
material = "unknown"
thickness = 1.0
[interface]
nodes = ["interface"]
[reduce]
method = "guyan"
[body]
fixed = ["interface"]
"""


def write_matrix_market(path, matrix):
    lower = [(i, j, matrix[i, j]) for j in range(len(matrix)) for i in range(j, len(matrix))]
    lower = [entry for entry in lower if entry[2] != 0.0]
    with open(path, "w", encoding="ascii") as file:
        file.write("%%MatrixMarket matrix coordinate real symmetric\n% lower triangle\n")
        file.write(f"{len(matrix)} {len(matrix)} {len(lower)}\n")
        file.writelines(f"{i + 1} {j + 1} {float(value)!r}\n" for i, j, value in lower)


def somebodys_matrices(folder, n=60):
    """A chain that is held at its left end: eigenvalues are known."""
    K = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    K[-1, -1] = 1.0
    write_matrix_market(folder / "K.mtx", 1e4 * K)
    write_matrix_market(folder / "M.mtx", np.eye(n))
    omega = 200.0 * np.sin((np.arange(1, n + 1) - 0.5) * math.pi / (2 * n + 1))
    return omega / (2.0 * math.pi)


def held_chain(n):
    """Angular frequencies of n of its masses between held ones."""
    return 200.0 * np.sin(0.5 * math.pi * np.arange(1, n + 1) / (n + 1))


def matrix_market(plugin):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        exact = somebodys_matrices(folder)
        command = [plugin.examples / "matrix_market", "-K", "K.mtx", "-M", "M.mtx", "-masters"]
        for ranks in (1, 2):
            text = plugin.run([*command, "60,20", "-cms_nmodes", "12", "-cms_sylvester",
                               "-cms_view", "hdf5:chain.reduced.h5"], ranks, folder=folder)  # fmt: skip
            found = numbers(text.replace("Hz  eta^2", ""))
            error = 2.0 * (found[:5, 0] / exact[:5] - 1.0)  # of lambda
            effectivity = found[:5, 1] / error
            yield expect(f"matrices of a file, {ranks} ranks, eta^2 against the exact error",
                         np.all((effectivity > 0.7) & (effectivity < 1.01)), effectivity)  # fmt: skip
            info = plugin.run([plugin.chladni, "info", "chain.reduced.h5"], folder=folder)
            for words in ("condition of K_ss", "12 expected, 12 found, 0 missing", "bound"):
                yield expect(f"chladni info says '{words}'", words in info)
            (folder / "scene.toml").write_text(BODY_SCENE)
            plugin.run([plugin.chladni, "body", "scene.toml", "--output", "."], folder=folder)
            with h5py.File(folder / "chain.body.h5") as file:
                # Held at both masters, the parts of the chain between them remain.
                held = np.sort(np.concatenate([held_chain(19), held_chain(39)]))
                body = file["modes/frequencies"][:]
                yield expect("a body from them", np.allclose(body, held[: body.size], rtol=1e-9))
            unsound = list(failed_checks(plugin.chladni.parent, folder))
            yield expect("both files are sound", not unsound, *unsound)
            again = numbers(plugin.run([PYTHON, SOURCE / "examples/plugin/reread.py", "chain.reduced.h5"], folder=folder).replace("Hz, error", ""))
            yield expect("the matrices of the file in PETSc again", np.allclose(again[:5, 0], found[:5, 0], rtol=1e-10))
            with h5py.File(folder / "chain.reduced.h5") as file:
                masters = file["attachment/node_numbers"][file["masters/node"][:]]
                yield expect("masters in the order given", list(masters) == [59, 19])
        for change, words in (
            (["60,61"], "master 60 is out of range; rows are 0 to 59"),
            (["60,60"], "master 59 is given twice"),
            (["60", "-cms_nmodes", "60"], "60 modes asked of 59 slaves"),
            (["60", "-cms_type", "hintz"], "hintz"),
        ):
            for ranks in (1, 2):
                text = plugin.run([*command, *change], ranks, code=1, folder=folder)
                yield expect(f"{' '.join(change)}: '{words}', {ranks} ranks", words in text)


def interrupted_run(plugin):
    """Killed between the factorisation and the end: the old file stays, bit by bit."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        view = ["-cms_view", "hdf5:membrane.reduced.h5", "-cms_monitor"]
        plugin.run([plugin.examples / "membrane", "-n", "8", *view], folder=folder)
        unsound = list(failed_checks(plugin.chladni.parent, folder))
        yield expect("the file of the example is sound", not unsound, *unsound)
        old = (folder / "membrane.reduced.h5").read_bytes()
        run = subprocess.Popen([plugin.examples / "membrane", "-n", "120", "-cms_nmodes", "200", *view],
                               cwd=folder, stdout=subprocess.PIPE)  # fmt: skip
        time.sleep(0.5)
        run.send_signal(signal.SIGKILL)
        run.wait()
        yield expect("killed before its end", run.returncode == -signal.SIGKILL)
        left = sorted(path.name for path in folder.iterdir())
        yield expect("nothing new", left == ["membrane.reduced.h5"], left)
        yield expect("the old file as it was", (folder / left[0]).read_bytes() == old)


def main(build, mpirun):
    plugin = Plugin(build, mpirun)
    parts = (solver_type_of_an_alien_program, answers_of_the_solver_type, intervals, python,
             memory_of_one_rank,
             class_of_the_compiled_example, sectors_of_the_compiled_example, matrix_market, interrupted_run)  # fmt: skip
    results = [result for part in parts for result in part(plugin)]
    return all(results)


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]), sys.argv[2]))
