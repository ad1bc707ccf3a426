#!/usr/bin/python3
"""The same reduction with what a user would take today, on the same matrices: scipy, one thread.

usage: peers.py [--modes 20 200] [--size 0.009] OUTPUT

scipy: splu with minimum degree on A^T + A in symmetric mode for the constraint modes; the
fixed-interface modes by eigsh, once by the call of its documentation (sigma=0: a factor of its own,
in SuperLU's default order) and once with the factor of the constraint modes as its inverse.
Chladni: as it comes, and with a tolerance of its eigen-solver that brings its residuals to those of
scipy. Times are CPU seconds of whole processes. The residual is |K x - lambda M x| / |lambda M x| of
the worst fixed-interface mode, from the same matrices for all. Writes OUTPUT/reduction_peers.json
and .md.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np

import run

SCIPY = """
import sys, resource, json
sys.path.insert(0, {here!r})
import numpy as np, scipy.sparse.linalg as sla
import peers
K, M, masters = peers.load({folder!r})
slaves = np.setdiff1d(np.arange(K.shape[0]), masters)
Kss, Ksm = K[slaves][:, slaves].tocsc(), K[slaves][:, masters]
Mss, Msm = M[slaves][:, slaves].tocsr(), M[slaves][:, masters]
factor = sla.splu(Kss, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                  options=dict(SymmetricMode=True))
Psi = factor.solve(-Ksm.toarray())
inverse = sla.LinearOperator(Kss.shape, matvec=factor.solve, dtype=float)
lam, Phi = sla.eigsh(Kss, k={modes}, M=Mss, sigma=0.0, OPinv=inverse if {shared} else None)
T = np.hstack([Psi, Phi])
Mr_ss, Mr_sm = T.T @ (Mss @ T), T.T @ Msm
Kr_sm = T.T @ Ksm
order = np.argsort(lam)
np.savez({folder!r} + "/scipy.npz", omega=np.sqrt(lam[order]))
usage = resource.getrusage(resource.RUSAGE_SELF)
print(json.dumps(dict(cpu_s=usage.ru_utime + usage.ru_stime, peak_MiB=usage.ru_maxrss / 1024,
                      residual=peers.residual(Kss, Mss, lam, Phi),
                      frequencies_Hz=list(np.sqrt(lam[order]) / (2 * np.pi)))))
"""


def read_petsc(path):
    """A sparse matrix or an index set in PETSc's binary format (big-endian)."""
    import scipy.sparse
    data = path.read_bytes()
    head = np.frombuffer(data, ">i4", 4)
    matrix, index_set = 1211216, 1211218
    if head[0] == index_set:
        return np.frombuffer(data, ">i4", head[1], 8).astype(int)
    if head[0] != matrix:
        raise SystemExit(f"{path} holds neither a matrix nor an index set of PETSc")
    n_rows, n_columns, n_entries = (int(i) for i in head[1:])
    lengths = np.frombuffer(data, ">i4", n_rows, 16)
    columns = np.frombuffer(data, ">i4", n_entries, 16 + 4 * n_rows)
    values = np.frombuffer(data, ">f8", n_entries, 16 + 4 * n_rows + 4 * n_entries)
    starts = np.concatenate([[0], np.cumsum(lengths)])
    return scipy.sparse.csr_matrix((values.astype(float), columns.astype(np.int32), starts),
                                   shape=(n_rows, n_columns))


def load(folder):
    folder = pathlib.Path(folder)
    return [read_petsc(folder / name) for name in ("K.petsc", "M.petsc", "masters.petsc")]


def residual(K, M, lam, X):
    """Worst relative residual of eigenpairs."""
    MX = (M @ X) * lam
    return float(np.max(np.linalg.norm(K @ X - MX, axis=0) / np.linalg.norm(MX, axis=0)))


