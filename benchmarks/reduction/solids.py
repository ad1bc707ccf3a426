#!/usr/bin/python3
"""The modes of one clamped disc of solids by CalculiX, by scipy and by Chladni, on the same mesh of 20-node hexahedra.

usage: solids.py [--cases 72x9x3 108x16x4 156x23x6] [--modes 40 200] [--large 300x45x6] [--most-s 600] [--quick] OUTPUT

A case is the number of elements around, across and over the thickness. CalculiX (Debian: calculix-ccx) takes C3D20 and
solves by ARPACK with SPOOLES. scipy takes the matrices of Chladni: eigsh with sigma = 0, by a factor of splu with minimum
degree on A^T + A in symmetric mode. Seconds and memory are those of whole processes with one thread. A run of the other
programs that takes --most-s of CPU time is ended, and so many modes and more of that mesh are not tried again. Errors are
against the exact solid. The large case is reduced by Chladni alone, and its memory compared with the forecast of a run that
may take hardly any. Writes OUTPUT/reduction_solids.json and .md; cases and modes that are not asked for stay there as they were.
"""
import argparse
import json
import math
import pathlib
import re
import subprocess
import tempfile

import numpy as np

import calculix
import peers
import run
from calculix import INNER, OUTER, THICKNESS

SCENE = f"""
name = "disc"
[mesh]
file = "disc.inp"
length_unit = "m"
{calculix.IRON}group = "DISC"
type = "solid"
"""
CLAMPED = '[[support]]\ngroup = "INNER"\ntype = "clamped"\n[modes]\ncount = COUNT\n'
REDUCED = """[[coupling]]
type = "rigid"
name = "hub"
group = "INNER"
[interface]
nodes = ["hub"]
[reduce]
method = "craig-bampton"
modes = COUNT
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
    lines += [*calculix.IRON_OF_CALCULIX, "*SOLID SECTION, ELSET=DISC, MATERIAL=IRON", "*BOUNDARY", "INNER, 1, 3",
              "*STEP", "*FREQUENCY", f"{modes}", "*END STEP"]  # fmt: skip
    return "\n".join(lines) + "\n"


def by_scipy(folder, modes, most_s):
    (folder / "disc.toml").write_text(SCENE + REDUCED.replace("COUNT", "1"))
    views = [f"-cms_view_{what}" for what in ("stiffness", "mass", "masters")]
    files = [f"binary:{folder}/{file}.petsc" for file in ("K", "M", "masters")]
    run.reduce(folder, folder / "disc.toml", options=[word for pair in zip(views, files) for word in pair])
    words = ["/usr/bin/python3", "-c", SCIPY.format(here=str(run.HERE), folder=str(folder), modes=modes)]
    usage = run.timed(words, folder, most_s)
    return {**usage, "f_Hz": None if usage.get("stopped") else list(np.sqrt(np.load(folder / "lambda.npy")) / (2 * np.pi))}


def by_chladni(folder, modes):
    (folder / "disc.toml").write_text(SCENE + CLAMPED.replace("COUNT", str(modes)))
    words = [run.CHLADNI, "modes", "disc.toml", "--output", "out", "--overwrite", "--json", "summary.json"]
    usage = run.timed(words, folder)
    return {**usage, "f_Hz": json.loads((folder / "summary.json").read_text())["frequencies_Hz"]}


def measure(folder, case, modes, exact, others):
    """@param others  programs beside Chladni, as functions of the folder, the mesh and the number of modes"""
    mesh = polar_mesh(*map(int, case.split("x")))
    text = inp(*mesh, modes)
    (folder / "disc.inp").write_text(text)
    runs = {"chladni modes": by_chladni(folder, modes), **{name: other(folder, text, modes) for name, other in others.items()}}
    own = runs["chladni modes"]["f_Hz"][:modes]
    for program in runs.values():
        del program["printed"]
        if (f_Hz := program.pop("f_Hz")) is None:
            continue
        f_Hz = f_Hz[:modes]
        program.update(found=len(f_Hz), from_chladni=max(abs(a / b - 1) for a, b in zip(f_Hz, own)), error=run.errors_of(f_Hz, exact))
    return {"case": case, "modes": modes, "elements": len(mesh[1]), "dofs": 3 * (len(mesh[0]) - len(mesh[2])), "programs": runs}


def reduced(folder, case, modes):
    """The reduction of the disc at its hub: what it takes, and what a run that has no memory says that it would."""
    mesh = polar_mesh(*map(int, case.split("x")))
    (folder / "disc.inp").write_text(inp(*mesh, modes))
    (folder / "disc.toml").write_text(SCENE + REDUCED.replace("COUNT", str(modes)))
    words = [str(run.CHLADNI), "reduce", "disc.toml", "--output", "out", "--overwrite", "--json", "summary.json"]
    refused = subprocess.run([*words, "--", "-cms_memory", "1"], cwd=folder, env=run.ENVIRONMENT, capture_output=True, text=True, check=False)
    needs = re.search(r"need (?:at least )?(\d+) MiB on one machine besides up to (\d+) MiB", refused.stderr)
    if not needs:
        raise SystemExit(f"{case} was not refused for its memory: {refused.stderr[-2000:]}")
    usage = run.timed(words, folder)
    del usage["printed"]
    return {"case": case, "modes": modes, "elements": len(mesh[1]), "dofs": json.loads((folder / "summary.json").read_text())["n_dofs"],
            "forecast_MiB": int(needs[1]) + int(needs[2]), **usage}


def cells(program, base):
    """Of a row."""
    if program.get("stopped"):
        return f"> {program['wall_s']:.0f} | > {program['cpu_s']:.0f} | > {program['cpu_s'] / base:.1f} | > {program['peak_MiB']:.0f} | stopped | | |"
    return (f"{program['wall_s']:.1f} | {program['cpu_s']:.1f} | {program['cpu_s'] / base:.1f} | {program['peak_MiB']:.0f} | {program['found']} | "
            f"{program['from_chladni']:.0e} | {program['error']['median']:.1e}, {program['error']['largest']:.1e} |")  # fmt: skip


def run_on(row):
    return f"{row['machine']['processor']}, commit {row['machine']['commit']}"


def table(result):
    lines = ["# Modes of solids beside CalculiX and scipy", "",
             "The clamped disc of 20 mm on one mesh of hexahedra with 20 nodes; wall and CPU seconds and peak memory of whole processes, one "
             "thread. scipy gets the matrices of Chladni, and its seconds are without their assembly. Written by `benchmarks/reduction/solids.py`.", "",
             f"{'; '.join(sorted({run_on(r) for r in result['runs']}))}; {result['ccx']}.", "",
             "Errors are those of the frequencies by their place in the order, relative, against the exact solid: they are those of the mesh. The "
             "frequencies of ccx have seven digits. A `>` stands before what a run had taken when it was stopped; more modes of that mesh were "
             "not tried with this program.", "",
             "| DOFs | modes | program | wall, s | CPU, s | CPU over that of chladni | peak, MiB | frequencies found | farthest from those of "
             "chladni | error (median, largest) |", "|---" * 10 + "|"]  # fmt: skip
    for r in result["runs"]:
        base = r["programs"]["chladni modes"]["cpu_s"]
        lines += [f"| {r['dofs']:,} | {r['modes']} | {name} | {cells(p, base)}" for name, p in r["programs"].items()]
    if "large" in result:
        r = result["large"]
        lines += ["", f"A ring of {r['dofs']:,} DOFs ({r['elements']:,} elements, {r['case']}) to six masters at its hub and {r['modes']} modes, on one core; {run_on(r)}:", "",
                  "| wall, s | CPU, s | peak, MiB | forecast, MiB | forecast over peak |", "|---" * 5 + "|",
                  f"| {r['wall_s']:.0f} | {r['cpu_s']:.0f} | {r['peak_MiB']:.0f} | {r['forecast_MiB']} | {r['forecast_MiB'] / r['peak_MiB']:.3f} |"]  # fmt: skip
    return "\n".join(lines) + "\n"


def other_programs(most_s):
    """Those beside Chladni; one that was stopped is not tried again."""
    own = {"ccx": lambda folder, text, modes: calculix.by_calculix(folder, text, modes, most_s),
           "scipy": lambda folder, text, modes: by_scipy(folder, modes, most_s)}  # fmt: skip

    def tried(name, *of):
        found = own[name](*of)
        if found.get("stopped"):
            del others[name]
        return found

    others = {name: lambda *of, name=name: tried(name, *of) for name in own}
    return others


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", nargs="*", default=["72x9x3", "108x16x4", "156x23x6"])
    parser.add_argument("--modes", type=int, nargs="+", default=[40, 200])
    parser.add_argument("--large", default="300x45x6", help="none: without")
    parser.add_argument("--most-s", type=int, default=600)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    cases, modes, large = (["24x4x1"], [10], "24x4x1") if arguments.quick else (arguments.cases, sorted(arguments.modes), arguments.large)
    exact = run.exact_frequencies("solid", max(modes))
    file = arguments.output / "reduction_solids.json"
    result = {"runs": [], **(json.loads(file.read_text()) if file.exists() and not arguments.quick else {}), "machine": run.machine(), "ccx": calculix.version()}
    for case in cases:
        others = other_programs(arguments.most_s)
        result["runs"] = [r for r in result["runs"] if r["case"] != case or r["modes"] not in modes]
        for count in modes:
            with tempfile.TemporaryDirectory() as name:
                result["runs"].append({**measure(pathlib.Path(name), case, count, exact, dict(others)), "machine": run.machine()})
    result["runs"].sort(key=lambda r: (r["dofs"], r["modes"]))
    if large != "none":
        with tempfile.TemporaryDirectory() as name:
            result["large"] = {**reduced(pathlib.Path(name), large, min(modes)), "machine": run.machine()}
    run.publish(arguments.output, "reduction_solids", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
