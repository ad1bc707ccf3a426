#!/usr/bin/python3
"""Natural frequencies of the annulus of exact_annulus.py as an elastic solid, clamped on its inner face.

With u cos(n phi), v sin(n phi), w cos(n phi) the solid falls into one problem on its cross-section for each number n
of nodal diameters, and that into motions odd (bending) and even (in its plane) about the middle:
    e_r = u_r,  e_phi = (u + n v) / r,  e_z = w_z
    g_r_phi = v_r - (v + n u) / r,  g_r_z = u_z + w_r,  g_phi_z = v_z - n w / r
Solved with products of polynomials on elements that shrink towards the clamped face, whose corners have singular
stresses: these decide how far the frequencies change with the degree. usage: exact_solid.py prints that.
"""
import numpy as np
import scipy.linalg
from numpy.polynomial import legendre

from exact_annulus import D, GAMMA, NU, R_A, R_I, hierarchical


def one_dimensional(ends, degree):
    """Gauss points, weights, and values and slopes of all functions at all points [points x functions]."""
    x, weight = legendre.leggauss(degree + 2)
    N, dN = hierarchical(degree, x)
    n_e, n_q = len(ends) - 1, len(x)
    values, slopes = np.zeros((2, n_e * n_q, n_e * degree + 1))
    points, weights = np.zeros((2, n_e * n_q))
    for e in range(n_e):
        J = (ends[e + 1] - ends[e]) / 2
        own = np.r_[e, e + 1, n_e + 1 + e * (degree - 1) + np.arange(degree - 1)]
        at = np.arange(e * n_q, (e + 1) * n_q)
        points[at], weights[at] = ends[e] + J * (1 + x), J * weight
        values[np.ix_(at, own)], slopes[np.ix_(at, own)] = N.T, dN.T / J
    return points, weights, values, slopes


def monomials(h, degree):
    """As one_dimensional over -h/2 < z < h/2, of Legendre polynomials: even and odd ones are apart."""
    x, weight = legendre.leggauss(degree + 2)
    values = np.array([legendre.legval(x, np.eye(degree + 1)[k]) for k in range(degree + 1)]).T
    slopes = np.array([legendre.legval(x, legendre.legder(np.eye(degree + 1)[k])) for k in range(degree + 1)]).T
    return h / 2 * weight, values, slopes * 2 / h


def symmetric_problem(n, h, degree, odd):
    """K and M of the motions whose u and v are odd or even in z and whose w is the contrary."""
    ends = R_I + (R_A - R_I) * np.array([0, 0.003, 0.02, 0.08, 0.25, 0.5, 0.75, 1.0])
    r, r_weight, R, dR = one_dimensional(ends, degree)
    z_weight, Z, dZ = monomials(h, degree)
    own = (slice(odd, None, 2), slice(odd, None, 2), slice(1 - odd, None, 2))
    field = lambda A, B, i: np.kron(A[:, 1:], B[:, own[i]])  # without the first function: clamped
    over_r = R / r[:, None]
    sizes = [field(R, Z, i).shape[1] for i in range(3)]
    zero = [np.zeros((len(r) * len(z_weight), size)) for size in sizes]
    row = lambda **parts: np.hstack([parts.get(name, zero[i]) for i, name in enumerate("uvw")])
    e = [row(u=field(dR, Z, 0)), row(u=field(over_r, Z, 0), v=n * field(over_r, Z, 1)), row(w=field(R, dZ, 2))]
    g = [row(u=-n * field(over_r, Z, 0), v=field(dR - over_r, Z, 1)), row(u=field(R, dZ, 0), w=field(dR, Z, 2)),
         row(v=field(R, dZ, 1), w=-n * field(over_r, Z, 2))]
    E, weight = 12 * D * (1 - NU**2) / h**3, np.kron(r_weight * r, z_weight)[:, None]
    shear, first = E / (2 * (1 + NU)), E * NU / ((1 + NU) * (1 - 2 * NU))
    product = lambda A: A.T @ (weight * A)
    K = 2 * shear * sum(map(product, e)) + first * product(sum(e)) + shear * sum(map(product, g))
    motions = (row(u=field(R, Z, 0)), row(v=field(R, Z, 1)), row(w=field(R, Z, 2)))
    return K, GAMMA / h * sum(map(product, motions))


def frequencies(n, h, degree=7, count=12):
    """The lowest ones with n nodal diameters, in Hz."""
    found = []
    for odd in (0, 1):
        K, M = symmetric_problem(n, h, degree, odd)
        if n == 0:  # radial and torsional motion do not touch, and torsion has no v
            kept = np.flatnonzero(K.diagonal() > 1e-14 * K.diagonal().max())
            K, M = K[np.ix_(kept, kept)], M[np.ix_(kept, kept)]
        lam = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=(0, count - 1))
        found.extend(np.sqrt(lam) / (2 * np.pi))
    return np.sort(found)[:count]


def all_frequencies(h, count, degree=7):
    """The lowest ones in Hz and in order, those with nodal diameters twice."""
    found, n = [], 0
    while True:
        own = frequencies(n, h, degree, 24)
        if len(found) >= count and n > 1 and own[0] > np.sort(found)[count - 1]:
            return np.sort(found)[:count]
        found.extend(np.repeat(own, 2 if n else 1))
        n += 1


def main():
    for degree in (5, 7, 9):
        print(degree, *(f"{f:.3f}" for n in (0, 3, 8) for f in frequencies(n, 0.02, degree)[:3]))


if __name__ == "__main__":
    main()
