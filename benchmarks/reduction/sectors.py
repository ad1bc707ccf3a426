#!/usr/bin/python3
"""What does a disc of N equal sectors cost from one of them, harmonic by harmonic?

usage: sectors.py [--counts 12 24 48 96] [--across 25] [--large 36 290] [--modes 40] OUTPUT

A clamped disc with N sectors of 4 x `across` quadrilaterals of order 2 each, in a mesh file of one sector and in one of
all. The reduction has a rigid hub and 6 harmonics of a ring of N nodes as masters, of a last, larger disc all of a ring
of 2 N nodes, all modes to 16 kHz, pictures and mass integrals. Then the modes of the disc with its hub held, from the same sector: by Chladni, by scipy (the complex Hermitian
matrices of each harmonic from Chladni's K and M, splu and eigsh), and by CalculiX's *CYCLIC SYMMETRY MODEL on solid
elements C3D20R, one over the thickness. Seconds and memory are those of whole processes with one thread.
Writes OUTPUT/sector_benchmarks.json and .md.
"""
import argparse
import json
import math
import pathlib
import shutil
import sys
import tempfile

import numpy as np

import calculix
import run

AROUND = 4  # elements in each sector
INNER, OUTER, THICKNESS = calculix.INNER, calculix.OUTER, calculix.THICKNESS

SCENE = f"""
name = "disc"
[mesh]
file = "disc.msh"
SECTORS
TRACK
[material.iron]
young = {calculix.YOUNG}
poisson = {calculix.POISSON}
density = {calculix.DENSITY}
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = {THICKNESS}
COUPLING
[interface]
nodes = [INTERFACE]
RINGS
[reduce]
method = "craig-bampton"
WANTED
"""
HUB = '[[coupling]]\ntype = "rigid"\nname = "hub"\ngroup = "inner"\n'
HELD = '[body]\nfixed = ["hub"]\n'


def radius(i, across):
    return INNER + (OUTER - INNER) * i / (2 * across)


def polar_mesh(count, n_made, across):
    """Nodes, 9-node elements and 3-node lines of the inner edge of the first n_made sectors of `count`, from 1."""
    columns = 2 * AROUND * n_made + (0 if n_made == count else 1)
    nodes = []
    for i in range(2 * across + 1):
        for j in range(columns):
            angle = 2 * math.pi * j / (2 * AROUND * count)
            nodes.append((radius(i, across) * math.cos(angle), radius(i, across) * math.sin(angle)))
    at = lambda i, j: 1 + i * columns + j % (2 * AROUND * count if n_made == count else columns)
    places = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    elements = [[at(2 * a + i, 2 * b + j) for i, j in places] for a in range(across) for b in range(AROUND * n_made)]
    edge = [[at(0, 2 * b), at(0, 2 * b + 2), at(0, 2 * b + 1)] for b in range(AROUND * n_made)]
    return nodes, elements, edge


def msh(nodes, elements, edge):
    return calculix.msh(nodes, elements, edge).replace(" 16 2 2 2 ", " 10 2 2 2 ")


def write_scene(folder, count, across, n_made, each=1, **words):
    (folder / "disc.msh").write_text(msh(*polar_mesh(count, n_made, across)))
    text = SCENE
    ring = 2 * round(0.766 * across)
    words = {"SECTORS": f"sectors = {count}" if n_made == 1 < count else "", "COUPLING": HUB,
             "TRACK": f'rings = [{{ name = "track", radius = {radius(ring, across):.17g}, nodes = {each * count} }}]',
             **words}
    for word, value in words.items():
        text = text.replace(word, value)
    (folder / "disc.toml").write_text(text)


def reduced(folder, ranks=1, options=()):
    launcher = ["mpirun", "--oversubscribe", "-n", ranks] if ranks > 1 else []
    done = run.timed([*launcher, run.CHLADNI, "reduce", "disc.toml", "--output", "out", "--json", "summary.json", *options],
                     folder)
    wall = {words[0]: float(words[1]) for words in map(str.split, done.pop("printed").splitlines())
            if len(words) == 3 and words[0] == "harmonics"}
    return done | wall, json.loads((folder / "summary.json").read_text())


def reduction(harmonics):
    """Of a scene; all harmonics of the ring without their number."""
    rings = f'rings = [{{ name = "track", harmonics = {harmonics} }}]' if harmonics else ""
    return {"INTERFACE": '"hub", "track"', "RINGS": rings, "WANTED": "cutoff_Hz = 16000.0\nsylvester = false\n" + HELD}


