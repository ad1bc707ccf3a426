#!/usr/bin/python3
"""The modes of one clamped disc of solids by CalculiX, by scipy and by Chladni, on the same mesh of 20-node hexahedra.

usage: solids.py [--cases 72x9x3 108x16x4] [--modes 40 200] [--quick] OUTPUT

A case is the number of elements around, across and over the thickness. CalculiX (Debian: calculix-ccx) takes C3D20 and
solves by ARPACK with SPOOLES. scipy takes the matrices of Chladni: eigsh with sigma = 0, by a factor of splu with minimum
degree on A^T + A in symmetric mode. Seconds and memory are those of whole processes with one thread. Errors are against the
exact solid. Writes OUTPUT/reduction_solids.json and .md.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np

import peers
import run

INNER, OUTER, THICKNESS = 0.025, 0.162, 0.02
YOUNG, POISSON, DENSITY = 9.15915e10, 0.3, 6300.0

SCENE = f"""
name = "disc"
[mesh]
file = "disc.inp"
length_unit = "m"
[material.iron]
young = {YOUNG}
poisson = {POISSON}
density = {DENSITY}
[[section]]
group = "DISC"
type = "solid"
material = "iron"
"""
CLAMPED = '[[support]]\ngroup = "INNER"\ntype = "clamped"\n[modes]\ncount = COUNT\n'
EXPORTED = """[[coupling]]
type = "rigid"
name = "hub"
group = "INNER"
[interface]
nodes = ["hub"]
[reduce]
method = "craig-bampton"
modes = 1
pictures = "none"
"""
SCIPY = """
import sys
sys.path.insert(0, {here!r})
import numpy as np, scipy.sparse.linalg as sla
import peers
K, M, masters = peers.load({folder!r})
slaves = np.setdiff1d(np.arange(K.shape[0]), masters)
K, M = K[slaves][:, slaves].tocsc(), M[slaves][:, slaves].tocsr()
factor = sla.splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=dict(SymmetricMode=True))
inverse = sla.LinearOperator(K.shape, matvec=factor.solve, dtype=float)
lam = sla.eigsh(K, k={modes}, M=M, sigma=0.0, OPinv=inverse, return_eigenvectors=False)
np.save({folder!r} + "/lambda.npy", np.sort(lam))
"""


def polar_mesh(around, across, layers):
    """Nodes [(x, y, z)], elements of 20 nodes in the order of Abaqus, and the nodes of the bore, all from 1."""
    number, nodes = {}, []
    for k in range(2 * layers + 1):
        for i in range(2 * across + 1):
            r = INNER + (OUTER - INNER) * i / (2 * across)
            for j in range(2 * around):
                if i % 2 + j % 2 + k % 2 > 1:
                    continue
                angle = math.pi * j / around
                nodes.append((r * math.cos(angle), r * math.sin(angle), THICKNESS * (k / (2 * layers) - 0.5)))
                number[i, j, k] = len(nodes)
    at = lambda i, j, k: number[i, j % (2 * around), k]
    flat = [(0, 0), (2, 0), (2, 2), (0, 2)]
    sides = [(1, 0), (2, 1), (1, 2), (0, 1)]
    places = [(i, j, k) for k in (0, 2) for i, j in flat] + [(i, j, k) for k in (0, 2) for i, j in sides] + [(i, j, 1) for i, j in flat]
    elements = [[at(2 * a + i, 2 * b + j, 2 * c + k) for i, j, k in places]
                for a in range(across) for b in range(around) for c in range(layers)]
    return nodes, elements, [n for (i, _, _), n in number.items() if i == 0]


def inp(nodes, elements, inner, modes):
    lines = ["*NODE, NSET=ALL"] + [f"{n}, {x:.12e}, {y:.12e}, {z:.12e}" for n, (x, y, z) in enumerate(nodes, 1)]
    lines.append("*ELEMENT, TYPE=C3D20, ELSET=DISC")
    for n, element in enumerate(elements, 1):
        words = [str(word) for word in (n, *element)]
        lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
    lines.append("*NSET, NSET=INNER")
    lines += [f"{n}," for n in inner]
    lines += ["*MATERIAL, NAME=IRON", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{DENSITY}",
              "*SOLID SECTION, ELSET=DISC, MATERIAL=IRON", "", "*BOUNDARY", "INNER, 1, 3", "*STEP", "*FREQUENCY", f"{modes}", "*END STEP", ""]
    return "\n".join(line for line in lines if line) + "\n"


def by_calculix(folder, modes):
    usage = run.timed(["ccx", "disc"], folder)
    f_Hz = []
    for line in (folder / "disc.dat").read_text().splitlines():
        row = line.split()  # the table of eigenvalues comes first: number, lambda, omega, f, imaginary part
        if len(row) == 5 and row[0] == str(len(f_Hz) + 1) and len(f_Hz) < modes:
            f_Hz.append(float(row[3]))
    return {**usage, "f_Hz": f_Hz}


def by_scipy(folder, modes):
    (folder / "disc.toml").write_text(SCENE + EXPORTED)
    views = [f"-cms_view_{what}" for what in ("stiffness", "mass", "masters")]
    files = [f"binary:{folder}/{file}.petsc" for file in ("K", "M", "masters")]
    run.reduce(folder, folder / "disc.toml", options=[word for pair in zip(views, files) for word in pair])
    usage = run.timed(["/usr/bin/python3", "-c", SCIPY.format(here=str(run.HERE), folder=str(folder), modes=modes)], folder)
    return {**usage, "f_Hz": list(np.sqrt(np.load(folder / "lambda.npy")) / (2 * np.pi))}


def by_chladni(folder, modes):
    (folder / "disc.toml").write_text(SCENE + CLAMPED.replace("COUNT", str(modes)))
    words = [run.CHLADNI, "modes", "disc.toml", "--output", "out", "--overwrite", "--json", "summary.json"]
    usage = run.timed(words, folder)
    return {**usage, "f_Hz": json.loads((folder / "summary.json").read_text())["frequencies_Hz"]}


def measure(folder, case, modes, exact, with_scipy):
    mesh = polar_mesh(*case)
    (folder / "disc.inp").write_text(inp(*mesh, modes))
    runs = {"chladni modes": by_chladni(folder, modes), "ccx": by_calculix(folder, modes)}
    if with_scipy:
        runs["scipy"] = by_scipy(folder, modes)
    own = runs["chladni modes"]["f_Hz"][:modes]
    for program in runs.values():
        del program["printed"]
        f_Hz = program.pop("f_Hz")[:modes]
        program.update(found=len(f_Hz), from_chladni=max(abs(a / b - 1) for a, b in zip(f_Hz, own)), error=run.errors_of(f_Hz, exact))
    return {"modes": modes, "elements": len(mesh[1]), "dofs": 3 * (len(mesh[0]) - len(mesh[2])), "programs": runs}


def table(result):
    lines = ["# Modes of solids beside CalculiX and scipy", "",
             "The clamped disc of 20 mm on one mesh of hexahedra with 20 nodes; wall and CPU seconds and peak memory of whole processes, one "
             "thread. scipy gets the matrices of Chladni, and its seconds are without their assembly. Written by `benchmarks/reduction/solids.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}, {result['ccx']}.", "",
             "Errors are those of the frequencies by their place in the order, relative, against the exact solid: they are those of the mesh. The "
             "frequencies of ccx have seven digits.", "",
             "| DOFs | modes | program | wall, s | CPU, s | CPU over that of chladni | peak, MiB | frequencies found | farthest from those of "
             "chladni | error (median, largest) |", "|---" * 10 + "|"]  # fmt: skip
    for r in result["runs"]:
        base = r["programs"]["chladni modes"]["cpu_s"]
        for name, p in r["programs"].items():
            lines.append(f"| {r['dofs']:,} | {r['modes']} | {name} | {p['wall_s']:.1f} | {p['cpu_s']:.1f} | {p['cpu_s'] / base:.1f} | "
                         f"{p['peak_MiB']:.0f} | {p['found']} | {p['from_chladni']:.0e} | {p['error']['median']:.1e}, "
                         f"{p['error']['largest']:.1e} |")  # fmt: skip
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", nargs="+", default=["72x9x3", "108x16x4"])
    parser.add_argument("--modes", type=int, nargs="+", default=[40, 200])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--without-scipy", action="store_true")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    cases, modes = (["24x4x1"], [10]) if arguments.quick else (arguments.cases, arguments.modes)
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.strip()
    exact = run.exact_frequencies("solid", max(modes))
    runs = []
    for case in cases:
        for count in modes:
            with tempfile.TemporaryDirectory() as name:
                size = [int(n) for n in case.split("x")]
                runs.append(measure(pathlib.Path(name), size, count, exact, not arguments.without_scipy))
    result = {"machine": run.machine(), "ccx": version.splitlines()[-1] if version else "ccx", "runs": runs}
    run.publish(arguments.output, "reduction_solids", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
