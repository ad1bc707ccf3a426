#!/usr/bin/python3
"""How long each library takes to compile, as a table, from the log that ninja keeps in a build folder.

usage: compile_times.py BUILD_FOLDER

With as many jobs as processors, as ./dev builds, the seconds of a step are those of a processor that does
nothing else. Each output counts with its last run.
"""
import collections
import pathlib
import re
import resource
import sys

TARGET = re.compile(r"CMakeFiles/(?:chladni_)?(\w+)\.dir/")


def processor_seconds():
    """User's and system's, of all commands that this process has waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def by_library(log):
    """{library: (seconds, steps)} of a .ninja_log, the longest first; what is no source is `linking`."""
    last = {}
    for line in log.read_text().splitlines():
        if line.startswith("#"):
            continue
        start, end, _, output, _ = line.split("\t")
        last[output] = (int(end) - int(start)) / 1e3
    sums = collections.defaultdict(lambda: [0.0, 0])
    for output, seconds in last.items():
        found = TARGET.search(output)
        entry = sums[found[1] if found and output.endswith((".o", ".pch")) else "linking"]
        entry[0] += seconds
        entry[1] += 1
    return dict(sorted(sums.items(), key=lambda item: -item[1][0]))


def table(build, shown=12):
    """Lines of markdown, of the longest ones and of all together; none where nothing was built by ninja."""
    log = pathlib.Path(build) / ".ninja_log"
    found = by_library(log) if log.is_file() else {}
    if not found:
        return []
    rows = list(found.items())
    others = rows[shown:]
    if others:
        rows[shown:] = [(f"{len(others)} others", [sum(entry[i] for _, entry in others) for i in (0, 1)])]
    rows.append(("all", [sum(entry[i] for entry in found.values()) for i in (0, 1)]))
    return ["| library | minutes of a processor | steps |", "| --- | --- | --- |",
            *(f"| {name} | {seconds / 60:.2f} | {steps} |" for name, (seconds, steps) in rows)]  # fmt: skip


if __name__ == "__main__":
    print("\n".join(table(sys.argv[1])))
