"""What does it cost to find all unstable eigenvalues of a brake whose friction is in its matrices, and which method finds them?

An annulus of hexahedra of order 1 between two pads; nodes of pads and disc coincide in the faces. Contact is a stiffness per
area along z, friction mu times its force along the motion of the disc: K is unsymmetric. D has a share of K, the damping that
friction has across its direction, and the Coriolis terms of the disc. Four methods on the same matrices, at several frictions:

- whole: all eigenvalues of the lowest modulus by TOAR of SLEPc on the whole system, with one LU factor of K; the reference
- enriched: chladni.complex_eigenvalues from nothing, and with the basis of another friction (`from another`)
- modes: the modes of K without friction up to 1.5 times the frequency (Krylov-Schur of SLEPc), as brakes are projected usually
- samples: Mehrmann and Schroeder (J. of Mathematics in Industry 6, 2016): the right eigenvectors of `whole` at the least and at
  the largest friction, their singular vectors above 1e-6 of the largest

usage: friction_matrices.py OUTPUT [--quick]
"""
import json
import pathlib
import sys
import time

import numpy as np
import scipy.linalg
import scipy.optimize
import scipy.sparse as sp
from petsc4py import PETSc
from slepc4py import SLEPc

RADII, HALF_HEIGHT, PAD = (0.08, 0.16), 0.01, 0.016  # m; thickness of a pad
DISC, LINING = (110e9, 0.27, 7150.0), (10e9, 0.3, 2500.0)  # Pa, -, kg/m^3
PRESSURE, SPEED = 2e6, 20.0  # Pa, rad/s
CONTACT = 2e13  # N/m^3
UP_TO_HZ = 6000.0


def hexahedra(X, elements, young, poisson, density):
    """K and M of hexahedra of order 1 at 2 x 2 x 2 points."""
    G = young / (2.0 + 2.0 * poisson)
    C = np.diag([2.0 * G] * 3 + [G] * 3)
    C[:3, :3] += young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    corner = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], float)
    n = len(elements)
    K_e, M_e = np.zeros((n, 24, 24)), np.zeros((n, 8, 8))
    for point in corner / np.sqrt(3.0):
        f = 1.0 + corner * point
        N, slopes = f.prod(1) / 8.0, np.array([corner[:, a] * np.delete(f, a, 1).prod(1) / 8.0 for a in range(3)])
        J = np.einsum("ai,eij->eaj", slopes, X[elements])
        g = np.einsum("eab,bi->eai", np.linalg.inv(J), slopes)
        volume = np.linalg.det(J)
        B = np.zeros((n, 6, 8, 3))
        for a in range(3):
            B[:, a, :, a] = g[:, a]
        for row, (a, b) in enumerate(((1, 2), (0, 2), (0, 1)), 3):
            B[:, row, :, a], B[:, row, :, b] = g[:, b], g[:, a]
        B = B.reshape(n, 6, 24)
        K_e += volume[:, None, None] * (B.transpose(0, 2, 1) @ (C @ B))
        M_e += density * volume[:, None, None] * np.outer(N, N)
    M3 = np.zeros((n, 8, 3, 8, 3))
    for a in range(3):
        M3[:, :, a, :, a] = M_e
    dofs = (3 * elements[:, :, None] + np.arange(3)).reshape(n, 24)
    places = np.repeat(dofs, 24, 1).ravel(), np.tile(dofs, 24).ravel()
    return [sp.coo_matrix((A.ravel(), places), shape=(3 * len(X),) * 2).tocsr() for A in (K_e, M3)]


