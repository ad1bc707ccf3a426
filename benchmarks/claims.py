"""What README.md says of speed and accuracy, each sentence made of the results of `./dev bench`."""
import re
from decimal import ROUND_CEILING, Context, Decimal

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
             "31 bending modes of a disc within 1e-4 of the exact plate (rms of their errors) need " + ", ".join(
                 f"{fewest[element]:,} DOFs with {name}" if element in fewest else f"more than the sweep has with {name}"
                 for element, name in (("order 3", "elements of order 3"), ("S8R", "our own implementation of S8R"))) +
             ", on Gmsh's meshes")]


def scale(found):
    largest = max((r for r in found["runs"] if r["ranks"] == 1), key=lambda r: r["dofs"])
    two = [r for r in found["runs"] if r["ranks"] == 2 and r["disc"] == largest["disc"]]
    ranks = f", {two[0]['wall_s']:.0f} s on two ranks" if two else ""
    return [("Reduction",
             f"{largest['dofs']:,} DOFs to 366 masters and 100 modes, the error of each frequency estimated, in {largest['wall_s']:.0f} s on one core{ranks}, "
             f"in {largest['peak_MiB'] / 1024:.1f} GiB")]


def accuracy(found):
    judged = [c["judgement"] for c in found["cases"]]
    ends = lambda key: "{:.2f} to {:.2f}".format(*(pick(j[key][i] for j in judged) for i, pick in enumerate((min, max))))
    modes, bounded = (sum(j[key] for j in judged) for key in ("modes", "bounded"))
    whole = "none is above its bound" if all(j["bounds_hold"] for j in judged) else "**one is above its bound**"
    return [("Certificates",
             f"the estimated error that is printed for a frequency is {ends('effectivity')} times its true error in {len(judged)} "
             f"reductions, with and without masses, below half of the last fixed-interface lambda, {ends('effectivity_of_all')} times "
             f"over all {modes} modes compared; {bounded} of them have a bound, and {whole}")]


def usage(program):
    return f"{program['cpu_s']:.1f} s and {program['peak_MiB']:.0f} MiB"


def peers(found):
    def case(run):
        own, shared, alone = (run["programs"][name] for name in ("chladni", "scipy, one factor", "scipy, eigsh alone"))
        return (f"{run['masters']} masters and {run['modes']} modes {usage(own)}; {alone['cpu_s'] / own['cpu_s']:.1f} times less time "
                f"than with eigsh as its documentation calls it ({usage(alone)}), {shared['cpu_s'] / own['cpu_s']:.1f} times less "
                f"than with one factor for all ({usage(shared)}), with the same error against the exact plate, "
                f"{own['error']['median']:.1e} and {shared['error']['median']:.1e} (median of {run['compared']} frequencies)")

    return [("Beside scipy", f"CPU time and peak memory of a reduction of {found['runs'][0]['dofs']:,} DOFs: " +
             "; ".join(case(run) for run in found["runs"]))]


def calculix(found):
    last = found["runs"][-1]
    ccx, modes, reduced = (last["programs"][name] for name in ("ccx", "chladni modes", "chladni reduce"))
    error = lambda program, theory: f"{program[theory]['median']:.1e} ({program[theory]['largest']:.1e} at most)"
    return [("Beside CalculiX",
             f"{last['modes']} modes of {last['elements']:,} elements with 8 nodes take {usage(modes)}, {ccx['cpu_s'] / modes['cpu_s']:.1f} "
             f"times less CPU time than by ccx ({usage(ccx)}), reduced to {reduced['masters']} masters besides "
             f"{ccx['cpu_s'] / reduced['cpu_s']:.1f} times less; median error against the exact plate {error(modes, 'plate')}, ccx "
             f"{error(ccx, 'plate')}; against the exact solid {error(modes, 'solid')}, ccx {error(ccx, 'solid')}; ccx, which has "
             f"no shear correction, is {error(ccx, 'plate_kappa_1')} from the plate without it")]


