"""Reductions of matrices of scipy and petsc4py; on several ranks under mpirun. Usage: reduction_test.py"""

import os
import pathlib
import pickle
import random
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import scipy.linalg
import scipy.sparse
from petsc4py import PETSc

import chladni

RANKS = PETSc.COMM_WORLD.getSize()
N = 400


def chain(n=N):
    """A chain of unequal springs and masses, held nowhere: every shape of it is known to scipy."""
    k = 1e4 * (1.0 + 0.3 * np.sin(np.arange(n - 1)))
    ends = np.concatenate([[0.0], k, [0.0]])
    K = scipy.sparse.diags([-k, ends[:-1] + ends[1:], -k], [-1, 0, 1], format="csr")
    M = scipy.sparse.diags(1.0 + 0.5 * np.cos(np.arange(n)), format="csr")
    return K, M


def distributed(A):
    """The same matrix on all ranks."""
    B = PETSc.Mat().createAIJ(A.shape, nnz=3, comm=PETSc.COMM_WORLD)
    first, last = B.getOwnershipRange()
    rows = A[first:last]
    B.setPreallocationCSR((rows.indptr.astype("i4"), rows.indices.astype("i4"), rows.data))
    B.assemble()
    return B


K, M = chain()
MASTERS = [N - 1, 0, 137]


