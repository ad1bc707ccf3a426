"""Memory that runs out on one of two ranks: run by plugin.py.

When the solution begins, the second rank may take the memory of the basis and a little more (-little BYTES).
"""

import resource
import sys

import slepc4py

slepc4py.init(sys.argv)
from petsc4py import PETSc  # noqa: E402  after init, which reads the options
from slepc4py import SLEPc  # noqa: E402

N = 200_000  # rows: what is larger than the heap has left over is asked of the system
BLOCK = 8  # vectors solved at a time


def chain():
    A = PETSc.Mat().createAIJ((N, N), nnz=3)
    first, last = A.getOwnershipRange()
    for i in range(first, last):
        for j, value in ((i - 1, -1.0), (i, 2.0), (i + 1, -1.0)):
            if 0 <= j < N:
                A[i, j] = value
    A.assemble()
    return A


eps = SLEPc.EPS().create()
eps.setOperators(chain())
eps.setProblemType(SLEPc.EPS.ProblemType.HEP)
eps.setDimensions(20)
eps.setTarget(0.0)
eps.getST().setType("sinvert")
eps.setType("blocklanczos")
eps.setFromOptions()
eps.setUp()
if PETSc.COMM_WORLD.getRank() == 1:
    pages = int(open("/proc/self/statm", encoding="ascii").read().split()[0])
    _, n_vectors, _ = eps.getDimensions()
    basis = 8 * (N // 2) * (n_vectors + BLOCK)
    most = pages * resource.getpagesize() + basis + PETSc.Options().getInt("little")
    resource.setrlimit(resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))
try:
    eps.solve()
except PETSc.Error as error:
    print(f"caught {error}", flush=True)
PETSc.COMM_WORLD.barrier()
print("came to its end", flush=True)
