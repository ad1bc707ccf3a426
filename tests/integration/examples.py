"""The examples that no other test runs; and none of the folder is forgotten. Usage: examples.py PROGRAM_DIR"""

import sys
import tempfile
from pathlib import Path

from running import run

EXAMPLES = Path(__file__).parents[2] / "examples"
# Folder or file -> the test that runs it.
ELSEWHERE = {
    "beam": "beam.py",
    "brake": "assembly.py",
    "decks": "public_decks.py",
    "fmu": "fmu.py",
    "hat_disc": "hat_disc.py",
    "matlab": "octave.py",
    "library": "../install/install.py",
    "oscillator": "../cli/squeal_program_test.cpp",
    "plugin": "plugin.py",
    "python": "../python/CMakeLists.txt",
    "response": "response.py",
    "rigid_disc": "../cli/squeal_program_test.cpp",
    "solid_disc": "solids.py",
    "read_body.py": "../cli/chladni_export_test.cpp",
    "thesis_disc": "thesis_disc.py",
    "vented_disc": "tutorial.py",
}
HERE = {"mechanisms", "tilting_block", "two_masses"}


def works(*command):
    run(*command)
    print(f"ok      {' '.join(str(word) for word in command[1:])}", flush=True)


def main(programs):
    known = HERE | set(ELSEWHERE)
    found = {path.name for path in EXAMPLES.iterdir() if path.name not in ("README.md", "__pycache__")}
    if found != known:
        sys.exit(f"FAILED: examples and tests differ: {sorted(found ^ known)}")
    for name, test in ELSEWHERE.items():
        if name.split(".")[0] not in (Path(__file__).parent / test).read_text():
            sys.exit(f"FAILED: {test} does not run {name}")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("tilting_block", "two_masses"):
            works(programs / "squeal", "run", EXAMPLES / name / "scene.toml", "--output", folder)
        # As docs/how-to/sweeps.md shows it.
        works(programs / "squeal", "sweep", EXAMPLES / "rigid_disc/scene.toml", "--output", folder, "--analyses", "critical-speed",
              "--vary", "squeal.friction=0.3:0.6:7", "--vary", "squeal.pads.preload=2000,3000,4000")  # fmt: skip
        works(sys.executable, EXAMPLES / "mechanisms/compare.py", programs / "squeal", folder, folder, 1.5)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
