"""Writes what response_modes.py has found: response_modes.md and its figure."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOURS = {"none": "#777777", "axial": "#2166ac", "axial and slopes": "#b2182b"}
HEAD = """# What frequency response modes buy

The table has the ratio of the error of the body without response modes to that of the body with the same modes and axial and slope response modes at the
ring. In `squeal` response modes beyond the range have no inertia: bodies of one range have
{inertia} coordinates with inertia there, without and with response modes.

| quantity | {ranges} |
| --- |{dashes}
{gains}
Response modes add coordinates to the body. Compared by coordinates: {by_body}

Written by `benchmarks/squeal/response_modes.py`{quick}; no number here was typed. The disc of `examples/thesis_disc`, all modes up to a
frequency, against the FE model itself with {dofs:,} DOFs (`unreduced_disc.py`). Compared are the critical speed of the
lowest mode, {critical:.6f} rad/s at {critical_Hz:.2f} Hz, and growth and frequency of the unstable modes below 4 kHz at
{speed:.4f} rad/s: {modes}. All errors are relative.

![Error over coordinates](figures/response_modes.png)

Accuracy of the reference: receptances of the FE model differ from a factorization at s by {receptance:.1e}; derivatives of the pad forces from
their closed form by {pads:.1e}. All coordinates of the reduced system ({fixed} fixed-interface modes) are off by {reduction}.

## Bodies

Coordinates: of the body, and with inertia in `squeal`. First instability: what `squeal` calls the critical speed of that body; it may be
that of a mode above 4 kHz.

| modes to | response modes | body | with inertia | first instability, rad/s (Hz) | critical speed | largest growth error | largest frequency error |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""
STATIC = """
## Where the rest of the error is from

These are the same modes with the exact static compliance of the FE model for all others, solved without `squeal`. The remaining error is the inertia of the
modes left out. More response modes cannot make a body better than this.

| modes to | critical speed | largest growth error | largest frequency error |
| --- | --- | --- | --- |
"""


def numbers(errors):
    """Critical speed, largest of growth and frequency."""
    return errors["critical"], max(errors["growth"]), max(errors["frequency"])


def cells(errors):
    return " | ".join("-" if e is None else f"{e:.1e}" for e in numbers(errors))


def gains(result):
    """Rows of the table of factors."""
    of = {(row["up_to_Hz"], row["responses"]): numbers(row["errors"]) for row in result["bodies"]}
    ranges = sorted({up_to for up_to, _ in of})
    for i, name in enumerate(("critical speed", "growth, largest error", "frequency, largest error")):
        pairs = [(of[up_to, "none"][i], of[up_to, "axial and slopes"][i]) for up_to in ranges]
        yield f"| {name} | " + " | ".join(f"{a / b:.0f}" if a and b else "-" for a, b in pairs) + " |\n"


def inertia(result, ranges):
    """Coordinates with inertia without and with response modes, of each range."""
    of = {(row["up_to_Hz"], row["responses"]): row["n_squeal"] for row in result["bodies"]}
    return ", ".join(f"{of[r, 'none']} and {of[r, 'axial and slopes']}" for r in ranges)


def by_body(result):
    """The largest body without response modes beside the smallest of each kind with them."""
    plain = max((row for row in result["bodies"] if row["responses"] == "none"), key=lambda row: row["n_body"])
    for kind in ("axial", "axial and slopes"):
        row = min((row for row in result["bodies"] if row["responses"] == kind), key=lambda row: row["n_body"])
        factors = [f"{a / b:.1f}" if a and b else "-" for a, b in zip(numbers(plain["errors"]), numbers(row["errors"]))]
        yield (f"{row['n_body']} coordinates with {kind} response modes have errors smaller by {', '.join(factors)} (critical speed, growth, "
               f"frequency) than {plain['n_body']} modes")


def markdown(result):
    reference, ranges = result["reference"], sorted({row["up_to_Hz"] for row in result["bodies"]})
    modes = "; ".join(f"{y / 6.283185307179586:.2f} Hz, {x:.5f} 1/s" for x, y in reference["eigenvalues"])
    yield HEAD.format(
        ranges=" | ".join(f"{1e-3 * r:g} kHz" for r in ranges), dashes=" --- |" * len(ranges), gains="".join(gains(result)),
        inertia=inertia(result, ranges), by_body="; ".join(by_body(result)) + ".",
        quick=" --quick" if result["quick"] else "", dofs=result["n_fe_dofs"], critical=reference["critical_rad_s"],
        critical_Hz=reference["critical_Hz"], speed=result["speed_rad_s"], modes=modes, receptance=reference["receptance_error"],
        pads=reference["pad_error"], fixed=result["fixed_interface_modes"],
        reduction="{:.1e} in the critical speed, {:.1e} in growth and {:.1e} in frequency".format(*numbers(result["reduction"])))
    for row in result["bodies"]:
        first = f"{row['first_rad_s']:.4f} ({row['first_Hz']:.0f})" if row["first_rad_s"] else "-"
        yield (f"| {1e-3 * row['up_to_Hz']:g} kHz | {row['responses']} | {row['n_body']} | {row['n_squeal']} | {first} | "
               f"{cells(row['errors'])} |\n")
    yield STATIC
    for row in result["static"]:
        yield f"| {1e-3 * row['up_to_Hz']:g} kHz | {cells(row['errors'])} |\n"


def draw(result, path):
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.4), layout="constrained", sharex=True)
    for i, (ax, title) in enumerate(zip(axes, ("critical speed", "growth, largest of the modes", "frequency, largest of the modes"))):
        for name, colour in COLOURS.items():
            rows = [row for row in result["bodies"] if row["responses"] == name and numbers(row["errors"])[i]]
            errors = [numbers(row["errors"])[i] for row in rows]
            ax.semilogy([row["n_squeal"] for row in rows], errors, "o-", ms=4, lw=1.2, color=colour, label=f"{name}, with inertia")
            ax.semilogy([row["n_body"] for row in rows], errors, "s:", ms=3, lw=1, color=colour, label=f"{name}, of the body")
        ax.axhline(numbers(result["reduction"])[i], color="black", lw=0.8, label="reduced system, all coordinates")
        ax.set(title=title, xlabel="coordinates", ylabel="relative error")
        ax.grid(color="#eeeeee")
    axes[0].legend(loc="lower right", bbox_to_anchor=(1.0, 0.08), frameon=False, fontsize=8)
    figure.savefig(path, dpi=120)


def write(result, output):
    (output / "response_modes.md").write_text("".join(markdown(result)))
    draw(result, output / "figures" / "response_modes.png")
