"""Figures 4.4 to 4.17 of the source: the two beams of examples/beam, whose scripts make the bodies and draw the pictures."""

import shutil
import subprocess
import sys

from drawing import plt
from studies import ROOT, Entry, Number

BEAM = ROOT / "examples/beam"
sys.path.insert(0, str(BEAM))
import beam  # noqa: E402
import figures as beam_figures  # noqa: E402
import report as beam_report  # noqa: E402

# Pictures of examples/beam/figures.py and the figures of the source that they stand for.
PICTURES = {
    "problems": "4.4, 4.5", "static_modes": "4.6", "fixed_interface_modes": "4.7", "rigid_modes": "4.8", "free_modes": "4.9",
    "cantilever_constrained_modes": "4.10", "supported_constrained_modes": "4.11", "cantilever_frequency_errors": "4.12",
    "supported_frequency_errors": "4.13", "cantilever_interface_modes": "4.14", "supported_interface_modes": "4.15",
    "cantilever_harmonic": "4.16", "supported_harmonic": "4.17",
}
TITLES = {
    "problems": "The two beams and their master DOFs", "static_modes": "The static modes of the masters",
    "fixed_interface_modes": "The first 8 modes with all masters held", "rigid_modes": "Rigid-body modes",
    "free_modes": "The first 8 elastic modes of the free beam", "cantilever_constrained_modes": "Modes of the cantilever",
    "supported_constrained_modes": "Modes of the simply supported beam", "cantilever_frequency_errors": "Errors of the frequencies of the cantilever",
    "supported_frequency_errors": "Errors of the frequencies of the simply supported beam",
    "cantilever_interface_modes": "Frequency-response modes of the cantilever", "supported_interface_modes": "Frequency-response modes of the simply supported beam",
    "cantilever_harmonic": "Harmonic response of the cantilever", "supported_harmonic": "Harmonic response of the simply supported beam",
}


def study(programs, folder):
    """All bodies and pictures of the example; the errors that its report computes."""
    subprocess.run([sys.executable, BEAM / "study.py", programs, folder], check=True, capture_output=True)
    with plt.rc_context({"savefig.dpi": 90}):
        beam_figures.main(folder)
    return {row.name: float(row.computed) for row in beam_report.figures(folder)}


def sizes(folder, name):
    """Coordinates of the reduced system, its masters and fixed-interface modes."""
    import h5py
    with h5py.File(folder / name / f"{name}.reduced.h5") as reduced:
        n, masters = len(reduced["matrices/stiffness"]), len(reduced["masters/node"])
    return n, masters, n - masters


def numbers_of(stem, found, folder):
    case = stem.split("_")[0]
    n, masters, modes = sizes(folder, beam.CASES[0].name)
    if stem == "static_modes":
        return (Number("static modes", "1", 6, masters),)
    if stem == "fixed_interface_modes":
        return (Number("fixed-interface modes", "1", 100, modes), Number("coordinates of the reduced system", "1", 106, n))
    if stem == "rigid_modes":
        return (Number("rigid-body modes", "1", 2, rigid_modes(folder)),)
    if stem.endswith("frequency_errors"):
        return (Number("constrained modes with an error below 1 %", "1", None, found[f"{case}: of these below 1 %"]),
                Number("of so many", "1", None, found[f"{case}: constrained modes"]))
    if stem.endswith("harmonic"):
        return tuple(Number(f"error of {name}, 5 modes{with_frm}", "1", None, found[f"{case}: 5 modes{with_frm}, error of {name}"])
                     for with_frm in ("", ", FRM at 0.5 omega_1") for name in "wMQ")
    return ()


def rigid_modes(folder):
    case = beam.CASES[0]
    omega = beam_figures.frequencies(beam.body_file(folder, case, "free"))
    return int((omega < 1e-3 * omega[5]).sum())


REMARKS = {
    "cantilever_frequency_errors": "The source: \"up until the last few eigenmodes ... the error is less than 1 %\".",
    "supported_frequency_errors": "The source: \"the different boundary conditions do not affect the global type of the error plot\".",
    "cantilever_harmonic": "The source: with five modes and one FRM \"basically the same as the full FE solution\"; a system of 6 instead of 602 coordinates. Errors are L2 norms over the "
                           "length, relative, at 3 omega_1. More of them are in [the benchmarks of bodies](body_benchmarks.md#the-beams-of-the-thesis).",
    "supported_harmonic": "As above; the shear force jumps here and the moment has a kink, so that fewer modes are enough.",
}


def entries(found, folder, figures):
    for stem, figure in PICTURES.items():
        image = f"source_{figure.replace('.', '_').replace(', ', '_')}.png"
        shutil.copy(folder / f"{stem}.png", figures / image)
        yield Entry(figure, TITLES[stem], (image,), REMARKS.get(stem, ""), numbers_of(stem, found, folder))
