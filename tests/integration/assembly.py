"""The brake of examples/brake against its finite elements without any reduction, with and without interface modes.

Usage: assembly.py PROGRAM_DIR
"""

import json
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import h5py
import numpy
from running import changed, run
from whole_brake import Body, Brake

EXAMPLE = Path(__file__).parents[2] / "examples/brake"
BAND_HZ = 5000.0
# All modes with the masters held, those with mass: the whole of the finite elements.
COMPLETE = {"disc": 1560, "pad": 150, "caliper": 132}




def with_modes(name, modes, interface=""):
    text = (EXAMPLE / f"{name}.toml").read_text()
    begin = text.index("keep = ")
    end = text.index("\n", begin)
    return text[:begin] + f"keep = {{ modes = {modes} }}\n{interface}" + text[end:]


def frm(*rows):
    return "interface_modes = [" + ", ".join(rows) + "]"


def modes_alone():
    return {"disc": with_modes("disc", 24), "pad": with_modes("pad", 13), "caliper": with_modes("caliper", 10)}


BODIES = {"modes alone": modes_alone}


def text_without(text, table):
    return text[: text.index(f"\n[{table}]")]


def make_bodies(programs, folder, bodies):
    for name, text in bodies.items():
        (folder / f"{name}.toml").write_text(text)
        run(programs / "chladni", "run", folder / f"{name}.toml", "--output", folder / "out", "--overwrite")


def complete_bodies(programs, folder):
    """The files of the bodies with all their modes."""
    files = {}
    for name, modes in COMPLETE.items():
        text = text_without((EXAMPLE / f"{name}.toml").read_text(), "body")
        kept = next(line for line in text.splitlines() if line.startswith("modes = "))
        (folder / f"complete_{name}.toml").write_text(text.replace(kept, f"modes = {modes}"))
        run(programs / "chladni", "reduce", folder / f"complete_{name}.toml", "--output", folder / "complete")
        files[name] = folder / "complete" / f"{name}.reduced.h5"
        with h5py.File(files[name]) as f:
            assert len(f["fixed_interface_frequencies"]) == modes
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


def errors_of(values, exact):
    """Relative distance of each exact eigenvalue of the band from the nearest one that was found."""
    return numpy.array([abs(values - one).min() / abs(one) for one in exact])


def main(programs):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file in EXAMPLE.glob("*"):
            shutil.copy(file, folder)
        text = changed((EXAMPLE / "scene.toml").read_text(), ('model = "assembly"', 'model = "assembly"\nconvection = "left out"'))
        scene = tomllib.loads(text)
        speed = scene["squeal"]["speeds"]["from_rad_s"]
        brake = whole_brake(complete_bodies(programs, folder), scene, speed)
        shifts = [2j * numpy.pi * f for f in (600.0, 1800.0, 3000.0, 4200.0)]
        exact = distinct(brake.eigenvalues(shifts, 24))
        print(f"finite elements: {len(brake.K)} coordinates, {len(exact)} eigenvalues up to {BAND_HZ:g} Hz")
        for what, bodies in BODIES.items():
            make_bodies(programs, folder, bodies())
            values = eigenvalues_of(programs, folder, text)
            errors = errors_of(values, exact)
            print(what, len(values), "coordinates, errors", errors.max(), numpy.median(errors))
            for one, error in zip(exact, errors, strict=True):
                print(f"   {one / (2 * numpy.pi):.3f} {error:.1e}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
