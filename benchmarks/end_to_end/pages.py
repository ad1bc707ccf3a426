"""The page and the figure of frontier.py."""
import method_pages

MAX_COST = 1.3  # of the automatic choice, over the best choice by hand

ABOUT = """# End to end: tolerance asked, error reached, time spent

Written by `benchmarks/end_to_end/frontier.py`; {processor}, commit {commit}.

The scenes are those of `examples/`, the discs on coarser meshes ({dofs} DOFs), so that each run can be repeated.
A tolerance makes two promises, and each is judged by itself, for loads at all nodes of `track` (discs) or at `B` (beam):

- **Frequencies** (`reduce.tolerance`): all modes of the range of the reduced system under its support, each against the mode of the
  same rank of the full model (`chladni modes`). A mode that is missing shifts all behind it, so it is noticed. `within` is the number of modes that
  keep the tolerance, of how many.
- **Responses** (`keep.tolerance`): the body's responses at the loaded DOFs over the whole range, resonances included, with 1 % of the
  critical damping, against those of the complete reduced system, on another grid of frequencies than the program's; and against
  those of the FE model at the middles of the widest gaps between frequencies, without damping. The responses of the FE model are those of a reduced
  system that contains its responses to all loads and to the forces of the support at that frequency (`space = "full"`), which are exact
  there. Both are to be below the tolerance.

`kept in the body`: modes of the range that are modes of the body. A body may leave out those that the loads do not excite, such as
the modes in the plane of a disc that is loaded along its normal; the responses show whether it was right to.

**By hand, frequencies alone**: the cheaper of the smallest number of fixed-interface modes whose frequencies keep the tolerance, by bisection, and of as many
mixed-interface modes as the range has; with all modes of the range and a frequency-response mode of each load in the body. **By hand, responses too**: all
modes up to a multiple of the range, in the reduction and in the body, of the method and with the smallest multiple that keep both promises. Cost: CPU seconds of all phases from the mesh to the body, without the start of the
program; the least of {rounds} runs in turn, to which other work of the machine adds least. The choice by hand knows the full model's frequencies and responses; the cost of finding it is not counted.

![Error against tolerance, and against cost](figures/end_to_end.png)
"""

FE = """## The body beside the FE model

`above` is above the tolerance. `by hand` is that of the frequencies alone: the body has the modes of the range, and this table shows the error by what it lacks
beyond them."""

OVER = """`by hand` keeps both promises, as the automatic choice does; `frequencies alone` keeps the first. Only the automatic choice prints its errors: it
bounds those of the responses, and this is part of its cost."""


def verdict(holds):
    return "holds" if holds else "**missed**"


def row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def header(*cells):
    return [row(*cells), "|" + "---|" * len(cells)]


def promises(studies):
    yield from header("scene", "tolerance", "method", "modes of the reduction", "frequencies: error", "within", "",
                      "responses: error, of the body", "against the FE model", "", "kept in the body", "coordinates")
    for one in studies:
        for both in one["tolerances"]:
            c = both["chosen"]
            yield row(one["case"], f"{c['tolerance']:g}", c["method"], c["modes"], f"{c['error']:.1e}",
                      f"{c['within']} of {c['expected']}", verdict(c["keeps_frequencies"]), f"{c['response_error']:.1e}",
                      f"{c['response_error_full']:.1e}", verdict(c["keeps_responses"]),
                      f"{c['kept_in_range']} of {c['expected']}", c["size"])


def against_fe(studies):
    yield from header("scene", "tolerance", "at, Hz", "by tolerance", "by hand")
    for one in studies:
        for both in one["tolerances"]:
            asked = both["chosen"]["tolerance"]
            errors = [both[name]["response_error_full"] for name in ("chosen", "hand")]
            yield row(one["case"], f"{asked:g}", ", ".join(f"{f:.0f}" for f in one["compared_at_Hz"]),
                      *(f"{e:.1e}" + ("" if e <= asked else ", above") for e in errors))


def costs(studies):
    yield from header("scene", "tolerance", "chosen, s", "method", "modes", "by hand, s", "method", "up to, of the range", "modes", "frequencies alone, s",
                      "method", "modes", "fixed-interface modes that do", "chosen over frequencies alone", "chosen over by hand", f"at most {MAX_COST:g}")
    for one in studies:
        for both in one["tolerances"]:
            c, hand, alone, ratio = both["chosen"], both["hand_with_responses"], both["hand"], both["cost_over_best_by_hand"]
            by_hand = [f"{hand['cost_s']:.3g}", hand["method"], hand["multiple"] or 1, hand["modes"]] if hand else ["none"] + 3 * [""]
            judged = [f"{ratio:.2f}", verdict(ratio <= MAX_COST)] if hand else ["", "holds"]
            yield row(one["case"], f"{c['tolerance']:g}", f"{c['cost_s']:.3g}", c["method"], c["modes"], *by_hand, f"{alone['cost_s']:.3g}",
                      alone["method"], alone["modes"], both["fixed_interface_modes"] or f"above {one['most_modes']}",
                      f"{both['cost_over_frequencies_by_hand']:.2f}", *judged)


