"""What the scripts of the beam example share: the two cases, the response of a body, the full model.

Units: length, bending stiffness and mass per length are 1.
"""

import json
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

REFERENCE = json.loads((Path(__file__).parent / "reference.json").read_text())
OMEGA_1_FREE = REFERENCE["omega_1_free"]  # first elastic frequency of the free beam
HIGHEST = 3 * OMEGA_1_FREE  # of the harmonic loads
SIZES = (3, 5)  # constrained modes kept
FRM_RATIOS = (0.0, 0.5, 1.0, 2.5)  # omega0 of the interface mode over OMEGA_1_FREE
N_ELEMENTS = 300


@dataclass(frozen=True)
class Case:
    name: str  # of the scene
    load: str  # component of the load at B
    fixed: tuple  # DOFs of the full model, (w, slope) of each node in turn
    title: str

    def load_dof(self):
        return 2 * (N_ELEMENTS // 3) + (self.load == "ry")

    def load_row(self):
        """Row of modes/attachment_displacements: node B is the second one."""
        return 6 + (4 if self.load == "ry" else 2)


CASES = (
    Case("cantilever", "ry", (0, 1), "cantilever, moment at B"),
    Case("supported", "z", (0, 2 * N_ELEMENTS), "simply supported, force at B"),
)


def body_name(n, ratio):
    """Of a body with n modes and, unless `ratio` is None, an interface mode at omega0 = ratio OMEGA_1_FREE."""
    kind = "" if ratio is None else ", IRM" if ratio == 0 else f", FRM at {ratio:g} omega_1"
    return f"{n} modes{kind}"


def body_file(folder, case, name=""):
    return Path(folder) / case.name / name / f"{case.name}.body.h5"


@dataclass(frozen=True)
class Response:
    """Amplitudes: w and slope at the nodes, moment at both ends of each element, shear in each."""

    x: np.ndarray
    w: np.ndarray
    slope: np.ndarray
    M: np.ndarray  # [n_elements, 2]
    Q: np.ndarray  # [n_elements]

    def norms(self):
        """L2 norms over the length of w (cubic in an element), M (linear) and Q (constant)."""
        a, b = self.M.T
        return np.array([norm_of_cubics(self), np.sqrt(np.sum(a * a + a * b + b * b) / 3),
                         np.linalg.norm(self.Q)])  # fmt: skip

    def __sub__(self, other):
        return Response(self.x, self.w - other.w, self.slope - other.slope, self.M - other.M,
                        self.Q - other.Q)  # fmt: skip

    def errors(self, exact):
        """Relative errors of w, M, Q."""
        return (self - exact).norms() / exact.norms()


def hermite(xi, h):
    return np.array([1 - 3 * xi**2 + 2 * xi**3, h * (xi - 2 * xi**2 + xi**3),
                     3 * xi**2 - 2 * xi**3, h * (xi**3 - xi**2)])  # fmt: skip


def norm_of_cubics(response):
    points, weights = np.polynomial.legendre.leggauss(4)
    h = response.x[1] - response.x[0]
    u = np.stack([response.w[:-1], response.slope[:-1], response.w[1:], response.slope[1:]])
    values = [hermite((1 + point) / 2, h) @ u for point in points]
    return np.sqrt(sum(weight * np.sum(v * v) for weight, v in zip(weights / 2, values)))


def element_stiffness(h):
    return np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                     [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]) / h**3  # fmt: skip


def element_mass(h):
    return np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2],
                     [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h**2, -22 * h, 4 * h**2]]) * h / 420  # fmt: skip


def assembled(element):
    n = 2 * (N_ELEMENTS + 1)
    A = np.zeros((n, n))
    for e in range(N_ELEMENTS):
        A[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += element
    return A


def full_response(case, Omega):
    """Of the full model of 602 DOFs to the unit load at B; written here anew, apart from Chladni."""
    h = 1 / N_ELEMENTS
    K = assembled(element_stiffness(h))
    free = np.setdiff1d(np.arange(len(K)), case.fixed)
    load = np.zeros(len(K))
    load[case.load_dof()] = -1.0 if case.load == "ry" else 1.0  # theta_y = -w'
    A = (K - Omega**2 * assembled(element_mass(h)))[np.ix_(free, free)]
    u = np.zeros(len(K))
    u[free] = np.linalg.solve(A, load[free])
    u[free] += np.linalg.solve(A, load[free] - A @ u[free])  # one step of refinement
    u_e = np.stack([u[2 * e : 2 * e + 4] for e in range(N_ELEMENTS)], axis=1)
    forces = element_stiffness(h) @ u_e
    # The signs of Chladni: forces on the face with normal +x, the moment about y.
    return Response(np.linspace(0, 1, N_ELEMENTS + 1), u[::2], u[1::2],
                    np.stack([forces[1], -forces[3]], axis=1), -forces[0])  # fmt: skip


def rows(body, kind):
    """The modes' resultants of one kind at both ends of each element, [n_elements, 2, n_modes]."""
    group = body["resultants/beam"]
    kinds = list(group["kinds"].asstr()[:])
    modes = group["modes"][:]
    return modes[kinds.index(kind) :: len(kinds)].reshape(N_ELEMENTS, 2, -1)


def modes_at_nodes(file):
    """x and the transverse displacement of each mode or coordinate there."""
    with h5py.File(file) as f:
        x = f["picture/positions"][:, 0]
        w = f["picture/displacements"][2::3]
    order = np.argsort(x)
    return x[order], w[order]


def body_response(file, case, Omega):
    """Of a body to the unit load at B."""
    x, w = modes_at_nodes(file)
    with h5py.File(file) as body:
        load = body["modes/attachment_displacements"][case.load_row()]
        q = load / (body["modes/frequencies"][:] ** 2 - Omega**2)
        M, Q = rows(body, "M_y") @ q, rows(body, "Q_z") @ q
    return Response(x, w @ q, slopes(w @ q, M, x[1] - x[0]), M, Q.mean(axis=1))


def slopes(w, M, h):
    """w' at the nodes of cubics with these end values and end moments; M_y = -w''."""
    left, right = -M.T
    first = np.diff(w) / h - h * (2 * left + right) / 6
    return np.append(first, np.diff(w)[-1] / h + h * (left[-1] + 2 * right[-1]) / 6)


def receptances(file, case, Omega):
    """Response at the load to the load, with the damping that the selection by tolerance assumes."""
    with h5py.File(file) as body:
        b = body["modes/attachment_displacements"][case.load_row()]
        omega2 = body["modes/frequencies"][:] ** 2
    D = (1 + 0.02j) * omega2 - Omega[:, None] ** 2
    return (b**2 / D).sum(axis=1), np.sqrt((b**4 / np.abs(D) ** 2).sum(axis=1))


def largest_response_error(complete, file, case, n=3000):
    """Over the range up to HIGHEST, as docs/explanation/theory.md defines it."""
    Omega = np.linspace(0, HIGHEST, n + 1)
    exact, incoherent = receptances(complete, case, Omega)
    difference = np.abs(receptances(file, case, Omega)[0] - exact)
    return float(np.max(difference / np.maximum(np.abs(exact), incoherent)))
