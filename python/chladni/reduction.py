"""Component-mode synthesis of any two symmetric matrices, of petsc4py or of scipy (docs/how-to/plugin.md is its theory)."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from petsc4py import PETSc
from slepc4py import SLEPc  # noqa: F401  begins SLEPc, which CMS needs

from chladni import _cms

Monitor = Callable[[str, float], object]

# PETSc is for one thread at a time, and a reduction lets other threads of Python go on.
_petsc_in_use = threading.RLock()


def _one_thread_at_a_time(function):
    """The same function, which waits while another thread is in one of these."""

    @functools.wraps(function)
    def waiting(*args, **named):
        with _petsc_in_use:
            return function(*args, **named)

    return waiting


def _of_one_thread_at_a_time(methods):
    for name, member in vars(methods).items():
        if callable(member):
            setattr(methods, name, _one_thread_at_a_time(member))
    return methods


@_of_one_thread_at_a_time
class CMS:
    """The PETSc class CMS (chladni_cms.h): operators, interface, choice of modes, solve, results.

    Every method is collective on the communicator of the matrices unless it only sets a number. Errors are
    `chladni.Error` with the words of the library. A thread waits while another one is in a method of any CMS; calls
    of petsc4py itself know nothing of that. A monitor may read, but not change the object that calls it.

    Args:
        K, M: symmetric petsc4py matrices [n x n] of one size and layout, or sparse ones of scipy on one process;
            K of the slaves positive definite, M semidefinite
        C: any matrix of velocity forces, or None
    """

    def __init__(self, K, M, C=None):
        stiffness, is_copy = _petsc(K)
        self._comm = stiffness.getComm() if not is_copy else PETSc.COMM_SELF
        self._cms = _cms.CMS(stiffness.handle)
        self.set_operators(stiffness, M, C)
        if is_copy:
            stiffness.destroy()

    def __del__(self):
        self.__dict__.pop("_cms", None)  # its destruction waits for other threads too

    def set_operators(self, K, M, C=None) -> None:
        """Other matrices, or the same ones again when their values have changed."""
        given = [(None, False) if A is None else _petsc(A) for A in (K, M, C)]
        try:
            self._cms.set_operators(*(0 if A is None else A.handle for A, _ in given))
        finally:
            for A, is_copy in given:
                if is_copy:  # the CMS has a reference; what Python collects, PETSc would destroy at its end
                    A.destroy()

    def set_interface(self, masters: Sequence[int]) -> None:
        """Global rows of the masters, each once, on any rank; their order is that of the reduced rows."""
        self._cms.set_interface(_indices(masters))

    def set_interface_geometry(self, nodes: Sequence[int], components: Sequence[int], positions) -> None:
        """For the file: node, component (0..5 = x y z rx ry rz) and position [n x 3] in m of this rank's masters."""
        self._cms.set_interface_geometry(
            _indices(nodes), _indices(components), np.asarray(positions, float).ravel().tolist()
        )

    def set_held(self, rows: Sequence[int]) -> None:
        """Masters that the support holds, each once, on any rank: what the frequencies and errors are of, and
        mixed-interface modes too."""
        self._cms.set_held(_indices(rows))

    def set_output(self, rows: Sequence[int] | None) -> None:
        """Global rows wanted of the transformation; None for all of them."""
        self._cms.set_output(None if rows is None else _indices(rows))

    def set_type(self, name: str) -> None:
        """ "guyan", "craig-bampton", "mixed-interface", "rubin" or, for a tolerance, "auto"."""
        self._cms.set_type(name)

    def get_type(self) -> str:
        return self._cms.get_type()

    def set_dimensions(self, n_modes: int) -> None:
        """So many modes; the last of this, `set_cutoff` and `set_tolerance` counts."""
        self._cms.set_dimensions(n_modes)

    def set_cutoff(self, f_Hz: float) -> None:
        """All modes up to a frequency in Hz, lambda = (2 pi f)^2."""
        self._cms.set_cutoff(f_Hz)

    def set_tolerance(self, tolerance: float, up_to_Hz: float) -> None:
        """As many modes as keep the estimated relative error of all frequencies up to one in Hz below the tolerance."""
        self._cms.set_tolerance(tolerance, up_to_Hz)

    def set_sylvester(self, count: bool) -> None:
        """Whether eigenvalues are counted by Sylvester's law, which makes bounds of estimates."""
        self._cms.set_sylvester(count)

    def set_options_prefix(self, prefix: str) -> None:
        self._cms.set_options_prefix(prefix)

    def set_from_options(self) -> None:
        """Takes -cms_... of PETSc's options."""
        self._cms.set_from_options()

    def set_up(self, monitor: Monitor | None = None) -> None:
        """Checks the input, partitions, factors K_ss. See `solve` for the monitor."""
        self._cms.set_up(monitor)

    def solve(self, monitor: Monitor | None = None) -> None:
        """Reduces and estimates the errors.

        Args:
            monitor: is called at the end of each phase with its name and its wall time in s; what it raises ends
                the reduction, and so does Ctrl-C, on one rank also in the midst of a long phase
        """
        self._cms.solve(monitor)

    def reset(self) -> None:
        """Forgets results and factor, keeps operators, interface and settings."""
        self._cms.reset()

    def dimensions(self) -> tuple[int, int]:
        """Numbers of masters (after `set_up`) and of modes (after `solve`)."""
        return self._cms.dimensions()

    def reduced_operators(self) -> tuple[PETSc.Mat, PETSc.Mat, PETSc.Mat | None]:
        """K_r, M_r and C_r [n_r x n_r], dense and distributed; masters in their order, then the modes."""
        K, M, C = self._cms.reduced_operators()
        return self._dense(K), self._dense(M), None if C is None else self._dense(C)

    def transformation(self) -> PETSc.Mat:
        """T [n x n_r] with K_r = T^T K T: u = T (u_m, q); dense, rows laid out as those of K."""
        return self._dense(self._cms.transformation())

    def frequencies(self) -> np.ndarray:
        """Elastic modes of the reduced model with free masters, ascending, in Hz: those that have an error estimate."""
        return self._cms.frequencies()

    def errors(self) -> np.ndarray:
        """eta^2 of the same modes: estimated relative error of lambda; half of it for the frequency."""
        return self._cms.errors()

    def rounding(self) -> np.ndarray:
        """What rounding may have done to lambda of the same modes, relative."""
        return self._cms.rounding()

    def error_bounds(self) -> np.ndarray:
        """Bounds of the relative errors of lambda of the first modes, where eigenvalues were counted."""
        return self._cms.error_bounds()

    def quality(self) -> dict[str, Any]:
        """Figures of merit: n_zero, rigid_residual, condition, and the counts modes, model, complete."""
        return self._cms.quality()

    def view(self, viewer: PETSc.Viewer | None = None) -> None:
        """Prints, or writes by a viewer of type HDF5."""
        self._cms.view((viewer or PETSc.Viewer.STDOUT(self._comm)).handle)

    def write(self, path: str) -> None:
        """The reduced file of docs/reference/file_formats.md, which `chladni.open` reads."""
        self._cms.write(path)

    def _dense(self, rows: np.ndarray) -> PETSc.Mat:
        n_rows, n_columns = rows.shape
        sizes = ((n_rows, PETSc.DETERMINE), (PETSc.DECIDE, n_columns))
        A = PETSc.Mat().createDense(sizes, comm=self._comm)
        A.setUp()
        A.getDenseArray()[:, :] = rows
        A.assemble()
        return A


