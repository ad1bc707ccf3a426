#!/usr/bin/python3
"""The same reduction with what a user would take today, on the same matrices: scipy, one thread.

usage: peers.py [--modes 20 200] [--size 0.009] OUTPUT

scipy: splu with minimum degree on A^T + A in symmetric mode for the constraint modes; the
fixed-interface modes by eigsh, once by the call of its documentation (sigma=0: a factor of its own,
in SuperLU's default order) and once with the factor of the constraint modes as its inverse.
Chladni: as it comes, and with a tolerance of its eigen-solver that brings its residuals to those of
scipy. Times and memory are those of whole processes. The error is that of the frequencies of the reduced disc with its
hub held, against the exact ones of the plate. The residual is |K x - lambda M x| / |lambda M x| of
the worst fixed-interface mode, from the same matrices for all. Writes OUTPUT/reduction_peers.json
and .md.
"""
import argparse
import json
import pathlib
import tempfile

import numpy as np

import run

SCIPY = """
import sys
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
n_m = len(masters)
K_mm, M_mm = (A[masters][:, masters].toarray() for A in (K, M))
K_r = np.diag(np.concatenate([np.zeros(n_m), lam]))
K_r[:n_m, :n_m] = K_mm + Ksm.T @ Psi
M_r, M_sm = T.T @ (Mss @ T), T.T @ Msm
M_r[:, :n_m] += M_sm
M_r[:n_m] += M_sm.T
M_r[:n_m, :n_m] += M_mm
np.savez({folder!r} + "/scipy.npz", K_r=K_r, M_r=M_r, omega=np.sqrt(np.sort(lam)), Phi=Phi, lam=lam)
"""


def reduced_frequencies(K_r, M_r, modes):
    """Hz, of the reduced disc with its hub held: its six DOFs are the last masters, before the modes."""
    import scipy.linalg
    kept = np.delete(np.arange(len(K_r)), np.arange(len(K_r) - modes - 6, len(K_r) - modes))
    lam = scipy.linalg.eigh(K_r[np.ix_(kept, kept)], M_r[np.ix_(kept, kept)], eigvals_only=True)
    return np.sqrt(lam) / (2 * np.pi)


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
    """One reduction by scipy; what is judged of it is computed after, in this process."""
    code = SCIPY.format(here=str(run.HERE), folder=str(folder), modes=modes, shared=shared)
    usage = run.timed(["/usr/bin/python3", "-c", code], folder)
    K, M, masters = load(folder)
    slaves = np.setdiff1d(np.arange(K.shape[0]), masters)
    found = np.load(folder / "scipy.npz")
    return {"wall_s": usage["wall_s"], "cpu_s": usage["cpu_s"], "peak_MiB": usage["peak_MiB"],
            "residual": residual(K[slaves][:, slaves], M[slaves][:, slaves], found["lam"], found["Phi"]),
            "fixed_Hz": found["omega"] / (2 * np.pi), "reduced_Hz": reduced_frequencies(found["K_r"], found["M_r"], modes)}


def chladni_run(folder, path, options=()):
    words = [run.CHLADNI, "reduce", path, "--output", folder, "--json", folder / "summary.json"]
    usage = run.timed([*words, *(["--", *options] if options else [])], folder)
    found = json.loads((folder / "summary.json").read_text())
    return {"wall_s": usage["wall_s"], "cpu_s": usage["cpu_s"], "peak_MiB": usage["peak_MiB"], "dofs": found["n_dofs"],
            "masters": found["n_masters"], "residual": found["modes_residual"],
            "fixed_Hz": np.array(found["frequencies_Hz"]), "reduced_Hz": np.array(found["certified_frequencies_Hz"])}


def export(folder, size):
    """K, M and the masters of the disc, for scipy."""
    views = [f"-cms_view_{what}" for what in ("stiffness", "mass", "masters")]
    files = [f"binary:{folder}/{file}.petsc" for file in ("K", "M", "masters")]
    run.reduce(folder, run.scene(folder, size, modes=1), options=[word for pair in zip(views, files) for word in pair])


