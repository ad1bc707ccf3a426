"""Chladni in Python: scenes, brakes that squeal, their files as plain objects; with PETSc also the reduction.

>>> import chladni
>>> scene = chladni.Scene({"squeal": {"model": "oscillator"}})
Traceback (most recent call last):
    ...
chladni.Error: scene:1: squeal.oscillator is missing: must be a table
"""

from chladni._squeal import Error, version as __version__
from chladni.files import Array, File, Group, open_file
from chladni.sampling import samples, write_samples
from chladni.scene import Run, Scene, sweep

Error.__module__ = "chladni"

__all__ = ["Array", "CMS", "ComplexEigenvalues", "Error", "File", "Group", "Reduction", "Run", "Scene", "complex_eigenvalues", "open", "reduce",
           "samples", "sweep", "write_samples"]  # fmt: skip

open = open_file


_NEEDS_PETSC = "needs python3-petsc4py, python3-slepc4py and a build with PETSc"


def __getattr__(name):
    """What needs PETSc is loaded when it is first asked for."""
    if name in ("CMS", "Reduction", "reduce", "ComplexEigenvalues", "complex_eigenvalues"):
        try:
            from chladni import eigenvalues, reduction
        except ImportError as missing:
            raise ImportError(f"{missing}; it {_NEEDS_PETSC}") from None
        return getattr(reduction if hasattr(reduction, name) else eigenvalues, name)
    raise AttributeError(f"module 'chladni' has no attribute {name!r}")
