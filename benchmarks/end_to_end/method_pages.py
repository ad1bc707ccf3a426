"""The section and the figure of by_method.py."""

ABOUT = """## Speed against error of the methods

{name} up to {up_to_Hz:g} Hz, its hub held: the largest error of the {modes_in_range} frequencies of the range by rank, against the FE model of the same mesh and
against the exact Mindlin plate. The difference of the two is the error of the mesh. Against the exact plate no method is better than its mesh, so more modes do not help below that error.
Cost: CPU seconds of all phases from the mesh to the reduced system, of one run; with `accuracy` those of the search for the mesh, too. Coordinates are those of the reduced
system, of which {masters} are the masters. Dotted in the figure: other meshes.

![Error over cost and over coordinates, against the FE model and the exact plate](figures/method_frontier.png)
"""


def told(error):
    return "-" if error is None else f"{error:.1e}"


def section(found, row, header):
    """Lines of the page; `row` and `header` are those of its tables."""
    yield ABOUT.format(name=found["case"].capitalize(), **found)
    yield from header("method", "mesh", "DOFs", "modes", "coordinates", "cost, s", "error against the FE model", "against the exact plate")
    for one in found["runs"] + found["by_accuracy"]:
        mesh = f"elements of {1000 * one['element_size']:g} mm" if "element_size" in one else f"by accuracy {one['accuracy']:g}"
        yield row(one["method"], mesh, one["dofs"], one["modes"], one["size"], f"{one['cost_s']:.2f}", told(one["error_fe"]), told(one["error_exact"]))


COLOURS = {"guyan": "k", "craig-bampton": "#2166ac", "rubin": "#1b7837", "mixed-interface": "#b2182b"}
FLOOR = 1e-8  # errors below are drawn there
AXES = [("cost_s", "CPU time, s"), ("size", "coordinates")]
ERRORS = [("error_fe", "error against the FE model"), ("error_exact", "error against the exact plate")]


def draw_runs(axis, found, x, y):
    sizes = sorted({one["element_size"] for one in found["runs"]})
    for method, colour in COLOURS.items():
        for size in sizes:
            own = [one for one in found["runs"] if (one["method"], one["element_size"]) == (method, size) and one[y] is not None]
            is_main = size == sizes[len(sizes) // 2]
            axis.loglog([one[x] for one in own], [max(one[y], FLOOR) for one in own], "o-" if is_main else "o:", color=colour, linewidth=0.8,
                        markersize=5 if is_main else 3, label=method if is_main else None)
    own = [one for one in found["by_accuracy"] if one[y] is not None]
    if own:
        axis.loglog([one[x] for one in own], [one[y] for one in own], "*-", color="#762a83", markersize=10, linewidth=0.8, label="by accuracy")
        for one in own:
            axis.annotate(f"  {one['accuracy']:g}", (one[x], one[y]), fontsize=7, color="#762a83", va="bottom")


def draw(found, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FormatStrFormatter, LogLocator
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.6), layout="constrained", sharex="col")
    for line, (y, y_label) in zip(axes, ERRORS):
        for axis, (x, x_label) in zip(line, AXES):
            draw_runs(axis, found, x, y)
            axis.grid(True, which="major", alpha=0.25)
            axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.xaxis.set_major_formatter(FormatStrFormatter("%g"))
            axis.xaxis.set_minor_formatter("")
            if y == ERRORS[-1][0]:
                axis.set_xlabel(x_label)
        line[0].set_ylabel(f"{y_label} ({FLOOR:g} or less)" if y == "error_fe" else y_label)
    axes[1][0].legend(fontsize=8)
    figure.savefig(path, dpi=130)
    plt.close(figure)
