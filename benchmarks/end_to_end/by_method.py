"""Speed against error of the methods: the held disc by each method with several numbers of modes, on two meshes, and by `accuracy`, which
chooses the mesh too. Errors are the largest of the frequencies of the range, by rank: against the FE model on the same mesh, and
against the exact plate. Used by frontier.py.
"""
import pathlib
import tempfile

import numpy as np

import responses
import run

RANGE = "range"  # as many modes as the range has
METHODS = {"guyan": [0], "craig-bampton": [RANGE, 60, 132, 259, 459], "rubin": [RANGE, 60, 132, 259],
           "mixed-interface": [RANGE, 60, 132]}
SIZES = [0.018, 0.013, 0.009]  # of elements, m: all methods on the middle one, the others for the best of them
ACCURACIES = [1e-2, 1e-3, 1e-4]
HELD = 'keep = { modes = 1 }'


def largest_error(f_Hz, reference):
    """By rank, of as many as the reference has; None where there are fewer."""
    error = np.abs(f_Hz[:len(reference)] / reference - 1)
    return float(error.max()) if np.all(np.isfinite(error)) else None


def reduced(frontier, case, text, count):
    """Frequencies, and what the reduction cost."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        summary = frontier.chladni("reduce", folder, case, text)
        held = responses.read_held(next(folder.glob("*.reduced.h5")), case["support"])
        return responses.frequencies_Hz(held, count), {
            "dofs": summary["n_dofs"], "modes": summary["n_modes"], "method": summary["method"],
            "size": summary["n_masters"] + summary["n_modes"], "cost_s": frontier.cost(summary)}


def on_mesh(frontier, case, size, methods, exact):
    """Each choice of some methods on one mesh."""
    case = {**case, "mesh": (case["mesh"][0], f"element_size = {size}")}
    with tempfile.TemporaryDirectory() as name:
        fe = frontier.full_model(case, pathlib.Path(name))["f"][:len(exact)]
    for method in methods:
        for asked in METHODS[method]:
            n = len(exact) if asked == RANGE else asked
            line = (f"modes = {n}\n" if n else "") + frontier.LEAN
            f_Hz, one = reduced(frontier, case, frontier.scene_text(case, line, HELD, f'method = "{method}"'), len(exact))
            yield {**one, "element_size": size, "error_fe": largest_error(f_Hz, fe), "error_exact": largest_error(f_Hz, exact)}


def by_accuracy(frontier, case, exact):
    for accuracy in ACCURACIES:
        text = frontier.scene_text(case, frontier.LEAN, HELD, "").replace(f"\n{case['mesh'][1]}\n", "\n").replace("element_order = 3\n", "")
        text = f"accuracy = {{ error = {accuracy}, up_to_Hz = {case['up_to_Hz']} }}\n" + text
        f_Hz, one = reduced(frontier, case, text, len(exact))
        yield {**one, "accuracy": accuracy, "error_fe": None, "error_exact": largest_error(f_Hz, exact)}


def study(frontier, case):
    exact = np.array(run.exact_frequencies("annulus", 60))
    exact = exact[exact <= case["up_to_Hz"]]
    coarse, middle, fine = SIZES
    found = [*on_mesh(frontier, case, middle, METHODS, exact)]
    for size in (coarse, fine):
        found += on_mesh(frontier, case, size, ["mixed-interface"], exact)
    return {"up_to_Hz": case["up_to_Hz"], "modes_in_range": len(exact), "masters": found[0]["size"] - found[0]["modes"], "runs": found,
            "by_accuracy": [*by_accuracy(frontier, case, exact)]}
