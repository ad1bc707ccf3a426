"""Complex eigenvalues of M x'' + D x' + K x = 0 with unsymmetric D and K, as of a brake whose friction is already in its matrices.

The method projects Q(lambda) = lambda^2 M + lambda D + K on a real basis V and enriches V:

1. One LU factor of P = K + mu M. Block Krylov spaces of P^-1 M and P^-T M have right and left modes of (K, M), with the
   friction in K; V are those below 1.5 times the frequency that is asked for. The symmetric part of K is no better a
   start: with friction on stiff contacts it has motions of negative stiffness.
2. V^T M V = I, so that the projected pairs are eigenpairs of [0 I; -K_r -D_r]. V holds left vectors too: errors of
   lambda are of second order.
3. Residuals r = Q x and s = Q^H y of each wanted pair with the full matrices; corrections P^-1 r and P^-T s enter V, those
   in most directions first, until |s^H P^-1 r| / |y^H Q' x| is below the tolerance for all pairs, and they stand still.
4. Random vectors, orthogonal to V and filtered by P^-1 M and P^-T M, enter V. A pair that was missed would be the
   largest part of them; where one appears, step 3 goes on.

V. Mehrmann and C. Schroeder, J. of Mathematics in Industry 6 (2016) 7, project on eigenvectors at several speeds;
`start` does so with the basis of another speed.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from petsc4py import PETSc

from chladni._squeal import Error
from chladni.reduction import _one_thread_at_a_time, _petsc

BEYOND = 1.5  # of the frequency asked for: up to here the modes of (K, M) are in the basis
BLOCK = 8
MOST_ROUNDS = 40
MOST_NEW = 64  # directions a round


@dataclass
class ComplexEigenvalues:
    """Pairs in ascending frequency; of conjugate ones that with Im lambda >= 0.

    Attributes:
        values: lambda in 1/s
        errors: estimates of their absolute errors in 1/s, of the basis and of the rounding of M, D and K
        residuals: |P^-1 Q(lambda) x| / |x| in the norm of M
        right, left: [n x k] vectors x and y of this rank's rows, x^H M x = y^H M y = 1
        basis: [n x m] of this rank's rows, for `start`
        rounds, solves: rounds of enrichment; vectors solved with the factor
        found_by_check: pairs that only the last check has found
    """

    values: np.ndarray
    errors: np.ndarray
    residuals: np.ndarray
    right: np.ndarray
    left: np.ndarray
    basis: np.ndarray
    rounds: int
    solves: int
    found_by_check: int

    @property
    def unstable(self) -> np.ndarray:
        """Those of positive real part, by more than the estimate of its error."""
        return self.values[self.values.real > self.errors]


class _System:
    """The matrices, the factor of P = K + mu M, and sums over ranks."""

    def __init__(self, M, D, K, omega):
        self.M, self.D, self.K = M, D, K
        self.comm = K.getComm()
        self.n_solves, self.mu = 0, (0.2 * omega) ** 2
        self.P = K.copy()
        self.P.axpy(self.mu, M)
        self.ksp = PETSc.KSP().create(self.comm)
        self.ksp.setOperators(self.P)
        self.ksp.setType("preonly")
        pc = self.ksp.getPC()
        pc.setType("lu")
        pc.setFactorSolverType("mumps")
        pc.setFactorSetUpSolverType()
        self.factor = pc.getFactorMatrix()
        self.factor.setMumpsIcntl(14, 60)  # %, of room for pivots that are put off
        try:
            self.ksp.setUp()
        except PETSc.Error as reason:
            self.destroy()
            raise Error(f"K + mu M with mu = {self.mu:.3g} 1/s^2 has no LU factor: {str(reason).splitlines()[-1].strip()}") from None
        code = self.factor.getMumpsInfog(1)
        if code < 0:
            self.destroy()
            is_singular = code in (-6, -10)
            raise Error(f"K + mu M has no LU factor (MUMPS says {code}): " + (
                "a motion has neither stiffness nor mass" if is_singular else "it needs more memory; take more ranks or a smaller model"))

    def destroy(self):
        """At once, on all ranks: what Python lets go later keeps its memory."""
        self.ksp.destroy()
        self.P.destroy()

    def sum(self, local):
        return local if self.comm.getSize() == 1 else self.comm.tompi4py().allreduce(local)

    def dense(self, X):
        rows, columns = X.shape
        A = PETSc.Mat().createDense(((rows, PETSc.DETERMINE), (PETSc.DECIDE, columns)), comm=self.comm)
        A.setUp()
        A.getDenseArray()[:, :] = X
        A.assemble()
        return A

    def product(self, A, X, transposed=False):
        if A is None or X.shape[1] == 0:
            return np.zeros_like(X)
        B = self.dense(X)
        C = A.transposeMatMult(B) if transposed else A.matMult(B)
        found = C.getDenseArray().copy()
        B.destroy()
        C.destroy()
        return found

    def solve(self, B, transposed=False):
        """P^-1 B or P^-T B."""
        self.n_solves += B.shape[1]
        if B.shape[1] == 0:
            return B
        right, X = self.dense(B), self.dense(np.zeros_like(B))
        self.factor.setMumpsIcntl(9, 0 if transposed else 1)
        self.factor.matSolve(right, X)
        found = X.getDenseArray().copy()
        right.destroy()
        X.destroy()
        return found


class _Basis:
    """A basis V, orthonormal in M, with its products and the projected matrices; of a Krylov space V and M V alone."""

    def __init__(self, system, of_krylov=False):
        self.system, self.of_krylov = system, of_krylov
        self.V, self.MV, self.KV, self.DV, self.KtV, self.DtV = (np.zeros((system.K.getLocalSize()[0], 0)) for _ in range(6))
        self.K_r = self.D_r = np.zeros((0, 0))

    def gram(self, A, B):
        return self.system.sum(A.T @ B)

    def orthogonal(self, X):
        for _ in range(2):
            X = X - self.V @ self.gram(self.MV, X)
        return X

    def add(self, X, least=1e-10, most=None):
        """The directions of X beyond V, the largest first; those below `least` of the largest are left out. Returns them."""
        X = self.orthogonal(X)
        for limit in (max(least, 1e-7), 0.1, 0.1):  # what cancelled is round-off, and its unit vectors shrink again
            sigma2, U = np.linalg.eigh(self.gram(X, self.system.product(self.system.M, X)))
            if sigma2.min(initial=0.0) < -1e-10 * abs(sigma2).max(initial=0.0) and limit >= 1e-7 and self.V.shape[1] == 0:
                raise Error("M is not positive definite: a motion has a negative kinetic energy")
            scale = sigma2.max(initial=1e-300) if limit < 0.1 else 1.0
            kept = np.flatnonzero(sigma2 > limit**2 * scale)[::-1][:most]
            X = self.orthogonal(X @ (U[:, kept] / np.sqrt(sigma2[kept])))
        of, V, K, D = self.system.product, self.V, self.system.K, self.system.D
        if not self.of_krylov:
            KX, DX = of(K, X), of(D, X)
            self.K_r = np.block([[self.K_r, self.gram(V, KX)], [self.gram(X, self.KV), self.gram(X, KX)]])
            self.D_r = np.block([[self.D_r, self.gram(V, DX)], [self.gram(X, self.DV), self.gram(X, DX)]])
            self.KV, self.DV = np.hstack([self.KV, KX]), np.hstack([self.DV, DX])
            self.KtV, self.DtV = np.hstack([self.KtV, of(K, X, True)]), np.hstack([self.DtV, of(D, X, True)])
        self.V, self.MV = np.hstack([V, X]), np.hstack([self.MV, of(self.system.M, X)])
        return X


def _random(system, columns, seed):
    """Of the global row alone, so that ranks change nothing."""
    first, last = system.K.getOwnershipRange()
    return np.random.default_rng(seed).standard_normal((system.K.getSize()[0], columns))[first:last]


def _modes(system, omega, transposed):
    """Real and imaginary parts of the modes of (K, M), or (K^T, M), below BEYOND omega, by block Arnoldi of P^-1 M."""
    krylov, n = _Basis(system, of_krylov=True), system.K.getSize()[0]
    block = krylov.add(_random(system, min(BLOCK, n), 1 + transposed))
    H = np.zeros((block.shape[1], 0))
    for step in itertools.count(1):
        W = system.solve(system.product(system.M, block), transposed)
        block = krylov.add(W)
        H = np.hstack([np.vstack([H, np.zeros((block.shape[1], H.shape[1]))]), krylov.gram(krylov.MV, W)])
        m, is_all = H.shape[1], block.shape[1] == 0
        if not is_all and step % 4:
            continue
        nu, Y = np.linalg.eig(H[:m])
        distance = abs(1.0 / nu - system.mu)
        residual = np.linalg.norm(H[m:] @ Y, axis=0) / abs(nu)
        if is_all or (np.all(residual[distance <= (1.1 * omega) ** 2] < 1e-3) and np.any(distance > (BEYOND * omega) ** 2)):
            near = distance <= max((BEYOND * omega) ** 2, np.sort(distance)[: 2 * BLOCK][-1])
            return krylov.V[:, :m] @ np.hstack([Y[:, near].real, Y[:, near].imag])


def _pairs(basis, omega, damped_up_to):
    """The wanted pairs of the projected problem: lambda, right and left vectors in V."""
    m = basis.V.shape[1]
    # In the unit of time in which the frequency is 1, so that no block outweighs the others.
    A = np.block([[np.zeros((m, m)), np.eye(m)], [-basis.K_r / omega**2, -basis.D_r / omega]])
    values, left, right = scipy.linalg.eig(A, left=True)
    values = omega * values
    wanted = (values.imag >= 0.0) & (values.imag <= omega) & (abs(values) <= BEYOND * omega)
    wanted &= values.real >= -damped_up_to * abs(values)
    wanted = np.flatnonzero(wanted)
    wanted = wanted[np.lexsort((values[wanted].real, values[wanted].imag))]
    x, y = right[:m, wanted], left[m:, wanted]
    return values[wanted], x / np.linalg.norm(x, axis=0), y / np.linalg.norm(y, axis=0)


def _residuals(basis, values, x, y):
    r = basis.KV @ x + (basis.DV @ x) * values + (basis.MV @ x) * values**2
    s = basis.KtV @ y + (basis.DtV @ y) * values.conj() + (basis.MV @ y) * values.conj() ** 2
    return r, s


def _corrections(basis, values, x, y, r, s):
    """P^-1 r and P^-T s of each pair, the norms of the former, and estimates of the errors of the values."""
    system, k = basis.system, len(values)
    t = system.solve(np.hstack([r.real, r.imag]))
    u = system.solve(np.hstack([s.real, s.imag]), transposed=True)
    norms = np.sqrt(abs(system.sum(np.einsum("ij,ij->j", t, system.product(system.M, t)))).reshape(2, k).sum(0))  # of both parts
    slope = np.einsum("ij,ij->j", y.conj(), basis.D_r @ x + 2.0 * values * x)
    errors = abs(system.sum(np.einsum("ij,ij->j", s.conj(), t[:, :k] + 1j * t[:, k:])))
    return np.hstack([t, u]), norms, errors / np.maximum(abs(slope), 1e-300)


class _Search:
    """Enriches the basis until all wanted pairs have converged."""

    def __init__(self, basis, omega, tolerance, damped_up_to, monitor):
        self.basis, self.omega, self.tolerance, self.damped_up_to, self.monitor = basis, omega, tolerance, damped_up_to, monitor
        self.values = self.errors = self.norms = np.zeros(0)
        self.sizes = np.zeros((2, 0))  # of r and s
        self.rounds = 0

    def converge(self):
        while True:
            self.rounds += 1
            new, n_open = self._round()
            if self.monitor:
                self.monitor(f"round {self.rounds}", len(self.values), n_open, self.basis.V.shape[1])
            if n_open == 0:
                return
            if self.rounds >= MOST_ROUNDS:
                raise Error(f"{n_open} of {len(self.values)} eigenvalues have not converged after {MOST_ROUNDS} rounds; "
                            "take a larger tolerance, a lower frequency or a lower damped_up_to")  # fmt: skip
            self.basis.add(new, 1e-3, MOST_NEW)

    def _round(self):
        """One projection; the corrections of pairs that are open, and how many these are. Of a pair that had converged and
        whose residuals have not grown, the estimate stands."""
        values, self.x, self.y = _pairs(self.basis, self.omega, self.damped_up_to)
        r, s = _residuals(self.basis, values, self.x, self.y)
        sizes = np.sqrt(self.basis.system.sum(np.array([(abs(r) ** 2).sum(0), (abs(s) ** 2).sum(0)])))
        limit = self.tolerance * np.maximum(abs(values), 1e-3 * self.omega)
        errors, norms, moved = (np.full(len(values), np.inf) for _ in range(3))
        for i, value in enumerate(values if len(self.values) else ()):
            j = np.argmin(abs(self.values - value))
            moved[i] = abs(self.values[j] - value)
            if moved[i] <= 10.0 * limit[i] and np.all(sizes[:, i] <= 1.5 * self.sizes[:, j] + 1e-300):
                errors[i], norms[i] = self.errors[j], self.norms[j]
        tried = np.flatnonzero(errors > limit)
        new, norms[tried], errors[tried] = _corrections(
            self.basis, values[tried], self.x[:, tried], self.y[:, tried], r[:, tried], s[:, tried])  # fmt: skip
        is_open = (errors > limit) | (moved > 10.0 * limit)
        if self.basis.V.shape[1] >= self.basis.system.K.getSize()[0]:
            is_open[:] = False
        self.values, self.errors, self.norms, self.sizes = values, errors, norms, sizes
        return new[:, np.tile(is_open[tried], 4)], int(is_open.sum())


def _check_space(basis, seed):
    """Random vectors beyond V, of which the low motions are left."""
    system, found = basis.system, []
    for transposed in (False, True):
        X = basis.orthogonal(_random(system, 4, seed + transposed))
        for _ in range(8):
            X = basis.orthogonal(system.solve(system.product(system.M, X), transposed))
            X /= np.sqrt(np.maximum(system.sum((X * X).sum(0)), 1e-300))
        found.append(X)
    return np.hstack(found)


def _rounding(basis, values, x, y):
    """What rounding of the entries of the matrices may do to the values: the diagonals tell of what size terms cancel.

    A perturbation of size delta of a simple value is one of delta / |y^H Q' x|, and one of sqrt(delta) where two meet.
    """
    system = basis.system
    moved = abs(basis.V @ x) * abs(basis.V @ y)
    delta = sum(
        abs(values) ** power * system.sum(abs(A.getDiagonal().getArray()) @ moved)
        for A, power in ((system.K, 0), (system.D, 1), (system.M, 2)) if A is not None)  # fmt: skip
    delta = 16.0 * np.finfo(float).eps * delta
    slope = abs(np.einsum("ij,ij->j", y.conj(), basis.D_r @ x + 2.0 * values * x))
    return delta / np.maximum(np.maximum(slope, np.sqrt(delta)), 1e-300)


@_one_thread_at_a_time
def complex_eigenvalues(M, D, K, *, up_to_Hz: float, tolerance: float = 1e-8, damped_up_to: float = 0.1,
                        start: ComplexEigenvalues | None = None, monitor: Callable[..., object] | None = None) -> ComplexEigenvalues:  # fmt: skip
    """The eigenvalues of lambda^2 M + lambda D + K with |Im lambda| <= 2 pi up_to_Hz whose damping ratio is below a limit.

    Args:
        M, D, K: sparse matrices of scipy on one process, or of petsc4py on any number of ranks; M symmetric and positive
            definite, D (or None) and K of any kind
        tolerance: of the estimated errors, relative to |lambda|
        damped_up_to: pairs with Re lambda < -damped_up_to |lambda| are left out
        start: results of similar matrices, whose basis is begun with, as of another speed
        monitor: is called in each round with its name, the numbers of pairs and of open ones, and the size of the basis

    Raises:
        chladni.Error: where a matrix does not fit, or pairs do not converge

    >>> import scipy.sparse
    >>> M, K = scipy.sparse.identity(2), scipy.sparse.csr_matrix([[4.0, 1.0], [-1.0, 4.0]])  # flutter: -lambda^2 = 4 +- i
    >>> found = complex_eigenvalues(M, None, K, up_to_Hz=1.0)
    >>> [f"{value:.4f}" for value in found.unstable]
    ['0.2481+2.0153j']
    """
    for name, value in (("up_to_Hz", up_to_Hz), ("tolerance", tolerance)):
        if not (value > 0.0 and np.isfinite(value)):
            raise Error(f"{name} is {value}: give a positive number")
    if M is None or K is None:
        raise Error(f"{'M' if M is None else 'K'} is None: give a matrix; D alone may be left out")
    given = [(None, False) if A is None else _petsc(A) for A in (M, D, K)]
    system = None
    try:
        _check(*(A for A, _ in given))
        _check_start(start, given[2][0])
        omega = 2.0 * np.pi * up_to_Hz
        system = _System(*(A for A, _ in given), omega)
        return _found(system, omega, tolerance, damped_up_to, start, monitor)
    finally:
        if system is not None:
            system.destroy()
        for A, is_copy in given:
            if is_copy:
                A.destroy()


def _found(system, omega, tolerance, damped_up_to, start, monitor):
    basis = _Basis(system)
    basis.add(np.hstack([_modes(system, omega, transposed) for transposed in (False, True)]) if start is None else start.basis, 1e-6)
    search = _Search(basis, omega, tolerance, damped_up_to, monitor)
    search.converge()
    found_by_check = 0
    for seed in range(11, 31, 2):
        n_before = len(search.values)
        basis.add(_check_space(basis, seed))
        search.converge()
        found_by_check += max(len(search.values) - n_before, 0)
        if len(search.values) <= n_before:
            break
    else:
        raise Error(f"each of ten searches has found pairs that were missed, {found_by_check} in all; take a lower frequency")
    return ComplexEigenvalues(
        values=search.values, errors=search.errors + _rounding(basis, search.values, search.x, search.y),
        residuals=search.norms, right=basis.V @ search.x, left=basis.V @ search.y,
        basis=basis.V, rounds=search.rounds, solves=system.n_solves, found_by_check=found_by_check)  # fmt: skip


def _check_start(start, K):
    """The rows of another system, or of another layout on some rank, are no start."""
    if start is None:
        return
    fits, comm = start.basis.shape[0] == K.getLocalSize()[0], K.getComm()
    if not (fits if comm.getSize() == 1 else all(comm.tompi4py().allgather(fits))):
        raise Error(f"start is of other matrices: its basis has {start.basis.shape[0]} rows on this rank, and K has {K.getLocalSize()[0]}")


def _check(M, D, K):
    """What is no second-order system is refused by matrix and row (from 1)."""
    n = K.getSize()[0]
    for name, A in (("M", M), ("D", D), ("K", K)):
        if A is None:
            continue
        if A.getSize() != (n, n):
            raise Error(f"{name} is {' x '.join(map(str, A.getSize()))}, and K has {n} rows: all matrices must be square and of one size")
        first, _ = A.getOwnershipRange()
        starts, columns, values = A.getValuesCSR()
        wrong = np.flatnonzero(~np.isfinite(values))
        row = first + int(np.searchsorted(starts, wrong[0], "right")) if len(wrong) else n + 1
        _agree(A, row, n, f"{name}, row {{}}: an entry is not a finite number")
    first, _ = M.getOwnershipRange()
    light = np.flatnonzero(M.getDiagonal().getArray() <= 0.0)
    _agree(M, first + int(light[0]) + 1 if len(light) else n + 1, n, "M, row {}: the diagonal is not positive; rows without mass must be condensed")
    transposed = M.transpose(PETSc.Mat())
    transposed.axpy(-1.0, M)
    starts, _, values = transposed.getValuesCSR()
    skew = np.flatnonzero(abs(values) > 1e-10 * M.norm(PETSc.NormType.INFINITY))
    row = first + int(np.searchsorted(starts, skew[0], "right")) if len(skew) else n + 1
    transposed.destroy()
    _agree(M, row, n, "M, row {}: the matrix is not symmetric; only D and K may be unsymmetric")


def _agree(A, row, n, sentence):
    """An error of the first bad row on any rank is one of all ranks."""
    comm = A.getComm()
    row = row if comm.getSize() == 1 else min(comm.tompi4py().allgather(row))
    if row <= n:
        raise Error(sentence.format(row))
