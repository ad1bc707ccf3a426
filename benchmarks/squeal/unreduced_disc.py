"""Complex eigenvalues of a rotating disc between pads, of the FE model itself.

In the inertial frame a disc that is the same in every position answers a force f exp(lambda t) at a pad harmonic by harmonic,
  u = H_0 f,  H_0 = sum_d H_d(s_d),  s_d = lambda + i d Omega,  H_d(s) = B_d^H (K + s^2 M)^-1 B_d / n^2,
with B_d the load exp(i d theta) on the n nodes of the ring, an axial force and moments about both slopes. The material rates
are p = H_1 f, H_1 = sum_d s_d H_d(s_d), and f = D_a u + D_p p closes it: the eigenvalues are the zeros of
det(I - D_a H_0 - D_p H_1), of order 3. Harmonic d answers harmonic d alone, which is the mean over all positions of the disc, and
d = n / 2 is left out: as in `squeal`.
"""
import cmath

import numpy as np
import petsc4py
import scipy.linalg
import scipy.sparse

petsc4py.init()
from petsc4py import PETSc  # noqa: E402  after init

MOMENTS = 8
COMPLEX_STEP = 1e-30


def petsc_matrix(file):
    """A symmetric sparse matrix of PETSc's binary viewer."""
    _, m, n, nnz = map(int, np.fromfile(file, ">i4", 4))
    lengths = np.fromfile(file, ">i4", m, offset=16)
    columns = np.fromfile(file, ">i4", nnz, offset=16 + 4 * m)
    values = np.fromfile(file, ">f8", nnz, offset=16 + 4 * m + 4 * nnz)
    A = scipy.sparse.csr_matrix((values.astype(float), columns.astype(int), np.r_[0, np.cumsum(lengths)]), (m, n))
    if abs(A - A.T).max() > 1e-9 * abs(A).max():
        raise SystemExit(f"unreduced_disc.py: {file} is not symmetric")
    return A


class Factor:
    """LDL^T of a real symmetric matrix by MUMPS, ordered by METIS."""

    def __init__(self, A):
        upper = scipy.sparse.triu(A, format="csr")
        upper.sort_indices()
        csr = (upper.indptr.astype("i4"), upper.indices.astype("i4"), upper.data)
        self.A = PETSc.Mat().createSBAIJ(upper.shape, 1, csr=csr)
        self.ksp = PETSc.KSP().create()
        self.ksp.setOperators(self.A)
        self.ksp.setType("preonly")
        pc = self.ksp.getPC()
        pc.setType("cholesky")
        pc.setFactorSolverType("mumps")
        pc.setFactorSetUpSolverType()
        pc.getFactorMatrix().setMumpsIcntl(7, 5)
        self.ksp.setUp()
        self.matrix = pc.getFactorMatrix()

    def solve(self, B):
        b = PETSc.Mat().createDense(B.shape, array=np.asfortranarray(B))
        x = PETSc.Mat().createDense(B.shape)
        x.setUp()
        self.matrix.matSolve(b, x)
        X = x.getDenseArray().copy()
        b.destroy(), x.destroy()
        return X

    def free(self):
        self.ksp.destroy(), self.A.destroy()


