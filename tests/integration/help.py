"""Each command explains itself with an example. Usage: help.py PROGRAM..."""

import re
import sys

from running import start


def help_of(*command):
    done = start(*command, "--help")
    if done.returncode or "Example" not in done.stdout:
        sys.exit(f"FAILED: {' '.join(command)} --help ends with {done.returncode}, without an example:\n{done.stdout}")
    return done.stdout


for program in sys.argv[1:]:
    subcommands = re.findall(r"^  ([a-z-]+) {2,}", help_of(program).split("Subcommands:")[1], re.M)
    for subcommand in subcommands:
        help_of(program, subcommand)
    print(f"ok      {program}: {', '.join(subcommands)}")
    if len(subcommands) < 4:
        sys.exit("FAILED: subcommands are missing")
