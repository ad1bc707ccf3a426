"""The brake of examples/brake against its finite elements without any reduction: with and without interface modes, and condensed.

Usage: assembly.py PROGRAM_DIR
"""

import re
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import h5py
import numpy
from running import changed, run, start
from whole_brake import Body, Brake

EXAMPLE = Path(__file__).parents[2] / "examples/brake"
BAND_HZ = 3000.0





def body_text(name, modes, interface_modes=(), reduced=None):
    """A body of the example that keeps so many modes, without damping; beside them IRM of these nodes and components."""
    text = (EXAMPLE / f"{name}.toml").read_text()
    rows = [f'{{ kind = "irm", at = "{at}", dofs = {list(dofs)} }}' for at, dofs in interface_modes]
    head = text[: text.index("keep = ")]
    if reduced:
        head = re.sub(r"\nmodes = \d+", f"\nmodes = {reduced}", head)
    return head + f"keep = {{ modes = {modes} }}\ninterface_modes = [{', '.join(rows)}]\n"


def undamped(name):
    return re.sub(r"\ndamping = .*", "", (EXAMPLE / f"{name}.toml").read_text())


def with_response_modes():
    return {name: undamped(name) for name in ("disc", "pad", "caliper")}


def modes_alone():
    """As many coordinates."""
    return {"disc": body_text("disc", 14), "pad": body_text("pad", 18), "caliper": body_text("caliper", 20)}


def many():
    """All that the reductions of plates and caliper have, and all that the linings do to the disc slowly."""
    rings = [(ring, ("z", "rx", "ry")) for ring in ("inner", "track", "outer")]
    return {"disc": body_text("disc", 30, rings), "pad": body_text("pad", 120), "caliper": body_text("caliper", 38)}


# The largest relative error that each may have below BAND_HZ. Many coordinates differ from the finite elements by what the
# reductions lack; of few, the errors are those of plates and disc under a lining, which modes of free plates do not know.
CASES = {"many": (many, 1e-3), "response modes": (with_response_modes, 8e-3), "modes alone": (modes_alone, 0.05)}


# What condensed bodies of at most so many coordinates together are asked to keep, beside the finite elements.
CONDENSED, AT_MOST = 1e-3, 60


def text_without(text, table):
    return text[: text.index(f"\n[{table}]")]


def make_bodies(programs, folder, bodies):
    for name, text in bodies.items():
        (folder / f"{name}.toml").write_text(text)
        run(programs / "chladni", "run", folder / f"{name}.toml", "--output", folder / "out", "--overwrite")


def complete_bodies(programs, folder):
    """The files of the bodies with all modes that have mass while the masters are held."""
    files = {}
    for name in ("disc", "pad", "caliper"):
        text = text_without((EXAMPLE / f"{name}.toml").read_text(), "body")
        kept = next(line for line in text.splitlines() if line.startswith("modes = "))
        scene, asked = folder / f"complete_{name}.toml", "100000"
        for _ in range(3):
            # Asked for too many, the program says how many slaves there are, then how many modes.
            scene.write_text(text.replace(kept, f"modes = {asked}"))
            done = start(programs / "chladni", "reduce", scene, "--output", folder / "complete", "--overwrite")
            if done.returncode == 0:
                break
            (asked,) = re.findall(r"modes asked of (\d+) slaves|(\d+) of \d+ modes found", done.stderr)[0:1]
            asked = "".join(asked)
        else:
            sys.exit(f"FAILED: no complete basis of {name}: {done.stderr}")
        files[name] = folder / "complete" / f"{name}.reduced.h5"
    return files


def shares_of(body, name):
    """Those of the trapezoidal rule over circles and rays."""
    x = body.positions[body.sets[name]]
    r, angle = numpy.hypot(x[:, 0], x[:, 1]).round(9), numpy.arctan2(x[:, 1], x[:, 0]).round(9)

    def widths(values, moment):
        edges = numpy.concatenate([values[:1], (values[1:] + values[:-1]) / 2, values[-1:]])
        return numpy.diff(moment(edges))

    radii, angles = numpy.unique(r), numpy.unique(angle)
    w_r, w_t = widths(radii, lambda e: e**2 / 2), widths(angles, lambda e: e)
    areas = w_r[numpy.searchsorted(radii, r)] * w_t[numpy.searchsorted(angles, angle)]
    return areas / areas.sum(), areas.sum()


