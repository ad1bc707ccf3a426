"""Complex eigenvalues of a brake of several bodies, from its finite elements and from nothing of squeal's.

A body's matrices are those of a reduction by Craig and Bampton that keeps every mode with the masters held: a complete
basis, in which nothing is left out. Contact is linearised by hand about steady sliding, at the nodes, on a disc whose
matrices stand still (`convection = "left out"`).
"""

import h5py
import numpy
import scipy.linalg
import scipy.sparse.linalg

COMPONENTS = ["x", "y", "z", "rx", "ry", "rz"]


def cross(arm):
    """[6 x 6]: motion (u, theta) of a point at `arm` from a node that moves by (u, theta)."""
    x, y, z = arm
    moved = numpy.eye(6)
    moved[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]  # theta x arm
    return moved


class Body:
    """K, M and C of a body in the place that the scene gives it, `offset` its first coordinate in the brake."""

    def __init__(self, file, turned=None, position=(0.0, 0.0, 0.0), held=()):
        with h5py.File(file) as f:
            self.K, self.M = f["matrices/stiffness"][:], f["matrices/mass"][:]
            self.node, self.component = f["masters/node"][:], f["masters/component"][:]
            self.sets = {name: f[f"attachment/sets/{name}"][:] for name in f["attachment/set_names"].asstr()[:]}
            positions = f["attachment/node_positions"][:]
        self.R = numpy.eye(3) if turned is None else numpy.array(turned)
        self.positions = positions @ self.R.T + numpy.array(position)
        held_nodes = [node for name in held for node in self.sets[name]]
        keep = numpy.ones(len(self.K), dtype=bool)
        keep[: len(self.node)] = ~numpy.isin(self.node, held_nodes)
        self.place = numpy.cumsum(keep) - 1
        self.K, self.M = self.K[numpy.ix_(keep, keep)], self.M[numpy.ix_(keep, keep)]
        self.size, self.offset = len(self.K), 0

    def motion(self, node, point):
        """Coordinates of the brake, and [6 x 6] of the motion of a point joined to a node by them."""
        rows = numpy.flatnonzero(self.node == node)
        assert list(self.component[rows]) == [0, 1, 2, 3, 4, 5]
        turned = numpy.kron(numpy.eye(2), self.R)
        return self.offset + self.place[rows], cross(point - self.positions[node]) @ turned


