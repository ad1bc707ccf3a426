"""Figures 3.1 and 3.3 of the source: the rigid disc by equation (3.2), by the program's state matrix, and in time.

The source compares the eigenvalues of (3.2) with those of a multi-body program, with linearised and with nonlinear angles.
Here `squeal` derives its state matrix from the nonlinear equations; the points are growth rates of simulations.
"""

import numpy as np
from matplotlib.ticker import MaxNLocator

from drawing import BLUE, GREY, ORANGE, RED, mark, plt, save
from studies import ROOT, Entry, Number, replaced, run

PI = np.pi
SPEEDS = (6.0, 9.0, 12.0, 16.0, 20.0)  # of the simulations, over pi; below, both motions decay alike and a rate is hard to read
# Table 3.1, moments of inertia in kg m^2.
K_T, D_T, K, D, N_0, MU, R_0, H, THETA, PHI = 1.88e7, 0.1, 6e6, 5.0, 3000.0, 0.6, 0.13, 0.02, 0.16, 0.32


def equation_3_2(Omega, d_t_in_C_11):
    """Eigenvalues with positive imaginary part of (3.2), by rising frequency; as printed C_11 lacks d_t."""
    C = np.array([[0.5 * MU * N_0 * H**2 / (R_0 * Omega) + 2 * D * R_0**2 + d_t_in_C_11, PHI * Omega],
                  [-PHI * Omega - MU * D * H * R_0, D_T]])
    K_ = np.array([[K_T + 2 * K * R_0**2 + N_0 * H, 0.5 * MU * N_0 * H**2 / R_0],
                   [-MU * (K * H * R_0 + 2 * N_0 * R_0), K_T + (1 + MU**2) * N_0 * H]])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-K_ / THETA, -C / THETA]])
    values = np.linalg.eigvals(A)
    return sorted(values[values.imag > 0], key=lambda value: value.imag)


def crossing(growth):
    """Omega / pi at which the larger growth rate of a function of it changes its sign, by bisection."""
    low, high = 2.0, 20.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if growth(middle * PI) > 0 else (middle, high)
    return low


def simulated(programs, folder, text, equations, quick):
    """[(Omega / pi, growth rate)] of simulations with these equations."""
    speeds = SPEEDS[::4] if quick else SPEEDS
    text = replaced(text, 'equations = "nonlinear"', f'equations = "{equations}"')
    text = replaced(text, r"growth = .*", f"growth = {{ speeds_rad_s = {[s * PI for s in speeds]}, duration_s = {2.0 if quick else 6.0} }}")
    text = replaced(text, r"analyses = .*", 'analyses = ["growth"]')
    summary = run(programs / "squeal", "run", folder / equations, text)
    return [(case["speed_rad_s"] / PI, case["measured_growth_1_s"]) for case in summary["growth"]]


def study(programs, folder, quick):
    import h5py
    text = (ROOT / "examples/rigid_disc/scene.toml").read_text()
    text = text[:text.index("# At 20 pi")]
    linear = replaced(text, r"analyses = .*", 'analyses = ["eigenvalues", "critical-speed"]')
    summary = run(programs / "squeal", "run", folder / "eigenvalues", linear)
    with h5py.File(folder / "eigenvalues/rigid.squeal.h5") as file:
        group = file["eigenvalues"]
        found = {"speeds": (group["speeds"][:] / PI).tolist(), "growth": group["lambda_re"][:].tolist(),
                 "omega": group["lambda_im"][:].tolist()}
    return {**found, "critical": summary["critical_speed_rad_s"] / PI,
            **{equations: simulated(programs, folder, text, equations, quick) for equations in ("linear", "nonlinear")}}


def curves(found):
    """(omega, growth) of both eigenvalues over the speed, the higher frequency first."""
    omega, growth = np.array(found["omega"]), np.array(found["growth"])
    order = np.argsort(-omega[0])
    return [(omega[:, j], growth[:, j]) for j in order]


