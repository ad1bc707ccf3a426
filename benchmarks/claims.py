"""What the index of docs/results/, README.md and other pages say of speed and accuracy, each sentence made of the results of `./dev bench`."""
import json
import re
from decimal import ROUND_CEILING, Context, Decimal
from itertools import takewhile

BEGIN, END = "<!-- made by ./dev bench: begin -->", "<!-- made by ./dev bench: end -->"
NAMES = {"craig-bampton": "Craig-Bampton", "rubin": "Rubin"}


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
    need = {element: f"{fewest[element]:,} DOFs" if element in fewest else "more DOFs than the sweep has" for element in ("order 3", "S8R")}
    return [f"31 bending modes within 1e-4 (rms) of the exact plate need {need['order 3']} with elements of order 3, on meshes of Gmsh",
            f"the same with our own implementation of S8R needs {need['S8R']}"]


def scale(found):
    largest = max((r for r in found["runs"] if r["ranks"] == 1), key=lambda r: r["dofs"])
    two = [r for r in found["runs"] if r["ranks"] == 2 and r["disc"] == largest["disc"]]
    ranks = f", {two[0]['wall_s']:.0f} s on two ranks" if two else ""
    return [f"{largest['dofs']:,} DOFs to 366 masters and 100 modes with error estimates: {largest['wall_s']:.0f} s on one core{ranks}",
            f"peak memory on one core: {largest['peak_MiB'] / 1024:.1f} GiB"]


def accuracy(found):
    judged = [c["judgement"] for c in found["cases"]]
    ends = lambda key: "{:.2f} to {:.2f}".format(*(pick(j[key][i] for j in judged) for i, pick in enumerate((min, max))))
    modes, bounded = (sum(j[key] for j in judged) for key in ("modes", "bounded"))
    whole = "none of these frequencies has an error above its bound" if all(j["bounds_hold"] for j in judged) else (
        "**one of these frequencies has an error above its bound**")
    return [f"below half of the last fixed-interface lambda the estimated error is {ends('effectivity')} times the true error "
            f"({len(judged)} reductions, with and without masses)",
            f"over all {modes} modes compared it is {ends('effectivity_of_all')} times the true error",
            f"{bounded} of them have a bound; {whole}"]


def usage(program):
    return f"{program['cpu_s']:.1f} s, {program['peak_MiB']:.0f} MiB"


def peers(found):
    def case(run):
        own, shared, alone = (run["programs"][name] for name in ("chladni", "scipy, one factor", "scipy, eigsh alone"))
        head = f"{run['dofs']:,} DOFs to {run['masters']} masters and {run['modes']} modes"
        return [f"{head}: {usage(own)} (CPU time, peak memory)",
                f"scipy with one factor for all: {shared['cpu_s'] / own['cpu_s']:.1f} times that CPU time ({usage(shared)})",
                f"scipy, eigsh as its documentation calls it: {alone['cpu_s'] / own['cpu_s']:.1f} times that CPU time ({usage(alone)})",
                f"median error of {run['compared']} frequencies against the exact plate: {own['error']['median']:.1e}, scipy "
                f"{shared['error']['median']:.1e}"]

    return [fact for run in found["runs"] for fact in case(run)]


def calculix(found):
    last = found["runs"][-1]
    ccx, modes, reduced = (last["programs"][name] for name in ("ccx", "chladni modes", "chladni reduce"))
    error = lambda program, theory: f"{program[theory]['median']:.1e} ({program[theory]['largest']:.1e} at most)"
    return [f"{last['modes']} modes of {last['elements']:,} elements with 8 nodes: {usage(modes)}; ccx {usage(ccx)}, "
            f"{ccx['cpu_s'] / modes['cpu_s']:.1f} times the CPU time",
            f"with a reduction to {reduced['masters']} masters besides, ccx takes {ccx['cpu_s'] / reduced['cpu_s']:.1f} times the CPU time",
            f"median error against the exact plate {error(modes, 'plate')}, ccx {error(ccx, 'plate')}",
            f"against the exact solid {error(modes, 'solid')}, ccx {error(ccx, 'solid')}",
            f"ccx, which has no shear correction, against the plate without it: {error(ccx, 'plate_kappa_1')}"]


