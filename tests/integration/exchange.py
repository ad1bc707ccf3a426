"""A plate from a universal file or a MED file has the frequencies of the same mesh from Gmsh's format, and bad files end in a
sentence.

Usage: exchange.py PROGRAM_DIR
"""

import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from plate_files import N_Y, frequencies, gmsh_file, grid, number, scene
from running import run, start, summary

STEP_OF_MED = "-0000000000000000001-0000000000000000001"


def parts(order):
    """Nodes, and elements by kind with their group: corners first, then the middles of the edges."""
    nodes, quads, triangles = grid(order)
    edge = [[number(0, j), number(0, j + 2)] + ([number(0, j + 1)] if order == 2 else []) for j in range(0, 2 * N_Y, 2)]
    return nodes, [("line", edge, "root"), ("triangle", triangles, "plate"), ("quad", quads, "plate")]


def around(kind, nodes):
    """In the order of universal files."""
    n = {"line": 2, "triangle": 3, "quad": 4}[kind]
    if len(nodes) == n:
        return nodes
    if kind == "line":
        return [nodes[0], nodes[2], nodes[1]]
    return [node for pair in zip(nodes[:n], nodes[n:], strict=True) for node in pair]


def tens(numbers):
    rows = [numbers[at : at + 8] for at in range(0, len(numbers), 8)]
    return ["".join(f"{n:10}" for n in row) for row in rows]


def universal_file(order):
    nodes, kinds = parts(order)
    lines = ["    -1", "   164", "         1  SI: Meter (newton)         2",
             "  1.0000000000000000D+03  1.0000000000000000D+00  1.0000000000000000D+00", "  2.7314999999999998D+02",
             "    -1", "    -1", "  2411"]  # fmt: skip
    for n, x, y in nodes:
        lines += [f"{n:10}         1         1        11", f"  {x:.16E}  {y:.16E}  0.0D+00".replace("E", "D")]
    lines += ["    -1", "    -1", "  2412"]
    descriptors = {"line": (21, 24), "triangle": (91, 92), "quad": (94, 95)}
    members, label = {"plate": [], "root": []}, 0
    for kind, elements, group in kinds:
        for element in elements:
            label += 1
            members[group].append(label)
            lines += tens([label, descriptors[kind][order - 1], 1, 1, 7, len(element)])
            lines += ["         0         1         1"] * (kind == "line") + tens(around(kind, element))
    lines += ["    -1", "    -1", "  2467"]
    for k, (group, labels) in enumerate(members.items(), 1):
        lines += tens([k, 0, 0, 0, 0, 0, 0, len(labels)]) + [group]
        lines += tens([value for label in labels for value in (8, label, 0, 0)])
    return "\n".join([*lines, "    -1", ""])


def med_file(path, order, change=lambda file: None):
    nodes, kinds = parts(order)
    place = {n: k for k, (n, _, _) in enumerate(nodes, 1)}
    with h5py.File(path, "w") as file:
        file.create_group("INFOS_GENERALES").attrs.update({"MAJ": 4, "MIN": 1, "REL": 0})
        mesh = file.create_group("ENS_MAA/Mesh_1")
        mesh.attrs.update({"DIM": 2, "ESP": 3, "REP": 0, "TYP": 0})
        step = mesh.create_group(STEP_OF_MED)
        x = np.array([(a, b, 0.0) for _, a, b in nodes])
        step.create_dataset("NOE/COO", data=x.flatten(order="F"))
        step.create_dataset("NOE/NUM", data=np.array([n for n, _, _ in nodes], dtype=np.int32))
        types = {"line": ("SE2", "SE3"), "triangle": ("TR3", "TR6"), "quad": ("QU4", "QU8")}
        for kind, elements, group in kinds:
            of_type = step.create_group(f"MAI/{types[kind][order - 1]}")
            connectivity = np.array([[place[n] for n in element] for element in elements], dtype=np.int32)
            of_type.create_dataset("NOD", data=connectivity.flatten(order="F"))
            of_type.create_dataset("FAM", data=np.full(len(elements), -1 if group == "plate" else -2, dtype=np.int32))
        file.create_group("FAS/Mesh_1/FAMILLE_ZERO").attrs["NUM"] = 0
        for k, group in enumerate(("plate", "root"), 1):
            family = file.create_group(f"FAS/Mesh_1/ELEME/FAM_{-k}_{group}")
            family.attrs["NUM"] = -k
            name = np.frombuffer(group.encode().ljust(80, b"\0"), dtype=np.int8)
            kind = np.dtype((np.int8, (80,)))
            family.create_dataset("GRO/NOM", shape=(1,), dtype=kind)[0] = name
        change(file)


def compared(chladni, folder, name, expected):
    path = folder / f"{name.replace('.', '_')}.toml"
    path.write_text(scene(name, "plate", "root"))
    for f, g in zip(frequencies(chladni, path), expected, strict=True):
        if abs(f - g) > 1e-9 * g:  # the order of sums differs
            yield f"{name}: {f} Hz instead of {g} Hz"


def of_order(chladni, folder, order):
    (folder / "plate.msh").write_text(gmsh_file(order))
    (folder / "msh.toml").write_text(scene("plate.msh", "plate", "root"))
    expected = frequencies(chladni, folder / "msh.toml")
    (folder / f"{order}.unv").write_text(universal_file(order))
    med_file(folder / f"{order}.med", order)
    for name in (f"{order}.unv", f"{order}.med"):
        yield from compared(chladni, folder, name, expected)


