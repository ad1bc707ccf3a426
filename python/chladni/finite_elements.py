"""From the mesh of a scene to its body, in this process: what needs PETSc, SLEPc and Gmsh."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from petsc4py import PETSc
import slepc4py.SLEPc  # noqa: F401  begins SLEPc

from chladni import _fe

_PACKAGE = Path(__file__).parent


def _name_mesher() -> None:
    """The program that reads mesh files is beside the package, or in the folder of the build that it stands in."""
    for reader in (_PACKAGE / "chladni-mesher", _PACKAGE.parents[1] / "libexec/chladni/chladni-mesher"):
        if reader.exists():
            os.environ.setdefault("CHLADNI_MESHER", str(reader))


def make_body(scene, folder: str, progress) -> list[str]:
    """Writes NAME.reduced.h5 and NAME.body.h5 in the folder; collective on all ranks.

    Returns:
        what is to be told of the body, a line for each note
    """
    _name_mesher()
    return _fe.make_body(scene.text, scene.path, folder, progress)


def same_on_all_ranks(folder: str) -> str:
    """The folder of the first rank."""
    return PETSc.COMM_WORLD.tompi4py().bcast(folder) if PETSc.COMM_WORLD.getSize() > 1 else folder


def on_first_rank(work: Callable[[], object]) -> None:
    """Performs work() on the first rank while the others wait; what it raises is raised on all."""
    if PETSc.COMM_WORLD.getSize() == 1:
        work()
        return
    ranks, failure = PETSc.COMM_WORLD.tompi4py(), None
    if ranks.rank == 0:
        try:
            work()
        except Exception as error:
            failure = error
    failure = ranks.bcast(failure)
    if failure is not None:
        raise failure
