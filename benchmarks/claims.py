"""What README.md says of speed and accuracy, each sentence made of the results of `./dev bench`."""
import re

BEGIN, END = "<!-- made by ./dev bench: begin -->", "<!-- made by ./dev bench: end -->"


def elements(found):
    """DOFs from which on all finer meshes keep a limit at r_a/h = 8.1 on Gmsh's meshes."""
    fewest = {}
    for element in ("order 3", "S8R"):
        own = sorted((r for r in found["convergence"] if (r["ratio"], r["mesh"], r["element"])
                      == (8.1, "unstructured", element)), key=lambda r: -r["n_dofs"])
        for run in own:
            if run["rms_31"] is None or run["rms_31"] > 1e-4:
                break
            fewest[element] = run["n_dofs"]
    return [("Elements",
             "31 bending modes of a disc within 1e-4 of the exact plate need " + ", ".join(
                 f"{fewest[element]:,} DOFs with {name}" if element in fewest else f"more than the sweep has with {name}"
                 for element, name in (("order 3", "elements of order 3"), ("S8R", "S8R"))) + ", on Gmsh's meshes")]


def scale(found):
    largest = max((r for r in found["runs"] if r["ranks"] == 1), key=lambda r: r["dofs"])
    two = [r for r in found["runs"] if r["ranks"] == 2 and r["disc"] == largest["disc"]]
    ranks = f", {two[0]['wall_s']:.0f} s on two ranks" if two else ""
    return [("Reduction",
             f"{largest['dofs']:,} DOFs to 366 masters and 100 certified modes in {largest['wall_s']:.0f} s on one core{ranks}, "
             f"in {largest['peak_MiB'] / 1024:.1f} GiB")]


def accuracy(found):
    judged = [(c["modes"], c["judgement"]) for c in found["cases"]]
    low, high = (pick(j["effectivity"][i] for _, j in judged) for i, pick in enumerate((min, max)))
    whole = "and none is above its bound" if all(j["bounds_hold"] for _, j in judged) else "but a bound was broken"
    return [("Certificates",
             f"the error estimate of a frequency is {low:.1f} to {high:.1f} times its true error over all modes of "
             f"{len(judged)} reductions, {whole}")]


def peers(found):
    cases = "; ".join(f"{r['masters']} masters and {r['modes']} modes {r['ratio_alone']:.1f} times less than with eigsh as its "
                      f"documentation calls it, {r['ratio']:.1f} times less than with one factor for all" for r in found["runs"])
    return [("Beside scipy", f"CPU time of a reduction of {found['runs'][0]['dofs']:,} DOFs: {cases}")]


def calculix(found):
    last = found["runs"][-1]
    return [("Beside CalculiX",
             f"{last['modes']} modes of {last['elements']:,} elements with 8 nodes take "
             f"{last['ccx_cpu_s'] / last['chladni_modes_cpu_s']:.1f} times less CPU time, reduced to {last['masters']} masters "
             f"besides {last['ccx_cpu_s'] / last['chladni_reduce_cpu_s']:.1f} times less")]


def body(found):
    last = [c for c in found["chain"] if c["n_FE"] == 500][0]
    with_five = [[next(r for r in rows if (r["n_h"], r["omega0_over_omega_1"]) == (5, ratio))["Q"] for ratio in (None, 0.5)]
                 for rows in found["kept_modes"]["models"].values()]
    fallen = [f"from {without:.1g} to {with_frm:.1g}" for without, with_frm in with_five]
    return [("Body", f"another boundary condition of a reduced system of 500 coordinates takes {last['body']:.2f} s"),
            ("Response modes",
             f"one of them takes the error of the shear force with five modes, against the FE model, {', '.join(fallen[:-1])} "
             f"(two beams) and {fallen[-1]} (a plate strip)")]


def squeal(found):
    of = {t["name"]: t["measured"] for t in found["targets"]}

    def claim(what, sentence, *starts):
        """Of the targets whose names begin so; nothing when one was not measured."""
        values = [next((v for k, v in of.items() if k.startswith(start)), None) for start in starts]
        return [] if None in values else [(what, sentence.format(*values))]

    return [*claim("Squeal", "a transient of two modes takes {:.1g} of real time, of 35 modes {:.1g}",
                   "6 s transient", "transient of 35 modes"),
            *claim("Stability map", "100 x 100 points with 35 modes in {:.0f} s", "stability map of 100 x 100 points, 35"),
            *claim("Limit cycle", "found directly with {:.0f} (signed friction: {:.0f}) times fewer contact evaluations than by "
                   "the fastest transient", "those of the transient of 6 s by exponential over them, bilateral",
                   "those of the transient of 6 s by exponential over them, signed")]


def sound(found):
    of = lambda table: min((r for r in found if r["table"] == table), key=lambda r: r["error"])
    plane, space = of("disc, plane"), of("disc, space")
    seconds = lambda r: r["mesh_cpu_s"] + r["solve_cpu_s"]
    return [("Sound",
             f"the field of a squealing disc within {plane['error']:.0e} in {seconds(plane):.1f} s by Fourier series, within "
             f"{space['error']:.0e} in {seconds(space):.0f} s by tetrahedra")]


def end_to_end(found):
    both = [b for s in found["studies"] for b in s["tolerances"]]
    kept = [sum(b["chosen"][promise] for b in both) for promise in ("keeps_frequencies", "keeps_responses")]
    costs = [b["cost_over_best_by_hand"] or 0.0 for b in both]
    return [("Choice by tolerance",
             f"of {len(both)} tolerances asked {kept[0]} are kept by all frequencies of the range, {kept[1]} by the body's responses beside "
             f"the reduced system; {sum(c <= 2 for c in costs)} cost at most twice the cheapest choice by hand, the dearest "
             f"{max(costs):.1f} times")]


MAKERS = {"elements": elements, "scale": scale, "accuracy": accuracy, "peers": peers, "calculix": calculix,
          "body": body, "squeal": squeal, "sound": sound, "end-to-end": end_to_end}


def claims(benchmarks):
    """(what, sentence) of all benchmarks that ran."""
    return [claim for name, make in MAKERS.items() if "results" in benchmarks.get(name, {})
            for claim in make(benchmarks[name]["results"])]


def table(benchmarks):
    return ["| | |", "|---|---|", *(f"| {what} | {sentence} |" for what, sentence in claims(benchmarks))]


def put_into(readme, benchmarks):
    """The table between its marks in README.md."""
    text = readme.read_text(encoding="utf-8")
    made = "\n".join([BEGIN, *table(benchmarks), END])
    new, n = re.subn(f"{re.escape(BEGIN)}.*?{re.escape(END)}", lambda _: made, text, flags=re.S)
    if n != 1:
        raise SystemExit(f"claims.py: {readme} has no marks for the table of results")
    readme.write_text(new, encoding="utf-8")