class Brake:
    def __init__(self, bodies):
        self.bodies, n = bodies, 0
        for body in bodies.values():
            body.offset = n
            n += body.size
        self.K, self.M, self.C = (numpy.zeros((n, n)) for _ in range(3))
        for body in bodies.values():
            at = slice(body.offset, body.offset + body.size)
            self.K[at, at], self.M[at, at] = body.K, body.M

    def join(self, ends, stiffness, damping):
        """Springs and dampers between the nodes of two sets, in the order of their names; None is the ground."""
        (part, name), other = ends
        body = self.bodies[part]
        for i, node in enumerate(body.sets[name]):
            point, columns, motions = body.positions[node], [], []
            if other:
                mate = self.bodies[other[0]]
                to = mate.sets[other[1]][i]
                point = (point + mate.positions[to]) / 2
                at, motion = mate.motion(to, point)
                columns.append(at)
                motions.append(-motion)
            at, motion = body.motion(node, point)
            columns.append(at)
            motions.append(motion)
            at, motion = numpy.concatenate(columns), numpy.hstack(motions)
            for matrix, values in ((self.K, stiffness), (self.C, damping)):
                diagonal = numpy.diag([values.get(c, 0.0) for c in COMPONENTS])
                matrix[numpy.ix_(at, at)] += motion.T @ diagonal @ motion

    def touch(self, part, name, shares, lining, speed):
        """A lining on the disc. With x = w - z of disc and plate, e the height of the contact plane above the ring's, v the
        speed of sliding and sigma = 1 above the disc, small changes of the forces are
            dS = sigma (k x + d (x' - v g_t)),  dN = dS - sigma mu N_0 g_t
            df_r = sigma N_0 g_r + mu N_0 / v (e g_r' + r'),  df_t = sigma N_0 g_t - mu dN,
        on the disc (w, g_r, g_t): (-sigma dS, -e df_r, -e df_t), on the plate (r, t, z): (-df_r, -df_t, sigma dS)."""
        disc, body = self.bodies["disc"], self.bodies[part]
        for node, share in zip(body.sets[name], shares, strict=True):
            point = body.positions[node].copy()
            sigma = numpy.sign(point[2])
            r, angle = numpy.hypot(*point[:2]), numpy.arctan2(point[1], point[0])
            point[2] -= sigma * lining["height"]
            under = int(numpy.argmin(numpy.linalg.norm(disc.positions[:, :2] - point[:2], axis=1)))
            assert numpy.linalg.norm(disc.positions[under, :2] - point[:2]) < 1e-9
            polar = numpy.array([[numpy.cos(angle), numpy.sin(angle), 0], [-numpy.sin(angle), numpy.cos(angle), 0], [0, 0, 1]])
            on_disc, at_disc = disc.motion(under, disc.positions[under])
            rotations = polar @ at_disc[3:]
            # w, g_r = -theta_t, g_t = theta_r
            w, g_r, g_t = at_disc[2], -rotations[1], rotations[0]
            on_plate, at_plate = body.motion(node, point)
            r_p, t_p, z_p = polar @ at_plate[:3]
            at = numpy.concatenate([on_disc, on_plate])
            zero = numpy.zeros(6)
            w, g_r, g_t = (numpy.concatenate([form, zero]) for form in (w, g_r, g_t))
            r_p, t_p, z_p = (numpy.concatenate([zero, form]) for form in (r_p, t_p, z_p))
            k, d, N_0, mu = share * lining["k"], share * lining["d"], share * lining["N"], lining["mu"]
            e, v = sigma * lining["thickness"] / 2, speed * r
            dS_a, dS_p = sigma * (k * (w - z_p) - d * v * g_t), sigma * d * (w - z_p)
            for matrix, dS, turn, slide in ((self.K, dS_a, N_0, 0.0), (self.C, dS_p, 0.0, mu * N_0 / v)):
                dN = dS - sigma * mu * turn * g_t
                df_r = sigma * turn * g_r + slide * (e * g_r + r_p)
                df_t = sigma * turn * g_t - mu * dN
                forces = ((w, -sigma * dS), (g_r, -e * df_r), (g_t, -e * df_t), (r_p, -df_r), (t_p, -df_t), (z_p, sigma * dS))
                for along, force in forces:
                    matrix[numpy.ix_(at, at)] -= numpy.outer(along, force)

    def eigenvalues(self, shifts, count):
        """Those nearest to each shift, rad/s, by inverse iteration on (lambda^2 M + lambda C + K) u = 0."""
        n, found = len(self.K), []
        for shift in shifts:
            factor = scipy.linalg.lu_factor(shift**2 * self.M + shift * self.C + self.K)

            def inverse(x, shift=shift, factor=factor):
                # (A - shift B)^-1 B x with A = [0, I; -K, -C], B = diag(I, M), x = (u, lambda u)
                u, p = x[:n], x[n:]
                solved = -scipy.linalg.lu_solve(factor, self.M @ p + self.C @ u + shift * (self.M @ u))
                return numpy.concatenate([solved, u + shift * solved])

            operator = scipy.sparse.linalg.LinearOperator((2 * n, 2 * n), matvec=inverse, dtype=complex)
            start = numpy.ones(2 * n, dtype=complex)
            values = scipy.sparse.linalg.eigs(operator, k=count, v0=start, return_eigenvectors=False, tol=1e-10)
            found.extend(shift + 1 / values)
        return numpy.array(found)
