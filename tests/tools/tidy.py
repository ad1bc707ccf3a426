#!/usr/bin/python3
"""clang-tidy over sources that have changed since they passed, many at a time.

usage: tidy.py BUILD_FOLDER SOURCE...

Most of the time goes into the headers of Eigen and of the standard library, which the sources of a
target read only once together. What is found in them is asked again file by file, so that nothing is
reported that is not there when a file is alone. A file has passed when its text, its headers, the rules and the tool are
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

ROOT = pathlib.Path(__file__).resolve().parents[2]
PASSED = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "chladni" / "lint"
MOST = 24  # sources at a time: 1 GB of memory
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


def rules_of(path):
    """The file of rules that holds for a source."""
    return next(folder / ".clang-tidy" for folder in path.parents if (folder / ".clang-tidy").is_file())


def target_of(entry):
    """Whose sources have distinct names in their unnamed namespaces."""
    return re.search(r" -o \S*CMakeFiles/([^/]+)\.dir/", entry["command"])[1]


def groups_of(paths, key):
    """Lists of up to MOST paths of one key."""
    of_key = {}
    for path in paths:
        of_key.setdefault(key(path), []).append(path)
    return [some[i:i + MOST] for some in of_key.values() for i in range(0, len(some), MOST)]


def together(flags):
    """The flags of several sources in one list; of a folder of headers or a macro the first place counts."""
    words = []
    for some in flags:
        at = 0
        while at < len(some):
            word = some[at : at + 2] if some[at] in ("-isystem", "-I", "-D") else some[at : at + 1]
            at += len(word)
            if word not in words:
                words.append(word)
    return [part for word in words for part in word]


def read_together(paths, flags, folder):
    """What is wrong with files of one set of rules, read as one; beside a copy of these rules."""
    rules = rules_of(paths[0])
    own = folder / rules.parent.relative_to(ROOT) / paths[0].stem
    own.mkdir(parents=True, exist_ok=True)
    (own / ".clang-tidy").write_text(rules.read_text(encoding="utf-8"), encoding="utf-8")
    whole = own / f"with_{paths[0].name}"
    whole.write_text("".join(f'#include "{path}"\n' for path in paths), encoding="utf-8")
    return complaints(whole, together(flags[path] for path in paths), "--checks=-bugprone-suspicious-include")  # that of a .cpp


def tidy(paths, flags, folder):
    """What is wrong with files that are read as one; marks those that have passed."""
    wrong = {path: "" for path in paths}
    if len(paths) == 1 or read_together(paths, flags, folder):
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
    target = {pathlib.Path(entry["file"]).resolve(): target_of(entry) for entry in database}
    groups = groups_of(paths, lambda path: (target[path], rules_of(path)))
    wrong = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        for found in workers.map(lambda group: tidy(group, flags, folder), groups):
            if found:
                wrong = True
                print(found, file=sys.stderr, flush=True)
    return wrong


if __name__ == "__main__":
    sys.exit(main())