class Reduction(unittest.TestCase):
    def test_is_the_projection_on_its_transformation(self):
        for method in ("craig-bampton", "guyan", "rubin"):
            with self.subTest(method):
                reduced = chladni.reduce(K, M, MASTERS, method=method, **({} if method == "guyan" else {"modes": 12}))
                scale = abs(reduced.K).max()
                np.testing.assert_allclose(reduced.T.T @ (K @ reduced.T), reduced.K, atol=1e-10 * scale)
                np.testing.assert_allclose(reduced.T.T @ (M @ reduced.T), reduced.M, atol=1e-10)
                np.testing.assert_allclose(reduced.T[MASTERS][:, :3], np.eye(3), atol=1e-12)

    def test_estimates_the_errors_of_its_frequencies(self):
        reduced = chladni.reduce(K, M, MASTERS, modes=12, count=True)
        exact = np.sqrt(scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True)[1:]) / (2 * np.pi)
        errors = (reduced.frequencies / exact[: len(reduced.frequencies)]) ** 2 - 1
        self.assertGreater(len(reduced.bounds), 5)
        self.assertTrue((errors[: len(reduced.bounds)] <= reduced.bounds).all())
        self.assertLess(np.median(np.abs(np.log(errors / reduced.eta2))), np.log(4.0))
        self.assertEqual(reduced.quality["n_zero"], 1)
        self.assertEqual(reduced.quality["model"]["missing"], 0)

    def test_has_the_modes_of_its_support(self):
        free = np.delete(np.arange(N), MASTERS[0])
        exact = scipy.linalg.eigh(K.toarray()[np.ix_(free, free)], M.toarray()[np.ix_(free, free)], eigvals_only=True)
        reduced = chladni.reduce(K, M, MASTERS, method="mixed-interface", modes=8, held=[MASTERS[0]])
        np.testing.assert_allclose(reduced.frequencies, np.sqrt(exact[:8]) / (2 * np.pi), rtol=1e-9)
        chosen = chladni.reduce(K, M, MASTERS, method="auto", tolerance=1e-3, held=[MASTERS[0]],
                                up_to_Hz=np.sqrt(exact[8] * 0.999) / (2 * np.pi))  # fmt: skip
        np.testing.assert_allclose(chosen.frequencies, np.sqrt(exact[:8]) / (2 * np.pi), rtol=1e-3)

    def test_of_petsc_is_that_of_scipy(self):
        theirs = chladni.reduce(K, M, MASTERS, modes=12)
        ours = chladni.reduce(distributed(K), distributed(M), MASTERS, modes=12)
        np.testing.assert_allclose(np.abs(ours.K), np.abs(theirs.K), atol=1e-8 * abs(theirs.K).max())
        np.testing.assert_allclose(np.abs(ours.M), np.abs(theirs.M), atol=1e-7)
        first, last = distributed(K).getOwnershipRange()
        np.testing.assert_allclose(np.abs(ours.T), np.abs(theirs.T[first:last]), atol=1e-7)

    def test_reduces_velocity_forces_and_chosen_rows(self):
        reduced = chladni.reduce(K, M, MASTERS, C=0.1 * K + 2.0 * M, modes=4, rows=[3, 5])
        np.testing.assert_allclose(reduced.C, 0.1 * reduced.K + 2.0 * reduced.M, atol=1e-8 * abs(reduced.K).max())
        self.assertEqual(reduced.T.shape, (2, 7))

    def test_chooses_modes_by_a_tolerance(self):
        reduced = chladni.reduce(K, M, MASTERS, tolerance=1e-4, up_to_Hz=1.0)
        self.assertTrue((reduced.eta2[reduced.frequencies < 1.0] / 2 < 1e-4).all())
        self.assertGreater(chladni.reduce(K, M, MASTERS, cutoff_Hz=4.0).n_modes, 0)

    def test_can_be_pickled(self):
        reduced = chladni.reduce(K, M, MASTERS, modes=3)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(reduced)).K, reduced.K)

    def test_is_refused_in_words(self):
        for masters, words, more in (
            ([0, 0], "master 0 is given twice", {}),
            ([0, N], f"master {N} is out of range; rows are 0 to {N - 1}", {}),
            ([], "0 masters of 400 rows", {}),
            ([0], "Unknown CMS type", {"method": "gauyan"}),
            ([0], "modes asked of 399 slaves", {"modes": 1000}),
            ([0], "method rubin, which cannot keep one", {"method": "rubin", "tolerance": 1e-3, "up_to_Hz": 1.0}),
        ):
            with self.subTest(words), self.assertRaisesRegex(chladni.Error, words):
                chladni.reduce(K, M, masters, **more)
        with self.assertRaisesRegex(chladni.Error, "not symmetric"):
            chladni.reduce(K + scipy.sparse.eye(N, k=1), M, MASTERS)
        with self.assertRaisesRegex(chladni.Error, "(?i)size|rows"):
            chladni.reduce(K, chain(N + 1)[1], MASTERS)
        for wrong in (np.eye(3), None, K * 1j):
            with self.assertRaises(TypeError):
                chladni.reduce(wrong, M, MASTERS)
        with self.assertRaises(TypeError):
            chladni.reduce(K, M, [0.5])
        with self.assertRaises(ValueError):
            chladni.reduce(K, M, MASTERS, modes=3, cutoff_Hz=1.0)
        with self.assertRaises(ValueError):
            chladni.reduce(PETSc.Mat(), M, MASTERS)

    def test_adds_up_entries_that_stand_twice_as_scipy_does(self):
        def in_halves(A):
            share = np.where(np.arange(A.nnz) % 2 == 0, 0.25, 0.5)
            both = np.stack([share * A.data, (1.0 - share) * A.data], 1).ravel()
            return scipy.sparse.csr_matrix((both, np.repeat(A.indices, 2), 2 * A.indptr), A.shape)

        expected = chladni.reduce(K, M, MASTERS, modes=4)
        for stiffness, mass in ((in_halves(K), M), (K, in_halves(M).tocoo()), (K, in_halves(M))):
            reduced = chladni.reduce(stiffness, mass, MASTERS, modes=4)
            np.testing.assert_allclose(reduced.frequencies, expected.frequencies, rtol=1e-12)
            self.assertEqual(stiffness.nnz + mass.nnz, K.nnz + M.nnz + (M.nnz if stiffness is K else K.nnz))  # left as they were
        halves = in_halves(K)
        as_it_is = PETSc.Mat().createAIJWithArrays(K.shape, (halves.indptr, halves.indices, halves.data), comm=PETSc.COMM_SELF)
        reduced = chladni.reduce(as_it_is, M, MASTERS, modes=4)
        np.testing.assert_allclose(reduced.frequencies, expected.frequencies, rtol=1e-12)

    @unittest.skipUnless(RANKS == 1, "on one rank")
    def test_takes_no_memory_that_stays(self):
        def resident():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

        large = chain(5000)
        for _ in range(15):
            chladni.reduce(*large, [0, 4999], method="guyan", transformation=False)
        before, n = resident(), 60
        for _ in range(n):
            chladni.reduce(*large, [0, 4999], method="guyan", transformation=False)
        matrices = sum(A.data.nbytes + A.indices.nbytes + A.indptr.nbytes for A in large)
        self.assertLess(resident() - before, 0.1 * n * matrices)

    @unittest.skipUnless(RANKS == 1, "on one rank")
    def test_of_two_threads_waits_for_the_other(self):
        results = []

        def work():
            results.extend(chladni.reduce(K, M, MASTERS, modes=6).frequencies[0] for _ in range(10))

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 30)
        np.testing.assert_allclose(results, results[0], rtol=1e-9)

    def test_tells_its_monitor_and_ends_with_what_it_raises(self):
        phases = []
        chladni.reduce(K, M, MASTERS, modes=3, monitor=lambda phase, seconds: phases.append(phase))
        self.assertEqual(phases[1], "factorization")

        def refuse(phase, seconds):
            if phase == "factorization":
                raise ZeroDivisionError(phase)

        with self.assertRaises(ZeroDivisionError):
            chladni.reduce(K, M, MASTERS, modes=3, monitor=refuse)

        def interrupt(phase, seconds):
            signal.raise_signal(signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            chladni.reduce(K, M, MASTERS, modes=3, monitor=interrupt)


LONG = """
import chladni, scipy.sparse
n = 250
line = scipy.sparse.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n))
K = scipy.sparse.kronsum(line, line).tocsr()
print("begins", flush=True)
try:
    chladni.reduce(K, scipy.sparse.identity(n * n, format="csr"), range(0, n * n, 1000), modes=1500,
                   monitor=lambda phase, seconds: print(phase, flush=True))
except KeyboardInterrupt:
    print("interrupted")
"""


@unittest.skipUnless(RANKS == 1, "on one rank")
class Interruption(unittest.TestCase):
    def test_ends_a_phase_in_its_midst(self):
        process = subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, text=True)
        while process.stdout.readline() != "factorization\n":
            pass
        time.sleep(1.0)  # in the search for modes, which takes minutes
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        self.assertEqual(process.communicate(timeout=60)[0].splitlines(), ["interrupted"])
        self.assertLess(time.monotonic() - start, 20.0)