def growth(folder, count, across, harmonics=6, each=1):
    """One sector and the whole disc, with so many nodes of the ring in each sector."""
    words = reduction(harmonics)
    found = {"sectors": count, "harmonics": count // 2 + 1, "across": across}
    summaries = {}
    for name, n_made in (("one sector", 1), ("whole disc", count)):
        write_scene(folder, count, across, n_made, each, **words)
        usage, summaries[name] = reduced(folder)
        found[name] = {**usage, "phases_cpu_s": summaries[name]["phases_cpu_s"]}
    part, whole = (np.array(summaries[name]["certified_frequencies_Hz"]) for name in ("one sector", "whole disc"))
    n = min(len(part), len(whole))
    found |= {"dofs": summaries["whole disc"]["n_dofs"], "masters": summaries["whole disc"]["n_masters"],
              "modes": summaries["whole disc"]["n_modes"], "frequencies": n,
              "difference": float(np.max(np.abs(part[:n] / whole[:n] - 1)))}
    return found


def over_ranks(folder, count, across):
    """Seconds of the harmonics alone; CPU of all ranks together."""
    write_scene(folder, count, across, 1, **reduction(6))
    rows = []
    for ranks in (1, 2):
        usage, summary = reduced(folder, ranks)
        rows.append({"ranks": ranks, "harmonics_wall_s": usage.pop("harmonics"),
                     "harmonics_cpu_s": summary["phases_cpu_s"]["harmonics"], **usage})
    return {"sectors": count, "harmonics": count // 2 + 1, "runs": rows}


SCIPY = """
import sys
sys.path.insert(0, {here!r})
import sectors
sectors.by_harmonics({folder!r}, {count}, {across}, {modes})
"""


def by_harmonics(folder, count, across, modes):
    """The frequencies of all harmonics from K and M of the open sector, whose nodes stand as in the mesh file."""
    import scipy.sparse as sp
    import scipy.sparse.linalg as sla

    import peers
    K, M, _ = peers.load(folder)
    nodes, _, _ = polar_mesh(count, 1, across)
    x = np.array(nodes)
    spin = np.zeros(6 * len(x))  # of the numbering: a rigid turn about the axis costs nothing
    spin[0::6], spin[1::6], spin[5::6] = -x[:, 1], x[:, 0], 1.0
    assert np.abs(K @ spin).max() < 1e-6 * abs(K).max(), "the rows are not those of the mesh file's nodes"
    columns = 2 * AROUND + 1
    low, high = (np.arange(0, len(x), columns) + j for j in (0, columns - 1))
    angle = 2 * np.pi / count
    R = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    R = np.kron(np.eye(2), R)
    kept = np.setdiff1d(np.arange(columns, len(x)), high)  # the first row of nodes is held
    place = {node: 6 * k for k, node in enumerate(kept)}
    f_Hz = []
    for n in range(count // 2 + 1):
        T = sp.lil_matrix((6 * len(x), 6 * len(kept)), dtype=complex)
        for node, k in place.items():
            T[6 * node:6 * node + 6, k:k + 6] = np.eye(6)
        for a, b in zip(low, high):
            if a in place:
                T[6 * b:6 * b + 6, place[a]:place[a] + 6] = np.exp(2j * np.pi * n / count) * R
        T = T.tocsr()
        K_n, M_n = ((T.conj().T @ A @ T).tocsc() for A in (K, M))
        if n == 0 or 2 * n == count:
            K_n, M_n = K_n.real.copy(), M_n.real.copy()
        per_harmonic = 2 + 4 * modes // (count // 2 + 1)
        lam = sla.eigsh(K_n, k=per_harmonic, M=M_n, sigma=0.0, return_eigenvectors=False)
        f_Hz += list(np.sqrt(lam) / (2 * np.pi)) * (1 if n == 0 or 2 * n == count else 2)
    np.save(pathlib.Path(folder) / "scipy.npy", np.sort(f_Hz)[:modes])


def inp(count, across, per_diameter):
    """One sector of C3D20R, one element over the thickness, its inner edge held."""
    nodes, elements, edge = polar_mesh(count, 1, across)
    at = {}
    lines = ["*NODE, NSET=ALL"]
    for level, z in enumerate((-THICKNESS / 2, 0.0, THICKNESS / 2)):
        used = {n for e in elements for n in (e[:4] if level == 1 else e[:8])}
        for n in sorted(used):
            at[n, level] = len(at) + 1
            x, y = nodes[n - 1]
            lines.append(f"{at[n, level]}, {x:.11e}, {y:.11e}, {z:.11e}")
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=DISC")
    for k, e in enumerate(elements, 1):
        corners, middles = e[:4], e[4:8]
        row = [at[n, 0] for n in corners] + [at[n, 2] for n in corners] + [at[n, 0] for n in middles]
        row += [at[n, 2] for n in middles] + [at[n, 1] for n in corners]
        lines.append(f"{k}, " + ", ".join(map(str, row[:10])) + ",\n" + ", ".join(map(str, row[10:])))
    columns = 2 * AROUND + 1
    sets = {"INNER": {n for three in edge for n in three}, "LOW": {n for n in range(1, len(nodes) + 1) if (n - 1) % columns == 0},
            "HIGH": {n for n in range(1, len(nodes) + 1) if n % columns == 0}}
    for name, members in sets.items():
        held = sets["INNER"] if name != "INNER" else set()  # SPCs do not stand in ties
        lines.append(f"*NSET, NSET={name}")
        lines += [f"{tag}," for (n, _), tag in at.items() if n in members - held]
    for name in ("LOW", "HIGH"):
        lines += [f"*SURFACE, NAME=S{name}, TYPE=NODE", name]
    lines += ["*MATERIAL, NAME=IRON", "*ELASTIC", f"{calculix.YOUNG}, {calculix.POISSON}", "*DENSITY", f"{calculix.DENSITY}",
              "*SOLID SECTION, ELSET=DISC, MATERIAL=IRON", "*TIE, POSITION TOLERANCE=1e-6, CYCLIC SYMMETRY, NAME=CUT", "SHIGH, SLOW",
              f"*CYCLIC SYMMETRY MODEL, N={count}, TIE=CUT", "0., 0., 0., 0., 0., 1.", "*BOUNDARY", "INNER, 1, 3",
              "*STEP", "*FREQUENCY", f"{per_diameter}", f"*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX={count // 2}",
              "*END STEP", ""]
    return "\n".join(lines)


def by_calculix(folder, count, across, modes):
    """Each diameter's modes: ccx lists each eigenvalue twice, also those of 0 and N / 2, which are single."""
    (folder / "sector.inp").write_text(inp(count, across, 2 + 4 * modes // (count // 2 + 1)))
    usage = run.timed(["ccx", "sector"], folder)
    del usage["printed"]
    f_Hz = []
    for line in (folder / "sector.dat").read_text().splitlines():
        row = line.split()
        if len(row) != 6 or not (row[0].isdigit() and row[1].isdigit()):
            continue
        is_single = int(row[0]) in (0, count / 2)
        if not is_single or int(row[1]) % 2:
            f_Hz.append(float(row[4]))
    return usage, np.sort(f_Hz)[:modes]


def beside(folder, count, across, modes):
    """The modes of the disc with its hub held, by three programs from the same sector."""
    wanted = {"INTERFACE": '"hub"', "RINGS": "", "WANTED": f'modes = {modes}\npictures = "none"\nmass_integrals = false\n' + HELD}
    write_scene(folder, count, across, 1, **wanted)
    usage, summary = reduced(folder)
    ours = np.sort(summary["frequencies_Hz"])[:modes]
    # K and M of the open sector, as a body of its own.
    open_sector = {"COUPLING": "", "TRACK": "", "INTERFACE": '"inner"', "RINGS": "", "SECTORS": "", "WANTED": "modes = 1\npictures = \"none\"\n"}
    write_scene(folder, count, across, 1, **open_sector)
    files = [f"binary:{folder}/{file}.petsc" for file in ("K", "M", "masters")]
    reduced(folder, options=("--", "-cms_view_stiffness", files[0], "-cms_view_mass", files[1], "-cms_view_masters", files[2]))
    script = SCIPY.format(here=str(run.HERE), folder=str(folder), count=count, across=across, modes=modes)
    by_scipy = run.timed([sys.executable, "-c", script], folder)
    del by_scipy["printed"]
    theirs = np.load(folder / "scipy.npy")
    exact = run.exact_frequencies("annulus", modes), run.exact_frequencies("solid", modes)
    rows = {"chladni": {**usage, "difference_from_scipy": float(np.max(np.abs(ours / theirs - 1))),
                        "plate": run.errors_of(ours, exact[0])},
            "scipy": {**by_scipy, "plate": run.errors_of(theirs, exact[0])}}
    if shutil.which("ccx"):
        of_ccx, f_Hz = by_calculix(folder, count, across, modes)
        rows["ccx"] = {**of_ccx, "found": len(f_Hz), "solid": run.errors_of(f_Hz, exact[1])}
    return {"sectors": count, "modes": modes, "programs": rows}


def table(result):
    lines = ["# One sector of a disc", "",
             "A clamped disc of N sectors of 4 elements around and "
             f"{result['across']} across, order 2; wall and CPU seconds and peak memory of whole processes, one thread. Written by "
             "`benchmarks/reduction/sectors.py`.", "",
             f"{result['machine']['processor']}, commit {result['machine']['commit']}.", "",
             "## Growth with the number of sectors", "",
             "Craig-Bampton to 16 kHz with a rigid hub and 6 harmonics of a ring of N nodes as masters, pictures and mass integrals included. The last disc is "
             f"larger, with {result['growth'][-1]['across']} elements across and all harmonics of a ring of 2 N nodes. The certified "
             "frequencies are compared with those of the whole disc.", "",
             "| sectors | DOFs of the whole | masters | modes | CPU of a harmonic, s | one sector: CPU, s | peak, MiB | whole disc: CPU, s | peak, MiB | "
             "CPU, ratio | memory, ratio | frequencies equal to |", "|---" * 12 + "|"]
    for r in result["growth"]:
        part, whole = r["one sector"], r["whole disc"]
        lines.append(f"| {r['sectors']} | {r['dofs']} | {r['masters']} | {r['modes']} | {part['phases_cpu_s']['harmonics'] / r['harmonics']:.3f} | "
                     f"{part['cpu_s']:.2f} | {part['peak_MiB']:.0f} | {whole['cpu_s']:.2f} | {whole['peak_MiB']:.0f} | "
                     f"{whole['cpu_s'] / part['cpu_s']:.1f} | {whole['peak_MiB'] / part['peak_MiB']:.1f} | {r['difference']:.0e} |")
    ranks = result["ranks"]
    one, two = ranks["runs"]
    lines += ["", "## Harmonics over ranks", "",
              f"{ranks['harmonics']} harmonics of {ranks['sectors']} sectors: {one['harmonics_wall_s']:.2f} s on one rank, "
              f"{two['harmonics_wall_s']:.2f} s on two, of {result['machine']['cores']} cores whose load was {result['load_before']:.1f} before. "
              f"CPU of both ranks together over that of one: {two['harmonics_cpu_s'] / one['harmonics_cpu_s']:.2f}; 1 is work that is shared without loss.", "",
              "## The same sector by other programs", "",
              f"The lowest {result['beside']['modes']} modes of the disc of {result['beside']['sectors']} sectors with its hub held. scipy has Chladni's matrices of the open sector: the complex "
              "Hermitian matrices of each harmonic, `splu` and `eigsh` as its documentation says. ccx has `*CYCLIC SYMMETRY MODEL` and solid elements, one over "
              "the thickness. Errors are those of the frequencies by their place: against the exact Mindlin plate, of ccx against the elastic solid.", "",
              "| program | wall, s | CPU, s | peak, MiB | error (median, largest) |", "|---|---|---|---|---|"]
    for name, p in result["beside"]["programs"].items():
        error = calculix.both(p["plate"] if "plate" in p else p["solid"])
        lines.append(f"| {name} | {p['wall_s']:.2f} | {p['cpu_s']:.2f} | {p['peak_MiB']:.0f} | {error} |")
    lines += ["", f"Chladni and scipy agree to {result['beside']['programs']['chladni']['difference_from_scipy']:.0e}."]
    return "\n".join(lines) + "\n"


def main():
    import os
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--counts", type=int, nargs="+", default=[12, 24, 48, 96])
    parser.add_argument("--across", type=int, default=25)
    parser.add_argument("--large", type=int, nargs=2, default=[36, 290], help="sectors and elements across of the last disc")
    parser.add_argument("--modes", type=int, default=40)
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        result = {"machine": run.machine(), "across": arguments.across, "load_before": load,
                  "growth": [*(growth(folder, count, arguments.across) for count in arguments.counts),
                             growth(folder, *arguments.large, harmonics=None, each=2)],
                  "ranks": over_ranks(folder, arguments.counts[-1], arguments.across),
                  "beside": beside(folder, arguments.counts[min(1, len(arguments.counts) - 1)], arguments.across, arguments.modes)}
    run.publish(arguments.output, "sector_benchmarks", result, table(result))
    print(table(result))


if __name__ == "__main__":
    main()