@dataclass
class Reduction:
    """A reduced model; arrays of numpy, so that it can be pickled.

    Attributes:
        K, M: [n_r x n_r] masters in their order, then the modes; the same on all ranks
        C: the same, or None
        T: [n x n_r] u = T (u_m, q): the rows of this rank, all rows on one process; or the rows asked for
        masters: global rows
        n_modes: fixed-interface modes
        frequencies: Hz, elastic modes of the free body that have an error estimate
        eta2: estimated relative errors of their lambda; `rounding` what rounding may have done to it
        bounds: of the first of these errors, where eigenvalues were counted
        quality: see `CMS.quality`
    """

    K: np.ndarray
    M: np.ndarray
    C: np.ndarray | None
    T: np.ndarray | None
    masters: np.ndarray
    n_modes: int
    frequencies: np.ndarray
    eta2: np.ndarray
    rounding: np.ndarray
    bounds: np.ndarray
    quality: dict[str, Any]

    def __repr__(self) -> str:
        return f"<Reduction to {len(self.masters)} masters and {self.n_modes} modes>"


@_one_thread_at_a_time
def reduce(K, M, masters: Sequence[int], *, C=None, method: str = "craig-bampton", modes: int | None = None,
           cutoff_Hz: float | None = None, tolerance: float | None = None, up_to_Hz: float | None = None,
           held: Sequence[int] = (), count: bool = False, rows: Sequence[int] | None = None, transformation: bool = True,
           monitor: Monitor | None = None) -> Reduction:  # fmt: skip
    """Reduces K and M to the masters and modes.

    Args:
        K, M, C: as in `CMS`
        masters: global rows, on every rank the whole list
        method: "craig-bampton", "mixed-interface", "guyan", "rubin" or, for a tolerance, "auto"
        modes, cutoff_Hz, tolerance with up_to_Hz: how many modes, one of the three; 20 if nothing is said
        held: of the masters those that the support holds, on every rank the whole list
        count: whether eigenvalues of the full model are counted, which makes bounds of the estimates
        rows: global rows wanted of T, on every rank the whole list; if nothing is said all
        transformation: whether T is wanted
        monitor: as in `CMS.solve`

    Raises:
        chladni.Error: with the words of the library

    >>> import numpy, scipy.sparse
    >>> n = 50
    >>> K = scipy.sparse.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)) * n
    >>> M = scipy.sparse.identity(n) / n
    >>> reduced = reduce(K, M, masters=[0, n - 1], modes=6)
    >>> reduced
    <Reduction to 2 masters and 6 modes>
    >>> bool(numpy.allclose(reduced.T.T @ (K @ reduced.T), reduced.K, atol=1e-8))
    True
    """
    if [modes, cutoff_Hz, tolerance].count(None) < 2:
        raise ValueError("give one of modes, cutoff_Hz and tolerance")
    if (tolerance is None) != (up_to_Hz is None):
        raise ValueError("tolerance needs up_to_Hz, the frequency up to which it is kept, and up_to_Hz a tolerance")
    cms = CMS(K, M, C)
    cms.set_type(method)
    if modes is not None:
        cms.set_dimensions(modes)
    if cutoff_Hz is not None:
        cms.set_cutoff(cutoff_Hz)
    if tolerance is not None and up_to_Hz is not None:
        cms.set_tolerance(tolerance, up_to_Hz)
    cms.set_sylvester(count)
    is_first = cms._comm.getRank() == 0
    cms.set_interface(masters if is_first else [])
    if len(held):
        cms.set_held(held if is_first else [])
    if rows is not None:
        cms.set_output(rows if is_first else [])
    cms.solve(monitor)
    return _result(cms, masters, transformation)