def units_are_asked_for(chladni, folder):
    for name in ("1.unv", "1.med"):
        done = start(chladni, "mesh", folder / name)
        if done.returncode == 0 or "--length-unit" not in done.stderr:
            yield f"{name}: the unit is not asked for: {done.stderr}"
        width = summary(chladni, "mesh", folder / name, "--length-unit", "mm", "--output", folder / f"mm_{name[2:5]}")
        if not width:
            yield f"{name}: nothing is told of it"
        (folder / "no_unit.toml").write_text(scene(name, "plate", "root").replace('length_unit = "mm"', ""))
        done = start(chladni, "mesh", folder / "no_unit.toml")
        if done.returncode != 1 or "length_unit" not in done.stderr:
            yield f"{name}: a scene without a unit: {done.stderr}"


def only_decks_are_imported(chladni, folder):
    done = start(chladni, "import", folder / "1.unv", "--length-unit", "mm")
    if done.returncode != 1 or "other mesh files have no sections" not in done.stderr:
        yield f"import of a .unv: {done.stderr}"


def bad_med_files_are_refused(chladni, folder):
    step = f"ENS_MAA/Mesh_1/{STEP_OF_MED}"

    def renamed(file):
        file.move(f"{step}/MAI/QU4", f"{step}/MAI/PY5")

    def filled(name, value):
        def change(file):
            file[name][0] = value

        return change

    def set_attribute(name, attribute, value):
        def change(file):
            file[name].attrs[attribute] = value

        return change

    def linked(file):
        del file[f"{step}/NOE/COO"]
        file[f"{step}/NOE/COO"] = h5py.ExternalLink("other.med", "x")

    def removed(name):
        def change(file):
            del file[name]

        return change

    def shortened(file):
        del file[f"{step}/MAI/QU4/FAM"]
        file[f"{step}/MAI/QU4/FAM"] = np.zeros(3, dtype=np.int32)

    def as_real(file):
        del file[f"{step}/MAI/QU4/NOD"]
        file[f"{step}/MAI/QU4/NOD"] = np.ones(80)

    def claimed(file):  # and never written: nothing of it is stored
        del file[f"{step}/NOE/NUM"]
        file.create_dataset(f"{step}/NOE/NUM", shape=(2**31 - 1,), dtype=np.int32)

    cases = {
        "more values than there are": (claimed, ("NOE/NUM", "claims more values than the file can hold")),
        "pyramids": (renamed, ("PY5", "a solid that Chladni does not have")),
        "polygons": (lambda file: file.create_group(f"{step}/MAI/POG"), ("POG", "not known")),
        "no such node": (filled(f"{step}/MAI/QU4/NOD", 9999), ("QU4/NOD", "no node 9999")),
        "no such family": (filled(f"{step}/MAI/QU4/FAM", -9), ("no family -9",)),
        "not finite": (filled(f"{step}/NOE/COO", np.nan), ("COO", "no finite number")),
        "number twice": (filled(f"{step}/NOE/NUM", 3), ("NOE/NUM",)),
        "version 2": (set_attribute("INFOS_GENERALES", "MAJ", 2), ("version 2", "medimport")),
        "structured": (set_attribute("ENS_MAA/Mesh_1", "TYP", 1), ("structured",)),
        "cylindrical": (set_attribute("ENS_MAA/Mesh_1", "REP", 1), ("Cartesian",)),
        "flat": (set_attribute("ENS_MAA/Mesh_1", "ESP", 1), ("1 dimensions",)),
        "two meshes": (lambda file: file.create_group("ENS_MAA/Mesh_2"), ("2 meshes", "Mesh_1, Mesh_2")),
        "two states": (lambda file: file.create_group("ENS_MAA/Mesh_1/later"), ("2 states",)),
        "no version": (removed("INFOS_GENERALES"), ("no MED file",)),
        "no coordinates": (removed(f"{step}/NOE/COO"), ("COO", "no such dataset")),
        "another file": (linked, ("other.med",)),
        "too few families": (shortened, ("FAM", "3 values")),
        "real numbers": (as_real, ("NOD", "whole numbers")),
    }
    for name, (change, words) in cases.items():
        med_file(folder / "bad.med", 1, change)
        done = start(chladni, "mesh", folder / "bad.med", "--length-unit", "mm", "--output", folder)
        if done.returncode != 1 or any(word not in done.stderr for word in ("bad.med", *words)):
            yield f"MED, {name}: {done.returncode}, {done.stderr}"
    whole = (folder / "1.med").read_bytes()
    (folder / "bad.med").write_bytes(whole[: len(whole) // 2])
    done = start(chladni, "mesh", folder / "bad.med", "--length-unit", "mm", "--output", folder)
    if done.returncode != 1 or "bad.med" not in done.stderr:
        yield f"MED cut off: {done.stderr}"


def main(programs):
    chladni = Path(programs) / "chladni"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        failures = [*of_order(chladni, folder, 1), *of_order(chladni, folder, 2),
                    *units_are_asked_for(chladni, folder), *only_decks_are_imported(chladni, folder),
                    *bad_med_files_are_refused(chladni, folder)]  # fmt: skip
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
