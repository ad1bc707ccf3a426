#!/usr/bin/python3
"""Exact natural frequencies of the annular Reissner-Mindlin plate, clamped inside and free outside.

Writes exact_annulus.json. With w cos(n phi), psi_r cos(n phi), psi_phi sin(n phi) the plate falls
into one problem on r for each number n of nodal diameters:
    k_r = psi_r',  k_phi = (psi_r + n psi_phi) / r,  2 k_r_phi = psi_phi' - (psi_phi + n psi_r) / r
    g_r = w' + psi_r,  g_phi = psi_phi - n w / r
    K = pi int D (k_r^2 + k_phi^2 + 2 nu k_r k_phi + (1 - nu)/2 (2 k_r_phi)^2) r dr
      + pi int 5/6 G h (g_r^2 + g_phi^2) r dr
    M = pi int (rho h w^2 + rho h^3 / 12 (psi_r^2 + psi_phi^2)) r dr
Solved with polynomials of degree 14 on elements that shrink to h towards both edges, where the plate
has boundary layers of that width; the frequencies then change by less than 1e-9 with the degree.
"""
import json
import sys

import numpy as np
from numpy.polynomial import legendre

R_I, R_A, D, NU, GAMMA = 0.025, 0.162, 67100.0, 0.3, 126.0  # Steinbrecher 2015, table 5.1
RATIOS = [8.1, 100.0, 1000.0, 10000.0]
N_DIAMETERS, N_CIRCLES = 10, 4


def breakpoints(h):
    """Element ends: h, 4 h, 16 h, ... from both edges, and four in between."""
    layer, width = [], h
    while width < (R_A - R_I) / 8:
        layer.append(width)
        width *= 4
    inner = [R_I + x for x in layer]
    outer = [R_A - x for x in layer]
    middle = np.linspace(inner[-1] if inner else R_I, outer[-1] if outer else R_A, 5)
    return np.unique(np.concatenate([[R_I], inner, middle, outer, [R_A]]))


def hierarchical(degree, x):
    """Values and derivatives of the two linear functions and the integrated Legendre polynomials."""
    values, slopes = [(1 - x) / 2, (1 + x) / 2], [0 * x - 0.5, 0 * x + 0.5]
    for k in range(2, degree + 1):
        P = lambda j: legendre.legval(x, np.eye(degree + 1)[j])
        scale = np.sqrt((2 * k - 1) / 2)
        values.append(scale * (P(k) - P(k - 2)) / (2 * k - 1))
        slopes.append(scale * P(k - 1))
    return np.array(values), np.array(slopes)


def frequencies(n, h, degree=14, count=N_CIRCLES, kappa=5 / 6):
    """The lowest ones in bending with n nodal diameters; kappa is the shear correction."""
    E = 12 * D * (1 - NU**2) / h**3
    shear, rho = kappa * E / (2 * (1 + NU)) * h, GAMMA / h
    ends = breakpoints(h)
    x, weight = legendre.leggauss(degree + 6)
    N, dN = hierarchical(degree, x)
    n_e, n_q = len(ends) - 1, len(x)
    n_f = n_e + 1 + n_e * (degree - 1)  # functions of one field: ends first
    B, H = np.zeros((5 * n_e * n_q, 3 * n_f)), np.zeros((3 * n_e * n_q, 3 * n_f))
    for e in range(n_e):
        J = (ends[e + 1] - ends[e]) / 2
        r = ends[e] + J * (1 + x)
        own = np.r_[e, e + 1, n_e + 1 + e * (degree - 1) + np.arange(degree - 1)]
        dofs = np.concatenate([own, n_f + own, 2 * n_f + own])
        zero = 0 * N
        rows = lambda w, a, b: np.concatenate([w, a, b])
        k_r, k_phi = rows(zero, dN / J, zero), rows(zero, N / r, n * N / r)
        strains = (np.sqrt(D) * (k_r + NU * k_phi), np.sqrt(D * (1 - NU**2)) * k_phi,
                   np.sqrt(D * (1 - NU) / 2) * rows(zero, -n * N / r, dN / J - N / r),
                   np.sqrt(shear) * rows(dN / J, N, zero), np.sqrt(shear) * rows(-n * N / r, zero, N))
        motions = (np.sqrt(rho * h) * rows(N, zero, zero), np.sqrt(rho * h**3 / 12) * rows(zero, N, zero),
                   np.sqrt(rho * h**3 / 12) * rows(zero, zero, N))
        s = np.sqrt(weight * J * r)
        for i, strain in enumerate(strains):
            B[(5 * e + i) * n_q:(5 * e + i + 1) * n_q, dofs] = (strain * s).T
        for i, motion in enumerate(motions):
            H[(3 * e + i) * n_q:(3 * e + i + 1) * n_q, dofs] = (motion * s).T
    free = np.setdiff1d(np.arange(3 * n_f), [0, n_f, 2 * n_f])
    B, H = B[:, free], H[:, free]
    return frequencies_of(B, H, count)


