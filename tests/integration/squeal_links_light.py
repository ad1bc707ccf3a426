"""Fails when `squeal` needs a library of the FE side.

Usage: squeal_links_light.py SQUEAL_PROGRAM
"""

import re
import subprocess
import sys

HEAVY = r"lib\S*(petsc|slepc|mpi|gmsh|metis|mumps|scotch)\S*"

# All libraries, also those that libraries need.
libraries = subprocess.run(["ldd", sys.argv[1]], capture_output=True, text=True, check=True).stdout
if not re.search(r"libhdf5", libraries):
    sys.exit(f"ldd shows no HDF5, so it has not seen the program at all:\n{libraries}")
heavy = sorted({found[0] for found in re.finditer(HEAVY, libraries)})
print("squeal needs " + (", ".join(heavy) if heavy else "nothing of the FE side"))
sys.exit(bool(heavy))
