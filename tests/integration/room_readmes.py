"""Each room has a README.md with a line for each header, and the files that it names are there. Usage: room_readmes.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

NO_ROOMS = ("benchmarks", "build", "cmake", "docs", "examples", "tests")


def complaints(root):
    for room in sorted(path for path in root.iterdir() if (path / "CMakeLists.txt").is_file()):
        if room.name in NO_ROOMS or room.name.startswith("."):
            continue
        readme = room / "README.md"
        if not readme.is_file():
            yield f"{room.name}/ has no README.md"
            continue
        text = readme.read_text()
        for header in sorted(path for path in room.rglob("*") if path.suffix in (".hpp", ".h")):
            if f"`{header.relative_to(room).as_posix()}`" not in text:
                yield f"{room.name}/README.md has no line for {header.relative_to(room)}"
        for name in re.findall(r"`([\w/]+\.(?:cpp|hpp|h))`", text):
            if not (room / name).is_file() and not (root / name).is_file():
                yield f"{room.name}/README.md names {name}, which is not there"


if __name__ == "__main__":
    found = list(complaints(Path(sys.argv[1])))
    print("\n".join(found) or "each room has a README.md that names files which are there")
    sys.exit(bool(found))
