#!/usr/bin/python3
"""How long each library takes to compile, as a table, from the log that ninja keeps in a build folder.

usage: compile_times.py BUILD_FOLDER

With as many jobs as processors, as ./dev builds, the seconds of a step are those of a processor that does
nothing else. Each output counts with its last run.
"""
import collections
import os
import pathlib
import re
import resource
import sys

TARGET = re.compile(r"CMakeFiles/(?:chladni_)?(\w+)\.dir/")


def processor_seconds():
    """User's and system's, of all commands that this process has waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def machine():
    """"2 cores, 24 GiB": what this process may use of them."""
    memory = int(re.search(r"MemTotal:\s*(\d+)", pathlib.Path("/proc/meminfo").read_text())[1]) * 1024
    for line in pathlib.Path("/proc/self/cgroup").read_text().splitlines():
        _, controllers, own = line.split(":", 2)
        for limit in (f"/sys/fs/cgroup/memory{own}/memory.limit_in_bytes" if controllers == "memory" else "",
                      f"/sys/fs/cgroup{own}/memory.max" if not controllers else ""):  # of the first and second version
            if limit and pathlib.Path(limit).is_file() and pathlib.Path(limit).read_text().strip().isdigit():
                memory = min(memory, int(pathlib.Path(limit).read_text()))
    n = len(os.sched_getaffinity(0))
    return f"{n} core{'s' if n > 1 else ''}, {memory / 2**30:.0f} GiB"


def by_library(log):
    """{library: [seconds, steps, seconds of the longest step]} of a .ninja_log, the longest first; what is no source is `linking`."""
    last = {}
    for line in log.read_text().splitlines():
        if line.startswith("#"):
            continue
        start, end, _, output, _ = line.split("\t")
        last[output] = (int(end) - int(start)) / 1e3
    sums = collections.defaultdict(lambda: [0.0, 0, 0.0])
    for output, seconds in last.items():
        found = TARGET.search(output)
        entry = sums[found[1] if found and output.endswith((".o", ".pch")) else "linking"]
        entry[0] += seconds
        entry[1] += 1
        entry[2] = max(entry[2], seconds)
    return dict(sorted(sums.items(), key=lambda item: -item[1][0]))


def together(entries):
    seconds, steps, longest = zip(*entries)
    return [sum(seconds), sum(steps), max(longest)]


def table(build, shown=12):
    """Lines of markdown, of the longest ones and of all together; none where nothing was built by ninja."""
    log = pathlib.Path(build) / ".ninja_log"
    found = by_library(log) if log.is_file() else {}
    if not found:
        return []
    rows = list(found.items())
    others = rows[shown:]
    if others:
        rows[shown:] = [(f"{len(others)} others", together(entry for _, entry in others))]
    rows.append(("all", together(found.values())))
    return ["| library | minutes of a processor | steps | longest, s |", "| --- | --- | --- | --- |",
            *(f"| {name} | {seconds / 60:.2f} | {steps} | {longest:.0f} |" for name, (seconds, steps, longest) in rows)]  # fmt: skip


if __name__ == "__main__":
    print("\n".join(table(sys.argv[1])))