def draw_locus(found, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4))
    for ax, (omega, growth), colour in zip(axes[::-1], curves(found), (RED, BLUE)):
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        ax.plot(omega / 1e3, growth, color=colour)
        mark(ax, omega[0] / 1e3, growth[0], "A")
        mark(ax, omega[-1] / 1e3, growth[-1], "B", (-12, 5))
        at = np.interp(found["critical"], found["speeds"], omega)
        if growth.max() > 0:
            mark(ax, at / 1e3, 0.0, "C")
        ax.set(xlabel="imaginary part in 1000/s", ylabel="real part in 1/s")
        ax.xaxis.set_major_locator(MaxNLocator(5))
    save(figure, path)


def draw_comparison(found, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4))
    speeds = np.array(found["speeds"])
    equation = np.array([equation_3_2(s * PI, D_T) for s in speeds])
    for j, (omega, growth) in enumerate(curves(found)[::-1]):
        for ax, own, part in ((axes[0], omega / 1e3, equation[:, j].imag / 1e3), (axes[1], growth, equation[:, j].real)):
            ax.plot(speeds, part, color=BLUE, label="equation (3.2), with $d_t$ in $C_{11}$" if j else None)
            ax.plot(speeds[::6], own[::6], "o", mfc="none", color=RED, ms=4, label="state matrix of squeal" if j else None)
    for name, marker in (("linear", "+"), ("nonlinear", "x")):
        at, rate = np.array(found[name]).T
        axes[1].plot(at, rate, marker, color=ORANGE, ms=7, label=f"simulation, {name} equations")
    axes[1].axhline(0.0, color=GREY, linewidth=0.8)
    axes[0].set_ylabel("imaginary part in 1000/s")
    axes[1].set_ylabel("real part in 1/s")
    for ax in axes:
        ax.set_xlabel(r"$\Omega_0 / \pi$ in rad/s")
    axes[1].legend()
    save(figure, path)


def farthest_from_equation(found):
    """The largest difference of both eigenvalues from (3.2) with d_t, relative."""
    equation = np.array([equation_3_2(s * PI, D_T) for s in found["speeds"]])
    own = np.sort_complex(np.array(found["omega"]) + 1j * np.array(found["growth"]))  # by rising frequency
    return float(np.abs(own - (equation.imag + 1j * equation.real)).max() / np.abs(equation).max())


def farthest_in_time(found, name):
    """Of the simulated growth rates from the eigenvalues, 1/s."""
    largest = np.array(found["growth"]).max(1)
    return max(abs(rate - np.interp(at, found["speeds"], largest)) for at, rate in found[name])


def entries(found, figures):
    draw_locus(found, figures / "source_3_1.png")
    draw_comparison(found, figures / "source_3_3.png")
    printed = crossing(lambda Omega: max(v.real for v in equation_3_2(Omega, 0.0)))
    yield Entry(
        "3.1, table 3.1", "Eigenvalues of the rigid disc", ("source_3_1.png",),
        "A at pi, B at 20 pi, C where the motion becomes unstable. The parameters of table 3.1 do not give 10.4 pi in any reading of the equations that "
        f"we tried; (3.2) as printed, without d_t in C_11, crosses at {printed:.3f} pi. [The page of the rigid disc](../explanation/rigid_disc.md#where-the-critical-speed-differs) "
        "has the table of readings.",
        (Number("critical speed over pi", "rad/s", 10.4, found["critical"]),))
    yield Entry(
        "3.3", "Eigenvalues of the rigid disc, equations against the program", ("source_3_3.png",),
        "The source finds its program \"basically identical\" to the equation with linearised angles, and with nonlinear ones slightly off in the real part. "
        "Here both sets of equations give the same growth, since it is measured on small motions; the motion in time is the one that decays "
        "least, so it has one branch only.",
        (Number("state matrix from (3.2) with d_t, largest relative difference", "1", None, farthest_from_equation(found)),
         Number("growth simulated with linear equations, largest difference", "1/s", None, farthest_in_time(found, "linear")),
         Number("growth simulated with nonlinear equations, largest difference", "1/s", None, farthest_in_time(found, "nonlinear"))))