def body(found):
    last = [c for c in found["chain"] if c["n_FE"] == 500][0]
    with_five = [[next(r for r in rows if (r["n_h"], r["omega0_over_omega_1"]) == (5, ratio))["Q"] for ratio in (None, 0.5)]
                 for rows in found["kept_modes"]["models"].values()]
    fallen = [f"from {without:.1g} to {with_frm:.1g}" for without, with_frm in with_five]
    return [("Body", f"another boundary condition of a reduced system of 500 coordinates takes {last['body']:.2f} s"),
            ("Response modes",
             f"one of them takes the error of the shear force with five modes, against the FE model, {', '.join(fallen[:-1])} "
             f"(two beams) and {fallen[-1]} (a plate strip)")]


def squeal_targets(found):
    targets = {t["name"]: t for t in found["targets"]}
    starting = lambda start: next((t for name, t in targets.items() if name.startswith(start)), None)
    pair, many, plane = map(starting, ("6 s transient", "transient of 35 modes", "stability map of 100 x 100 points, 35"))
    said = []
    if pair and many:
        said.append(("Squeal", f"a transient of two modes takes {pair['measured']:.1g} of real time, of 35 modes {many['measured']:.1g}"))
    if plane:
        met = "met" if plane["measured"] < plane["target"] else "**missed**"
        said.append(("Stability map", f"100 x 100 points with 35 modes in {plane['measured']:.2g} s (target {plane['target']:.0f} s: {met})"))
    least = {}  # over the integrators, by the law
    for name, target in targets.items():
        if name.startswith("those of the transient of 6 s by "):
            law = name.rsplit(", ", 1)[1]
            least[law] = min(target["measured"], least.get(law, target["measured"]))
    if least:
        said.append(("Limit cycle", "found directly with " + ", ".join(f"{ratio:.0f} ({law})" for law, ratio in least.items()) +
                     " times fewer contact evaluations than the transient of 6 s by the integrator that needs fewest"))
    return said


def squeal(found):
    modes = found.get("modes")
    if not modes:
        return squeal_targets(found)
    thin = modes["discs"][0]["rows"]
    alone, last = thin[0], thin[-1]
    return [*squeal_targets(found),
            ("Modes in a critical speed",
             f"the pair with three nodal diameters squeals from {alone['branch_over_pi']:.3f} pi rad/s on by itself, from "
             f"{last['branch_over_pi']:.3f} pi with {last['modes']} modes, and another pair from {last['critical_over_pi']:.3f} pi; at most "
             f"{upwards(modes['largest_difference'])} from values computed without this code")]


def upwards(value):
    """With two digits, rounded up."""
    return f"{Context(prec=2, rounding=ROUND_CEILING).plus(Decimal(repr(value))):.1e}"


def sound(found):
    of = lambda table: min((r for r in found if r["table"] == table), key=lambda r: r["error"])
    plane, space = of("disc, plane"), of("disc, space")
    seconds = lambda r: r["mesh_cpu_s"] + r["solve_cpu_s"]
    return [("Sound",
             f"the field of a squealing disc within {upwards(plane['error'])} in {seconds(plane):.1f} s by Fourier series, within "
             f"{upwards(space['error'])} in {seconds(space):.0f} s by tetrahedra")]


def end_to_end(found):
    both = [b for s in found["studies"] for b in s["tolerances"]]
    kept = [sum(b["chosen"][promise] for b in both) for promise in ("keeps_frequencies", "keeps_responses")]
    costs = [b["cost_over_best_by_hand"] or 0.0 for b in both]
    return [("Choice by tolerance",
             f"of {len(both)} tolerances asked {kept[0]} are kept by all frequencies of the range, {kept[1]} by the body's responses beside "
             f"the FE model; {sum(c <= 2 for c in costs)} cost at most twice the cheapest choice by hand, the dearest "
             f"{max(costs):.1f} times")]


MAKERS = {"elements": elements, "scale": scale, "accuracy": accuracy, "peers": peers, "calculix": calculix,
          "body": body, "squeal": squeal, "sound": sound, "end-to-end": end_to_end}


def claims_of(name, results):
    """Those of one benchmark; of results in the form of an older commit only that."""
    try:
        return MAKERS[name](results)
    except (KeyError, TypeError):
        return [(name, "measured by an older commit, in another form: `bench.py --only` has left it as it was")]


def claims(benchmarks):
    """(what, sentence) of all benchmarks that ran."""
    return [claim for name in MAKERS if "results" in benchmarks.get(name, {})
            for claim in claims_of(name, benchmarks[name]["results"])]


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
