"""The annular Kirchhoff plate, clamped inside and free outside, in closed form (equations 5.4 to 5.10 of the source).

    U = C_1 J_n(b r) + C_2 Y_n(b r) + C_3 I_n(b r) + C_4 K_n(b r),   omega = b^2 sqrt(D / gamma)
    Delta U = -b^2 U of J and Y, +b^2 U of I and K
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp

FUNCTIONS = ((jv, jvp, -1.0), (yv, yvp, -1.0), (iv, ivp, 1.0), (kv, kvp, 1.0))


def conditions(b, n, plate):
    """[4 x 4]: U and U' at r_i, bending moment and shear force at r_a, of each function."""
    r_i, r_a, nu = plate["r_i"], plate["r_a"], plate["nu"]
    columns = []
    for f, f_prime, sign in FUNCTIONS:
        U, U_1 = f(n, b * r_a), b * f_prime(n, b * r_a)
        U_2 = sign * b**2 * U - U_1 / r_a + n**2 * U / r_a**2
        moment = U_2 + nu * (U_1 / r_a - n**2 * U / r_a**2)
        shear = sign * b**2 * U_1 - (1 - nu) * n**2 / r_a**2 * (U_1 - U / r_a)
        columns.append([f(n, b * r_i), b * f_prime(n, b * r_i), moment, shear])
    rows = np.array(columns).T
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def wave_number(n, plate):
    """The lowest b at which the conditions have a solution, 1/m."""
    determinant = lambda b: np.linalg.det(conditions(b, n, plate))
    grid = np.linspace(1.0, 12.0, 400) / plate["r_a"]
    values = [determinant(b) for b in grid]
    first = next(i for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0)
    return brentq(determinant, grid[first], grid[first + 1], xtol=1e-13)


def frequency(n, plate):
    """Hz."""
    return wave_number(n, plate) ** 2 * np.sqrt(plate["D"] / plate["gamma"]) / (2 * np.pi)


def mode(n, plate, r):
    """U(r), 1 at the outer edge."""
    b = wave_number(n, plate)
    C = np.linalg.svd(conditions(b, n, plate))[2][-1]
    U = lambda x: sum(c * f(n, b * x) for c, (f, _, _) in zip(C, FUNCTIONS))
    return U(r) / U(plate["r_a"])