class Cms(unittest.TestCase):
    def test_has_the_life_of_the_object_in_c(self):
        cms = chladni.CMS(distributed(K), distributed(M))
        with self.assertRaisesRegex(chladni.Error, r"Call CMSSolve\(\) first"):
            cms.reduced_operators()
        cms.set_interface(MASTERS if PETSc.COMM_WORLD.getRank() == 0 else [])
        cms.set_dimensions(5)
        cms.set_sylvester(True)
        self.assertEqual(cms.get_type(), "craig-bampton")
        cms.set_up()
        self.assertEqual(cms.dimensions()[0], 3)
        cms.solve()
        self.assertEqual(cms.dimensions(), (3, 5))
        T, (K_r, M_r, C_r) = cms.transformation(), cms.reduced_operators()
        self.assertIsNone(C_r)
        self.assertEqual(T.getSize(), (N, 8))
        projected = distributed(K).matMult(T)
        projected = T.transposeMatMult(projected)
        projected.axpy(-1.0, K_r)
        self.assertLess(projected.norm(), 1e-9 * K_r.norm())
        self.assertEqual(M_r.getSize(), (8, 8))
        with tempfile.TemporaryDirectory() as folder:
            path = PETSc.COMM_WORLD.tompi4py().bcast(f"{folder}/a.reduced.h5")
            cms.write(path)
            PETSc.COMM_WORLD.barrier()
            self.assertEqual(chladni.open(path).matrices.stiffness.shape, (8, 8))
            PETSc.COMM_WORLD.barrier()
        cms.reset()
        with self.assertRaises(chladni.Error):
            cms.frequencies()

    def test_counts_when_that_is_asked_for_after_a_solution(self):
        cms = chladni.CMS(K, M)
        cms.set_interface(MASTERS)
        cms.set_dimensions(5)
        cms.solve()
        self.assertEqual(len(cms.error_bounds()), 0)
        cms.set_sylvester(True)
        cms.solve()
        self.assertGreater(len(cms.error_bounds()), 0)

    def test_is_not_changed_by_its_monitor(self):
        cms = chladni.CMS(K, M)
        cms.set_interface(MASTERS)
        for change in (cms.reset, cms.solve, lambda: cms.set_dimensions(3), lambda: cms.set_interface([0]),
                       lambda: cms.set_sylvester(True), lambda: cms.set_operators(M, K)):  # fmt: skip
            with self.assertRaisesRegex(chladni.Error, "called by a monitor"):
                cms.solve(lambda phase, seconds, change=change: change())
        cms.solve()
        self.assertEqual(cms.dimensions(), (3, 20))

    def test_takes_options_of_petsc(self):
        options = PETSc.Options()
        options["mine_cms_nmodes"] = 7
        cms = chladni.CMS(K, M)
        cms.set_interface(MASTERS)
        cms.set_options_prefix("mine_")
        cms.set_from_options()
        cms.solve()
        self.assertEqual(cms.dimensions(), (3, 7))


