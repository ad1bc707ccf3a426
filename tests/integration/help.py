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
    for slip, meant in (("runn", "run"), ("infos", "info")):
        done = start(program, slip)
        if done.returncode != 2 or f"did you mean {meant}?" not in done.stderr:
            sys.exit(f"FAILED: {program} {slip} does not lead to {meant}:\n{done.stderr}")
    done = start(program, "run", "scene.toml", "--ouput", "out")
    if done.returncode != 2 or "did you mean --output?" not in done.stderr:
        sys.exit(f"FAILED: {program} run --ouput does not lead to --output:\n{done.stderr}")
