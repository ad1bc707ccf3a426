"""Memory that runs out on one of two ranks: run by plugin.py.

When the solution begins, the second rank may take the memory of the basis and a little more (-little BYTES).
"""

import resource
import sys

import slepc4py

slepc4py.init(sys.argv)
from petsc4py import PETSc  # noqa: E402  after init, which reads the options
from slepc4py import SLEPc  # noqa: E402

N = 200_000  # rows
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


def bytes_taken():
    return int(open("/proc/self/statm", encoding="ascii").read().split()[0]) * resource.getpagesize()


def allow(n_bytes):
    resource.setrlimit(resource.RLIMIT_AS, (n_bytes, resource.RLIM_INFINITY))


def what_the_heap_has_left_over():
    """Blocks that fill the heap, so that whatever is larger is asked of the system."""
    blocks = []
    try:
        while True:
            blocks.append(bytearray(1 << 18))
    except MemoryError:
        return blocks


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
    taken = bytes_taken()
    allow(taken)
    left_over = what_the_heap_has_left_over()
    _, n_vectors, _ = eps.getDimensions()
    basis = 8 * (N // 2) * (n_vectors + BLOCK)
    allow(taken + basis + PETSc.Options().getInt("little"))
try:
    eps.solve()
except PETSc.Error as error:
    print(f"caught {error}", flush=True)
PETSc.COMM_WORLD.barrier()
print("came to its end", flush=True)
