"""Figures 5.3 and 5.4 of the source: what shear flexibility does to the frequency and to the shape of the mode with three nodal diameters.

The disc of the source as an FE model, with the same D, mass per area and radii at each ratio r_a/h; beside it the closed
form of the Kirchhoff plate and the exact Reissner-Mindlin plate of benchmarks/elements/exact_annulus.py.
"""

import sys

import h5py
import numpy as np

import kirchhoff
from drawing import BLACK, BLUE, GREY, RED, plt, save
from studies import ROOT, Entry, Number, run

sys.path[:0] = [str(ROOT / "benchmarks/elements"), str(ROOT / "benchmarks/squeal")]
import exact_annulus  # noqa: E402
import modes  # noqa: E402

PLATE = {"r_i": exact_annulus.R_I, "r_a": exact_annulus.R_A, "D": exact_annulus.D, "nu": exact_annulus.NU,
         "gamma": exact_annulus.GAMMA}
N = 3  # nodal diameters
OF_THE_SOURCE, THIN = 8.1, 100.0  # r_a/h of figure 5.4
RATIOS = (4.0, 5.0, 6.5, OF_THE_SOURCE, 10.0, 14.0, 20.0, 30.0, 50.0, 70.0, THIN)


def shape(body, numbers):
    """(r, U) at the nodes of the picture: the amplitude around the axis of a pair of modes, 1 at the edge."""
    x = body["picture/positions"][:]
    w = body["picture/displacements"][:].reshape(len(x), 3, -1)[:, 2, [i - 1 for i in numbers]]
    r, U = np.hypot(x[:, 0], x[:, 1]), np.linalg.norm(w, axis=1)
    return r, U / U[r > PLATE["r_a"] * (1 - 1e-6)].mean()


def disc(programs, folder, ratio, quick):
    """The pair with three nodal diameters of the FE model at one r_a/h."""
    thinner = modes.THICKNESS * ratio / PLATE["r_a"]
    text = modes.scene(thinner, *((0.02, 20, 2500.0) if quick else (0.009, 150, 2500.0)))
    summary = run(programs / "chladni", "run", folder, text)
    pair = next(g for g in modes.groups_of(folder / "disc.body.h5") if g["n"] == N)
    found = {"ratio": ratio, "dofs": summary["n_dofs"], "f_Hz": pair["f_Hz"],
             "exact_Hz": float(exact_annulus.frequencies(N, PLATE["r_a"] / ratio)[0])}
    if ratio in (OF_THE_SOURCE, THIN):
        with h5py.File(folder / "disc.body.h5") as body:
            found["r"], found["U"] = (values.tolist() for values in shape(body, pair["numbers"]))
    return found


def study(programs, folder, quick):
    ratios = (4.0, OF_THE_SOURCE, 30.0, THIN) if quick else RATIOS
    return {"kirchhoff_Hz": float(kirchhoff.frequency(N, PLATE)),
            "discs": [disc(programs, folder / f"{ratio:g}", ratio, quick) for ratio in ratios]}


def draw_ratios(found, path):
    figure, ax = plt.subplots(figsize=(5.5, 3.4))
    fine = np.geomspace(4.0, THIN, 40)
    exact = [exact_annulus.frequencies(N, PLATE["r_a"] / ratio)[0] / found["kirchhoff_Hz"] for ratio in fine]
    ax.axhline(1.0, color=GREY, linewidth=0.8)
    ax.plot(fine, exact, color=BLUE, label="exact Reissner-Mindlin plate")
    ax.plot([d["ratio"] for d in found["discs"]], [d["f_Hz"] / found["kirchhoff_Hz"] for d in found["discs"]], "o",
            color=RED, ms=4, label="FE model")
    ax.axvline(OF_THE_SOURCE, color=GREY, linewidth=0.8, linestyle=":")
    ax.annotate("the disc of the source", (OF_THE_SOURCE, 0.88), xytext=(5, 0), textcoords="offset points", color=GREY)
    ax.set(xscale="log", xlabel="$r_a / h$", ylabel="frequency over that of the Kirchhoff plate",
           xticks=(4, 8.1, 20, 50, 100), xticklabels=("4", "8.1", "20", "50", "100"))
    ax.minorticks_off()
    ax.legend(loc="center right")
    save(figure, path)


def draw_modes(found, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4))
    r = np.linspace(PLATE["r_i"], PLATE["r_a"], 200)
    axes[0].plot(r, kirchhoff.mode(N, PLATE, r), color=BLACK, label="closed form, Kirchhoff")
    for one, colour, marker in zip(shaped(found), (RED, BLUE), (".", "x")):
        near, U = np.array(one["r"]), np.array(one["U"])
        axes[0].plot(near, U, marker, color=colour, ms=3, label=f"FE model, $r_a/h$ = {one['ratio']:g}")
        axes[1].plot(near, U - kirchhoff.mode(N, PLATE, near), marker, color=colour, ms=3)
    axes[0].set(xlabel="r in m", ylabel="U(r), 1 at the outer edge")
    axes[1].set(xlabel="r in m", ylabel="difference from the closed form")
    axes[0].legend()
    save(figure, path)


def shaped(found):
    return [d for d in found["discs"] if "U" in d]


def difference(one):
    """The largest between the shapes, relative to the largest displacement."""
    return float(np.abs(np.array(one["U"]) - kirchhoff.mode(N, PLATE, np.array(one["r"]))).max())


def entries(found, figures):
    draw_ratios(found, figures / "source_5_3.png")
    draw_modes(found, figures / "source_5_4.png")
    by_ratio = {d["ratio"]: d for d in found["discs"]}
    thick, thin, first = by_ratio[OF_THE_SOURCE], by_ratio[THIN], found["discs"][0]
    over = lambda d: d["f_Hz"] / found["kirchhoff_Hz"]
    far = max(abs(d["f_Hz"] / d["exact_Hz"] - 1) for d in found["discs"])
    yield Entry(
        "5.3", "Frequencies with and without shear flexibility", ("source_5_3.png",),
        f"At r_a/h from {first['ratio']:g} to {thin['ratio']:g} the ratio is {over(first):.4f} to {over(thin):.4f}. The text says \"about 5 %\" of the "
        "disc itself; the number here follows from its two frequencies. The FE models are at most "
        f"{far:.1e} from the exact Reissner-Mindlin plate.",
        (Number("frequency of the Kirchhoff plate", "Hz", 1749.75, found["kirchhoff_Hz"]),
         Number("frequency of the FE model", "Hz", 1672.13, thick["f_Hz"]),
         Number("ratio of both at r_a/h = 8.1", "1", 1672.13 / 1749.75, over(thick))))
    yield Entry(
        "5.4", "The shape of the mode with and without shear flexibility", ("source_5_4.png",),
        "The text has no number: \"the eigenmodes are not as much effected by a small ratio of r_a/h as the eigenvalues\". Dots are all nodes of the "
        "picture, whatever their angle.",
        (Number("largest difference of U(r), r_a/h = 8.1", "1", None, difference(thick)),
         Number("largest difference of U(r), r_a/h = 100", "1", None, difference(thin))))
