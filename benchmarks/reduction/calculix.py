#!/usr/bin/python3
"""The modes of one clamped disc by CalculiX and by Chladni, on the same mesh of 8-node shells.

usage: calculix.py [--modes 50 200] [--around 120] [--across 25] OUTPUT

CalculiX (Debian: calculix-ccx) expands its S8R shells into solid elements and solves by ARPACK with
SPOOLES; Chladni completes the quadrilaterals by a node in the middle. CPU seconds are those of whole
processes with one thread: `chladni modes`, and `chladni reduce` to 366 masters with as many
fixed-interface modes and its certificate. Writes OUTPUT/reduction_calculix.json and .md.
"""
import argparse
import json
import math
import pathlib
import resource
import shutil
import subprocess
import tempfile

import run

INNER, OUTER, THICKNESS = 0.025, 0.162, 0.02
YOUNG, POISSON, DENSITY = 9.15915e10, 0.3, 6300.0

SCENE = f"""
name = "disc"
[mesh]
file = "disc.msh"
rings = [{{ name = "track", radius = RADIUS, nodes = 60 }}]
[material.iron]
young = {YOUNG}
poisson = {POISSON}
density = {DENSITY}
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = {THICKNESS}
"""
CLAMPED = '[[support]]\ngroup = "inner"\ntype = "clamped"\n[modes]\ncount = COUNT\n'
REDUCED = """[[coupling]]
type = "rigid"
name = "hub"
group = "inner"
[interface]
nodes = ["track", "hub"]
[reduce]
method = "craig-bampton"
modes = COUNT
pictures = "none"
[body]
fixed = ["hub"]
"""


def polar_mesh(around, across):
    """Nodes [(x, y)], 8-node elements, and the 3-node lines of the inner edge, all from 1."""
    number, nodes = {}, []
    for i in range(2 * across + 1):
        r = INNER + (OUTER - INNER) * i / (2 * across)
        for j in range(2 * around):
            if i % 2 and j % 2:
                continue
            angle = math.pi * j / around
            nodes.append((r * math.cos(angle), r * math.sin(angle)))
            number[i, j] = len(nodes)
    at = lambda i, j: number[i, j % (2 * around)]
    corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = [[at(2 * a + i, 2 * b + j) for i, j in corners]
                for a in range(across) for b in range(around)]
    edge = [[at(0, 2 * b), at(0, 2 * b + 2), at(0, 2 * b + 1)] for b in range(around)]
    return nodes, elements, edge


def msh(nodes, elements, edge):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 1 "inner"',
             '2 2 "disc"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{n} {x:.17g} {y:.17g} 0" for n, (x, y) in enumerate(nodes, 1)]
    lines += ["$EndNodes", "$Elements", str(len(edge) + len(elements))]
    line, quadrilateral = "8 2 1 1", "16 2 2 2"
    for n, element in enumerate(edge + elements, 1):
        kind = line if n <= len(edge) else quadrilateral
        lines.append(f"{n} {kind} " + " ".join(map(str, element)))
    return "\n".join(lines + ["$EndElements", ""])


def inp(nodes, elements, edge, modes):
    lines = ["*NODE, NSET=ALL"] + [f"{n}, {x:.11e}, {y:.11e}, 0." for n, (x, y) in enumerate(nodes, 1)]
    lines.append("*ELEMENT, TYPE=S8R, ELSET=DISC")
    lines += [f"{n}, " + ", ".join(map(str, element)) for n, element in enumerate(elements, 1)]
    lines.append("*NSET, NSET=INNER")
    lines += [f"{n}," for n in sorted({n for three in edge for n in three})]
    lines += ["*MATERIAL, NAME=IRON", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{DENSITY}",
              "*SHELL SECTION, ELSET=DISC, MATERIAL=IRON", f"{THICKNESS}", "*BOUNDARY",
              "INNER, 1, 6", "*STEP", "*FREQUENCY", f"{modes}", "*END STEP", ""]
    return "\n".join(lines)


