#!/usr/bin/python3
"""Does the automatic choice reach the error that was asked for, and what does it cost beside the best choice by hand?

usage: frontier.py [--quick] OUTPUT

A tolerance is asked for twice, and each is judged by itself:

- `reduce.tolerance`, of the frequencies: all modes of the range, of the reduced system under the support, by rank
  against those of the full model (`chladni modes`). A mode that is missing shifts all behind it and is seen.
- `keep.tolerance`, of the responses: all responses of the body at the loaded DOFs over the range against those of the
  complete reduced system, and, at some frequencies, against the FE model, which is what it promises. Modes that no load excites are
  left out of a body on purpose, which neither comparison minds.

By hand, twice. For the frequencies alone: the cheapest of the smallest number of fixed-interface modes whose frequencies keep the
tolerance, found by bisection (the matrices of fewer modes are corners of those of more), and of mixed-interface modes, as many as the
range has; with all modes of the range in the body. For the responses too: all modes up to a multiple of the range, in the reduction and in
the body, the smallest multiple of a list that keeps both promises, of either method. Cost is the CPU time of all phases from the mesh to the
body, the least of several runs in turn. Writes OUTPUT/end_to_end.json, .md, OUTPUT/figures/end_to_end.png and
method_frontier.png (by_method.py).
"""
import argparse
import pathlib
import re
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "reduction"))
import by_method  # noqa: E402
import method_pages  # noqa: E402
import pages  # noqa: E402
import responses  # noqa: E402
import run  # noqa: E402

CASES = {
    "thesis disc": {"scene": "thesis_disc/scene.toml", "up_to_Hz": 8000.0, "support": "hub", "loads": "track",
                    "dof": "z", "most_modes": 500, "rounds": 5, "mesh": ("element_size = 0.009", "element_size = 0.013")},
    "disc with hat": {"scene": "hat_disc/scene.toml", "up_to_Hz": 4000.0, "support": "hub", "loads": "track",
                      "dof": "z", "most_modes": 400, "rounds": 5, "mesh": ("size = 16.0", "size = 22.0")},
    "beam": {"scene": "beam/cantilever.toml", "up_to_Hz": 200.0, "support": "A", "loads": "B", "dof": "ry",
             "most_modes": 60, "rounds": 9, "mesh": ("elements = 300", "elements = 300")},
}
TOLERANCES = [1e-2, 1e-3, 1e-4]
COMPONENTS = ["x", "y", "z", "rx", "ry", "rz"]
MULTIPLES = [1, 1.2, 1.4, 1.7, 2, 2.4, 2.8, 3.4, 4, 5, 6, 8]  # of the range, for a choice by hand
METHODS = ["mixed-interface", "craig-bampton"]
N_WHOLE_MODEL = 3  # frequencies at which bodies are compared with the whole model
LEAN = 'pictures = "none"\nmass_integrals = false'


def scene_text(case, reduce_line, body_lines, method='method = "craig-bampton"'):
    """The example's scene on a mesh of this benchmark's with another choice of modes, without [squeal]."""
    text = (run.ROOT / "examples" / case["scene"]).read_text().split("[squeal]")[0]
    assert text.count(case["mesh"][0]) == 1
    text = text.replace(*case["mesh"])
    text = re.sub(r"\[reduce\]\n.*?(?=\n\[)", f"[reduce]\n{method}\n{reduce_line}\n", text,
                  flags=re.S)
    return text[:text.index("[body]")] + f'[body]\nfixed = ["{case["support"]}"]\n{body_lines}\n'


def frm(case, omega0='"auto"', more=""):
    return f'{{ kind = "frm", at = "{case["loads"]}", dofs = ["{case["dof"]}"], omega0 = {omega0}{more} }}'


def kept(case, keep):
    """Lines of [body]: modes, and interface modes at all loads."""
    return f"keep = {{ {keep} }}\ninterface_modes = [{frm(case)}]"


def chladni(command, folder, case, text):
    """One command on a scene beside its mesh; its summary."""
    source = (run.ROOT / "examples" / case["scene"]).parent
    for mesh in source.glob("*.geo"):
        (folder / mesh.name).write_bytes(mesh.read_bytes())
    path = folder / "scene.toml"
    path.write_text(text)
    return run.summary(run.CHLADNI, command, path, folder)


def cost(summary):
    return sum(summary["phases_cpu_s"].values())


def full_model(case, folder):
    """Frequencies of the full model up to the first above the range, Hz."""
    for count in (40, 120, 360):
        text = scene_text(case, "modes = 5", "keep = { modes = 2 }") + (
            f'[[support]]\ngroup = "{case["support"]}"\ntype = "clamped"\n[modes]\ncount = {count}\n')
        found = chladni("modes", folder, case, text)
        f = np.array(found["frequencies_Hz"])
        if f[-1] > case["up_to_Hz"]:
            return {"f": f[:np.sum(f <= case["up_to_Hz"]) + 1], "cpu_s": found["cpu_s"], "dofs": found["n_dofs"]}
    raise SystemExit(f"{case['scene']}: more than {count} modes up to {case['up_to_Hz']} Hz")


