"""Fails on an #include against the arrows of the architecture.

Usage: include_arrows.py SOURCE_DIR
"""

import re
import sys
from pathlib import Path

# A folder may include itself and what stands before it (the plugin delivers the reduced file) ...
ORDER = ["common", "mesh", "plate", "reduce", "mbs_export", "reduce_export", "reduce/plugin", "squeal", "sound", "cli"]
# ... but these two cuts are deeper: reduce/ takes any matrices, and right of the modal body nobody
# has heard of the finite elements or of their libraries. (Folder: forbidden beginnings.)
HEAVY = ("common/petsc", "petsc", "slepc", "mpi.h", "gmsh.h", "metis.h", "dmumps", "zmumps")
CUTS = {
    "reduce": ("mesh/", "plate/", "gmsh.h"),  # METIS orders its matrices
    "reduce_export": ("mesh/", "plate/", "gmsh.h", "metis.h"),
    "reduce/plugin": ("mesh/", "plate/", "gmsh.h", "metis.h"),
    "mbs_export": ("mesh/", "plate/", "reduce/", *HEAVY),
    "squeal": ("mesh/", "plate/", "reduce/", *HEAVY),
    # The sound field needs complex equations and a mesh of the air, not the body's elements.
    "sound": ("mesh/", "plate/", "reduce/", "common/petsc", "petsc", "slepc", "dmumps"),
}
# One source of the folder knows this header.
ONLY_IN = {"sound": ("gmsh.h", "mesh_air.cpp")}


def offences(root):
    """Yields file:line and text of each #include that is not allowed."""
    for folder in ORDER:
        later = tuple(f"{name}/" for name in ORDER[ORDER.index(folder) + 1 :])
        forbidden = later + CUTS.get(folder, ())
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            if folder == "reduce" and "plugin" in path.parts:
                continue
            for number, line in enumerate(path.read_text().splitlines(), start=1):
                found = re.match(r'\s*#\s*include\s*[<"]([^>"]+)', line)
                header, source = ONLY_IN.get(folder, ("", ""))
                misplaced = found and header and found[1] == header and path.name != source
                if found and (found[1].startswith(forbidden) or misplaced):
                    yield f"{path.relative_to(root)}:{number}: {line.strip()}"


if __name__ == "__main__":
    bad = list(offences(Path(sys.argv[1])))
    print("\n".join(bad) or "every #include follows the arrows")
    sys.exit(bool(bad))