def _result(cms: CMS, masters: Sequence[int], transformation: bool) -> Reduction:
    K, M, C = cms._cms.reduced_operators()
    return Reduction(
        K=_all_rows(cms, K), M=_all_rows(cms, M), C=None if C is None else _all_rows(cms, C), T=cms._cms.transformation() if transformation else None,
        masters=np.array(masters, dtype=np.int64), n_modes=cms.dimensions()[1], frequencies=cms.frequencies(),
        eta2=cms.errors(), rounding=cms.rounding(), bounds=cms.error_bounds(), quality=cms.quality(),
    )  # fmt: skip


def _all_rows(cms: CMS, own: np.ndarray) -> np.ndarray:
    return own if cms._comm.getSize() == 1 else np.vstack(cms._comm.tompi4py().allgather(own))


def _indices(numbers: Sequence[int]) -> list[int]:
    array = np.asarray(numbers)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise TypeError(f"rows are integers, not {array.dtype}")
    return array.ravel().tolist()


def _petsc(A) -> tuple[PETSc.Mat, bool]:
    """As a matrix of PETSc: its own, or a copy of one of scipy on one process, and whether it is a copy."""
    if isinstance(A, PETSc.Mat):
        if not A.handle:
            raise ValueError("a matrix of petsc4py that was never created")
        return A, False
    if not hasattr(A, "tocsr"):
        raise TypeError(f"give petsc4py.PETSc.Mat or a sparse matrix of scipy, not {type(A).__name__}")
    csr = A.tocsr()
    if np.iscomplexobj(csr.data):
        raise TypeError("the matrix is complex; the reduction takes real ones")
    if not csr.has_canonical_format:  # entries that stand twice mean their sum
        csr = csr.copy()
        csr.sum_duplicates()
    pattern = (csr.indptr.astype(PETSc.IntType), csr.indices.astype(PETSc.IntType))
    return PETSc.Mat().createAIJ(csr.shape, csr=(*pattern, csr.data.astype(float)), comm=PETSc.COMM_SELF), True