def solids(found):
    def times(run, name):
        other, own = run["programs"].get(name), run["programs"]["chladni modes"]
        if not other:
            return []
        more = "more than " if other.get("stopped") else ""
        return [f"{name} takes {more}{other['cpu_s'] / own['cpu_s']:.1f} times that CPU time"]

    def case(run):
        return "; ".join([f"{run['modes']} modes of {run['dofs']:,} DOFs: {usage(run['programs']['chladni modes'])}", *times(run, "ccx"), *times(run, "scipy")])

    far = max(p["from_chladni"] for run in found["runs"] for p in run["programs"].values() if not p.get("stopped"))
    large = found.get("large")
    return [*map(case, found["runs"]), f"frequencies of the three programs differ by at most {far:.0e} on one mesh",
            *([f"a ring of {large['dofs']:,} DOFs to its hub and {large['modes']} modes: {large['wall_s'] / 60:.1f} minutes on one core, "
               f"{large['peak_MiB'] / 1024:.1f} GiB, of which the forecast is {large['forecast_MiB'] / large['peak_MiB']:.2f}"] if large else [])]  # fmt: skip


def solid_disc(found):
    shell, solid = found["shell"], found["solid"]
    return [f"critical speed of the pair with three nodal diameters: {shell['critical_speed']:.3f} rad/s as a shell, {solid['critical_speed']:.3f} as a solid",
            f"its frequency: {shell['pair_Hz']:.1f} and {solid['pair_Hz']:.1f} Hz"]


def body(found):
    last = [c for c in found["chain"] if c["n_FE"] == 500][0]
    with_five = {name: [next(r for r in rows if (r["n_h"], r["omega0_over_omega_1"]) == (5, ratio))["Q"] for ratio in (None, 0.5)]
                 for name, rows in found["kept_modes"]["models"].items()}
    return [f"another boundary condition of a reduced system of 500 coordinates: {last['body']:.2f} s",
            *(f"{name}: one frequency response mode takes the error of the shear force with five modes from {without:.1g} to {with_frm:.1g}"
              for name, (without, with_frm) in with_five.items())]


def squeal_targets(found):
    targets = {t["name"]: t for t in found["targets"]}
    starting = lambda start: next((t for name, t in targets.items() if name.startswith(start)), None)
    pair, many, plane = map(starting, ("6 s transient", "transient of 35 modes", "stability map of 100 x 100 points, 35"))
    said = []
    if plane:
        met = "met" if plane["measured"] < plane["target"] else "**missed**"
        said.append(f"stability map of 100 x 100 points with 35 modes: {plane['measured']:.2g} s (target {plane['target']:.0f} s: {met})")
    if pair and many:
        said.append(f"CPU time of a transient over the simulated time: {pair['measured']:.1g} with two modes, {many['measured']:.1g} with 35")
    least = {}  # over the integrators, by the law
    for name, target in targets.items():
        if name.startswith("those of the transient of 6 s by "):
            law = name.rsplit(", ", 1)[1]
            least[law] = min(target["measured"], least.get(law, target["measured"]))
    said += [f"limit cycle found directly ({law} contact): {ratio:.0f} times fewer contact evaluations than a transient of 6 s by the "
             "integrator that needs fewest" for law, ratio in least.items()]
    return said


def squeal(found):
    modes = found.get("modes")
    if not modes:
        return squeal_targets(found)
    thin = modes["discs"][0]["rows"]
    alone, last = thin[0], thin[-1]
    return [*squeal_targets(found),
            f"critical speed of the pair with three nodal diameters: {alone['branch_over_pi']:.3f} pi rad/s by itself, "
            f"{last['branch_over_pi']:.3f} pi with {last['modes']} modes, where another pair squeals from "
            f"{last['critical_over_pi']:.3f} pi on",
            f"largest relative difference from critical speeds computed without this code: {upwards(modes['largest_difference'])}"]


def upwards(value):
    """With two digits, rounded up."""
    return f"{Context(prec=2, rounding=ROUND_CEILING).plus(Decimal(repr(value))):.1e}"


def sound(found):
    of = lambda table: min((r for r in found if r["table"] == table), key=lambda r: r["error"])
    plane, space = of("disc, plane"), of("disc, space")
    seconds = lambda r: r["mesh_cpu_s"] + r["solve_cpu_s"]
    return [f"field of a squealing disc by Fourier series: error {upwards(plane['error'])} in {seconds(plane):.1f} s",
            f"by tetrahedra: error {upwards(space['error'])} in {seconds(space):.0f} s"]