class FeModel:
    """K and M with the hub held, and the loads of the ring; of the files K, M and masters that `chladni reduce` has written."""

    def __init__(self, folder):
        import h5py
        K, M = petsc_matrix(folder / "K"), petsc_matrix(folder / "M")
        masters = np.fromfile(folder / "masters", ">i4")[2:].astype(int)
        with h5py.File(folder / "disc.reduced.h5") as file:
            ring, hub = (file["attachment/sets"][name][:] for name in ("track", "hub"))
            positions = file["attachment/node_positions"][:]
        dofs = masters.reshape(-1, 6)  # x, y, z, rx, ry, rz of each attachment node
        free = np.setdiff1d(np.arange(K.shape[0]), dofs[hub].ravel())
        number = np.full(K.shape[0], -1)
        number[free] = np.arange(len(free))
        self.K, self.M = K[free][:, free].tocsr(), M[free][:, free].tocsr()
        self.n = len(ring)
        self.theta = np.arctan2(positions[ring, 1], positions[ring, 0])
        self.load = ring_loads(number[dofs[ring]], self.theta, len(free))

    def harmonics(self):
        return range((self.n - 1) // 2 + 1)

    def harmonic(self, d):
        """B_d [n x 3]."""
        wave = np.exp(1j * d * self.theta)
        return np.column_stack([b @ wave for b in self.load])


def ring_loads(at, theta, n_dofs):
    """What moves with u_z, W_r = -theta_t and W_t = theta_r at the nodes with the DOFs `at` [n x 6]; each [n_dofs x n]."""
    c, s, n = np.cos(theta), np.sin(theta), len(theta)
    parts = [[(2, np.ones(n))], [(3, s), (4, -c)], [(3, c), (4, s)]]
    of = lambda dof, value: scipy.sparse.csc_matrix((value, (at[:, dof], np.arange(n))), (n_dofs, n))
    return [sum(of(*part) for part in kind) for kind in parts]


class Poles:
    """H_d(s) = sum of c_j c_j^H / (omega_j^2 + s^2) + G_d; {d: (omega_j^2 [m], c [m x 3])} for d >= 0, G_d without: 0."""

    def __init__(self, poles, static=None):
        self.poles, self.static = poles, static or {}

    def __call__(self, d, s):
        omega_2, c = self.poles[abs(d)]
        G = self.static.get(abs(d), 0.0)
        c, G = (c.conj(), np.conj(G)) if d < 0 else (c, G)
        return (c.conj().T / (omega_2 + s * s)) @ c + G


def projected(fe, omega_0):
    """`Poles` by projection on the moments of (K - omega_0^2 M)^-1 B_d."""
    factor = Factor(fe.K - omega_0**2 * fe.M)
    poles = {}
    for d in fe.harmonics():
        B = fe.harmonic(d)
        X = factor.solve(np.column_stack([B.real, B.imag]) if d else B.real)
        basis = np.zeros((X.shape[0], 0))
        for k in range(MOMENTS):
            for _ in range(2):
                X -= basis @ (basis.T @ X)
            q, r = np.linalg.qr(X)
            q = q[:, abs(np.diag(r)) > 1e-10 * abs(np.diag(r)).max()]
            basis = np.column_stack([basis, q])
            X = factor.solve(fe.M @ q) if k + 1 < MOMENTS else X
        omega_2, Phi = scipy.linalg.eigh(basis.T @ (fe.K @ basis), basis.T @ (fe.M @ basis))
        poles[d] = omega_2, Phi.T @ (basis.T @ B) / fe.n
    factor.free()
    return Poles(poles)


def static_receptances(fe):
    """{d: H_d(0)} by a factorization of K."""
    factor = Factor(fe.K)
    found = {}
    for d in fe.harmonics():
        B = fe.harmonic(d)
        X = factor.solve(np.column_stack([B.real, B.imag]))
        found[d] = B.conj().T @ (X[:, :3] + 1j * X[:, 3:]) / fe.n**2
    factor.free()
    return found


def factored(fe, d, s):
    """H_d(s) by a factorization of K - Im(s)^2 M and refinement with K + s^2 M until its residual is below 1e-9."""
    B = fe.harmonic(d)
    factor = Factor(fe.K - s.imag**2 * fe.M)
    X = np.zeros_like(B)
    for _ in range(60):
        R = B - fe.K @ X - s * s * (fe.M @ X)
        if np.linalg.norm(R) < 1e-9 * np.linalg.norm(B):
            factor.free()
            return B.conj().T @ X / fe.n**2
        dX = factor.solve(np.column_stack([R.real, R.imag]))
        X = X + dX[:, :3] + 1j * dX[:, 3:]
    raise SystemExit(f"unreduced_disc.py: the refinement at harmonic {d}, {s} did not converge")


class Pads:
    """One pad pair of a scene's [squeal] on its ring, bilateral and without damping."""

    def __init__(self, scene):
        squeal = scene["squeal"]
        pad, = squeal["pads"]
        self.radius, = (ring["radius"] for ring in scene["mesh"]["rings"] if ring["name"] == squeal["ring"])
        self.thickness, self.friction = squeal["thickness"], squeal["friction"]
        self.stiffness, self.preload = pad["stiffness"], pad["preload"]

    def forces(self, motion, rates, speed):
        """(F_w, F_r, F_t) on the disc at (w, g_r, g_t) and their material rates."""
        w, g_r, g_t = motion
        s = cmath.sqrt(1 + g_r * g_r + g_t * g_t)
        half = 0.5 * self.thickness
        F = np.zeros(3, complex)
        for sigma in (1.0, -1.0):
            v_x, v_y = -sigma * half / s * rates[1], speed * self.radius - sigma * half / s * rates[2]
            v_z = g_r * v_x + g_t * v_y
            v = cmath.sqrt(v_x * v_x + v_y * v_y + v_z * v_z)
            S = self.preload + sigma * self.stiffness * (w + sigma * half * (s - 1))
            N = S / (1 / s + sigma * self.friction * v_z / v)
            f_r = sigma * N * g_r / s - self.friction * N * v_x / v
            f_t = sigma * N * g_t / s - self.friction * N * v_y / v
            F += np.array([-sigma * S, -sigma * half / s * f_r, -sigma * half / s * f_t])
        return F

    def derivatives(self, speed):
        """D_a and D_p at rest, by complex steps."""
        D = np.zeros((3, 6))
        for j in range(6):
            x = np.zeros(6, complex)
            x[j] = 1j * COMPLEX_STEP
            D[:, j] = self.forces(x[:3], x[3:], speed).imag / COMPLEX_STEP
        return D[:, :3], D[:, 3:]

    def closed_form(self, speed):
        """The same by hand."""
        k, N, mu, h, r = self.stiffness, self.preload, self.friction, self.thickness, self.radius
        D_a = -np.array([[2 * k, 0, 0], [0, N * h, 0], [-mu * h * k, 0, (1 + mu * mu) * N * h]])
        return D_a, np.diag([0.0, -mu * N * h * h / (2 * r * speed), 0.0])


def closing(pads, n, receptance):
    """(lambda, Omega) -> det(I - D_a H_0 - D_p H_1) for receptances (d, s) -> H_d(s)."""
    def determinant(lam, speed):
        D_a, D_p = pads.derivatives(speed)
        H_0, H_1 = np.zeros((3, 3), complex), np.zeros((3, 3), complex)
        for d in range(-((n - 1) // 2), (n - 1) // 2 + 1):
            s = lam + 1j * d * speed
            H = receptance(d, s)
            H_0 += H
            H_1 += s * H
        return np.linalg.det(np.eye(3) - D_a @ H_0 - D_p @ H_1)
    return determinant


def eigenvalue(determinant, guess, speed):
    """The zero beside a guess, by the secant method."""
    x, dx = guess, 1e-6 * abs(guess)
    y = determinant(x, speed)
    for _ in range(60):
        x_2 = x + dx
        y_2 = determinant(x_2, speed)
        dx = -y_2 * dx / (y_2 - y)
        x, y = x_2, y_2
        if abs(dx) < 1e-11 * abs(x):
            return x + dx
    raise SystemExit(f"unreduced_disc.py: no eigenvalue found from {guess} at {speed} rad/s")


def critical_speed(determinant, guess, omega):
    """(speed, lambda) at which the eigenvalue beside i omega has no growth, by the secant method."""
    speed, lam = guess, eigenvalue(determinant, 1j * omega, guess)
    change = 1e-3 * speed
    for _ in range(40):
        above = eigenvalue(determinant, lam, speed + change)
        speed, change, growth, lam = speed + change, -above.real * change / (above.real - lam.real), lam.real, above
        if abs(change) < 1e-9 * speed:
            return speed + change, lam
    raise SystemExit(f"unreduced_disc.py: no critical speed found from {guess} rad/s")
