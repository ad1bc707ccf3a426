"""No file holds the marks of a merge that was not finished. Usage: no_merge_marks.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

MARK = re.compile(rb"^(<{7}|>{7}) ", re.MULTILINE)
NO_SOURCES = ("build", ".git")


def marked(root):
    for path in sorted(root.rglob("*")):
        inside = path.relative_to(root).parts
        if inside[0] not in NO_SOURCES and path.is_file() and MARK.search(path.read_bytes()):
            yield "/".join(inside)


if __name__ == "__main__":
    found = list(marked(Path(sys.argv[1])))
    print("\n".join(f"{name}: marks of a merge" for name in found) or "no marks of a merge")
    sys.exit(bool(found))