def number_of_commits():
    """Another seed with each commit; outside a repository always the same."""
    git = ["git", "-C", str(pathlib.Path(__file__).parent), "rev-list", "--count", "HEAD"]
    try:
        return int(subprocess.run(git, capture_output=True, text=True, check=True).stdout)
    except (OSError, subprocess.CalledProcessError):
        return 1


class Caller:
    """Calls methods of a CMS in any order, and knows what it must have in the end."""

    def __init__(self, dice, of_petsc):
        self.dice = dice
        self.operators = [(distributed(A), distributed(B)) if of_petsc else (A, B) for A, B in ((K, M), (2.0 * K, M), (K, 3.0 * M))]
        self.matrices = ((K, M), (2.0 * K, M), (K, 3.0 * M))
        self.is_first = not of_petsc or PETSc.COMM_WORLD.getRank() == 0
        self.which, self.masters, self.held, self.type, self.modes, self.count = 0, [0, N - 1], [], "craig-bampton", 5, False
        self.cms = chladni.CMS(*self.operators[0])
        self.cms.set_interface(self.own(self.masters))
        self.cms.set_dimensions(self.modes)

    def own(self, rows):
        return rows if self.is_first else []

    def set_operators(self):
        self.which = self.dice.randrange(3)
        self.cms.set_operators(*self.operators[self.which])

    def set_interface(self):
        self.masters, self.held = self.dice.sample(range(N), self.dice.randint(1, 4)), []
        self.cms.set_held([])
        self.cms.set_interface(self.own(self.masters))

    def set_held(self):
        self.held = [i for i in self.masters if self.dice.random() < 0.5]
        self.cms.set_held(self.own(self.held))

    def set_type(self):
        self.type = self.dice.choice(["guyan", "craig-bampton", "mixed-interface", "rubin"])
        self.cms.set_type(self.type)

    def set_dimensions(self):
        self.modes = self.dice.randint(1, 8)
        self.cms.set_dimensions(self.modes)

    def set_sylvester(self):
        self.count = self.dice.random() < 0.5
        self.cms.set_sylvester(self.count)

    def solve(self):
        self.cms.solve()

    def set_up(self):
        self.cms.set_up()

    def reset(self):
        self.cms.reset()

    def refused(self):
        for wrong in (lambda: self.cms.set_type("gauyan"), lambda: self.cms.set_dimensions(-3), lambda: self.cms.set_cutoff(-1.0)):
            try:
                wrong()
            except chladni.Error:
                continue
            raise AssertionError("it must be refused")

    def asks(self):
        """Whatever is there, or an error."""
        for ask in (self.cms.frequencies, self.cms.error_bounds, self.cms.reduced_operators, self.cms.quality, self.cms.transformation):
            try:
                ask()
            except chladni.Error:
                pass

    def calls(self, n):
        steps = (self.set_operators, self.set_interface, self.set_held, self.set_type, self.set_dimensions, self.set_sylvester,
                 self.solve, self.solve, self.set_up, self.reset, self.refused, self.asks)  # fmt: skip
        for _ in range(n):
            self.dice.choice(steps)()

    def differences(self):
        """Between what it has after all that and a reduction that is made at once, relative."""
        self.cms.solve()
        stiffness, mass = self.matrices[self.which]
        own = {} if self.type == "guyan" else {"modes": self.modes}
        fresh = chladni.reduce(stiffness, mass, self.masters, method=self.type, held=self.held, count=self.count, **own)
        found = self.cms.frequencies()
        if len(found) != len(fresh.frequencies) or len(self.cms.error_bounds()) != len(fresh.bounds):
            return np.inf
        return np.max(np.abs(found / fresh.frequencies - 1.0), initial=0.0)


