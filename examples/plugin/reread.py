"""A reduced file back in PETSc: its matrices as Mats, and its lowest frequencies by SLEPc. Usage: reread.py NAME.reduced.h5"""

import math
import sys

import h5py
import slepc4py

slepc4py.init(sys.argv)
from petsc4py import PETSc  # noqa: E402  after init, which reads the options
from slepc4py import SLEPc  # noqa: E402

with h5py.File(sys.argv[1]) as file:
    K, M = (file[f"matrices/{name}"][:] for name in ("stiffness", "mass"))
K = PETSc.Mat().createDense(K.shape, array=K, comm=PETSc.COMM_SELF)
M = PETSc.Mat().createDense(M.shape, array=M, comm=PETSc.COMM_SELF)

eps = SLEPc.EPS().create(PETSc.COMM_SELF)
eps.setOperators(K, M)
eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
eps.setType("lapack")  # all eigenvalues of dense matrices
eps.setWhichEigenpairs(SLEPc.EPS.Which.SMALLEST_REAL)
eps.setFromOptions()
eps.solve()
for i in range(min(6, eps.getConverged())):
    print(f"{i:3d} {math.sqrt(abs(eps.getEigenvalue(i).real)) / (2 * math.pi):.14e} Hz, error {eps.computeError(i):.1e}")
