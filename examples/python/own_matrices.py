"""Any two matrices of petsc4py: a membrane on springs, reduced to some of its nodes. Usage: [mpirun -n 2] own_matrices.py"""

import numpy as np
import scipy.linalg
from petsc4py import PETSc

import chladni

N = 24  # nodes along each side


def membrane(n):
    """Stiffness and mass of a square membrane by differences, each rank with its rows; 0.1 holds every node a little."""
    K = PETSc.Mat().createAIJ((n * n, n * n), nnz=5)
    M = PETSc.Mat().createAIJ((n * n, n * n), nnz=1)
    for row in range(*K.getOwnershipRange()):
        i, j = divmod(row, n)
        near = [(i + di, j + dj) for di, dj in ((1, 0), (-1, 0), (0, 1), (0, -1)) if 0 <= i + di < n and 0 <= j + dj < n]
        K[row, row] = len(near) + 0.1
        for k, m in near:
            K[row, k * n + m] = -1.0
        M[row, row] = 1e-4
    K.assemble()
    M.assemble()
    return K, M


K, M = membrane(N)
corners = [0, N - 1, N * N - N, N * N - 1]
phases = []
reduced = chladni.reduce(K, M, corners, tolerance=1e-3, up_to_Hz=7.0, count=True,
                         monitor=lambda phase, seconds: phases.append(phase))  # fmt: skip
f = np.sqrt(scipy.linalg.eigh(reduced.K, reduced.M, eigvals_only=True)) / (2 * np.pi)
x = 0.1 + 4 * np.add.outer(*2 * [np.sin(np.pi * np.arange(N) / (2 * N)) ** 2])  # eigenvalues of K, in closed form
exact = np.sort(np.sqrt(x.ravel() / 1e-4)) / (2 * np.pi)
in_range = f < 7.0
error = abs(f / exact[: len(f)] - 1)[in_range].max()
if PETSc.COMM_WORLD.getRank() == 0:
    print(f"{N * N} DOFs to {len(corners)} masters and {reduced.n_modes} modes: {', '.join(phases)}")
    print(f"{in_range.sum()} frequencies up to 7 Hz within {error:.1e} of the exact ones; asked: 1e-3")
    print(f"missing in the range that was counted: {reduced.quality['model']['missing']}")
assert error < 1e-3
