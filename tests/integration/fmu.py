"""A body as FMU of both versions, by an importer of our own: its description keeps the rules of the standard, the model that it
exchanges has the receptances of the body, and its co-simulation the body's motion in time.

Usage: fmu.py PROGRAM_DIR
"""

import ctypes
import re
import sys
import tempfile
import zipfile
from pathlib import Path

import h5py
import numpy as np
from fmi_importer import Fmu, description_rules, needs_nothing
from running import changed, run, start
from scipy.integrate import solve_ivp
from scipy.linalg import expm

ROOT = Path(__file__).resolve().parents[2]


class Body:
    """What the body file says: q'' + C q' + omega^2 q = Phi^T F."""

    def __init__(self, file, fmu):
        with h5py.File(file) as body:
            self.omega = body["modes/frequencies"][:]
            n = self.omega.size
            self.C = body["modes/damping"][:] if "damping" in body["modes"] else np.zeros((n, n))
            modes = body["modes/attachment_displacements"][:].reshape(-1, 6, n)
            sets = {name: body[f"attachment/sets/{name}"][:] for name in body["attachment/sets"]}
        self.inputs = fmu.names(r".*\.[FM]_[xyz]")
        rows = []
        for name in self.inputs:
            node, symbol, axis = re.fullmatch(r"(.*)\.([FM])_([xyz])", name).groups()
            index = re.fullmatch(r"(\w+)(?:\[(\d+)\])?", node)
            place = sets[index[1]][int(index[2] or 1) - 1]
            rows.append(modes[place, "xyz".index(axis) + 3 * (symbol == "M")])
        self.Phi = np.array(rows)
        self.outputs = [[re.sub(r"\.([FM])_", lambda m: f".{symbols[m[1]]}_", name) for name in self.inputs]
                        for symbols in ({"F": "u", "M": "theta"}, {"F": "v", "M": "omega"}, {"F": "a", "M": "alpha"})]  # fmt: skip

    def matrices(self):
        n = self.omega.size
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(self.omega**2), -self.C]])
        return A, np.vstack([np.zeros_like(self.Phi.T), self.Phi.T])


