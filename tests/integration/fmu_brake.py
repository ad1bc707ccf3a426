"""The brake of a scene as FMU: over one rotation its motions grow as the eigenvalues of `squeal` say, and the model that is
exchanged moves as the co-simulation does.

Usage: fmu_brake.py PROGRAM_DIR
"""

import ctypes
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmi_importer import Fmu, description_rules, needs_nothing
from running import run, start, summary
from scipy.integrate import solve_ivp

ROOT = Path(__file__).resolve().parents[2]
SPEED = 18.8495559
SQUEAL = f"""
[squeal]
ring = "track"
thickness = 0.02
use_modes = "nodal-diameters 3"
speeds = {{ from_rad_s = {SPEED}, to_rad_s = 30.0, count = 2 }}
friction = 0.6
contact = "signed"
pads = [{{ angle_deg = 20.0, stiffness = 6e6, damping = 2.0, preload = 2000.0 }}]
analyses = ["eigenvalues"]
transient = {{ speed_rad_s = {SPEED}, duration_s = 0.1, initial_pad_displacement = 1e-8 }}
"""


def growth_over_a_rotation(fmu):
    """Of the multipliers of the motion in the frame that turns with the disc."""
    states, turn = fmu.states(), 2.0 * np.pi / SPEED
    monodromy, small = [], 1e-9
    for k in range(len(states)):
        fmu.call("Reset")
        fmu.set(states, small * np.eye(len(states))[k])
        fmu.step(0.0, turn)
        monodromy.append(fmu.get(states) / small)
    return np.sort(np.log(np.abs(np.linalg.eigvals(np.array(monodromy).T))) / turn)


def exchanged_as_simulated(fmu, other):
    """Model exchange under an integrator of the importer's, with another preload and friction."""
    names = ["angle", *fmu.states()]
    x = np.r_[0.3, 1e-6 * np.cos(np.arange(len(names) - 1))]
    inputs, values, end = ["speed", "friction", "pad[1].preload"], [25.0, 0.4, 1700.0], 2e-3
    for each in (fmu, other):
        each.set(names, x)
        each.set(inputs, values)
    other.step(0.0, end)
    n = len(names)

    def slope(_, x):
        fmu.call("SetContinuousStates", (ctypes.c_double * n)(*x), ctypes.c_size_t(n))
        derivatives = (ctypes.c_double * n)()
        name = "GetDerivatives" if fmu.version == 2 else "GetContinuousStateDerivatives"
        fmu.call(name, derivatives, ctypes.c_size_t(n))
        return np.array(derivatives)

    found = solve_ivp(slope, (0.0, end), x, method="DOP853", rtol=1e-11, atol=1e-16).y[:, -1]
    expected = other.get(names)
    if abs(found[0] - 0.3 - 25.0 * end) > 1e-9:
        yield f"the disc has turned by {found[0] - 0.3}"
    error = np.abs(found - expected)[1:].max() / np.abs(expected)[1:].max()
    if error > 1e-7:
        yield f"model exchange and co-simulation differ by {error:.1e}"
    outputs = ["pad[1].upper.N", "pad[1].lower.N", "pad[1].upper.v", "torque"]
    fmu.call("SetContinuousStates", (ctypes.c_double * n)(*expected), ctypes.c_size_t(n))
    if not np.allclose(fmu.get(outputs), other.get(outputs), rtol=1e-12):
        yield "the outputs differ"
    N = other.get(["pad[1].upper.N", "pad[1].lower.N"])
    if abs(N.sum() / 2 - 1700.0) > 50.0 or other.get(["torque"])[0] >= 0.0:
        yield f"normal forces {N}, torque {other.get(['torque'])}"


def of_version(chladni, folder, scene, version, expected):
    file = folder / f"brake_{version}.fmu"
    run(chladni, "export", scene, "--from", folder, "--format", "fmu-brake", "--fmi", version, "--output", file)
    fmu = Fmu(file, folder / f"unpacked_{version}", version)
    yield from description_rules(fmu, version)
    yield from needs_nothing(fmu)
    fmu.instantiate().initialize()
    if fmu.get(["speed"])[0] != SPEED or fmu.get(["friction"])[0] != 0.6:
        yield "the inputs do not begin as in the scene"
    growth = growth_over_a_rotation(fmu)
    # squeal tells one of each conjugate pair.
    if np.abs(growth[[0, -1]] - [min(expected), max(expected)]).max() > 1e-4 * np.abs(expected).max():
        yield f"growth {growth} 1/s instead of {expected}"
    exchanged = Fmu(file, folder / f"exchanged_{version}", version).instantiate(kind="ModelExchange").initialize()
    yield from exchanged_as_simulated(exchanged, fmu)
    fmu.messages.clear()
    fmu.set(["speed"], [0.0])
    zero = (ctypes.c_uint32 * 1)(fmu.reference["torque"]), ctypes.c_size_t(1), (ctypes.c_double * 1)()
    more = () if version == 2 else (ctypes.c_size_t(1),)
    fmu.call("GetReal" if version == 2 else "GetFloat64", *zero, *more, status=3)
    if not any("speed" in message for message in fmu.messages):
        yield f"a disc at rest: {fmu.messages}"


def bad_input(chladni, folder, scene):
    plain = folder / "plain.toml"
    plain.write_text(scene.read_text().replace(SQUEAL, ""))
    table = folder / "table.toml"
    table.write_text(scene.read_text().replace("friction = 0.6\n", "") + "[squeal.friction]\n"
                     "[[squeal.friction.table]]\nspeed_m_s = [0.0, 1.0, 50.0]\nmu = [0.7, 0.6, 0.5]\n")
    elsewhere = folder / "elsewhere"
    for words, expected in (((plain, "--from", folder), "[squeal]"), ((table, "--from", folder), "one coefficient"), ((scene, "--from", elsewhere), "chladni run"),
                            ((folder / "disc.body.h5",), "made of its scene")):  # fmt: skip
        done = start(chladni, "export", *words, "--format", "fmu-brake", "--output", folder / "bad.fmu")
        if done.returncode == 0 or expected not in done.stderr or (folder / "bad.fmu").exists():
            yield f"{words}: {done.returncode}, {done.stderr}"


def main(programs):
    programs = Path(programs).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = folder / "disc.toml"
        scene.write_text('name = "disc"\n' + (ROOT / "tests/data/coarse_disc.toml").read_text() + SQUEAL)
        run(programs / "chladni", "run", scene, "--output", folder)
        results = summary(programs / "squeal", "run", scene, "--output", folder)
        expected = np.array(results["eigenvalues"][0]["lambda"])[:, 0]
        failures = [failure for version in (2, 3)
                    for failure in of_version(programs / "chladni", folder, scene, version, expected)]  # fmt: skip
        failures += bad_input(programs / "chladni", folder, scene)
    print("\n".join(f"FAILED: {line}" for line in failures))
    sys.exit(bool(failures))


main(*sys.argv[1:])