def cpu_s(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, env=run.ENVIRONMENT, capture_output=True, text=True,
                          check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}\n{done.stderr}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def by_calculix(folder, mesh, modes):
    (folder / "disc.inp").write_text(inp(*mesh, modes))
    seconds = cpu_s(["ccx", "disc"], folder)
    rows = [line.split() for line in (folder / "disc.dat").read_text().splitlines()]
    f_Hz = []
    for row in rows:  # the table of eigenvalues comes first: number, lambda, omega, f, imaginary part
        if len(row) == 5 and row[0] == str(len(f_Hz) + 1) and len(f_Hz) < modes:
            f_Hz.append(float(row[3]))
    return seconds, f_Hz


def by_chladni(folder, command, scene):
    (folder / "disc.toml").write_text(scene)
    seconds = cpu_s([str(run.CHLADNI), command, "disc.toml", "--output", "out", "--json",
                     "summary.json"], folder)
    return seconds, json.loads((folder / "summary.json").read_text())


def measure(folder, arguments, modes):
    mesh = polar_mesh(arguments.around, arguments.across)
    (folder / "disc.msh").write_text(msh(*mesh))
    middle = INNER + (OUTER - INNER) * round(0.766 * arguments.across) / arguments.across
    scene = SCENE.replace("RADIUS", f"{middle:.17g}")
    ccx_s, ccx_Hz = by_calculix(folder, mesh, modes)
    modes_s, found = by_chladni(folder, "modes", scene + CLAMPED.replace("COUNT", str(modes)))
    reduce_s, reduced = by_chladni(folder, "reduce", scene + REDUCED.replace("COUNT", str(modes)))
    difference = [abs(a / b - 1) for a, b in zip(ccx_Hz, found["frequencies_Hz"])]
    return {"modes": modes, "nodes": len(mesh[0]), "elements": len(mesh[1]),
            "chladni_dofs": found["n_dofs"], "masters": reduced["n_masters"], "ccx_cpu_s": ccx_s,
            "chladni_modes_cpu_s": modes_s, "chladni_reduce_cpu_s": reduce_s,
            "ccx_modes_found": len(ccx_Hz), "largest_difference": max(difference),
            "median_difference": sorted(difference)[len(difference) // 2]}


def table(result):
    lines = ["# Modes beside CalculiX", "",
             "A clamped disc on one mesh of 8-node quadrilaterals; CPU seconds of whole processes, one "
             "thread. The reduction has 366 masters beside the modes and estimates its errors. "
             "Written by `benchmarks/reduction/calculix.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}, "
             f"{result['ccx']}.", "",
             "| modes | elements | DOFs of Chladni | ccx, s | chladni modes, s | ratio | chladni "
             "reduce, s | ratio | frequencies differ by (median, most) |", "|---" * 9 + "|"]
    for r in result["runs"]:
        lines.append(
            f"| {r['modes']} | {r['elements']} | {r['chladni_dofs']} | {r['ccx_cpu_s']:.1f} | "
            f"{r['chladni_modes_cpu_s']:.1f} | {r['ccx_cpu_s'] / r['chladni_modes_cpu_s']:.1f} | "
            f"{r['chladni_reduce_cpu_s']:.1f} | {r['ccx_cpu_s'] / r['chladni_reduce_cpu_s']:.1f} | "
            f"{r['median_difference']:.1e}, {r['largest_difference']:.1e} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--modes", type=int, nargs="+", default=[50, 200])
    parser.add_argument("--around", type=int, default=120)
    parser.add_argument("--across", type=int, default=25)
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    if shutil.which("ccx") is None:
        raise SystemExit("ccx is not installed (Debian: calculix-ccx)")
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.strip()
    with tempfile.TemporaryDirectory() as name:
        runs = [measure(pathlib.Path(name), arguments, modes) for modes in arguments.modes]
    result = {"machine": run.machine(), "ccx": version.splitlines()[-1] if version else "ccx",
              "runs": runs}
    run.publish(arguments.output, "reduction_calculix", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