def frequencies_of(B, H, count):
    """Hz. K = B^T B = R^T R: the singular values of H R^-1 are 1 / omega, without the loss of digits of K."""
    scale = 1 / np.linalg.norm(B, axis=0)
    R = np.linalg.qr(B * scale, mode="r")
    sigma = np.linalg.svd(np.linalg.solve(R.T, (H * scale).T), compute_uv=False)
    return 1 / (2 * np.pi * sigma[:count])


def plane_frequencies(n, h, degree=14, count=N_CIRCLES):
    """The lowest ones in its plane (plane stress) with n nodal diameters, u cos(n phi) and v sin(n phi):
    e_r = u', e_phi = (u + n v) / r, 2 e_r_phi = v' - (v + n u) / r
    K = pi int E h / (1 - nu^2) (e_r^2 + e_phi^2 + 2 nu e_r e_phi + (1 - nu)/2 (2 e_r_phi)^2) r dr
    M = pi int rho h (u^2 + v^2) r dr
    """
    stiffness, mass = 12 * D / h**2, GAMMA
    ends = np.linspace(R_I, R_A, 9)
    x, weight = legendre.leggauss(degree + 6)
    N, dN = hierarchical(degree, x)
    n_e, n_q = len(ends) - 1, len(x)
    n_f = n_e + 1 + n_e * (degree - 1)
    B, H = np.zeros((3 * n_e * n_q, 2 * n_f)), np.zeros((2 * n_e * n_q, 2 * n_f))
    for e in range(n_e):
        J = (ends[e + 1] - ends[e]) / 2
        r = ends[e] + J * (1 + x)
        own = np.r_[e, e + 1, n_e + 1 + e * (degree - 1) + np.arange(degree - 1)]
        dofs = np.concatenate([own, n_f + own])
        rows = lambda u, v: np.concatenate([u, v])
        e_r, e_phi = rows(dN / J, 0 * N), rows(N / r, n * N / r)
        strains = (np.sqrt(stiffness) * (e_r + NU * e_phi), np.sqrt(stiffness * (1 - NU**2)) * e_phi,
                   np.sqrt(stiffness * (1 - NU) / 2) * rows(-n * N / r, dN / J - N / r))
        s = np.sqrt(weight * J * r)
        for i, strain in enumerate(strains):
            B[(3 * e + i) * n_q:(3 * e + i + 1) * n_q, dofs] = (strain * s).T
        for i, motion in enumerate((rows(N, 0 * N), rows(0 * N, N))):
            H[(2 * e + i) * n_q:(2 * e + i + 1) * n_q, dofs] = (np.sqrt(mass) * motion * s).T
    free = np.setdiff1d(np.arange(2 * n_f), [0, n_f])
    return frequencies_of(B[:, free], H[:, free], count)


def all_frequencies(h, count, kappa=5 / 6):
    """The lowest of the clamped annulus as a plate with six DOFs at each point, in bending and in its plane, in Hz and
    in order, those with nodal diameters twice."""
    found, n = [], 0
    limit = np.inf  # above it there are `count` already
    while True:
        own = np.concatenate([frequencies(n, h, count=12, kappa=kappa), plane_frequencies(n, h, count=12)])
        if own.min() > limit and n > 1:
            return np.sort(found)[:count]
        # n = 0: radial and torsional motion come from one problem, each frequency once.
        found.extend(np.repeat(own, 2 if n else 1))
        limit = np.sort(found)[count - 1] if len(found) >= count else np.inf
        n += 1


def main():
    tables = {}
    for ratio in RATIOS:
        h = R_A / ratio
        tables[f"{ratio:g}"] = [list(frequencies(n, h)) for n in range(N_DIAMETERS)]
        change = max(abs(frequencies(n, h, 12) / tables[f"{ratio:g}"][n] - 1).max() for n in (0, 3, 8))
        print(f"r_a/h = {ratio:g}: n = 3: {tables[f'{ratio:g}'][3][0]:.9f} Hz, degree 12 to 14 changes {change:.1e}")
    out = {"r_i": R_I, "r_a": R_A, "D": D, "nu": NU, "gamma": GAMMA, "f_Hz[r_a/h][n][m]": tables}
    with open(sys.argv[1], "w") as file:
        json.dump(out, file, indent=1)


if __name__ == "__main__":
    main()
