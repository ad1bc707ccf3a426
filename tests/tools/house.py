#!/usr/bin/python3
"""The weight of the house: files, lines, what is too small or too long, headers with one user.

usage: house.py SOURCE_DIR [--check]    prints it; --check compares it with the limits in CONTRIBUTING.md
"""
import re
import sys
from pathlib import Path

NO_PRODUCT = ("benchmarks", "build", "cmake", "docs", "examples", "out", "packaging", "tests")
SMALL, LONG = 50, 700  # lines of a file
LONGEST = 12  # functions shown
LIMIT = re.compile(r"^\| ([^|]+?) \| (at (?:most|least)) \| ([\d,]+) \|", re.M)


def lines_of(path):
    return path.read_text(encoding="utf-8").splitlines()


def files_below(folder, *suffixes):
    return sorted(path for path in folder.rglob("*") if path.suffix in suffixes and path.is_file())


def rooms(root):
    return [path for path in sorted(root.iterdir()) if path.is_dir() and path.name not in NO_PRODUCT and not path.name.startswith(".")]


def functions(path):
    """(lines, name) of each function of a source as clang-format lays them out: its brace stands alone in the first column."""
    lines, head = lines_of(path), 0
    for number, line in enumerate(lines):
        if line == "{":
            end = next(i for i in range(number, len(lines)) if lines[i].startswith("}"))
            name = re.search(r"([\w:~]+)\(", lines[head])
            yield end - head + 1, name[1] if name else lines[head]
        elif line and not line[0].isspace() and not line.startswith((")", "//")) and (number == 0 or not lines[number - 1].endswith(",")):
            head = number


def users(root, headers):
    """{header: names of the files of the project that include it}."""
    found = {header: set() for header in headers}
    places = {header.relative_to(root).as_posix(): header for header in headers}
    for path in files_below(root, ".hpp", ".cpp", ".h", ".c"):
        if path.relative_to(root).parts[0] in ("build", "out"):
            continue
        for name in re.findall(r'^#include "([^"]+)"', path.read_text(encoding="utf-8"), re.M):
            if name in places:
                found[places[name]].add(path)
    return found


def measure(root):
    cpp = [path for room in rooms(root) for path in files_below(room, ".hpp", ".cpp", ".h", ".c")]
    other = [path for room in rooms(root) for path in files_below(room, ".py", ".pyi", ".js")]
    lengths = {path: len(lines_of(path)) for path in cpp}
    tests = [path for name in ("tests",) if (root / name).is_dir()
             for path in files_below(root / name, ".hpp", ".cpp", ".h", ".c", ".py")]  # fmt: skip
    total = sum(lengths.values())
    return lengths, {
        "C and C++ files of the product": len(cpp),
        "lines of such a file, in the mean": total // len(cpp),
        "of them with 50 lines or less, %": 100 * sum(n <= SMALL for n in lengths.values()) // len(cpp),
        "lines of the product, with Python and JavaScript": total + sum(len(lines_of(path)) for path in other),
        "lines of the tests": sum(len(lines_of(path)) for path in tests),
        "rooms": len(rooms(root)),
    }


def show(root, lengths, numbers):
    for name, value in numbers.items():
        print(f"{value:8,}  {name}")
    print(f"\nfiles of more than {LONG} lines")
    for path, n in sorted(lengths.items(), key=lambda item: -item[1]):
        if n > LONG:
            print(f"{n:8}  {path.relative_to(root)}")
    print("\nlongest functions")
    found = [(n, name, path) for path in lengths if path.suffix == ".cpp" for n, name in functions(path)]
    for n, name, path in sorted(found, key=lambda entry: -entry[0])[:LONGEST]:
        print(f"{n:8}  {name}  {path.relative_to(root)}")
    print("\nheaders with one user")
    for header, those in users(root, [path for path in lengths if path.suffix == ".hpp"]).items():
        if len(those - {header.with_suffix(".cpp")}) <= 1:
            print(f"{lengths[header]:8}  {header.relative_to(root)}")
    print(f"\nfiles of at most {SMALL} lines")
    print(*(path.relative_to(root).as_posix() for path, n in lengths.items() if n <= SMALL), sep="\n")


def beyond(root, numbers):
    """What the limits of CONTRIBUTING.md do not allow."""
    limits = {name: (word, int(value.replace(",", ""))) for name, word, value in LIMIT.findall((root / "CONTRIBUTING.md").read_text())}
    for name, value in numbers.items():
        if name not in limits:
            yield f"CONTRIBUTING.md has no limit of: {name}"
        elif (value > limits[name][1]) if limits[name][0] == "at most" else (value < limits[name][1]):
            yield f"{name}: {value:,}, {limits[name][0]} {limits[name][1]:,}"


if __name__ == "__main__":
    source = Path(sys.argv[1]).resolve()
    each, sums = measure(source)
    if "--check" in sys.argv[2:]:
        wrong = list(beyond(source, sums))
        print("\n".join(wrong) or "the house keeps its limits")
        sys.exit(bool(wrong))
    show(source, each, sums)