def held_of(case, folder):
    return responses.read_held(next(folder.glob("*.reduced.h5")), case["support"], case["loads"],
                               COMPONENTS.index(case["dof"]))


def rank_errors(held, f):
    """Relative errors of the frequencies of the range, each against that of its rank."""
    return np.abs(responses.frequencies_Hz(held, len(f)) / f - 1)


class Reference:
    """The full model: its frequencies, and its responses at some frequencies between resonances, undamped: there a reduced system
    with the FE model's own responses (`space = "full"`) answers as the FE model. One reduction for each frequency."""

    def __init__(self, case, folder):
        full = full_model(case, folder)
        self.f, self.dofs, self.full_cpu_s = full["f"][:-1], full["dofs"], full["cpu_s"]
        widest = np.sort(np.argsort(np.diff(full["f"]))[-N_WHOLE_MODEL:])
        self.between_Hz = (full["f"][widest] + full["f"][widest + 1]) / 2
        spread = np.linspace(0.01, 1, 100) * case["up_to_Hz"]
        near = np.concatenate([self.f * x for x in (0.99, 1.0, 1.01)])
        self.Omega = 2 * np.pi * np.sort(np.concatenate([spread, near[near <= case["up_to_Hz"]]]))
        held = [self.whole_model_at(case, folder, f) for f in self.between_Hz]
        self.columns = np.arange(0, len(held[0].loads), 4)
        self.between = [one for f, of in zip(self.between_Hz, held) for one in self.undamped(responses.modes(of), [f])]

    @staticmethod
    def whole_model_at(case, folder, f_Hz):
        more = frm(case, repr(2 * np.pi * float(f_Hz)), ', space = "full"')
        chladni("reduce", folder, case, scene_text(case, f"modes = 20\n{LEAN}", f"interface_modes = [{more}]"))
        return held_of(case, folder)

    def undamped(self, modes, f_Hz):
        return list(responses.responses(modes, 2 * np.pi * np.asarray(f_Hz), self.columns, eta=0.0))

    def damped(self, modes):
        """Over the whole range, resonances included."""
        return list(responses.responses(modes, self.Omega, self.columns))


def judged(case, reference, folder, tolerance):
    """Errors of the reduced system and of the body in the folder."""
    held = held_of(case, folder)
    errors = rank_errors(held, reference.f)
    in_body = responses.body_modes(next(folder.glob("*.body.h5")), case["loads"], COMPONENTS.index(case["dof"]))
    in_reduced = responses.modes(held)
    is_kept = [np.any(np.abs(in_body.mu / mu - 1) < 1e-6) for mu in in_reduced.mu[:len(errors)]]
    difference = responses.largest_difference
    return {"expected": len(errors), "within": int(np.sum(errors <= tolerance)), "error": float(errors.max()),
            "kept_in_range": int(np.sum(is_kept)),
            "response_error": difference(reference.damped(in_body), reference.damped(in_reduced)),
            "response_error_full": difference(reference.undamped(in_body, reference.between_Hz), reference.between)}


def measured(case, reference, tolerance, text):
    """One run of a choice, judged."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        summary = chladni("run", folder, case, text)
        return {"method": summary["method"], "modes": summary["n_modes"], "size": len(summary["frequencies_Hz"]), "costs": [cost(summary)],
                "program_cpu_s": summary["cpu_s"], **judged(case, reference, folder, tolerance)}


def again(case, choice, text):
    """One more run, for its time."""
    with tempfile.TemporaryDirectory() as name:
        choice["costs"].append(cost(chladni("run", pathlib.Path(name), case, text)))


def smallest(error, most, tolerance):
    """The smallest count whose error, which falls with the count, is within the tolerance; None if none."""
    if error(most) > tolerance:
        return None
    too_few, enough = 0, most
    while enough - too_few > 1:
        middle = (too_few + enough) // 2
        too_few, enough = (too_few, middle) if error(middle) <= tolerance else (middle, enough)
    return enough


def sweep_by_hand(case, reference):
    """Error of the frequencies for each number of modes that is asked for, of one reduction with the most of them."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        chladni("reduce", folder, case, scene_text(case, f"modes = {case['most_modes']}\n{LEAN}", ""))
        held = held_of(case, folder)
    known = {}

    def error(n):
        if n not in known:
            known[n] = float(rank_errors(held.with_modes(n), reference.f).max())
        return known[n]

    for n in np.unique(np.geomspace(1, case["most_modes"], 20).astype(int)):
        error(int(n))
    return error, known