def whole_brake(files, scene, speed):
    """The brake of a scene by its finite elements."""
    parts = {part["name"]: part for part in scene["part"]}
    bodies = {"disc": Body(files["disc"], held=["hub"])}
    for name, part in parts.items():
        if name == "disc":
            continue
        angle = numpy.radians(part.get("rotation_deg", [0, 0, 0])[0])
        turned = [[1, 0, 0], [0, numpy.cos(angle), -numpy.sin(angle)], [0, numpy.sin(angle), numpy.cos(angle)]]
        kind = part["body"].split(".")[0]
        bodies[name] = Body(files[kind], numpy.round(turned, 12), part.get("position", [0, 0, 0]))
    brake = Brake(bodies)
    for joint in scene["joint"]:
        ends = [None if end == "ground" else end.split(".") for end in joint["between"]]
        brake.join(ends, joint["stiffness"], joint.get("damping", {}))
    for contact in scene["contact"]:
        part, name = contact["face"].split(".")
        shares, area = shares_of(bodies[part], name)
        lining = {"k": contact["stiffness_per_area"] * area, "d": contact["damping_per_area"] * area, "N": contact["pressure"] * area}
        lining |= {"mu": scene["squeal"]["friction"], "height": contact["height"], "thickness": scene["squeal"]["thickness"]}
        brake.touch(part, name, shares, lining, speed)
    return brake


def eigenvalues_of(programs, folder, text):
    """Eigenvalues of the first speed, and how many coordinates there are."""
    (folder / "scene.toml").write_text(text)
    run(programs / "squeal", "run", folder / "scene.toml", "--output", folder / "out", "--overwrite")
    with h5py.File(folder / "out/brake.squeal.h5") as f:
        values = f["eigenvalues/lambda_re"][0] + 1j * f["eigenvalues/lambda_im"][0]
    return values


def distinct(values):
    """One of each that oscillates within the band, by frequency."""
    low, high = 2 * numpy.pi * 50.0, 2 * numpy.pi * BAND_HZ
    ordered = sorted((v for v in values if low < v.imag < high), key=lambda v: (v.imag, v.real))
    kept = []
    for value in ordered:
        if all(abs(value - other) > 1e-6 * abs(value) for other in kept):
            kept.append(value)
    return numpy.array(kept)


def seen_by_friction(values):
    """Modes of the disc in its plane, which no pad on its middle surface feels, keep their zero real part."""
    return numpy.array([value for value in values if abs(value.real) > 1e-7 * abs(value)])


def condensed(programs, folder, text):
    """The scene with small bodies that `squeal condense` makes of the large ones at hand."""
    (folder / "scene.toml").write_text(text)
    run(programs / "squeal", "condense", folder / "scene.toml", "--output", folder / "out", "--up-to-Hz", f"{BAND_HZ:g}",
        "--tolerance", str(0.8 * CONDENSED))  # fmt: skip
    small, n = re.subn(r'(name = "(\w+)"[^\n]*\nbody = )"[^"]+"', r'\1"brake.condensed/\2.body.h5"', text)
    assert n == 4, "a part of the scene was not found"
    return small


def compared_scene():
    """The example at two speeds, with a disc whose matrices stand still."""
    text = (EXAMPLE / "scene.toml").read_text()
    analyses = next(line for line in text.splitlines() if line.startswith("analyses = "))
    return changed(text, ('model = "assembly"', 'model = "assembly"\nconvection = "left out"'), ("count = 16", "count = 2"), (analyses, 'analyses = ["eigenvalues"]'))


def errors_of(values, exact):
    """Relative distance of each exact eigenvalue of the band from the nearest one that was found."""
    return numpy.array([abs(values - one).min() / abs(one) for one in exact])


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file in EXAMPLE.glob("*"):
            shutil.copy(file, folder)
        text = compared_scene()
        scene = tomllib.loads(text)
        speed = scene["squeal"]["speeds"]["from_rad_s"]
        brake = whole_brake(complete_bodies(programs, folder), scene, speed)
        shifts = [2j * numpy.pi * f for f in (500.0, 1300.0, 2100.0, 2900.0)]
        exact = seen_by_friction(distinct(brake.eigenvalues(shifts, 20)))
        print(f"finite elements: {len(brake.K)} coordinates, {len(exact)} eigenvalues up to {BAND_HZ:g} Hz")
        largest = {}
        for what, (bodies, limit) in CASES.items():
            make_bodies(programs, folder, bodies())
            values = eigenvalues_of(programs, folder, text)
            errors = errors_of(values, exact)
            largest[what] = errors.max()
            print(f"{what}: {len(values)} coordinates, errors {errors.max():.1e} at most, median {numpy.median(errors):.1e}")
            if not errors.max() < limit:
                sys.exit(f"FAILED: {what}: {errors.max():.2e} is not below {limit}")
            if what == "many":
                values = eigenvalues_of(programs, folder, condensed(programs, folder, text))
                errors = errors_of(values, exact)
                print(f"condensed: {len(values)} coordinates, errors {errors.max():.1e} at most, median {numpy.median(errors):.1e}")
                if len(values) > AT_MOST or not errors.max() < CONDENSED:
                    sys.exit(f"FAILED: condensed: {len(values)} coordinates, {errors.max():.2e}")
        if not 3 * largest["response modes"] < largest["modes alone"]:
            sys.exit("FAILED: response modes do not reduce the largest error by three")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