def sweeps(studies):
    for one in studies:
        yield from ["", f"{one['case']}: {one['dofs']} DOFs, {one['modes_in_range']} modes up to {one['up_to_Hz']:g} Hz.", ""]
        told = one["sweep"][::2]
        yield from header("modes", *(s["modes"] for s in told))
        yield row("error of the frequencies", *("too few" if s["error"] is None else f"{s['error']:.1e}" for s in told))


def of_methods(result):
    """None of a quick run."""
    found = result.get("methods")
    return ["", *method_pages.section(found, row, header)] if found else []


def table(result):
    studies = result["studies"]
    of_each = lambda form: ", ".join(form.format(**s) for s in studies)
    about = ABOUT.format(**result["machine"], rounds=of_each("{rounds} ({case})"), dofs=of_each("{case}: {dofs}"))
    lines = [about, "## What is promised and what is kept", "", *promises(studies), "", FE, "", *against_fe(studies), "",
             "## What it costs", "", OVER, "", *costs(studies), *of_methods(result), "",
             "## Error of the frequencies over the number of fixed-interface modes", "",
             "Of one reduction with the most modes, whose matrices have those of fewer modes as corners.", *sweeps(studies)]
    return "\n".join(lines) + "\n"


RED, BLUE, GREY = "#b2182b", "#2166ac", "0.45"
FLOOR = 1e-6  # errors below are drawn there: they would squeeze the others
KINDS = [("error", "o", RED, f"frequencies, against the full model ({FLOOR:g} or less)"),
         ("response_error", "s", BLUE, "responses, against the reduced system"),
         ("response_error_full", "x", GREY, "responses between resonances, against the FE model")]


def draw_promises(axis, study):
    """Error reached over tolerance asked; below the line is kept."""
    asked = [both["chosen"]["tolerance"] for both in study["tolerances"]]
    for key, marker, colour, label in KINDS:
        axis.loglog(asked, [max(both["chosen"][key], FLOOR) for both in study["tolerances"]], marker + "-", color=colour,
                    label=label, linewidth=1)
    axis.loglog(asked, asked, "--", color="k", linewidth=0.8, label="asked")
    axis.set_xlim(2 * max(asked), min(asked) / 2)
    axis.set_xlabel("tolerance asked")
    axis.set_title(f"{study['case']}, to {study['up_to_Hz']:g} Hz", fontsize=10)
    axis.grid(True, which="major", alpha=0.25)


def ticks(low, high):
    """Round numbers of a logarithmic axis: three at least, if need be of closer ones."""
    for steps in ((1, 2, 5), (1, 1.5, 2, 3, 4, 5, 7), (1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9)):
        found = [step * 10.0**power for power in range(-6, 7) for step in steps if low <= step * 10.0**power <= high]
        if len(found) > 2:
            break
    return found


def draw_costs(axis, study):
    """Error of the responses over cost: a line from the choice by hand for frequencies to the automatic one for each tolerance."""
    from matplotlib.ticker import FixedLocator, FormatStrFormatter, NullFormatter
    for both in study["tolerances"]:
        x, y = zip(*((both[name]["cost_s"], both[name]["response_error_full"]) for name in ("hand", "chosen")))
        axis.plot(x, y, "-", color=GREY, linewidth=0.7)
    for name, colour, label in (("hand", GREY, "by hand: modes of the range"), ("hand_with_responses", BLUE, "by hand: responses too"),
                                ("chosen", RED, "by tolerance")):
        points = [both[name] for both in study["tolerances"] if both[name]]
        axis.loglog([p["cost_s"] for p in points], [p["response_error_full"] for p in points], "o", color=colour, label=label)
        for p in points:
            axis.annotate(f" {p['modes']}", (p["cost_s"], p["response_error_full"]), fontsize=7, color=colour, va="bottom")
    for both in study["tolerances"]:
        axis.axhline(both["chosen"]["tolerance"], color="k", linestyle="--", linewidth=0.5)
    costs_s = [both[name]["cost_s"] for both in study["tolerances"] for name in ("hand", "hand_with_responses", "chosen") if both[name]]
    axis.set_xlim(0.7 * min(costs_s), 1.5 * max(costs_s))
    axis.xaxis.set_major_locator(FixedLocator(ticks(*axis.get_xlim())))
    axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_xlabel("CPU time of all phases, s")
    axis.grid(True, which="major", alpha=0.25)


def draw(result, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    studies = result["studies"]
    figure, axes = plt.subplots(2, len(studies), figsize=(4.4 * len(studies), 7.4), layout="constrained", squeeze=False)
    for column, study in zip(axes.T, studies):
        draw_promises(column[0], study)
        draw_costs(column[1], study)
    axes[0][0].set_ylabel("relative error reached")
    axes[1][0].set_ylabel("error of the responses beside the FE model")
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper center", fontsize=8, ncols=min(2, len(studies)))
    figure.get_layout_engine().set(rect=(0, 0, 1, 0.89))  # below the legend
    axes[1][0].legend(fontsize=8)
    figure.savefig(path, dpi=130)
    plt.close(figure)