def dependencies_are_true(fmu, version):
    """What is not listed must not be depended upon."""
    states, inputs = fmu.states(), fmu.names(r".*\.[FM]_[xyz]")
    structure = fmu.model.find("ModelStructure")
    unknowns = structure.findall("Output") if version == 3 else structure.find("Outputs")
    for unknown in list(unknowns)[:: max(1, len(unknowns) // 12)]:
        place = int(unknown.get("valueReference" if version == 3 else "index")) - (version == 2)
        name = fmu.variables[place].get("name")
        if unknown.get("dependencies") is None:
            continue
        known = {fmu.variables[int(word) - (version == 2)].get("name") for word in unknown.get("dependencies").split()}
        row = fmu.jacobian([name], states + inputs)[0]
        if {k for k, d in zip(states + inputs, row, strict=True) if d != 0.0} != known:
            yield f"{name} depends on other variables than it lists"


def receptances(fmu, body):
    """From the derivatives that are exchanged: G = C (i w - A)^-1 B + D."""
    states = fmu.states()
    A, B = fmu.jacobian([f"der({s})" for s in states], states), fmu.jacobian([f"der({s})" for s in states], body.inputs)
    for outputs, power in zip(body.outputs, (0, 1, 2), strict=True):
        C, D = fmu.jacobian(outputs, states), fmu.jacobian(outputs, body.inputs)
        for w in (0.3 * body.omega[0], 1.01 * body.omega[1], 0.9 * body.omega[-1]):
            G = C @ np.linalg.solve(1j * w * np.eye(len(states)) - A, B.astype(complex)) + D
            Z = np.diag(body.omega**2 - w**2) + 1j * w * body.C
            expected = (1j * w) ** power * body.Phi @ np.linalg.solve(Z, body.Phi.T.astype(complex))
            # Far below a resonance the acceleration is the difference of two large terms.
            scale = np.abs(expected).max() + (np.abs(D).max() if power == 2 else 0.0)
            error = np.abs(G - expected).max() / scale
            if error > 1e-9:
                yield f"receptance at {w:.4g} rad/s, derivative {power}: off by {error:.1e}"


def motion_in_time(fmu, body):
    """Steps of several sizes under forces that change, against the matrix exponential, which is exact."""
    A, B = body.matrices()
    n, m = B.shape
    x, time, rng = np.zeros(n), 0.0, np.random.default_rng(1)
    fmu.set(fmu.states(), x)
    for h in (1e-4, 1e-4, 3e-3, 1e-5, 1e-4):
        force = rng.normal(size=m)
        fmu.set(body.inputs, force)
        fmu.step(time, h)
        exponential = expm(np.block([[A * h, B * h], [np.zeros((m, n + m))]]))
        x, time = exponential[:n] @ np.concatenate([x, force]), time + h
        u = body.Phi @ x[: n // 2]
        error = np.abs(fmu.get(body.outputs[0]) - u).max() / np.abs(u).max()
        # scipy's exponential of unscaled modes loses a few digits.
        if error > 1e-8:
            yield f"co-simulation at {time:.2g} s: off by {error:.1e}"
    if abs(fmu.get(["time"])[0] - time) > 1e-15:
        yield "the time of the FMU is another one"


def integrated(fmu, body):
    """Model exchange with an integrator of the importer's, under a force that grows, against the exact response."""
    n = 2 * body.omega.size
    fmu.set(fmu.states(), np.zeros(n))
    rate, end = 300.0, 5e-3

    def slope(time, x):
        fmu.call("SetTime", ctypes.c_double(time))
        fmu.call("SetContinuousStates", (ctypes.c_double * n)(*x), ctypes.c_size_t(n))
        fmu.set(body.inputs[:1], [rate * time])
        derivatives = (ctypes.c_double * n)()
        name = "GetDerivatives" if fmu.version == 2 else "GetContinuousStateDerivatives"
        fmu.call(name, derivatives, ctypes.c_size_t(n))
        return np.array(derivatives)

    found = solve_ivp(slope, (0.0, end), np.zeros(n), method="DOP853", rtol=1e-10, atol=1e-14).y[:, -1]
    A, B = body.matrices()
    ramp = np.zeros((n + 2, n + 2))  # x' = A x + b F, F' = rate
    ramp[:n, :n], ramp[:n, n], ramp[n, n + 1] = A, B[:, 0], rate
    exact = (expm(ramp * end) @ np.r_[np.zeros(n + 1), 1.0])[:n]
    error = np.abs(found - exact)[: n // 2].max() / np.abs(exact[: n // 2]).max()
    if error > 1e-7:
        yield f"model exchange: off by {error:.1e}"


def parameters(fmu, body):
    n = body.omega.size
    x = np.r_[np.zeros(n), np.ones(n)]
    fmu.set(fmu.states(), x)
    fmu.set(body.inputs, np.zeros(len(body.inputs)))
    accelerations = [f"der(mode[{i + 1}].q_dot)" for i in range(n)]
    fmu.set(["damping_factor", "mode[2].damping_ratio"], [2.0, 0.1])
    expected = -2.0 * body.C @ x[n:]
    expected[1] -= 2.0 * 0.1 * body.omega[1]
    if np.abs(fmu.get(accelerations) - expected).max() > 1e-9 * np.abs(expected).max():
        yield "the parameters damp otherwise than they should"
    fmu.call("Reset")
    if fmu.get(["damping_factor"])[0] != 1.0 or np.any(fmu.get(fmu.states())):
        yield "a reset leaves something"


def states_are_kept(fmu, body):
    state = ctypes.c_void_p()
    suffix = "FMUstate" if fmu.version == 2 else "FMUState"
    fmu.set(body.inputs[:1], [7.0])
    fmu.call(f"Get{suffix}", ctypes.byref(state))
    fmu.step(0.0, 1e-3)
    once = fmu.get(body.outputs[0])
    fmu.call(f"Set{suffix}", state)
    fmu.step(0.0, 1e-3)
    if not np.array_equal(once, fmu.get(body.outputs[0])):
        yield "from a kept state the same step leads elsewhere"
    size, copy = ctypes.c_size_t(), ctypes.c_void_p()
    fmu.call(f"Serialized{suffix}Size", state, ctypes.byref(size))
    stored = ctypes.create_string_buffer(size.value)
    fmu.call(f"Serialize{suffix}", state, stored, size)
    word = "DeSerialize" if fmu.version == 2 else "Deserialize"
    fmu.call(f"{word}{suffix}", stored, size, ctypes.byref(copy))
    fmu.call(f"Set{suffix}", copy)
    fmu.step(0.0, 1e-3)
    if not np.array_equal(once, fmu.get(body.outputs[0])):
        yield "from a stored state the same step leads elsewhere"
    fmu.call(f"{word}{suffix}", stored, ctypes.c_size_t(size.value - 8), ctypes.byref(copy), status=3)
    fmu.messages.clear()
    fmu.call(f"Free{suffix}", ctypes.byref(copy))
    fmu.call(f"Free{suffix}", ctypes.byref(state))
    if state.value is not None:
        yield "a freed state is not null"


def errors_are_told(fmu):
    fmu.set(["mode[1].q"], [float("nan")], status=3)
    if not any("no finite number" in message for message in fmu.messages):
        yield f"nobody is told of a value that is none: {fmu.messages}"
    fmu.messages.clear()
    for words in ({"token": "other"}, {"resources": Path("/nowhere")}):
        alone = Fmu.__new__(Fmu)
        alone.__dict__.update(fmu.__dict__)
        alone.messages = []
        alone.instantiate(**words)
        if alone.instance is not None or len(alone.messages) != 1:
            yield f"{words}: no error is told: {alone.messages}"


def of_version(chladni, folder, scene, version):
    file = folder / f"body_{version}.fmu"
    printed = run(chladni, "export", scene, "--from", folder, "--format", "fmu", "--fmi", version, "--output", file)
    fmu = Fmu(file, folder / f"unpacked_{version}", version)
    body = Body(folder / "strip.body.h5", fmu)
    if "degrees of freedom in which the body cannot move" not in printed or len(body.inputs) != 6:
        yield f"the held edge has forces: {body.inputs}, {printed}"
    yield from description_rules(fmu, version)
    yield from needs_nothing(fmu)
    fmu.instantiate(kind="ModelExchange").initialize()
    for test in (receptances, integrated):
        yield from test(fmu, body)
    yield from dependencies_are_true(fmu, version)
    fmu.free()
    fmu.instantiate().initialize()
    for test in (motion_in_time, parameters, states_are_kept):
        yield from test(fmu, body)
    yield from errors_are_told(fmu)
    fmu.free()


def bodies(chladni, folder):
    """Without damping, damped mode by mode, with a full matrix of damping, and free."""
    text = (ROOT / "tests/data/strip.toml").read_text()
    modal = 'fixed = ["L"]\ndamping = { type = "modal", ratio = 0.01 }'
    damper = '\n[[spring]]\nat = "R"\nstiffness = {}\ndamping = { z = 5.0, rx = 0.1 }\n'
    for name, change in {"none": [], "modal": [('fixed = ["L"]', modal)], "matrix": [("[interface]", damper + "[interface]")]}.items():
        (folder / name).mkdir()
        scene = folder / name / "scene.toml"
        scene.write_text(changed(text, *change))
        run(chladni, "run", scene, "--output", folder / name)
        for version in (2, 3):
            for failure in of_version(chladni, folder / name, scene, version):
                yield f"{name}, FMI {version}: {failure}"


def of_a_body_file(chladni, folder):
    file = folder / "none/strip.body.h5"
    run(chladni, "export", file, "--format", "fmu", "--nodes", "R", "--output", folder / "end.fmu")
    end = Fmu(folder / "end.fmu", folder / "end", 2)
    if not end.names(r"R\.F_z") or end.names(r"L\..*"):
        yield f"--nodes R: {list(end.reference)[:20]}"
    example = ROOT / "examples/fmu/hammer.py"
    printed = run(sys.executable, example, folder / "end.fmu", "R.F_z", "R.u_z")
    last = re.findall(r"R\.u_z = *(\S+)", printed)
    if len(last) != 20 or not 1e-9 < abs(float(last[-1])) < 1e-1:
        yield f"the example: {printed}"
    free = folder / "free.toml"
    free.write_text(changed((folder / "none/scene.toml").read_text(), ('fixed = ["L"]', 'fixed = []')))
    printed = run(chladni, "export", free, "--from", folder / "none", "--format", "fmu", "--stale", "--output", folder / "free.fmu")
    if "6 rigid-body motions are free" not in printed:
        yield f"a free body: {printed}"
    again = folder / "again.fmu"
    run(chladni, "export", file, "--format", "fmu", "--nodes", "R", "--output", again)
    with zipfile.ZipFile(again) as a, zipfile.ZipFile(folder / "end.fmu") as b:
        if a.read("resources/body.chladni-fmu") != b.read("resources/body.chladni-fmu"):
            yield "two exports of one body differ"


def odd_names(chladni, folder):
    """A name that is none of C's is quoted, one that XML knows is escaped."""
    text = (ROOT / "tests/data/strip.toml").read_text().replace('"R"', '"R-1"')
    scene = folder / "odd.toml"
    scene.write_text(changed(text, ('title = "strip"', "title = 'a \"strip\" & <more>'"), ('name = "strip"', 'name = "2-odd"')))
    run(chladni, "run", scene, "--output", folder)
    run(chladni, "export", scene, "--from", folder, "--format", "fmu", "--output", folder / "2-odd.fmu")
    fmu = Fmu(folder / "2-odd.fmu", folder / "odd", 2)
    if "'R-1'.F_z" not in fmu.reference or fmu.model.get("modelName") != 'a "strip" & <more>':
        yield f"odd names: {list(fmu.reference)[-1]}, {fmu.model.get('modelName')}"
    if fmu.binary.name != "_2_odd.so":
        yield f"the library is called {fmu.binary.name}"


def bad_input(chladni, folder):
    file = folder / "none/strip.body.h5"
    for words, expected in ((("--nodes", "M"), ('no set "M"', "it has")), (("--fmi", "1"), ("--fmi",)),
                            (("--nodes", "L"), ("moves at none",))):  # fmt: skip
        done = start(chladni, "export", file, "--format", "fmu", *words, "--output", folder / "bad.fmu")
        if done.returncode == 0 or any(word not in done.stderr for word in expected) or (folder / "bad.fmu").exists():
            yield f"{words}: {done.returncode}, {done.stderr}"
    reduced = start(chladni, "export", folder / "none/strip.reduced.h5", "--format", "fmu", "--output", folder / "bad.fmu")
    if reduced.returncode == 0 or "chladni-body" not in reduced.stderr:
        yield f"a reduced system is no body: {reduced.stderr}"


def main(programs):
    chladni = Path(programs).resolve() / "chladni"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        failures = [*bodies(chladni, folder), *of_a_body_file(chladni, folder), *odd_names(chladni, folder), *bad_input(chladni, folder)]
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
