#!/usr/bin/python3
"""clang-tidy over sources that have changed since they passed, several of a folder at a time.

usage: tidy.py BUILD_FOLDER SOURCE...

Most of the time goes into the headers of Eigen and of the standard library, which a batch reads only
once. What a batch complains of is asked again file by file, so that nothing is reported that is not
there when a file is alone. A file has passed when its text, its headers, the rules and the tool are
the same; all checkouts of a user share what has passed.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

from batches import batches

ROOT = pathlib.Path(__file__).resolve().parents[2]
PASSED = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "chladni" / "lint"
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)


def headers_of(path, seen):
    """The file and all headers of the project that it reads."""
    if path in seen or not path.is_file():
        return
    seen.add(path)
    for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
        for folder in (ROOT, path.parent):
            headers_of((folder / name).resolve(), seen)


@functools.cache
def tool():
    return subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout


def mark_of(path):
    """The file that stands for the state in which this one has passed."""
    seen = set()
    headers_of(path, seen)
    rules = [folder / ".clang-tidy" for folder in [ROOT, *path.parents] if (folder / ".clang-tidy").is_file()]
    text = b"".join(p.read_bytes() for p in [*sorted(seen), *rules, pathlib.Path(__file__)])
    return PASSED / hashlib.sha256(str(path.relative_to(ROOT)).encode() + tool() + text).hexdigest()[:32]


def flags_of(entry):
    """Those that matter to a reader of the source: macros, folders, language."""
    words = shlex.split(entry["command"])
    kept, take = [], False
    for word in words:
        if take or re.match(r"-[DI]|-std=|-isystem", word):
            kept.append(word)
        take = word in ("-isystem", "-I", "-D")
    return kept


def complaints(path, flags, *options):
    done = subprocess.run(["clang-tidy", "--quiet", *options, str(path), "--", "-w", *flags], cwd=ROOT,
                          capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr


def read_together(paths, flags, folder):
    """What is wrong with files of one folder, read as one; below a copy of the rules of that folder."""
    own = folder / paths[0].parent.relative_to(ROOT)
    own.mkdir(parents=True, exist_ok=True)
    rules = paths[0].parent / ".clang-tidy"
    if rules.is_file():
        (own / ".clang-tidy").write_text(rules.read_text(encoding="utf-8"), encoding="utf-8")
    together = own / f"with_{paths[0].name}"
    together.write_text("".join(f'#include "{path}"\n' for path in paths), encoding="utf-8")
    return complaints(together, flags, "--checks=-bugprone-suspicious-include")  # that of a .cpp


def tidy(paths, flags, folder):
    """What is wrong with a batch; marks the files that have passed."""
    wrong = {path: "" for path in paths}
    if len(paths) == 1 or read_together(paths, flags[paths[0]], folder):
        wrong = {path: complaints(path, flags[path]) for path in paths}
    for path in paths:
        if not wrong[path]:
            mark_of(path).touch()
    return "".join(wrong.values())


def main():
    build = pathlib.Path(sys.argv[1])
    folder = build.resolve() / "together"
    folder.mkdir(parents=True, exist_ok=True)
    PASSED.mkdir(parents=True, exist_ok=True)
    database = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    flags = {pathlib.Path(entry["file"]).resolve(): flags_of(entry) for entry in database}
    # What is not built here, for want of an optional library, cannot be read either.
    paths = [p for p in (pathlib.Path(name).resolve() for name in sys.argv[2:]) if p in flags]
    paths = [p for p in paths if not mark_of(p).exists()]
    groups = batches(paths, lambda path: (path.parent, *flags[path]))
    wrong = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        for found in workers.map(lambda batch: tidy(batch, flags, folder), groups):
            if found:
                wrong = True
                print(found, file=sys.stderr, flush=True)
    return wrong


if __name__ == "__main__":
    sys.exit(main())
