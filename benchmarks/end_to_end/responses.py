"""Frequencies and frequency responses of reduced systems and bodies, from their files alone.

A reduced system held at its support, K u = lambda M u, has modes u with u^T K u = 1 and u^T M u = mu =
1 / omega^2; a coordinate without mass has mu = 0. Responses to harmonic loads at the rows B of u are then

    H(Omega) = sum_k b_k b_k^T / (1 + i eta - Omega^2 mu_k),    b_k = B u_k
"""
from dataclasses import dataclass

import h5py
import numpy as np
from scipy.linalg import eigh

ETA = 0.02  # structural damping with which keep.tolerance compares responses, docs/explanation/theory.md


@dataclass(frozen=True)
class Held:
    """K_r and M_r without the DOFs of the support, and the rows that are loaded."""

    K: np.ndarray
    M: np.ndarray
    n_masters: int
    loads: list

    def with_modes(self, n):
        """The system of the first n fixed-interface modes: Craig-Bampton's matrices are nested."""
        size = self.n_masters + n
        return Held(self.K[:size, :size], self.M[:size, :size], self.n_masters, self.loads)


@dataclass(frozen=True)
class Modes:
    """mu of all modes, descending, and their rows at the loads, [n_loads x n_modes]."""

    mu: np.ndarray
    at_loads: np.ndarray


def read_held(path, support, load=None, component=0):
    """The reduced system of a file, held at all DOFs of `support`; loads: `component` of the set `load`, or none."""
    with h5py.File(path) as file:
        K, M = file["matrices/stiffness"][:], file["matrices/mass"][:]
        masters = list(zip(file["masters/node"][:], file["masters/component"][:]))
        held = set(file[f"attachment/sets/{support}"][:])
        loaded = [(node, component) for node in file[f"attachment/sets/{load}"][:]] if load else []
    kept = [i for i in range(len(K)) if i >= len(masters) or masters[i][0] not in held]
    place = {masters[i]: row for row, i in enumerate(kept) if i < len(masters)}
    return Held(K[np.ix_(kept, kept)], M[np.ix_(kept, kept)], len(place), [place[dof] for dof in loaded])


def modes(held, count=None):
    """All modes, or the lowest `count`."""
    s = 1 / np.sqrt(np.diag(held.K))
    n = len(s)
    lowest = None if count is None else [max(0, n - count), n - 1]
    mu, u = eigh(s[:, None] * held.M * s, s[:, None] * held.K * s, subset_by_index=lowest)
    return Modes(np.maximum(mu[::-1], 0), (s[:, None] * u)[held.loads, ::-1])


def frequencies_Hz(held, count):
    """The lowest `count`, infinite where there are fewer."""
    mu = modes(held, count).mu
    f = 1 / (2 * np.pi * np.sqrt(np.maximum(mu, 1e-300)))
    return np.concatenate([f, np.full(count - len(f), np.inf)])


def body_modes(path, load, component):
    """Of a body file, as those of a held system."""
    with h5py.File(path) as file:
        omega = file["modes/frequencies"][:]
        rows = 6 * file[f"attachment/sets/{load}"][:] + component
        return Modes(1 / omega**2, file["modes/attachment_displacements"][:][rows] / omega)


def responses(of, Omega, columns, eta=ETA):
    """H [n_loads x n_columns] to the loads `columns` at each frequency, rad/s, and what they are measured by: the norm of
    each column or, where modes cancel, the root sum of squares of what they contribute."""
    B = of.at_loads
    b2 = (B**2).sum(axis=0)
    for one in Omega:
        d = 1 + 1j * eta - one**2 * of.mu
        H = (B / d) @ B[columns].T
        incoherent = np.sqrt((B[columns] ** 2) @ (b2 / np.abs(d) ** 2))
        yield H, np.maximum(np.linalg.norm(H, axis=0), incoherent)


def largest_difference(found, exact):
    """The largest error over loads and frequencies of responses to those of `exact`, a list of `responses`."""
    return max(float(np.max(np.linalg.norm(H - H_exact, axis=0) / size))
               for (H, _), (H_exact, size) in zip(found, exact))
