"""Makes all bodies of the beam example. Usage: study.py PROGRAM_DIR OUT

Each beam is reduced once; a body for another support or choice of modes takes `chladni body` alone,
on the reduced system that is there. OUT/BEAM/ gets the body of the scene as it stands, OUT/BEAM/BODY/ those of
the other choices.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import beam
import numpy as np

EXAMPLE = Path(__file__).parent


def with_body(scene, **lines):
    """The scene with other lines in its [body]; None takes a line out."""
    for key, value in lines.items():
        scene, n = re.subn(rf"(?m)^{key} = .*\n", "" if value is None else f"{key} = {value}\n", scene)
        assert n == 1, f"{key} must stand once in the scene"
    return scene


def interface_mode(case, omega0):
    """One frequency-response mode of the loaded DOF; at omega0 = 0 it is an inertia-relief mode."""
    kind = 'kind = "irm"' if omega0 == 0 else f'kind = "frm", omega0 = {omega0!r}'
    return f'[{{ {kind}, at = "B", dofs = ["{case.load}"] }}]'


def bodies(case):
    """Name of the body -> lines of its [body]."""
    yield "free", {"fixed": "[]", "keep": None, "interface_modes": None}
    yield "all", {"keep": None, "interface_modes": None}
    for n in beam.SIZES:
        keep = f"{{ modes = {n} }}"
        yield beam.body_name(n, None), {"keep": keep, "interface_modes": None}
        for ratio in beam.FRM_RATIOS:
            modes = interface_mode(case, ratio * beam.OMEGA_1_FREE)
            yield beam.body_name(n, ratio), {"keep": keep, "interface_modes": modes}


def run(programs, *arguments):
    subprocess.run([programs / "chladni", *arguments], check=True, stdout=subprocess.DEVNULL)


def make_body(programs, case, folder, name, lines):
    """Makes OUT/BEAM/NAME/ with the lines in the scene."""
    target = folder / case.name / name
    target.mkdir(parents=True, exist_ok=True)
    reduced = f"{case.name}.reduced.h5"
    shutil.copy(folder / case.name / reduced, target / reduced)
    scene = target / "scene.toml"
    scene.write_text(with_body((EXAMPLE / f"{case.name}.toml").read_text(), **lines))
    run(programs, "body", scene, "--output", target)
    (target / reduced).unlink()


def make_selected(programs, case, folder):
    """The body that a tolerance chooses: the accuracy of five modes and one interface mode."""
    complete, by_hand = (
        beam.body_file(folder, case, name) for name in ("all", beam.body_name(5, 0.5))
    )
    error = beam.largest_response_error(complete, by_hand, case)
    keep = f"{{ tolerance = {error!r}, up_to_Hz = {beam.HIGHEST / (2 * np.pi)!r} }}"
    loads = f'[{{ kind = "frm", at = "B", dofs = ["{case.load}"], omega0 = "auto" }}]'
    make_body(programs, case, folder, "selected", {"keep": keep, "interface_modes": loads})


def main(programs, folder):
    for case in beam.CASES:
        run(programs, "run", EXAMPLE / f"{case.name}.toml", "--output", folder / case.name)
        for name, lines in bodies(case):
            make_body(programs, case, folder, name, lines)
        make_selected(programs, case, folder)
        print(folder / case.name)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
