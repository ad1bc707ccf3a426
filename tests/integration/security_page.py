"""Each line of docs/explanation/security.md names tests, and these exist.

Usage: security_page.py SOURCE_DIR
"""

import re
import sys
from fnmatch import fnmatch
from pathlib import Path

TABLE_HEADS = ("it cannot", "what", "---")


def names_of_tests(source):
    """`Suite.Name` of GoogleTest and `integration.name` of the scripts."""
    names = []
    for file in (source / "tests").rglob("*.cpp"):
        names += [f"{suite}.{name}" for suite, name in re.findall(r"TEST(?:_[FP])?\((\w+), (\w+)\)", file.read_text())]
    scripts = (source / "tests" / "integration").glob("*.py")
    return names + [f"integration.{script.stem}" for script in scripts]


def rows(page):
    """The cells of each row of each table."""
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and cells[0] not in TABLE_HEADS:
            yield cells


def wrong(source):
    tests = names_of_tests(source)
    for cells in rows((source / "docs/explanation/security.md").read_text()):
        named = re.findall(r"`([\w*]+\.[\w*]+)`", cells[-1])
        if not named:
            yield f"no test for: {cells[0]}"
        for pattern in named:
            if not any(fnmatch(test, pattern) for test in tests):
                yield f"no test is called {pattern}: {cells[0]}"


failures = list(wrong(Path(sys.argv[1])))
print("\n".join(f"FAILED: {line}" for line in failures) or "each line of docs/explanation/security.md has a test")
sys.exit(bool(failures))