def end_to_end(found):
    both = [b for s in found["studies"] for b in s["tolerances"]]
    kept = [sum(b["chosen"][promise] for b in both) for promise in ("keeps_frequencies", "keeps_responses")]
    # Where no choice by hand keeps both promises, the automatic one is the cheapest.
    costs = [(b["cost_over_best_by_hand"] if b["hand_with_responses"] else 0.0) for b in both]
    return [f"of {len(both)} tolerances asked, {kept[0]} are kept by all frequencies of the range, {kept[1]} by the body's responses "
            "beside the FE model",
            f"{sum(c <= 1.3 for c in costs)} cost at most 1.3 times the cheapest choice by hand that keeps both, the dearest {max(costs):.2f} times"]


def scenes(found):
    given = [row for row in found["rows"] if "true" in row]
    near = sum(row["told"] <= 5.0 * max(row["true"], 1e-7) for row in given)
    return [f"{len(given)} of {len(found['rows'])} scenes that ask for an accuracy get an answer, {sum(row['true'] <= row['asked'] for row in given)} of "
            "them with that accuracy",
            f"the error that is told is at most five times the true one in {near} of these"]


def ranks(found):
    last = max((r for r in found["runs"] if r["ranks"] <= 16), key=lambda r: (r["dofs"], r["ranks"]))
    further = [f"carried on to four million DOFs: {100 * found['carried_on'][n]:.0f} % efficiency on {n}" for n in ("16", "64")
               if n in found.get("carried_on", {})]
    return [f"{last['dofs']:,} DOFs on {last['ranks']} ranks: {last['speedup']:.1f} times faster than on one, by a model of the counts", *further]


def methods(found):
    """How many frequencies of the most modes are right to 1e-4."""
    cases = found["cases"]
    rows = []
    for model, support in dict.fromkeys((c["model"], c["support"]) for c in cases):
        own = [c for c in cases if (c["model"], c["support"]) == (model, support)]
        most = [c for c in own if c["modes"] == max(c["modes"] for c in own)]
        right = ", ".join(f"{NAMES[c['method']]} {sum(1 for _ in takewhile(lambda e: abs(e) < 1e-4, c['error']))}" for c in most)
        rows.append(f"{model}, {support}, {most[0]['modes']} modes in the basis; frequencies right to 1e-4, counted from the first: {right}")
    return rows


def rings(found):
    whole, ten = (next(c for c in found["cases"] if c["harmonics"] == n) for n in (None, 10))
    return [f"10 harmonics of the ring in place of all its DOFs: {ten['masters']} masters in place of {whole['masters']}, critical speed "
            f"changed by {upwards(abs(ten['critical_speed_rad_s'] / whole['critical_speed_rad_s'] - 1))}",
            f"file of the reduced system: {ten['file_MiB']:.1f} MiB in place of {whole['file_MiB']:.1f} MiB"]


def sectors(found):
    largest = max(found["growth"], key=lambda r: r["sectors"])
    one, whole = largest["one sector"], largest["whole disc"]
    return [f"disc of {largest['sectors']} sectors, {largest['dofs']:,} DOFs: {whole['cpu_s'] / one['cpu_s']:.1f} times less CPU time and "
            f"{whole['peak_MiB'] / one['peak_MiB']:.1f} times less memory than by the whole disc",
            f"its frequencies differ from those of the whole disc by at most {upwards(largest['difference'])}"]


def many_modes(found):
    last = found["cases"][-1]
    of = lambda method: next(r["cpu_s"] for r in last["rows"] if r["method"] == method)
    return [f"{last['modes']} fixed-interface modes of {found['slaves']:,} slaves by block Lanczos: {of('block Lanczos'):.1f} s",
            f"by the Krylov-Schur method of SLEPc: {of('Krylov-Schur'):.1f} s"]


def response_modes(found):
    def error(kind):
        own = [b for b in found["bodies"] if b["responses"] == kind and b["up_to_Hz"] == found["bodies"][0]["up_to_Hz"]]
        return upwards(own[0]["errors"]["critical"])

    first = found["bodies"][0]
    return [f"modes up to {first['up_to_Hz'] / 1000:.0f} kHz: relative error of the critical speed {error('none')} without frequency response "
            f"modes, {error('axial and slopes')} with them"]


def friction_matrices(found):
    """What each method finds of the unstable eigenvalues at all frictions together, and its time."""
    said = []
    for method in ("whole", "enriched", "modes", "samples"):
        rows = [row for row in found["rows"] if row["method"].startswith(method)]
        of, hit, near = (sum(row[key] for row in rows) for key in ("of", "found", "growth_within_1_percent"))
        said.append(f"{method}: {hit} of {of} unstable eigenvalues of {found['n_dofs']:,} DOFs at {len(rows)} frictions, the growth of {near} within 1 %, "
                    f"in {sum(row['seconds'] for row in rows):.0f} s")
    return said