def block(radii, angles, heights):
    """Nodes, elements, and numbers [angle, radius, height] of a grid; closed where the last angle is the first."""
    closed = bool(np.isclose(angles[-1] - angles[0], 2 * np.pi))
    P, R, Z = np.meshgrid(angles[:-1] if closed else angles, radii, heights, indexing="ij")
    X = np.stack([R * np.cos(P), R * np.sin(P), Z], -1).reshape(-1, 3)
    number = np.arange(len(X)).reshape(P.shape)
    around = np.concatenate([number, number[:1]]) if closed else number
    i, j, k = (size - 1 for size in around.shape)
    corners = [around[a : a + i, b : b + j, c : c + k].ravel() for c in (0, 1) for a, b in ((0, 0), (0, 1), (1, 1), (1, 0))]
    return X, np.stack(corners, 1), number


class Entries:
    def __init__(self):
        self.rows, self.columns, self.values = [], [], []

    def add(self, left, right, factor):
        """factor times left right^T, each a dict {DOF: coefficient}."""
        for i, a in left.items():
            for j, b in right.items():
                self.rows.append(i), self.columns.append(j), self.values.append(factor * a * b)

    def matrix(self, n):
        return sp.coo_matrix((self.values, (self.rows, self.columns)), shape=(n, n)).tocsr()


