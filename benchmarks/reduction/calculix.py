#!/usr/bin/python3
"""The modes of one clamped disc by CalculiX and by Chladni, on the same mesh of 8-node shells.

usage: calculix.py [--modes 50 200] [--around 120] [--across 25] OUTPUT

CalculiX (Debian: calculix-ccx) expands its S8R shells into solid elements and solves by ARPACK with
SPOOLES; Chladni completes the quadrilaterals by a node in the middle. Seconds and memory are those of whole
processes with one thread: `chladni modes`, and `chladni reduce` to 366 masters with as many
fixed-interface modes and its certificate. Errors are against the exact plate and the exact solid.
Writes OUTPUT/reduction_calculix.json and .md.
"""
import argparse
import json
import math
import pathlib
import shutil
import subprocess
import tempfile

import run

INNER, OUTER, THICKNESS = 0.025, 0.162, 0.02
YOUNG, POISSON, DENSITY = 9.15915e10, 0.3, 6300.0

IRON = f"""
[material.iron]
young = {YOUNG}
poisson = {POISSON}
density = {DENSITY}
[[section]]
material = "iron"
"""
IRON_OF_CALCULIX = ["*MATERIAL, NAME=IRON", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{DENSITY}"]
SCENE = f"""
name = "disc"
[mesh]
file = "disc.msh"
rings = [{{ name = "track", radius = RADIUS, nodes = 60 }}]
{IRON}group = "disc"
type = "shell"
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
    lines += [*IRON_OF_CALCULIX, "*SHELL SECTION, ELSET=DISC, MATERIAL=IRON", f"{THICKNESS}", "*BOUNDARY",
              "INNER, 1, 6", "*STEP", "*FREQUENCY", f"{modes}", "*END STEP", ""]
    return "\n".join(lines)


def by_calculix(folder, text, modes, most_s=None):
    """Of the file disc.inp with this text; None for the frequencies of a run that took `most_s` of CPU time."""
    (folder / "disc.inp").write_text(text)
    usage = run.timed(["ccx", "disc"], folder, most_s)
    if usage.get("stopped"):
        return {**usage, "f_Hz": None}
    f_Hz = []
    for line in (folder / "disc.dat").read_text().splitlines():
        row = line.split()  # the table of eigenvalues comes first: number, lambda, omega, f, imaginary part
        if len(row) == 5 and row[0] == str(len(f_Hz) + 1) and len(f_Hz) < modes:
            f_Hz.append(float(row[3]))
    return {**usage, "f_Hz": f_Hz}


def version():
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.strip()
    return said.splitlines()[-1].replace("This is Version", "CalculiX") if said else "CalculiX"


def by_chladni(folder, command, scene):
    (folder / "disc.toml").write_text(scene)
    usage = run.timed([run.CHLADNI, command, "disc.toml", "--output", "out", "--json", "summary.json"], folder)
    summary = json.loads((folder / "summary.json").read_text())
    f_Hz = summary["frequencies_Hz"]
    if command == "reduce":  # lambda below half of the last fixed-interface one: what the reduction is meant for
        f_Hz = [f for f in summary["certified_frequencies_Hz"] if f * f < 0.5 * f_Hz[-1] ** 2]
    return {**usage, "dofs": summary["n_dofs"], "masters": summary.get("n_masters"), "f_Hz": f_Hz}


def measure(folder, arguments, modes, exact):
    mesh = polar_mesh(arguments.around, arguments.across)
    (folder / "disc.msh").write_text(msh(*mesh))
    middle = INNER + (OUTER - INNER) * round(0.766 * arguments.across) / arguments.across
    scene = SCENE.replace("RADIUS", f"{middle:.17g}")
    runs = {"ccx": by_calculix(folder, inp(*mesh, modes), modes),
            "chladni modes": by_chladni(folder, "modes", scene + CLAMPED.replace("COUNT", str(modes))),
            "chladni reduce": by_chladni(folder, "reduce", scene + REDUCED.replace("COUNT", str(modes)))}
    for program in runs.values():
        del program["printed"]
        f_Hz = program.pop("f_Hz")[:modes]
        program.update(found=len(f_Hz), **{theory: run.errors_of(f_Hz, f) for theory, f in exact.items()})
    return {"modes": modes, "elements": len(mesh[1]), "highest_Hz": float(exact["plate"][modes - 1]), "programs": runs,
            "plate_from_solid": run.errors_of(exact["plate"][:modes], exact["solid"])}


def table(result):
    lines = ["# Modes beside CalculiX", "",
             "A clamped disc of 20 mm on one mesh of 8-node quadrilaterals; wall and CPU seconds and peak memory of whole "
             "processes, one thread. The reduction has 366 masters beside the modes and estimates its errors. Written by "
             "`benchmarks/reduction/calculix.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}, {result['ccx']}.", "",
             "Errors are those of the frequencies by their place in the order, relative, against the exact solutions of three theories: the "
             "Reissner-Mindlin plate with plane stress and the shear correction 5/6, which Chladni's elements approximate; "
             "the same plate without the correction; and the elastic solid. ccx makes one layer of solid elements of S8R, "
             "quadratic over the thickness: in bending their shear is constant over it, as without the correction. The plate differs from the solid by " +
             "; ".join(f"{both(r['plate_from_solid'])} over {r['modes']} modes" for r in result["runs"]) + " (median, largest): no plate is nearer to the solid than that.", "",
             "Frequencies of the reduction are compared up to lambda half of that of its last fixed-interface mode.", "",
             "| modes | elements | up to, Hz | program | wall, s | CPU, s | CPU over that of chladni modes | peak, MiB | "
             "frequencies compared | error against the plate (median, largest) | against the plate without shear "
             "correction | against the solid |", "|---" * 12 + "|"]
    for r in result["runs"]:
        base = r["programs"]["chladni modes"]["cpu_s"]
        for name, p in r["programs"].items():
            lines.append(f"| {r['modes']} | {r['elements']} | {r['highest_Hz']:.0f} | {name} | {p['wall_s']:.1f} | {p['cpu_s']:.1f} | "
                         f"{p['cpu_s'] / base:.1f} | {p['peak_MiB']:.0f} | {p['found']} | {both(p['plate'])} | "
                         f"{both(p['plate_kappa_1'])} | {both(p['solid'])} |")
    return "\n".join(lines) + "\n"


def both(error):
    return f"{error['median']:.1e}, {error['largest']:.1e}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--modes", type=int, nargs="+", default=[50, 200])
    parser.add_argument("--around", type=int, default=120)
    parser.add_argument("--across", type=int, default=25)
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    if shutil.which("ccx") is None:
        raise SystemExit("ccx is not installed (Debian: calculix-ccx)")
    most = max(arguments.modes)
    exact = {"plate": run.exact_frequencies("annulus", most), "solid": run.exact_frequencies("solid", most),
             "plate_kappa_1": run.exact_frequencies("annulus", most, kappa=1.0)}
    with tempfile.TemporaryDirectory() as name:
        runs = [measure(pathlib.Path(name), arguments, modes, exact) for modes in arguments.modes]
    result = {"machine": run.machine(), "ccx": version(), "runs": runs}
    run.publish(arguments.output, "reduction_calculix", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
