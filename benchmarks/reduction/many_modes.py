#!/usr/bin/python3
"""500 and 1000 fixed-interface modes: block Lanczos, Krylov-Schur in one piece and in slices, AMLS.

usage: many_modes.py [--size 0.009] [--modes 100 500 1000] [--only NAME ...] OUTPUT

All solve K_ss x = lambda M_ss x of the disc with 366 masters, one thread, CPU seconds of the solve with
its factorisations. Krylov-Schur is SLEPc's with MUMPS' Cholesky factor, in slices with its own
spectrum slicing (-eps_interval). AMLS is the numpy prototype of amls.py, whose kernels are those of
BLAS; its error is that against block Lanczos. Writes OUTPUT/reduction_many_modes.json and .md.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile
import time

import numpy as np

import peers
import run

SLICES = """
import sys, time, json
import petsc4py
import slepc4py; slepc4py.init("x -eps_type krylovschur -st_type sinvert -st_ksp_type preonly -st_pc_type cholesky "
    "-st_pc_factor_mat_solver_type mumps -st_mat_mumps_icntl_13 1 -st_mat_mumps_icntl_24 1 "
    "-st_mat_mumps_cntl_3 1e-12".split())
from petsc4py import PETSc
from slepc4py import SLEPc
folder, n_modes, lambda_max = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
def load(name):
    return PETSc.Mat().load(PETSc.Viewer().createBinary(folder + "/" + name, "r"))
K, M = load("K_ss.petsc"), load("M_ss.petsc")
start = time.process_time()
eps = SLEPc.EPS().create()
eps.setOperators(K, M)
eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
eps.setWhichEigenpairs(SLEPc.EPS.Which.ALL)
eps.setInterval(0.0, lambda_max)
eps.setTolerances(1e-7)
eps.setFromOptions()
eps.solve()
n = eps.getConverged()
print(json.dumps({"cpu_s": time.process_time() - start, "found": n,
                  "lambda": sorted(eps.getEigenvalue(i).real for i in range(n))[:n_modes]}))
"""


def write_petsc(path, A):
    """A sparse matrix in PETSc's binary format."""
    A = A.tocsr()
    head = np.array([1211216, *A.shape, A.nnz], ">i4")
    lengths = np.diff(A.indptr).astype(">i4")
    path.write_bytes(head.tobytes() + lengths.tobytes() + A.indices.astype(">i4").tobytes() +
                     A.data.astype(">f8").tobytes())


def export(folder, size):
    views = [f"-cms_view_{what}" for what in ("stiffness", "mass", "masters")]
    files = [f"binary:{folder}/{file}.petsc" for file in ("K", "M", "masters")]
    run.reduce(folder, run.scene(folder, size, modes=1),
               options=[word for pair in zip(views, files) for word in pair])
    K, M, masters = peers.load(folder)
    slaves = np.setdiff1d(np.arange(K.shape[0]), masters)
    K, M = K[slaves][:, slaves].tocsr(), M[slaves][:, slaves].tocsr()
    M.eliminate_zeros()
    write_petsc(folder / "K_ss.petsc", K)
    write_petsc(folder / "M_ss.petsc", M)
    return K, M


def by_chladni(folder, size, modes, options=()):
    summary = run.reduce(folder, run.scene(folder, size, modes=modes), options=options)
    lam = (2 * np.pi * np.array(summary["frequencies_Hz"][:modes]))**2
    cpu = summary["phases_cpu_s"]
    return {"cpu_s": cpu["fixed-interface modes"] + summary["factor_cpu_s"], "lambda": lam,
            "peak_MiB": summary["peak_MiB"]}


def by_slices(folder, modes, lambda_max):
    done = subprocess.run(["/usr/bin/python3", "-c", SLICES, str(folder), str(modes),
                           repr(lambda_max)], env=run.ENVIRONMENT, capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        return {"failed": done.stderr.strip().splitlines()[-1] if done.stderr else "?"}
    return json.loads(done.stdout.splitlines()[-1])


def by_amls(K, M, modes, lambda_cut, depth):
    import amls
    start = time.process_time()
    reduced = amls.Amls(K, M, 6, depth, lambda_cut)
    lam = reduced.solve(modes)
    return {"cpu_s": time.process_time() - start, "lambda": lam, "n_reduced": reduced.n_reduced,
            "phases_cpu_s": reduced.times}


def measure(folder, arguments, modes):
    wanted = lambda name: not arguments.only or name in arguments.only
    ours = by_chladni(folder / "ours", arguments.size, modes)
    rows = [{"method": "block Lanczos", **ours}]
    if wanted("krylov-schur"):
        rows.append({"method": "Krylov-Schur", **by_chladni(
            folder / "ks", arguments.size, modes, ["-cms_modes_solver", "krylov-schur"])})
    last = ours["lambda"][-1] * (1 + 1e-6)
    if wanted("slices"):
        rows.append({"method": "Krylov-Schur, slices", **by_slices(folder, modes, last)})
    if wanted("amls"):
        K, M = (peers.read_petsc(folder / name) for name in ("K_ss.petsc", "M_ss.petsc"))
        for factor in arguments.cut:
            rows.append({"method": f"AMLS, local modes up to {factor:g} lambda",
                         **by_amls(K, M, modes, factor * last, arguments.depth)})
    exact = np.array(ours["lambda"])
    for row in rows:
        if "lambda" not in row:
            continue
        lam = np.array(row.pop("lambda"))
        n = min(len(lam), len(exact))
        error = lam[:n] / exact[:n] - 1
        row.update(found=n, largest_error=float(np.max(error)), median_error=float(np.median(error)))
    return {"modes": modes, "rows": rows}


def table(result):
    lines = ["# Many modes: which eigen-solver?", "",
             f"Fixed-interface modes of the disc with 366 masters, {result['slaves']} slaves; CPU "
             "seconds of one thread, factorisations of the slices included. AMLS is a prototype in "
             "numpy. Written by `benchmarks/reduction/many_modes.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}.", "",
             "| modes | method | CPU, s | over block Lanczos | largest error of lambda | median |",
             "|---|---|---|---|---|---|"]
    for case in result["cases"]:
        base = case["rows"][0]["cpu_s"]
        for row in case["rows"]:
            if "failed" in row:
                lines.append(f"| {case['modes']} | {row['method']} | {row['failed']} | | | |")
                continue
            error = "-" if row is case["rows"][0] else f"{row['largest_error']:.1e}"
            median = "-" if row is case["rows"][0] else f"{row['median_error']:.1e}"
            lines.append(f"| {case['modes']} | {row['method']} | {row['cpu_s']:.1f} | "
                         f"{row['cpu_s'] / base:.2f} | {error} | {median} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=float, default=0.009)
    parser.add_argument("--modes", type=int, nargs="+", default=[100, 500, 1000])
    parser.add_argument("--only", nargs="*", help="krylov-schur slices amls")
    parser.add_argument("--cut", type=float, nargs="+", default=[5.0, 20.0])
    parser.add_argument("--depth", type=int, default=9, help="levels of the dissection")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    cases = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        K, _ = export(folder, arguments.size)
        for modes in arguments.modes:
            cases.append(measure(folder, arguments, modes))
    result = {"machine": run.machine(), "slaves": K.shape[0], "cases": cases}
    run.publish(arguments.output, "reduction_many_modes", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
