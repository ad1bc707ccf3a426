"""Chladni in Python: scenes, brakes that squeal, their files as plain objects; with PETSc also the reduction.

>>> import chladni
>>> scene = chladni.Scene({"squeal": {"model": "oscillator"}})
Traceback (most recent call last):
    ...
chladni.Error: scene:1: squeal.oscillator is missing: must be a table
"""

from chladni._squeal import Error, version as __version__
from chladni.files import Array, File, Group, open_file
from chladni.scene import Run, Scene, sweep

Error.__module__ = "chladni"

__all__ = ["Array", "CMS", "Error", "File", "Group", "Reduction", "Run", "Scene", "open", "reduce", "sweep"]

open = open_file


def __getattr__(name):
    """What needs PETSc is loaded when it is first asked for."""
    if name in ("CMS", "Reduction", "reduce"):
        from chladni import reduction

        return getattr(reduction, name)
    raise AttributeError(f"module 'chladni' has no attribute {name!r}")
