"""A scene on all ranks of mpirun: one body, the same on all of them. Usage: mpirun -n 2 on_ranks.py"""

from disc_scene import disc
from petsc4py import PETSc

import chladni

ranks = PETSc.COMM_WORLD.tompi4py()
run = disc().run()
found = ranks.allgather((run.folder, run.body.modes.frequencies.values.tolist(), run.squeal.critical.speed))
assert all(one == found[0] for one in found), found
ranks.barrier()  # the first rank owns the folder
try:
    disc(body={"fixed": [], "keep": {"modes": 3}}).run()
    raise AssertionError("a free body squeals")
except chladni.Error as error:
    assert "body.fixed" in str(error), error
ranks.barrier()
