"""Draws what a digit of the sound field costs and writes it down.

Usage: report.py RESULT.json DOCS_DIR

Writes DOCS_DIR/sound_benchmarks.md and DOCS_DIR/figures/sound_convergence.png and sound_layer.png, and a
copy of the results as DOCS_DIR/sound_benchmarks.json.
"""

import json
import re
import shutil
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOURS = {2: "#999999", 4: "#2166ac", 6: "#b2182b", "space": "#1b7837"}
HEAD = """# Sound: error over unknowns and seconds

Written by `benchmarks/sound/report.py` from the results of `sound_convergence`. Times are processor times of one process on the machine that
ran it, with Gmsh and without, and compare only with each other.

![Error over unknowns and seconds](figures/sound_convergence.png)
![Reflection of the layer](figures/sound_layer.png)
"""
SECTIONS = {
    "sphere, plane": "Sphere at ka = 3, Fourier form\n\nError in the mean square over the nodes, against the closed form.",
    "sphere, space": "Sphere at ka = 3, tetrahedra\n\nThe oscillating one in a half space.",
    "disc, plane": "Squealing disc of 20 mm at 1697 Hz, Fourier form\n\nError at 40 points in the mesh and beyond it, against order 8 with rims of "
    "0.1 micrometre. The size is that of the elements at the rim.",
    "disc, space": "Squealing disc of 20 mm at 1697 Hz, tetrahedra in the half space\n\nAt the same points, against the same.",
}


def draw_errors(ax, rows, cost, label):
    for table, marker in (("disc, plane", "o"), ("disc, space", "s")):
        for order in sorted({row["order"] for row in rows if row["table"] == table}):
            points = [row for row in rows if row["table"] == table and row["order"] == order]
            colour = COLOURS["space" if table.endswith("space") else order]
            name = "tetrahedra, order 2" if table.endswith("space") else f"plane, order {order}"
            ax.loglog(
                [cost(row) for row in points], [row["error"] for row in points],
                marker=marker, markersize=3.5, linewidth=1.2, color=colour, label=name,
            )  # fmt: skip
    ax.set(xlabel=label, ylabel="error of the pressure")
    ax.grid(color="#eeeeee")


def draw_convergence(rows, path):
    figure, axes = plt.subplots(1, 2, figsize=(8.5, 3.6), layout="constrained")
    draw_errors(axes[0], rows, lambda row: row["unknowns"], "unknowns")
    draw_errors(axes[1], rows, lambda row: row["mesh_cpu_s"] + row["solve_cpu_s"], "processor time in s")
    axes[0].legend(frameon=False, fontsize=8)
    axes[0].set_title("squealing disc, 20 mm", loc="left", fontsize=10)
    figure.savefig(path, dpi=120)


def layer_of(row):
    thickness, alpha, m = re.findall(r"[\d.]+", row["what"])
    return float(thickness), float(alpha), int(m)


def draw_layer(rows, path):
    layers = [(*layer_of(row), row["error"]) for row in rows if row["table"] == "layer"]
    exponents = sorted({m for _, _, m, _ in layers})
    figure, axes = plt.subplots(1, len(exponents), figsize=(10, 3.3), sharey=True, layout="constrained")
    for ax, m in zip(axes, exponents):
        sizes = sorted({d for d, _, exponent, _ in layers if exponent == m})
        for i, size in enumerate(sizes):
            points = sorted((alpha, error) for d, alpha, exponent, error in layers if (d, exponent) == (size, m))
            colour = plt.cm.viridis_r(0.1 + 0.9 * i / max(len(sizes) - 1, 1))
            ax.semilogy(*zip(*points), "o-", ms=3, lw=1.1, color=colour, label=f"{size:g}")
        ax.semilogy([1, 10], [pow(2.718281828, -2.0), pow(2.718281828, -20.0)], "--", lw=0.8, color="#888888")
        ax.set(xlabel="strength alpha", title=f"exponent m = {m}", ylim=(2e-8, 2))
        ax.grid(color="#eeeeee")
    axes[0].set_ylabel("error of the pressure")
    axes[-1].legend(title="thickness in\nwavelengths", frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(path, dpi=120)


def table_of(rows):
    text = "| case | order | element size, mm | unknowns | error | mesh, s | equations, s | factor, MiB |\n"
    text += "| --- | --- | --- | --- | --- | --- | --- | --- |\n"
    for row in rows:
        text += (
            f"| {row['what']} | {row['order']} | {1e3 * row['element_size_m']:.3g} | {row['unknowns']} | {row['error']:.1e} | "
            f"{row['mesh_cpu_s']:.2f} | {row['solve_cpu_s']:.2f} | {row['memory_MiB']:.0f} |\n"
        )
    return text


def layer_table(rows):
    """The best strength of each thickness."""
    layers = [(*layer_of(row), row["error"]) for row in rows if row["table"] == "layer"]
    text = "| thickness, wavelengths | m | best alpha | error | error at alpha = 5 | error at alpha = 10 |\n"
    text += "| --- | --- | --- | --- | --- | --- |\n"
    for size, m in sorted({(d, m) for d, _, m, _ in layers}):
        errors = {alpha: error for d, alpha, exponent, error in layers if (d, exponent) == (size, m)}
        best = min(errors, key=errors.get)
        text += f"| {size:g} | {m} | {best:g} | {errors[best]:.1e} | {errors.get(5.0, float('nan')):.1e} | {errors.get(10.0, float('nan')):.1e} |\n"
    return text


def main(result, docs):
    rows = json.loads(Path(result).read_text())
    figures = docs / "figures"
    figures.mkdir(parents=True, exist_ok=True)
    draw_convergence(rows, figures / "sound_convergence.png")
    draw_layer(rows, figures / "sound_layer.png")
    text = HEAD
    for table, title in SECTIONS.items():
        text += f"\n## {title}\n\n" + table_of([row for row in rows if row["table"] == table])
    text += (
        "\n## Reflection of the absorbing layer\n\nOscillating sphere at ka = 3, elements of order 6 and 25 mm (an eighth of the wavelength), layer from 1.5 "
        "radii on; largest error over the nodes. Dashed in the figure: exp(-2 alpha), what passes the layer twice. More strength than the elements "
        "in the layer resolve reflects, too.\n\n" + layer_table(rows)
    )
    (docs / "sound_benchmarks.md").write_text(text)
    shutil.copy(result, docs / "sound_benchmarks.json")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