def scipy_run(folder, modes, shared):
    code = SCIPY.format(here=str(run.HERE), folder=str(folder), modes=modes, shared=shared)
    out = subprocess.run(["/usr/bin/python3", "-c", code], env=run.ENVIRONMENT,
                         capture_output=True, text=True, check=False)
    if out.returncode != 0:
        raise SystemExit(out.stderr)
    return json.loads(out.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--modes", type=int, nargs="+", default=[20, 200])
    parser.add_argument("--size", type=float, default=0.009)
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for modes in arguments.modes:
            path = run.scene(folder, arguments.size, modes=modes)
            ours = run.reduce(folder, path)
            exact = run.reduce(folder, path, options=("-cms_lanczos_tolerance", "1e-12"))
            views = [f"-cms_view_{what}" for what in ("stiffness", "mass", "masters")]
            files = [f"binary:{folder}/{file}.petsc" for file in ("K", "M", "masters")]
            run.reduce(folder, run.scene(folder, arguments.size, modes=1),
                       options=[word for pair in zip(views, files) for word in pair])
            shared, alone = scipy_run(folder, modes, True), scipy_run(folder, modes, False)
            n = min(len(ours["frequencies_Hz"]), modes)
            difference = np.max(np.abs(np.array(ours["frequencies_Hz"][:n]) /
                                       np.array(shared["frequencies_Hz"][:n]) - 1))
            rows.append({"masters": ours["n_masters"], "modes": modes, "dofs": ours["n_dofs"],
                         "chladni_cpu_s": ours["cpu_s"], "chladni_exact_cpu_s": exact["cpu_s"],
                         "scipy_cpu_s": shared["cpu_s"], "scipy_alone_cpu_s": alone["cpu_s"],
                         "ratio": shared["cpu_s"] / ours["cpu_s"],
                         "ratio_alone": alone["cpu_s"] / ours["cpu_s"],
                         "chladni_peak_MiB": ours["peak_MiB"], "scipy_peak_MiB": shared["peak_MiB"],
                         "scipy_residual": shared["residual"],
                         "chladni_residual": ours["modes_residual"],
                         "chladni_exact_residual": exact["modes_residual"],
                         "frequency_difference": float(difference)})
    arguments.output.mkdir(parents=True, exist_ok=True)
    result = {"machine": run.machine(), "runs": rows}
    (arguments.output / "reduction_peers.json").write_text(json.dumps(result, indent=1))
    lines = ["# Reduction beside scipy", "",
             "CPU seconds of the whole process, one thread; Chladni's include mesh, assembly and "
             "error estimates, scipy reads the matrices from files. Written by "
             "`benchmarks/reduction/peers.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}.", "",
             "scipy with one factor: that of the constraint modes serves eigsh too; eigsh alone: the call "
             "of its documentation, which factors in another order. Chladni, exact: with "
             "`-cms_lanczos_tolerance 1e-12`.", "",
             "| masters + modes | DOFs | Chladni, s | exact, s | scipy, one factor, s | ratio, exact | "
             "scipy, eigsh alone, s | ratio, exact | residuals: Chladni, exact, scipy | frequencies differ by |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for r in rows:
        def both(theirs, r=r):
            return (f"{r[theirs] / r['chladni_cpu_s']:.1f}, "
                    f"{r[theirs] / r['chladni_exact_cpu_s']:.1f}")
        lines.append(f"| {r['masters']} + {r['modes']} | {r['dofs']} | {r['chladni_cpu_s']:.1f} | "
                     f"{r['chladni_exact_cpu_s']:.1f} | {r['scipy_cpu_s']:.1f} | "
                     f"{both('scipy_cpu_s')} | {r['scipy_alone_cpu_s']:.1f} | "
                     f"{both('scipy_alone_cpu_s')} | {r['chladni_residual']:.1e}, "
                     f"{r['chladni_exact_residual']:.1e}, {r['scipy_residual']:.1e} | "
                     f"{r['frequency_difference']:.1e} |")
    text = "\n".join(lines) + "\n"
    (arguments.output / "reduction_peers.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