def chladni_runs(folder, path):
    return {"chladni": chladni_run(folder, path),
            "chladni, exact": chladni_run(folder, path, ("-cms_lanczos_tolerance", "1e-12"))}


def measure(folder, size, modes):
    export(folder, size)
    own = folder / f"{modes}"
    path = run.scene(own, size, modes=modes)
    # Seconds vary by a tenth within minutes, and those of scipy take minutes.
    rounds = [chladni_runs(own, path)]
    scipy_runs = {}
    for name, shared in (("scipy, one factor", True), ("scipy, eigsh alone", False)):
        scipy_runs[name] = scipy_run(folder, modes, shared)
        rounds.append(chladni_runs(own, path))
    middle = {name: sorted((r[name] for r in rounds), key=lambda found: found["cpu_s"])[1] for name in rounds[0]}
    programs = {**middle, **scipy_runs}
    ours, scipy = programs["chladni"], programs["scipy, one factor"]
    difference = np.max(np.abs(ours["fixed_Hz"][:modes] / scipy["fixed_Hz"][:modes] - 1))
    highest = np.sqrt(0.5) * ours["fixed_Hz"][-1]  # lambda below half of the last fixed-interface one
    count = int(min((program["reduced_Hz"] < highest).sum() for program in programs.values()))
    exact = run.exact_frequencies("annulus", count)
    for program in programs.values():
        del program["fixed_Hz"]
        program["error"] = run.errors_of(program.pop("reduced_Hz")[:count], exact)
    return {"masters": ours["masters"], "modes": modes, "dofs": ours["dofs"], "compared": count, "highest_Hz": float(exact[-1]),
            "frequency_difference": float(difference), "programs": programs}


def table(result):
    lines = ["# Reduction beside scipy", "",
             "Wall and CPU seconds and peak memory of the whole process, one thread; Chladni's include mesh, assembly and "
             "error estimates, scipy reads the matrices from files and estimates nothing. Chladni runs before, between and "
             "after the runs of scipy; the table has the middle one of the three by CPU time. Written by `benchmarks/reduction/peers.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}.", "",
             "scipy with one factor: that of the constraint modes serves eigsh too; eigsh alone: the call "
             "of its documentation, which factors in another order. Chladni, exact: with "
             "`-cms_lanczos_tolerance 1e-12`. Residual: of the worst fixed-interface mode. Error: of the frequencies of "
             "the reduced disc with its hub held, up to lambda half of that of the last fixed-interface mode, "
             "against the exact plate (`benchmarks/elements/exact_annulus.py`): all reduce the same model, so it is that of mesh "
             "and modes, and the same.", "",
             "| masters + modes | DOFs | program | wall, s | CPU, s | CPU over Chladni's | over Chladni's, exact | peak, MiB | "
             "residual | frequencies compared, up to Hz | error (median, largest) |", "|---" * 11 + "|"]
    for r in result["runs"]:
        own, exact = (r["programs"][name]["cpu_s"] for name in ("chladni", "chladni, exact"))
        for name, p in r["programs"].items():
            lines.append(f"| {r['masters']} + {r['modes']} | {r['dofs']} | {name} | {p['wall_s']:.1f} | {p['cpu_s']:.1f} | "
                         f"{p['cpu_s'] / own:.1f} | {p['cpu_s'] / exact:.1f} | {p['peak_MiB']:.0f} | {p['residual']:.1e} | "
                         f"{r['compared']}, {r['highest_Hz']:.0f} | {p['error']['median']:.1e}, {p['error']['largest']:.1e} |")
    differences = ", ".join(f"{r['frequency_difference']:.0e} ({r['modes']} modes)" for r in result["runs"])
    lines += ["", f"Fixed-interface frequencies of Chladni and scipy differ by {differences} at most."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--modes", type=int, nargs="+", default=[20, 200])
    parser.add_argument("--size", type=float, default=0.009)
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        runs = [measure(pathlib.Path(name), arguments.size, modes) for modes in arguments.modes]
    result = {"machine": run.machine(), "runs": runs}
    run.publish(arguments.output, "reduction_peers", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
