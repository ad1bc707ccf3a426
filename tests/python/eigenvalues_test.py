"""Complex eigenvalues of unsymmetric matrices, on one rank or several. Usage: eigenvalues_test.py SOURCE_DIR"""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import scipy.io
import scipy.linalg
import scipy.sparse as sp
from petsc4py import PETSc

import chladni

SOURCE = pathlib.Path(sys.argv.pop(1))
sys.path[:0] = [str(SOURCE / "benchmarks/squeal"), str(SOURCE / "examples/python")]
import complex_eigenvalues  # noqa: E402  the program
import friction_matrices  # noqa: E402  a brake of hexahedra

RANKS = PETSc.COMM_WORLD.getSize()


def chain(n, seed, friction=0.4):
    """Springs and masses in a row, with followers' forces between some of them, damping and gyroscopic terms."""
    rng = np.random.default_rng(seed)
    k = 1e4 * (1.0 + rng.random(n + 1))
    K = sp.diags([k[:-1] + k[1:], -k[1:-1], -k[1:-1]], [0, 1, -1]).tolil()
    for i, j in rng.integers(0, n, (n // 10, 2)):
        K[i, i] += 2e4
        K[j, i] += friction * 2e4
    G = sp.random(n, n, 2.0 / n, random_state=seed)
    K = K.tocsr()
    return sp.diags(1.0 + rng.random(n)).tocsr(), (1e-5 * K + 0.01 * sp.identity(n) + 0.5 * (G - G.T)).tocsr(), K


def exact(M, D, K, up_to_Hz, damped_up_to=0.1):
    """By the QZ algorithm on the whole, in the unit of time in which the frequency is 1."""
    Z, one, omega = np.zeros(M.shape), np.eye(M.shape[0]), 2 * np.pi * up_to_Hz
    values = omega * scipy.linalg.eigvals(
        np.block([[Z, one], [-K.toarray() / omega**2, -D.toarray() / omega]]), scipy.linalg.block_diag(one, M.toarray()))  # fmt: skip
    wanted = (values.imag >= 0.0) & (values.imag <= 2 * np.pi * up_to_Hz) & (values.real >= -damped_up_to * abs(values))
    return values[wanted]


def given(A):
    return A if RANKS == 1 else complex_eigenvalues.on_all_ranks(sp.csr_matrix(A))


class Eigenvalues(unittest.TestCase):
    def compare(self, M, D, K, up_to_Hz, **options):
        expected = exact(M, D, K, up_to_Hz)
        found = chladni.complex_eigenvalues(given(M), given(D), given(K), up_to_Hz=up_to_Hz, **options)
        self.assertEqual(len(found.values), len(expected))
        worst = max(np.min(abs(found.values - value)) for value in expected)
        # 1e-8 is asked for; the QZ of a small system is right to 1e-11 of its largest eigenvalue
        self.assertLess(worst, 1e-8 * 2 * np.pi * up_to_Hz)
        self.assertEqual(len(found.unstable), int((expected.real > 1e-9).sum()))
        return found

    def test_are_those_of_QZ_with_many_that_flutter(self):
        for n, seed, up_to_Hz in ((40, 4, 8.0), (150, 1, 8.0), (200, 2, 4.0)):
            with self.subTest(n=n, seed=seed):
                self.assertGreater(len(self.compare(*chain(n, seed), up_to_Hz).unstable), 0)

    def test_of_a_brake_with_friction_in_K_are_those_of_QZ(self):
        M, D, K = friction_matrices.brake(around=12, across=4, layers=1, friction=1.0)
        found = self.compare(M, D, K, 8000.0)
        self.assertGreater(len(found.unstable), 0)

    def test_vectors_satisfy_their_equations(self):
        if RANKS > 1:
            self.skipTest("of scipy's products")
        M, D, K = chain(200, 3)
        found = chladni.complex_eigenvalues(M, D, K, up_to_Hz=4.0)
        for value, x, y in zip(found.values, found.right.T, found.left.T):
            Q = value**2 * M + value * D + K
            self.assertLess(np.linalg.norm(Q @ x), 1e-3 * np.linalg.norm(K @ x))  # of first order, where the value's is of second
            self.assertLess(np.linalg.norm(Q.conj().T @ y), 1e-3 * np.linalg.norm(K @ y))
        self.assertTrue(np.all(found.errors <= 1e-8 * abs(found.values)))

    def test_a_basis_of_another_speed_is_a_start_and_misses_nothing(self):
        M, D, K = chain(200, 2, friction=0.2)
        start = chladni.complex_eigenvalues(given(M), given(D), given(K), up_to_Hz=4.0)
        self.assertEqual(self.compare(*chain(200, 2), 4.0, start=start).found_by_check, 0)
        start.basis = start.basis[:, :3]  # of a start that lacks most
        found = self.compare(*chain(200, 2), 4.0, start=start)
        self.assertGreater(found.found_by_check, 0)

    def test_bodies_that_nothing_holds_have_their_motions(self):
        M, D, K = chain(60, 5)
        K = (K - sp.diags(np.asarray(K.sum(1)).ravel())).tocsr()  # rows sum to zero: a translation is free
        found = chladni.complex_eigenvalues(given(M), None, given(K), up_to_Hz=8.0)
        self.assertLess(np.min(abs(found.values)), 1e-4)
        self.assertEqual(len(found.unstable), len(found.values[found.values.real > 1e-2]))  # rounding at zero is no growth

    def test_of_an_undamped_symmetric_system_none_is_unstable(self):
        n, k = 40, 1e9
        held = sp.diags([2 * k * np.ones(n), -k * np.ones(n - 1), -k * np.ones(n - 1)], [0, 1, -1]).tocsr()
        free = held.tolil()
        free[0, 0] = free[-1, -1] = k
        for K in (held, sp.block_diag([free.tocsr()] * 3).tocsr()):
            M = sp.identity(K.shape[0], format="csr")
            found = chladni.complex_eigenvalues(given(M), None, given(K), up_to_Hz=8000.0)
            self.assertGreater(len(found.values), 15)
            self.assertEqual(len(found.unstable), 0)
            self.assertLess(max(found.errors[abs(found.values) > 100.0]), 1e-6)

    def test_systems_that_are_none_are_refused_by_matrix_and_row(self):
        M, D, K = chain(30, 1)
        skew = M.tolil()
        skew[3, 7] = 0.1
        light = M.tolil()
        light[4, 4] = 0.0
        broken = K.copy()
        broken.data[0] = np.nan
        for said, matrices in (("M, row 4: the matrix is not symmetric", (skew.tocsr(), D, K)), ("M, row 5: the diagonal", (light.tocsr(), D, K)),
                               ("K, row 1: an entry is not", (M, D, broken)), ("D is 3 x 3", (M, sp.identity(3, format="csr"), K))):  # fmt: skip
            with self.subTest(said), self.assertRaisesRegex(chladni.Error, said):
                chladni.complex_eigenvalues(*map(given, matrices), up_to_Hz=8.0)
        for up_to_Hz in (0.0, np.inf):
            with self.assertRaisesRegex(chladni.Error, "up_to_Hz is .* positive number"):
                chladni.complex_eigenvalues(given(M), None, given(K), up_to_Hz=up_to_Hz)
        with self.assertRaisesRegex(chladni.Error, "K is None"):
            chladni.complex_eigenvalues(given(M), None, None, up_to_Hz=8.0)
        indefinite = sp.block_diag([np.array([[1.0, 2.0], [2.0, 1.0]])] * 15).tocsr()
        with self.assertRaisesRegex(chladni.Error, "M is not positive definite"):
            chladni.complex_eigenvalues(given(indefinite), None, given(K), up_to_Hz=8.0)
        start = chladni.complex_eigenvalues(given(M), None, given(K), up_to_Hz=8.0)
        start.basis = start.basis[:-1]
        with self.assertRaisesRegex(chladni.Error, "start is of other matrices"):
            chladni.complex_eigenvalues(given(M), None, given(K), up_to_Hz=8.0, start=start)


@unittest.skipIf(RANKS > 1, "files of one rank")
class Files(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_program(self, *words):
        out, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(said):
            code = complex_eigenvalues.main([str(word) for word in words])
        return code, out.getvalue(), said.getvalue()

    def write(self, name, A, kind):
        file = self.folder / name
        A = A.tocoo()
        if kind == "market":
            scipy.io.mmwrite(file, A, precision=17)
        else:
            label = (lambda i: f"{100 + i // 3}, {1 + i % 3}") if kind == "abaqus" else (lambda i: i + 1)
            between = ", " if kind == "abaqus" else " "
            file.write_text("** a comment\n" + "".join(f"{between.join(map(str, (label(i), label(j), repr(v))))}\n" for i, j, v in zip(A.row, A.col, A.data)))
        return file

    def test_of_all_layouts_give_the_same_table(self):
        M, D, K = chain(60, 4)
        tables = []
        for kind in ("market", "triples", "abaqus"):
            files = [self.write(f"{name}.mtx", A, kind) for name, A in (("M", sp.triu(M) if kind != "market" else M), ("D", D), ("K", K))]
            table = self.folder / f"{kind}.csv"
            code, out, said = self.run_program("--mass", files[0], "--damping", files[1], "--stiffness", files[2], "--up-to-Hz", 8, "--output", table)
            self.assertEqual((code, said), (0, ""))
            self.assertIn("of them unstable", out)
            tables.append(np.loadtxt(table, delimiter=",", skiprows=1))
        expected = exact(M, D, K, 8.0)
        for table in tables:
            self.assertEqual(len(table), len(expected))
            expected = expected[np.lexsort((expected.real, expected.imag))]
            np.testing.assert_allclose(table[:, 0], expected.imag / (2 * np.pi), rtol=1e-7)
            np.testing.assert_allclose(table[:, 1], expected.real, atol=1e-6)

    def test_that_are_wrong_are_told_by_line(self):
        M, _, K = chain(20, 4)
        good = self.write("M.mtx", M, "triples")
        text = self.write("K.mtx", K, "triples").read_text()
        market = self.write("K_market.mtx", K, "market").read_text()
        for said, content in (("line 3: '1 x 3.0' is not", "** a\n1 1 2.0\n1 x 3.0\n"), ("row 1, column 1 is there twice", text + "1 1 5.0\n"),
                              ("is not 2 numbers from 1", "0 1 2.0\n"), ("has no lines", "nothing\n"), ("has no lines", ""),
                              ("line 3: '3' is not", "1 1 2.0\n1 2 -1.0\n3"), ("line 1: '1e999 2 -1.0'", "1e999 2 -1.0\n"),
                              ("line 2: '1, 64, 1, 1, 2.0'", "1, 1, 1, 1, 2.0\n1, 64, 1, 1, 2.0\n"),
                              ("line 1: give a real coordinate", market.replace("real", "complex")),
                              ("entries follow", market[: market.rindex("\n", 0, -1) + 1])):  # fmt: skip
            with self.subTest(said):
                bad = self.folder / "bad.mtx"
                bad.write_text(content)
                table = self.folder / "none.csv"
                code, _, told = self.run_program("--mass", good, "--stiffness", bad, "--up-to-Hz", 8, "--output", table)
                self.assertEqual((code, told.count("\n"), table.exists()), (1, 1, False))
                self.assertIn(f"{bad}", told)
                self.assertIn(said, told)
        code, _, told = self.run_program("--mass", good, "--stiffness", self.folder / "no.mtx", "--up-to-Hz", 8)
        self.assertEqual(code, 1)
        self.assertIn("cannot be read", told)


if __name__ == "__main__":
    unittest.main()
