"""The solver type of the plugin from Python, in a program that knows nothing else of Chladni.

    PETSC_OPTIONS="-dll_append libchladni_petsc.so" mpirun -n 2 python3 laplacian.py
"""

import sys

import slepc4py

slepc4py.init(sys.argv)
from petsc4py import PETSc  # noqa: E402  after init, which reads the options
from slepc4py import SLEPc  # noqa: E402


def laplacian(n):
    """-u'' on n points of an interval, u = 0 at both ends, scaled by h^2."""
    A = PETSc.Mat().createAIJ((n, n), nnz=3)
    first, last = A.getOwnershipRange()
    for i in range(first, last):
        A[i, i] = 2.0
        if i > 0:
            A[i, i - 1] = -1.0
        if i < n - 1:
            A[i, i + 1] = -1.0
    A.assemble()
    return A


def main():
    eps = SLEPc.EPS().create()
    eps.setOperators(laplacian(PETSc.Options().getInt("n", 100)))
    eps.setProblemType(SLEPc.EPS.ProblemType.HEP)
    eps.setDimensions(5)
    eps.setTarget(0.0)
    eps.getST().setType("sinvert")
    eps.setType("blocklanczos")
    eps.setFromOptions()
    eps.solve()
    for i in range(eps.getConverged()):
        PETSc.Sys.Print(f"{i:3d} {eps.getEigenvalue(i).real:.14e} {eps.computeError(i):.2e}")


if __name__ == "__main__":
    main()