def of_multiple(case, method, multiple):
    """Scene with all modes of the method up to this multiple of the range, in the reduction and in the body."""
    cutoff_Hz = multiple * case["up_to_Hz"]
    return scene_text(case, f"cutoff_Hz = {cutoff_Hz}", kept(case, f"up_to_Hz = {cutoff_Hz}"), f'method = "{method}"')


def smallest_multiple(case, reference, tolerance, method):
    """The smallest of MULTIPLES with which frequencies and responses keep the tolerance; None if none."""
    def error(n):
        one = measured(case, reference, tolerance, of_multiple(case, method, MULTIPLES[n - 1]))
        return max(one["error"] if one["within"] == one["expected"] else np.inf, one["response_error"], one["response_error_full"])

    n = smallest(error, len(MULTIPLES), tolerance)
    return n and MULTIPLES[n - 1]


def texts(case, reference, tolerance, n_fixed, multiples):
    """Scenes of the automatic choice and of those by hand: `n_fixed` fixed-interface modes if there is such a number, mixed-interface
    modes, and those of the multiples {method: of the range}."""
    in_range = kept(case, f"up_to_Hz = {case['up_to_Hz']}")
    found = {"chosen": scene_text(case, f"tolerance = {tolerance}\nup_to_Hz = {case['up_to_Hz']}",
                                  kept(case, f"tolerance = {tolerance}, up_to_Hz = {case['up_to_Hz']}"), method=""),
             "mixed": scene_text(case, f"modes = {len(reference.f)}", in_range, 'method = "mixed-interface"')}
    if n_fixed:
        found["fixed"] = scene_text(case, f"modes = {n_fixed}", in_range)
    return found | {method: of_multiple(case, method, multiple) for method, multiple in multiples.items() if multiple}


def cheapest(choices, promises):
    """Of those that keep them; None if none does."""
    return min((one for one in choices if all(one[promise] for promise in promises)), key=lambda one: one["cost_s"], default=None)


def compared(case, reference, tolerance, n_by_hand):
    """The automatic choice and the cheapest by hand, with the costs of several runs in turn."""
    multiples = {method: smallest_multiple(case, reference, tolerance, method) for method in METHODS}
    text = texts(case, reference, tolerance, n_by_hand, multiples)
    found = {name: measured(case, reference, tolerance, one) for name, one in text.items()}
    names = list(text)
    for i in range(1, case["rounds"]):  # each round begins with another: what ran before may matter
        for name in names[i % len(names):] + names[:i % len(names)]:
            again(case, found[name], text[name])
    for name, one in found.items():
        one["tolerance"], one["multiple"] = tolerance, multiples.get(name)
        one["cost_s"] = min(one["costs"])
        one["keeps_frequencies"] = one["within"] == one["expected"]
        one["keeps_responses"] = max(one["response_error"], one["response_error_full"]) <= tolerance
    chosen = found.pop("chosen")
    return {"chosen": chosen, "hand": cheapest(found.values(), ["keeps_frequencies"]),
            "hand_with_responses": cheapest(found.values(), ["keeps_frequencies", "keeps_responses"])}


def study(name, case, tolerances):
    with tempfile.TemporaryDirectory() as folder:
        reference = Reference(case, pathlib.Path(folder))
    error, known = sweep_by_hand(case, reference)
    found = []
    for tolerance in tolerances:
        n = smallest(error, case["most_modes"], tolerance)
        both = compared(case, reference, tolerance, n)
        for ratio, hand in (("cost_over_best_by_hand", both["hand_with_responses"]), ("cost_over_frequencies_by_hand", both["hand"])):
            both[ratio] = hand and both["chosen"]["cost_s"] / hand["cost_s"]
        both["fixed_interface_modes"] = n
        found.append(both)
    return {"case": name, "up_to_Hz": case["up_to_Hz"], "dofs": reference.dofs, "modes_in_range": len(reference.f),
            "full_cpu_s": reference.full_cpu_s, "compared_at_Hz": list(map(float, reference.between_Hz)), "rounds": case["rounds"],
            "most_modes": case["most_modes"], "tolerances": found,
            "sweep": [{"modes": n, "error": e if np.isfinite(e) else None} for n, e in sorted(known.items())]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="the beam alone, two tolerances")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    studies = ([study("beam", {**CASES["beam"], "rounds": 3}, TOLERANCES[:2])] if arguments.quick
               else [study(name, case, TOLERANCES) for name, case in CASES.items()])
    result = {"machine": run.machine(), "studies": studies}
    (arguments.output / "figures").mkdir(parents=True, exist_ok=True)
    if not arguments.quick:
        name = "thesis disc"
        result["methods"] = {"case": name, **by_method.study(sys.modules[__name__], CASES[name])}
        method_pages.draw(result["methods"], arguments.output / "figures" / "method_frontier.png")
    run.publish(arguments.output, "end_to_end", result, pages.table(result))
    pages.draw(result, arguments.output / "figures" / "end_to_end.png")
    print(pages.table(result))


if __name__ == "__main__":
    main()
