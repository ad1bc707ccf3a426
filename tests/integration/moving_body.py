"""Bodies that move: mass integrals against theory, files for other programs, section forces of shells, interface modes of
the whole model, checks.

Usage: moving_body.py PROGRAM_DIR SOURCE_DIR
"""

import json
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from running import run

failures = []


def expect(claim, value, limit):
    """Prints and remembers whether |value| <= limit."""
    good = abs(value) <= limit
    print(f"{'ok    ' if good else 'FAILED'} {claim}: {value:.3g} (limit {limit:g})")
    if not good:
        failures.append(claim)


def make(programs, folder, text):
    """Runs a scene; returns the stem of its files."""
    folder.mkdir()
    (folder / "scene.toml").write_text(text)
    run(programs / "chladni", "run", folder / "scene.toml", "--output", folder)
    return next(folder.glob("*.reduced.h5")).name.removesuffix(".reduced.h5")


def product(file, axes):
    return file[f"mass_integrals/displacement_{axes}"][:]


def coriolis(folder, name):
    """The Coriolis coupling of the pair with three nodal diameters."""
    with h5py.File(folder / f"{name}.body.h5") as file:
        W = file["rings/track/displacement_cosine"][:] ** 2 + file["rings/track/displacement_sine"][:] ** 2
        f_Hz = file["modes/frequencies"][:] / (2 * np.pi)
        pair = [i for i in range(f_Hz.size) if W[:, i].argmax() == 3 and W[:, i].max() > 1e-3][:2]
        S = product(file, "xy")
        M = sum(product(file, axes) for axes in ("xx", "yy", "zz"))
        G = 2 * (S.T - S)
        expect("S_xx + S_yy + S_zz of modes is 1", np.abs(M - np.eye(f_Hz.size)).max(), 1e-9)
        # SQUEAL.md 2.2: the Coriolis forces of the rotary inertia take 0.766 % from the coupling 2 n Omega m.
        share = abs(G[pair[0], pair[1]]) / (2 * 3)
        expect("Coriolis share of the pair with 3 diameters against 0.766 %", share / 0.00766 - 1, 0.02)
        expect("and none within a mode", G[pair[0], pair[0]], 1e-12)


def value_of(item):
    """As Exudyn's LoadDictFromHDF5 takes an object, which says its type as text."""
    kind = item.attrs["datatype"]
    assert isinstance(kind, str), "bytes would not compare equal to 'dict'"
    if kind == "dict":
        return {key: value_of(entry) for key, entry in item.items()}
    if kind == "list":
        return [value_of(item[f"item_{i}"]) for i in range(len(item))]
    if kind == "str":
        return item[()].decode("utf-8")
    return {"int": int, "float64": float, "ndarray": np.array}[kind](item[()])


def exports(programs, folder, name):
    scene = folder / "scene.toml"
    json_file = folder / "export.json"
    run(programs / "chladni", "export", scene, "--from", folder, "--format", "exudyn",
        "--output", folder / "a.exudyn.hdf5", "--json", json_file)
    with h5py.File(folder / "a.exudyn.hdf5") as file:
        cms = {key: value_of(item) for key, item in file.items()}
    n_modes, n_nodes = cms["infoList"][:2]
    expect("Exudyn: rows of the shapes", cms["modeBasis"].shape[0] - 3 * n_nodes, 0)
    expect("Exudyn: columns", cms["mPsiTildePsiTilde"].shape[1] - 3 * n_modes, 0)
    expect("Exudyn: triangles", cms["trigList"].max() - (n_nodes - 1), 0)
    with h5py.File(folder / f"{name}.body.h5") as file:
        omega = file["modes/frequencies"][:]
        expect("Exudyn: stiffness", np.abs(np.diag(cms["stiffnessMatrixReduced"]) / omega**2 - 1).max(), 1e-9)
        expect("Exudyn: mass", cms["totalMass"] / file["rigid_body/mass"][()] - 1, 1e-10)
        J = file["rigid_body/inertia"][:]
        c = file["rigid_body/centre_of_mass"][:]
        expect("Exudyn: inertia", np.abs(cms["inertiaLocal"] - J).max() / J.max() + np.abs(c).max(), 1e-9)
    expect("export says what it wrote", len(json.loads(json_file.read_text())["files"]) - 1, 0)
    for dialect in ("simpack", "welib"):
        run(programs / "chladni", "export", scene, "--from", folder, "--format", "sid", "--sid-dialect", dialect,
            "--output", folder / f"{dialect}.SID_FEM")
    lines = (folder / "simpack.SID_FEM").read_text().splitlines()
    expect("SID_FEM: modes", int(lines[0].split()[1]) - n_modes, 0)
    expect("SID_FEM: the last line ends the part", int(lines[-1].strip() != "end part"), 0)


def picture(folder, name):
    """The body opens as a file of VTK; with VTK's own reader where that is installed."""
    with h5py.File(folder / f"{name}.body.h5") as file:
        shapes = file["picture/displacements"][:]
        fields = file["VTKHDF/PointData"]
        expect("as many fields as modes", len(fields) - shapes.shape[1], 0)
        error = max(np.abs(field[:].ravel() - shape).max() for field, shape in zip(fields.values(), shapes.T))
        expect("each of which is its mode", error, 0)
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOHDF import vtkHDFReader
    except ImportError:
        print("no VTK here (package python3-vtk9): its reader is not asked")
        return
    reader = vtkHDFReader()
    reader.SetFileName(str(folder / f"{name}.body.h5"))
    reader.Update()
    grid = reader.GetOutput()
    expect("VTK: points", 3 * grid.GetNumberOfPoints() - len(shapes), 0)
    expect("VTK: quadrilaterals", int(grid.GetCellType(0) != 9), 0)
    data = grid.GetPointData()
    expect("VTK: fields", data.GetNumberOfArrays() - shapes.shape[1], 0)
    read = [vtk_to_numpy(data.GetArray(j)).ravel() for j in range(shapes.shape[1])]
    expect("VTK: values", max(np.abs(a - b).max() for a, b in zip(read, shapes.T)), 0)