class Orders(unittest.TestCase):
    def test_of_calls_do_not_matter(self):
        first = 1000 * number_of_commits()
        for seed in range(first, first + 25):
            caller = Caller(random.Random(seed), of_petsc=seed % 2 == 0 or RANKS > 1)
            caller.calls(12)
            self.assertLess(caller.differences(), 1e-7, f"seed {seed}")

    @unittest.skipUnless(RANKS == 1, "on one rank")
    def test_of_several_threads_do_not_matter(self):
        found = {}

        def work(seed):
            caller = Caller(random.Random(seed), of_petsc=False)
            caller.calls(10)
            found[seed] = caller.differences()

        seeds = range(1000 * number_of_commits(), 1000 * number_of_commits() + 6)
        threads = [threading.Thread(target=work, args=[seed]) for seed in seeds]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(found), len(seeds))
        self.assertLess(max(found.values()), 1e-7, str(found))


@unittest.skipUnless(RANKS == 1, "on one rank")
class LongLife(unittest.TestCase):
    def test_goes_on_after_interruptions_at_any_time(self):
        dice = random.Random(number_of_commits())
        large = chain(20000)
        expected = chladni.reduce(*large, [0, 19999], modes=10).frequencies
        start = time.monotonic()
        chladni.reduce(*large, [0, 19999], modes=10)
        duration, n_interrupted = time.monotonic() - start, 0
        for _ in range(12):
            timer = threading.Timer(dice.uniform(0.0, 1.1 * duration), os.kill, (os.getpid(), signal.SIGINT))
            try:
                timer.start()
                chladni.reduce(*large, [0, 19999], modes=10)
                timer.join()
                time.sleep(0.05)
            except KeyboardInterrupt:
                n_interrupted += 1
            timer.join()
            found = chladni.reduce(*large, [0, 19999], modes=10).frequencies
            np.testing.assert_allclose(found, expected, rtol=1e-9)
        self.assertEqual(n_interrupted, 12)

    def test_of_a_thousand_reductions_takes_no_more_memory(self):
        def resident():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

        small = chain(120)
        methods = ("guyan", "craig-bampton", "mixed-interface", "rubin")

        def some(n):
            for i in range(n):
                method = methods[i % len(methods)]
                own = {} if method == "guyan" else {"modes": 4}
                chladni.reduce(*small, [0, 119], method=method, count=i % 3 == 0, held=[0] if i % 2 else [], **own)

        some(200)
        before = resident()
        some(1000)
        self.assertLess(resident() - before, 2 << 20)


if __name__ == "__main__":
    unittest.main()
