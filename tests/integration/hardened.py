"""Programs and shared libraries are linked and compiled so that an overrun ends them, and libraries have versions.

Usage: hardened.py PROGRAM|LIBRARY...
"""

import re
import subprocess
import sys
from pathlib import Path


def readelf(*arguments):
    return subprocess.run(["readelf", "-W", *arguments], capture_output=True, text=True, check=True).stdout


def lacking(path):
    head, dynamic, segments = readelf("-h", path), readelf("-d", path), readelf("-l", path)
    symbols = readelf("--dyn-syms", path)
    if "DYN" not in re.search(r"Type:(.*)", head)[1]:
        yield "no random addresses (PIE)"
    if not re.search(r"FLAGS.*\bNOW\b", dynamic) or "GNU_RELRO" not in segments:
        yield "a writable table of functions (-z relro -z now)"
    if not re.search(r"GNU_STACK.* RW ", segments):
        yield "an executable stack"
    if "__stack_chk_fail" not in symbols:
        yield "no -fstack-protector-strong"
    if not re.search(r"__\w+_chk\b", symbols.replace("__stack_chk_fail", "")):
        yield "no _FORTIFY_SOURCE"
    if re.search(r"(RPATH|RUNPATH).*(\[:|::|:\])", dynamic):
        yield "libraries from the folder it is run in"
    if ".so" in path.name and not re.search(r"SONAME.*\[lib\w+\.so\.\d+\.\d+\]", dynamic):
        yield "no version in its soname"


def main(*paths):
    failures = [f"{path} has {what}" for path in paths for what in lacking(Path(path))]
    print("\n".join(f"FAILED: {line}" for line in failures) or f"{len(paths)} files are hardened")
    sys.exit(bool(failures))


main(*sys.argv[1:])