def checks(programs, folder, name):
    for kind in ("reduced", "body"):
        run(programs / "chladni", "check", folder / f"{name}.{kind}.h5", "--json", folder / "check.json")
        found = json.loads((folder / "check.json").read_text())
        expect(f"check of {name}.{kind}.h5", int(found["verdict"] == "FAIL"), 0)
        names = [check["check"] for check in found["checks"]]
        expect("which looks at the mass integrals", names.count("mass integrals") - 1, 0)


STRIP = (Path(__file__).parents[1] / "data/strip.toml").read_text()


def static_forces(file, load):
    """Section forces of the reduced model held at its first node, loaded at its second one: {kind: [n_points]}."""
    K = file["matrices/stiffness"][:]
    u = np.zeros(K.shape[0])
    free = np.arange(6, K.shape[0])
    u[free] = np.linalg.solve(K[np.ix_(free, free)], load[free])
    kinds = list(file["resultants/plate/kinds"].asstr()[:])
    forces = (file["resultants/plate/modes"][:] @ u).reshape(-1, len(kinds))
    return dict(zip(kinds, forces.T))


def shells(programs, folder):
    """A strip of 0.1 m between rigid edges: forces of its whole width are those of a beam."""
    name = make(programs, folder, STRIP)
    checks(programs, folder, name)
    picture(folder, name)
    with h5py.File(folder / f"{name}.reduced.h5") as file:
        x = file["resultants/plate/positions"][:]
        expect("points stand on the mid-surface", np.abs(x[:, 2] - 0.03).max(), 1e-12)
        load = np.zeros(file["matrices/mass"].shape[0])
        load[6 + 4] = 1.0  # moment about y at R: tension on the side of e_z
        forces = static_forces(file, load)
        expect("M_x of a moment of 1 N m over 0.1 m", np.abs(forces["M_x"] / 10.0 - 1).max(), 1e-6)
        expect("and no shear", np.abs(forces["Q_x"]).max(), 1e-5)
        load[:] = 0.0
        load[6 + 2] = 1.0  # force along z at R
        forces = static_forces(file, load)
        expect("Q_x of 1 N over 0.1 m", np.abs(forces["Q_x"] / 10.0 - 1).max(), 1e-4)
        expect("M_x falls to the end", np.abs(forces["M_x"] - 10.0 * (x[:, 0] - 0.4)).max() / 4.0, 1e-4)
        load[:] = 0.0
        load[6] = 1.0
        load[6 + 4] = 0.03  # along the mid-surface
        forces = static_forces(file, load)
        expect("N_x of 1 N over 0.1 m", np.abs(forces["N_x"] / 10.0 - 1).max(), 1e-6)
    (folder / "scene.toml").write_text(STRIP.replace('["plate"]', '["plate"]\nresultant_elements = [99999]'))
    message = run(programs / "chladni", "reduce", folder / "scene.toml", "--output", folder, code=1)
    expect("an element that is not there is named", int("none of reduce.resultant_elements" not in message), 0)


def receptance(folder, name, load, Omega):
    """Of the body: all attachment displacements for a unit load at a row of them."""
    with h5py.File(folder / f"{name}.body.h5") as file:
        X, omega = file["modes/attachment_displacements"][:], file["modes/frequencies"][:]
    return X @ (X[load] / (omega**2 - Omega**2))


def full_space(programs, folder, source):
    """Three fixed-interface modes and one response of the whole model against a hundred of these modes."""
    text = (source / "examples/beam/cantilever.toml").read_text()
    Omega = 40.0  # beyond the second frequency, 22.03
    start = text.index("[body]")
    body = f"""[body]
fixed = ["A"]
keep = {{ modes = 3 }}
interface_modes = [{{ kind = "frm", at = "B", dofs = ["ry"], omega0 = {Omega}, space = "SPACE" }}]
"""
    # A body of all modes of a reduction with many modes, as the FE model.
    exact = make(programs, folder / "exact", text[:start] + '[body]\nfixed = ["A"]\nkeep = { up_to_Hz = 1e9 }\n')
    row = 6 + 4  # B.ry
    reference = receptance(folder / "exact", exact, row, Omega)
    error = {}
    for space in ("reduced", "full"):
        few = text[:start].replace("modes = 100", "modes = 3")
        name = make(programs, folder / space, few + body.replace("SPACE", space))
        found = receptance(folder / space, name, row, Omega)
        error[space] = np.linalg.norm(found - reference) / np.linalg.norm(reference)
        checks(programs, folder / space, name)
    expect("response at omega0 of a body made of the whole model", error["full"], 1e-6)
    expect("which the reduced space alone does not reach", 1e-4 / error["reduced"], 1.0)


def main(programs, source):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        disc = (source / "tests/data/coarse_disc.toml").read_text()
        stem = make(programs, folder / "disc", disc)
        coriolis(folder / "disc", stem)
        exports(programs, folder / "disc", stem)
        checks(programs, folder / "disc", stem)
        shells(programs, folder / "strip")
        (folder / "beam").mkdir()
        full_space(programs, folder / "beam", source)
    if failures:
        sys.exit(f"FAILED: {', '.join(failures)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
