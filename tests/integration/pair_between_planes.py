"""The critical speed of one pair of modes between two pads, from what the nodes of its rings do: displacements and rotations of a
body file, forces of first order written down here, eigenvalues by numpy. What `squeal` has in common with it is the body alone."""

import h5py
import numpy as np

PAD = {"k": 6e6, "N_0": 2000.0, "mu": 0.6, "r": 0.13}


def harmonics(body, ring, modes, n):
    """[mode, (cos, sin)] of what the nodes of a ring do: w, radial and tangential displacement, rotations about both directions."""
    rows, components = body["modes/row_nodes"][:], body["modes/row_components"][:]
    motion, group = body["modes/attachment_displacements"][:][:, modes], body[f"rings/{ring}"]
    theta = group["angles"][:]
    at = np.zeros((len(theta), 6, len(modes)))
    for i, node in enumerate(group["nodes"][:]):
        for row in np.flatnonzero(rows == node):
            at[i, components[row] - components.min()] = motion[row]
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    polar = {"w": at[:, 2], "u_r": c * at[:, 0] + s * at[:, 1], "u_t": c * at[:, 1] - s * at[:, 0],
             "rot_r": c * at[:, 3] + s * at[:, 4], "rot_t": c * at[:, 4] - s * at[:, 3]}
    waves = 2 / len(theta) * np.array([np.cos(n * theta), np.sin(n * theta)])
    return {name: (waves @ values).T for name, values in polar.items()}


def planes_of(body, rings, modes, n):
    """Of each (ring, distance of the contact plane above it), in the coordinates a, b of which w = W (a cos + b sin): the plane
    moves by R a radially and T b along itself where a is largest, and leans by W_r a and S b."""
    seen, planes = [harmonics(body, ring, modes, n) for ring, _ in rings], []
    u, _, v = np.linalg.svd(seen[0]["w"])
    for (_, z), ring in zip(rings, seen):
        f = {name: (u @ v).T @ values for name, values in ring.items()}
        planes.append({"W": f["w"][0, 0], "W_r": -f["rot_t"][0, 0], "S": f["rot_r"][1, 0],
                       "R": f["u_r"][0, 0] + z * f["rot_t"][0, 0], "T": f["u_t"][1, 0] - z * f["rot_r"][1, 0]})
    return planes


def of_a_plate(plane, thickness):
    """What both planes would do, did a plate of this thickness lean like one of them."""
    half = 0.5 * thickness
    return [{**plane, "R": -side * half * plane["W_r"], "T": -side * half * plane["S"]} for side in (1, -1)]


def largest_growth(planes, omega, n, speed):
    """Normal force N_0 + k w across each plane, friction mu N against the slip, whose direction turns with the radial velocity."""
    k, N_0, mu, r = PAD.values()
    C = 2 * n * speed * np.array([[0.0, 1.0], [-1.0, 0.0]])
    K = (omega**2 - (n * speed) ** 2) * np.eye(2)
    for side, plane in zip((1, -1), planes):
        W, W_r, S, R, T = (plane[key] for key in ("W", "W_r", "S", "R", "T"))
        C[0, 0] += mu * N_0 * R**2 / (speed * r)
        K += [[k * W**2 - side * N_0 * R * W_r, mu * N_0 * R**2 * n / r], [side * mu * k * T * W, -side * N_0 * T * S * (1 + mu**2)]]
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-K, -C]])
    return np.linalg.eigvals(A).real.max()


def critical_speed(planes, omega, n, low=5.0, high=200.0):
    """By bisection, rad/s."""
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if largest_growth(planes, omega, n, middle) > 0 else (middle, high)
    return low


def critical_speeds(path, rings, modes, n, thickness):
    """Of the planes as they move, and as those of a plate that leans like the first."""
    with h5py.File(path) as body:
        omega = body["modes/frequencies"][:][modes].mean()
        planes = planes_of(body, rings, modes, n)
    return critical_speed(planes, omega, n), critical_speed(of_a_plate(planes[0], thickness), omega, n)