MAKERS = {"elements": elements, "scale": scale, "ranks": ranks, "methods": methods, "rings": rings, "sectors": sectors,
          "many-modes": many_modes, "response-modes": response_modes, "accuracy": accuracy, "peers": peers, "calculix": calculix,
          "solids": solids, "friction-matrices": friction_matrices, "solid-disc": solid_disc, "body": body, "squeal": squeal, "sound": sound, "end-to-end": end_to_end,
          "scenes": scenes}


def facts(name, results):
    """Short sentences of one benchmark; none of a benchmark without a maker, or of results in the form of an older commit."""
    try:
        return MAKERS[name](results) if name in MAKERS else []
    except (KeyError, TypeError):
        return []


def three_lines(results):
    """What README.md says: size, speed beside another program, and correctness of the squeal."""
    largest = max((r for r in results["scale"]["runs"] if r["ranks"] == 1), key=lambda r: r["dofs"])
    shares = [run["programs"]["scipy, one factor"]["cpu_s"] / run["programs"]["chladni"]["cpu_s"] for run in results["peers"]["runs"]]
    difference = results["squeal"]["modes"]["largest_difference"]
    return [f"- **Size:** {largest['dofs']:,} DOFs become 366 masters and 100 modes, each frequency with its estimated error, in "
            f"{largest['wall_s']:.0f} s on one core ([reduction over size](docs/results/reduction_scale.md)).",
            f"- **Speed:** a reduction takes {min(shares):.1f} to {max(shares):.1f} times less CPU time than scipy with one factorisation, at the "
            "same error ([beside scipy](docs/results/reduction_peers.md)).",
            f"- **Squeal:** critical speeds differ by at most {upwards(difference)} (relative) from values computed without this code "
            "([squeal benchmarks](docs/results/squeal_benchmarks.md))."]


def put_into(text, results):
    """The text of README.md with the three lines between their marks."""
    made = "\n".join([BEGIN, *three_lines(results), END])
    new, n = re.subn(f"{re.escape(BEGIN)}.*?{re.escape(END)}", lambda _: made, text, flags=re.S)
    if n != 1:
        raise SystemExit("claims.py: README.md has no marks for the lines of results")
    return new


def largest_disc(folder):
    size, memory = scale(read(folder, "reduction_scale"))
    return f"{size.split(' to ')[0]}: {size.split(': ')[1].split(',')[0]} and {memory.split(': ')[1]}"


def faster_modes(folder):
    """How many times the CPU time of Krylov-Schur is that of block Lanczos."""
    ratios = []
    for case in read(folder, "reduction_many_modes")["cases"]:
        of = {row["method"]: row["cpu_s"] for row in case["rows"]}
        ratios.append(f"{of['Krylov-Schur'] / of['block Lanczos']:.1f} times for {case['modes']} modes")
    return ", ".join(ratios)


def kept_tolerances(folder):
    return end_to_end(read(folder, "end_to_end"))[0]


def minutes_of_demo(folder):
    """As the log of a newcomer has it, who has the packages and no compiler cache."""
    log = (folder / "newcomer.md").read_text(encoding="utf-8")
    return f"{float(re.search(r'## `./dev demo`[^0-9]*([0-9]+) s', log)[1]) / 60:.0f} minutes on {re.search(r'- machine: .*, ([0-9]+ cores)', log)[1]}"


def minutes_of_first_steps(folder):
    return re.search(r"after ([0-9]+ minutes) in all", (folder / "newcomer.md").read_text(encoding="utf-8"))[1]


def read(folder, stem):
    return json.loads((folder / f"{stem}.json").read_text(encoding="utf-8"))


# Pieces of sentences that pages quote between <!-- bench: NAME --> and <!-- end -->.
QUOTES = {"largest disc": largest_disc, "block lanczos": faster_modes, "tolerances": kept_tolerances, "demo": minutes_of_demo,
          "first steps": minutes_of_first_steps}
QUOTED = re.compile(r"(<!-- bench: ([\w ]+) -->)(.*?)(<!-- end -->)", re.S)


def quote(text, folder):
    """The text of a page with all that it quotes as the results of a folder have it."""
    return QUOTED.sub(lambda found: found[1] + QUOTES[found[2]](folder) + found[4], text)
