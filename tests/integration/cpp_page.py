"""The C++ of docs/how-to/cpp.md compiles against the headers. Usage: cpp_page.py BUILD_DIR"""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

PROLOGUE = """
#include "mbs_export/make_body.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "reduce/support.hpp"
#include "reduce/reduction.hpp"
#include "reduce/reduced_system.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/study/study.hpp"
using namespace chladni;
"""
# What each piece of the page takes as given.
GIVEN = [
    "const mesh::AnnulusOptions& annulus_options, std::vector<plate::Coupling> couplings, "
    "std::vector<plate::ShellSection> sections, int n_ranks, "
    "const reduce::ReductionOptions& options, std::vector<PetscInt> masters, "
    "std::vector<PetscInt> held, mbs_export::ReducedSystem described",
    "const squeal::SquealOptions& options",
]


def flags(build):
    """Definitions and include folders of the program that sees all of the FE side."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if "CMakeFiles/chladni.dir/" in entry["command"]:
            words = shlex.split(entry["command"])
            pairs = zip(words, words[1:])
            systems = [word for flag, path in pairs if flag == "-isystem" for word in (flag, path)]
            return systems + [word for word in words if re.match("-[ID]|-std", word)]
    sys.exit("no source of chladni is in the compile database")


def main(build):
    page = (Path(__file__).parents[2] / "docs/how-to/cpp.md").read_text()
    pieces = re.findall(r"```cpp\n(.*?)```", page, flags=re.S)
    if len(pieces) != len(GIVEN):
        sys.exit(f"the page has {len(pieces)} pieces of C++, this test knows {len(GIVEN)}")
    functions = [
        f"void piece_{i}({given})\n{{\n{piece}}}\n"
        for i, (given, piece) in enumerate(zip(GIVEN, pieces))
    ]
    command = ["c++", *flags(build), "-fsyntax-only", "-x", "c++", "-"]
    run = subprocess.run(command, input=PROLOGUE + "\n".join(functions), text=True, check=False)
    sys.exit(run.returncode)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