def brake(around, across, layers, friction=0.5):
    """M, D and K; an annulus on springs at its bore, pads of 60 degrees on springs at their backs."""
    angles, radii = np.linspace(0.0, 2 * np.pi, around + 1), np.linspace(*RADII, across + 1)
    heights, inner, outer = np.linspace(-HALF_HEIGHT, HALF_HEIGHT, layers + 1), 3 * across // 8, 7 * across // 8
    part = angles[: around // 6 + 1], radii[inner : outer + 1]
    bodies = [block(radii, angles, heights)]
    bodies += [block(part[1], part[0], side * HALF_HEIGHT + np.linspace(min(side, 0), max(side, 0), layers + 1) * PAD) for side in (-1, 1)]
    pairs = [hexahedra(X, elements, *(LINING if b else DISC)) for b, (X, elements, _) in enumerate(bodies)]
    K, M = (sp.block_diag([pair[i] for pair in pairs]).tocsr() for i in (0, 1))
    start = np.cumsum([0] + [len(X) for X, _, _ in bodies])
    contact, damping = Entries(), Entries()
    disc = bodies[0][2]
    for body, side in ((1, -1), (2, 1)):
        near, back = (-1, 0) if side < 0 else (0, -1)
        own = start[body] + bodies[body][2]
        for i in range(own.shape[0]):
            for j in range(own.shape[1]):
                p, d, r, phi = 3 * own[i, j, near], 3 * disc[i, inner + j, -1 if side > 0 else 0], part[1][j], part[0][i]
                area = r * (angles[1] - angles[0]) * (radii[1] - radii[0])
                area *= (0.5 if i in (0, own.shape[0] - 1) else 1.0) * (0.5 if j in (0, own.shape[1] - 1) else 1.0)
                gap = {d + 2: 1.0, p + 2: -1.0}
                along = {d: -np.sin(phi), d + 1: np.cos(phi), p: np.sin(phi), p + 1: -np.cos(phi)}
                aside = {d: np.cos(phi), d + 1: np.sin(phi), p: -np.cos(phi), p + 1: -np.sin(phi)}
                contact.add(gap, gap, CONTACT * area)
                contact.add(along, gap, friction * side * CONTACT * area)
                damping.add(aside, aside, friction * PRESSURE * area / (SPEED * r))
        for node in own[:, :, back].ravel():
            for c, stiffness in enumerate((2e8, 2e8, 5e7)):
                contact.add({3 * node + c: 1.0}, {3 * node + c: 1.0}, stiffness / own[:, :, back].size)
    for dof in (3 * disc[:, 0, :].ravel()[:, None] + np.arange(3)).ravel():
        contact.add({dof: 1.0}, {dof: 1.0}, 1e9 / disc[:, 0, :].size)
    turn = sp.kron(sp.diags((np.arange(start[-1]) < start[1]).astype(float)), np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    D = 2e-8 * K + damping.matrix(3 * start[-1]) + 2.0 * SPEED * (M @ turn)
    M.eliminate_zeros()
    return M, D.tocsr(), (K + contact.matrix(3 * start[-1])).tocsr()


def petsc(A):
    A = A.tocsr()
    return PETSc.Mat().createAIJ(A.shape, csr=(A.indptr.astype(np.int32), A.indices.astype(np.int32), A.data))


def lowest(solver, matrices, factor, limit):
    """Values and right vectors of the lowest modulus, as many as it takes for one to lie beyond the limit."""
    operators = [petsc(A) for A in matrices]
    for n_values in (80, 160, 320, 640, 1280):
        solver.reset()
        solver.setOperators(*(operators if factor == "cholesky" else [operators]))
        solver.setDimensions(n_values, 2 * n_values)
        st = solver.getST()
        st.setType("sinvert")
        pc = st.getKSP().getPC()
        st.getKSP().setType("preonly")
        pc.setType(factor)
        pc.setFactorSolverType("mumps")
        solver.solve()
        x, y, pairs = *(operators[0].createVecRight() for _ in range(2)), []
        for i in range(solver.getConverged()):
            value = complex(solver.getEigenpair(i, x, y))
            pairs.append((value, x.getArray() + 1j * y.getArray()))
        values = np.array([value for value, _ in pairs])
        if len(values) >= n_values and abs(values).max() > limit or n_values >= matrices[0].shape[0]:
            return values, np.array([vector for _, vector in pairs]).T
    raise SystemExit("friction_matrices.py: 1280 eigenvalues do not reach the frequency")


def whole(M, D, K, omega):
    """Eigenvalues up to omega, and their right vectors."""
    pep = SLEPc.PEP().create()
    pep.setType("toar")
    pep.setScale(SLEPc.PEP.Scale.SCALAR)
    pep.setTarget(0.0)
    pep.setWhichEigenpairs(SLEPc.PEP.Which.TARGET_MAGNITUDE)
    pep.setTolerances(1e-10, 200)
    values, X = lowest(pep, (K, D, M), "lu", omega)
    near = (values.imag >= 0.0) & (values.imag <= omega)
    return values[near], X[:, near]


def modes_without_friction(M, K, omega):
    eps = SLEPc.EPS().create()
    eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    eps.setTarget(0.0)
    eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    eps.setTolerances(1e-8, 200)
    values, X = lowest(eps, (K, M), "cholesky", omega**2)
    return X[:, values.real <= omega**2].real


def projected(V, M, D, K, omega):
    """Unstable eigenvalues of the system projected on the columns of V, and how many directions these have."""
    Q = scipy.linalg.orth(V / np.linalg.norm(V, axis=0), 1e-6)
    M_r, D_r, K_r = (Q.T @ (A @ Q) for A in (M, D, K))
    A = np.block([[np.zeros_like(M_r), np.eye(len(M_r))], [-np.linalg.solve(M_r, K_r) / omega**2, -np.linalg.solve(M_r, D_r) / omega]])
    values = omega * np.linalg.eigvals(A)
    return unstable(values[(values.imag >= 0.0) & (values.imag <= omega)]), Q.shape[1]


def unstable(values):
    """By more than the tolerance of the reference."""
    return values[values.real > 1e-8 * abs(values)]


def compared(found, reference):
    """Each unstable value of the reference beside one of its own, at most 1 % of its modulus away, and how far their growth rates are apart."""
    apart = abs(np.subtract.outer(reference, found))
    i, j = scipy.optimize.linear_sum_assignment(apart)
    near = apart[i, j] <= 1e-2 * abs(reference[i])
    error = abs(found[j].real - reference[i].real)[near]
    return {"found": int(near.sum()), "of": len(reference), "invented": len(found) - int(near.sum()),
            "growth_within_1_percent": int((error <= 1e-2 * reference[i].real[near]).sum()), "worst_1_per_s": float(max(error, default=0.0))}  # fmt: skip


def measured(sizes, frictions):
    root = pathlib.Path(__file__).resolve().parents[2]
    sys.path[:0] = [str(root / "build/release/python"), str(root / "benchmarks/reduction")]
    import chladni
    import run

    omega, rows, systems = 2 * np.pi * UP_TO_HZ, [], {friction: brake(*sizes, friction=friction) for friction in frictions}
    reference, samples, sampled = {}, [], 0.0

    def add(friction, method, began, values, size):
        rows.append({"friction": friction, "method": method, "seconds": time.process_time() - began, "size": size,
                     **compared(unstable(values), reference[friction])})  # fmt: skip
        print(rows[-1], flush=True)

    for friction in frictions:
        began = time.process_time()
        values, X = whole(*systems[friction], omega)
        reference[friction] = unstable(values)
        add(friction, "whole", began, values, X.shape[1])
        if friction in (frictions[0], frictions[-1]):
            samples += [X.real, X.imag]
            sampled += rows[-1]["seconds"]
    before = None
    for friction in (*frictions[:1], *frictions):
        began = time.process_time()
        found = chladni.complex_eigenvalues(*systems[friction], up_to_Hz=UP_TO_HZ, start=before)
        if before is None or friction != frictions[0]:
            add(friction, "enriched, from another" if before else "enriched", began, found.values, found.basis.shape[1])
        before = found
    began = time.process_time()
    M, _, K_0 = brake(*sizes, friction=0.0)
    modes, seconds = modes_without_friction(M, K_0, 1.5 * omega), time.process_time() - began
    for method, V, spent in (("modes", modes, seconds), ("samples", np.hstack(samples), sampled)):
        for friction in frictions:
            add(friction, method, time.process_time() - (spent if friction == frictions[0] else 0.0), *projected(V, *systems[friction], omega))
    return {"machine": run.machine(), "n_dofs": M.shape[0], "up_to_Hz": UP_TO_HZ, "rows": sorted(rows, key=lambda row: (row["friction"], row["method"]))}


def page(found):
    lines = ["# Unstable eigenvalues of matrices with friction in them", "",
             f"Written by `benchmarks/squeal/friction_matrices.py`, which makes the matrices: an annulus of hexahedra between two pads, {found['n_dofs']:,} DOFs, friction in K, all "
             f"eigenvalues of positive real part up to {found['up_to_Hz']:g} Hz. Those of `whole`, SLEPc's TOAR on the whole system with one LU factor of K and a tolerance of 1e-10, are what the "
             "others are compared with. `enriched` is `chladni.complex_eigenvalues`, from nothing or with the basis of the friction before. `modes` projects on the modes without friction up to "
             "1.5 times the frequency. `samples` is the method of Mehrmann and Schroeder (J. of Mathematics in Industry 6, 2016): eigenvectors of `whole` at the least and at the "
             "largest friction, their singular vectors above 1e-6 of the largest. They solve for their samples with several complex shifts, here one factor at 0 does. A value is found if one of the method "
             "lies within 1 % of its modulus; invented are unstable values of the method without such a partner. What `modes` and `samples` compute once is in the time of the least friction. CPU s on one core.", "",
             "| friction | method | size | found | of | growth within 1 % | invented | largest error, 1/s | CPU s |", "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]  # fmt: skip
    for row in found["rows"]:
        lines.append("| {friction:g} | {method} | {size} | {found} | {of} | {growth_within_1_percent} | {invented} | {worst_1_per_s:.2g} | {seconds:.1f} |".format(**row))
    return "\n".join([*lines, ""])


def main(output, quick):
    found = measured((24, 4, 1) if quick else (240, 24, 4), (0.4, 1.0) if quick else (0.3, 0.5, 0.7))
    out = pathlib.Path(output)
    (out / "friction_matrices.json").write_text(json.dumps(found, indent=1) + "\n")
    (out / "friction_matrices.md").write_text(page(found))


if __name__ == "__main__":
    main(sys.argv[1], "--quick" in sys.argv)
