"""Fails on an #include against the arrows of the architecture.

Usage: include_arrows.py SOURCE_DIR
"""

import re
import sys
from pathlib import Path

# What each room may include besides itself; a room within a folder has rules of its own. "plate" is what stands in
# plate/ itself, "plate/" that and all rooms below it.
LIGHT = ("common", "common/files", "linear/dense")
LINEAR = ("common", "linear/")
BODIES = (*LIGHT, "mbs_export/")
MODELS = ("common", "mesh/", "plate/", "reduce", "reduce/cyclic", "linear/", "common/files", "mbs_export/", "squeal/", "sound")
ALLOWED = {
    "common": (),
    "common/files": ("common",),
    "linear": ("common",),
    "linear/dense": ("common",),
    "linear/kernels": ("common", "linear", "linear/dense"),
    "linear/cholesky": ("common", "linear", "linear/kernels", "linear/cholesky/supernodal"),
    "linear/cholesky/supernodal": ("common", "linear", "linear/kernels", "linear/cholesky"),
    "linear/lanczos": ("common", "linear", "linear/kernels"),
    "common/confinement": ("common",),
    "mesh": ("common", "common/confinement", "common/files", "mesh/decks", "mesh/exchange"),
    "mesh/decks": ("common", "mesh"),
    "mesh/gmsh": ("common", "common/confinement", "mesh", "mesh/decks", "mesh/exchange"),
    "mesh/exchange": ("common", "common/files", "mesh", "mesh/decks"),
    "plate": ("common", "mesh"),
    "plate/elements": ("common", "mesh", "plate"),
    "plate/refinement": ("common", "mesh", "plate", "plate/elements"),
    "plate/sections": ("common", "mesh", "plate", "plate/elements"),
    "plate/dofs": ("common", "mesh", "plate", "plate/elements", "plate/sections"),
    "plate/assembly": ("common", "mesh", "plate/"),
    "reduce": (*LINEAR, "common/files", "mbs_export/"),
    "reduce/cyclic": (*LINEAR, "reduce"),
    "mbs_export/fmu": ("common",),
    "mbs_export": (*BODIES, "mbs_export/fmu"),
    "plugin": (*LINEAR, "common/files", "reduce", "reduce/cyclic", "mbs_export/"),
    "squeal": BODIES,
    "squeal/results": (*BODIES, "squeal"),
    "squeal/brake": (*BODIES, "squeal", "squeal/results"),
    "squeal/motion": (*BODIES, "squeal", "squeal/results", "squeal/brake"),
    "squeal/assembly": (*BODIES, "squeal", "squeal/results", "squeal/brake"),
    "squeal/models": (*BODIES, "squeal", "squeal/results", "squeal/brake", "squeal/assembly", "squeal/motion"),
    "squeal/stability": (*BODIES, "squeal", "squeal/results", "squeal/brake", "squeal/motion", "squeal/models"),
    "squeal/condensation": (*BODIES, "squeal", "squeal/results", "squeal/brake", "squeal/assembly", "squeal/models",
                            "squeal/stability"),
    "squeal/transient": (*BODIES, "squeal", "squeal/results", "squeal/brake", "squeal/motion", "squeal/models",
                         "squeal/stability"),
    "squeal/cycle": (*BODIES, "squeal", "squeal/results", "squeal/brake", "squeal/motion", "squeal/models",
                     "squeal/stability", "squeal/transient"),
    "squeal/fmu": (*BODIES, "mbs_export/fmu", "squeal/brake", "squeal/motion", "squeal"),
    "squeal/study": (*BODIES, "squeal/"),
    "sound": (*BODIES, "squeal/", "common/confinement"),
    "sound/gmsh": ("common", "sound"),
    "scene": ("common",),  # and OPTIONS
    "report": (*BODIES, "squeal/", "scene/"),
    "report/fe": (*BODIES, "squeal/", "sound", "mesh", "plate/", "scene/", "report/"),
    "cases": (*MODELS, "scene/", "report/"),
    "cases/squeal": (*BODIES, "squeal/", "squeal/fmu", "scene/", "report"),
    "cli": (*MODELS, "scene/", "report/", "cases/"),  # and MESHER
    "python": (*MODELS, "scene/", "report/", "cases/"),
}
# The scene knows the options of all libraries: plain structs, which include nothing of theirs.
OPTIONS = re.compile(r"[\w/]+/(\w+_options|friction|cycle_harmonics)\.hpp$")
# Right of the modal body nobody has heard of the finite elements or of their libraries; METIS orders the matrices of linear/.
HEAVY = ("common/petsc", "common/all_ranks", "common/index_sets", "petsc", "slepc", "mpi.h", "gmsh.h", "metis.h", "dmumps", "zmumps")
CUTS = {
    "common/files": HEAVY,
    "mbs_export/fmu": (*HEAVY, "fmt", "hdf5", "common/files"),  # runs in programs of others, where none of it is
    "squeal/fmu": (*HEAVY, "fmt", "hdf5", "common/files"),
    "linear/dense": HEAVY,
    "reduce": ("metis.h",),
    "reduce/cyclic": ("metis.h",),
    "plugin": ("metis.h",),
    "mbs_export": HEAVY,
    "squeal": HEAVY,
    "scene": HEAVY,
    "report": tuple(name for name in HEAVY),
    "cases/squeal": HEAVY,
    # The sound field needs complex equations and a mesh of the air, not the body's elements.
    "sound": ("common/petsc", "common/all_ranks", "common/index_sets", "petsc", "slepc", "dmumps"),
}
# One program knows Gmsh, which is slow to load: these rooms are linked to nothing else.
OF_GMSH = ("mesh/gmsh", "sound/gmsh")
MESHER = ("cli", "mesher_main.cpp", ("common/confinement", *OF_GMSH))
# These cost the compiler up to a minute in each source; they are compiled once behind this header, for all who may include it.
SOLVERS = ("Eigen/Eigenvalues", "Eigen/SVD", "Eigen/Dense")
COMPILED_ONCE = "linear/dense/dense_solvers.hpp"


def room_of(path, rooms):
    """The innermost room that a path is in; None for headers of other libraries."""
    inside = [room for room in rooms if path.startswith(room + "/")]
    return max(inside, key=len, default=None)


def is_allowed(room, header, name=""):
    """Whether a source of this name in `room` may include the header."""
    folder = room.split("/")[0]
    if header.startswith(CUTS.get(room, CUTS.get(folder, ()))):
        return False
    if header in SOLVERS and name != Path(COMPILED_ONCE).name and is_allowed(room, COMPILED_ONCE):
        return False
    if header.startswith("gmsh.h"):
        return room in OF_GMSH
    target = room_of(header, ALLOWED)
    if (room, name) == MESHER[:2] and target in MESHER[2]:
        return True
    if target in OF_GMSH and target != room:
        return False
    if target in (None, room) or (room == "scene" and OPTIONS.match(header)):
        return True
    return any(target == a or (a.endswith("/") and (target + "/").startswith(a)) for a in ALLOWED[room])


def offences(root):
    """Yields file:line and text of each #include that is not allowed."""
    for folder in sorted({room.split("/")[0] for room in ALLOWED}):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            here = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text().splitlines(), start=1):
                found = re.match(r'\s*#\s*include\s*[<"]([^>"]+)', line)
                if found and not is_allowed(room_of(here, ALLOWED), found[1], path.name):
                    yield f"{here}:{number}: {line.strip()}"


if __name__ == "__main__":
    bad = list(offences(Path(sys.argv[1])))
    print("\n".join(bad) or "every #include follows the arrows")
    sys.exit(bool(bad))
