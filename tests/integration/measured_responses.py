"""`chladni response --measured`: frequency responses of a universal file beside computed ones.

Usage: measured_responses.py PROGRAM_DIR MPIRUN
"""

import json
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from response import BEAM, RESPONSE, TWO_PI, Case, Checks, exact_tip, of, responses
from running import run, start


def function_as_measured(output, load, f, H, quantity=12):
    """A dataset 58 in single precision, at even frequencies, from a load to an output of (node, direction)."""
    text = "    -1\n    58\n" + "NONE\n" * 5
    text += f"{4:5d}{0:10d}{0:5d}{0:10d} {'NONE':10}{output[0]:10d}{output[1]:4d} {'NONE':10}{load[0]:10d}{load[1]:4d}\n"
    text += f"{5:10d}{len(f):10d}{1:10d}{f[0]:13.5E}{f[1] - f[0]:13.5E}{0:13.5E}\n"
    for kind, unit in ((18, "Hz"), (quantity, "mm/s^2"), (13, "N"), (0, "NONE")):
        text += f"{kind:10d}{0:5d}{0:5d}{0:5d} {'NONE':20} {unit:20}\n"
    numbers = np.stack([H.real, H.imag], axis=1).reshape(-1)
    lines = ["".join(f"{x:13.5E}" for x in numbers[i : i + 6]) for i in range(0, len(numbers), 6)]
    return text + "\n".join(lines) + "\n    -1\n"


def check_beam_beside_its_closed_form(program, mpirun, folder, checks):
    """The exact accelerance of the beam as a measurement in mm, of sensors a little beside their nodes: FRAC by numpy."""
    beam = Case(program, mpirun, folder, BEAM + RESPONSE, "beam").made()
    f = np.linspace(0.0, 4.0, 81)
    exact = -((TWO_PI * f) ** 2) * exact_tip(TWO_PI * f, 0.05) * 1e3  # mm, and another damping than the model's
    factors = "".join(f"{x:25.16E}" for x in (1e3, 1.0, 1.0)).replace("E", "D")
    text = f"    -1\n   164\n{1:10d}{'SI: mm':20}{2:10d}\n{factors}\n{273.15:25.16E}\n    -1\n    -1\n    15\n"
    for number, x in ((101, 1001.0), (102, 999.0), (103, 600.0)):
        text += f"{number:10d}{0:10d}{0:10d}{1:10d}{x:13.5E}{0:13.5E}{0:13.5E}\n"
    text += "    -1\n" + function_as_measured((101, -3), (102, 3), f, -exact) + function_as_measured((103, 3), (102, 3), f, exact)
    changes = (("from_Hz = 0.0", "from_Hz = 0.5"), ("to_Hz = 12.0", "to_Hz = 3.0"))
    kept = (f >= 0.5 - 1e-9) & (f <= 3.0 + 1e-9)
    words = ("response", "scene.toml", "--output", "out", "--measured", "hammer.uff")
    for model, ranks in (("body", 1), ("reduced", 1), ("fe", 1), ("fe", 2)):
        beam.write(*changes, of(model))
        (beam.folder / "hammer.uff").write_text(text)
        run(beam.program, *words, "--distance", "0.002", "--json", "out/told.json", mpirun=mpirun, ranks=ranks, cwd=beam.folder)
        found = json.loads((beam.folder / "out/told.json").read_text())["measured"]
        Omega, _, outputs, H = responses(beam.folder / "out/beam.response.h5")
        x, y = exact[kept] / 1e3 / -((TWO_PI * f[kept]) ** 2), H[0][:, outputs.index("C.z")]
        frac = abs(np.vdot(x, y)) ** 2 / (np.vdot(x, x) * np.vdot(y, y)).real
        checks.holds(f"{model}, {ranks} rank(s): compared is {[(one['output'], one['load']) for one in found]}, FRAC {found[0]['frac']:.4f}",
                     [(one["output"], one["load"]) for one in found] == [("C.z", "C.z")] and 0.5 < frac < 0.99)  # fmt: skip
        checks.below("  measured frequencies", np.abs(Omega / TWO_PI - f[kept]).max(), 1e-12)
        checks.below("  FRAC by numpy, six digits in the file", abs(found[0]["frac"] - frac), 1e-5)
        checks.below("  amplitudes", abs(found[0]["amplitude_ratio"] / (np.linalg.norm(y) / np.linalg.norm(x)) - 1), 1e-5)
    with h5py.File(beam.folder / "out/beam.response.h5") as file:
        stored = file["measured/H_re"][:, 0] + 1j * file["measured/H_im"][:, 0]
        checks.below("  in the file", np.abs(stored - x).max() / np.abs(x).max(), 1e-5)
    told = run(beam.program, "info", "out/beam.response.h5", cwd=beam.folder)
    checks.holds("info tells FRAC", "FRAC" in told)
    checks.holds("the page draws it", '"measured"' in (beam.folder / "out/beam.response.html").read_text())
    named = ('{ at = "C", dofs = ["z"] }', '{ at = "C", dofs = ["z"], measured_node = 102 }')
    beam.write(*changes, named)
    scene = (beam.folder / "scene.toml").read_text()
    (beam.folder / "scene.toml").write_text(scene.replace('dofs = ["z", "ry"] }, { at = "B"', 'dofs = ["z"], measured_node = 101 }, { at = "B"'))
    (beam.folder / "hammer.uff").write_text(text[text.index("    -1\n    58\n") :])
    done = start(beam.program, *words, cwd=beam.folder)
    checks.holds(f"by numbers of nodes, without units: {done.stderr.rstrip()}", done.returncode == 0 and "taken for SI" in done.stderr
                 and "1 of 2 frequency responses" in done.stderr)  # fmt: skip
    beam.write(*changes)
    for name, change, more, expected in (
        ("damaged", ("    58\n", "    5x\n"), ["--distance", "0.002"], ["hammer.uff:", "5x"]),
        ("elsewhere", None, ["--distance", "0.0001"], ["none of its 2", "--distance"]),
        ("without a distance", None, [], ["measured_node", "--distance"]),
        ("no function", (text[text.index("    -1\n    58\n") :], ""), ["--distance", "0.002"], ["hammer.uff", "dataset 58 of type 4"]),
    ):  # fmt: skip
        (beam.folder / "hammer.uff").write_text(text.replace(*change, 1) if change else text)
        done = start(beam.program, *words, *more, cwd=beam.folder)
        checks.holds(f"{name}: {done.stderr.rstrip()}", done.returncode != 0 and all(word in done.stderr for word in expected))


if __name__ == "__main__":
    CHECKS = Checks()
    with tempfile.TemporaryDirectory() as FOLDER:
        check_beam_beside_its_closed_form(Path(sys.argv[1]), sys.argv[2], FOLDER, CHECKS)
    sys.exit(not CHECKS.good)
