"""The commands and the Python of the three doors of README.md run. Usage: readme.py BUILD_DIR

They are run in a folder that has the examples and the build where the root of the project has them, so that what they write
goes away with it. The README is short: its test says how short.
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.M | re.S)


def doors(readme):
    """(heading, language, text) of each block below "Three doors"."""
    section = readme.split("\n## Three doors\n")[1].split("\n## ")[0]
    for door in section.split("\n### ")[1:]:
        heading, _, text = door.partition("\n")
        blocks = BLOCK.findall(text)
        if not blocks:
            sys.exit(f"FAILED: the door {heading} has nothing that runs")
        yield from ((heading, language, block) for language, block in blocks)


def main(build):
    readme = (ROOT / "README.md").read_text()
    if readme.count("\n") >= 120:
        sys.exit("FAILED: README.md has 120 lines or more; the details belong into docs/")
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        (root / "build").mkdir()
        (root / "build/release").symlink_to(build)
        (root / "examples").symlink_to(ROOT / "examples")
        environment = {**os.environ, "PYTHONPATH": str(build / "python")}
        for heading, language, text in doors(readme):
            start = time.monotonic()
            command = ["sh", "-ec", text] if language == "sh" else [sys.executable, "-c", text]
            run = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True)
            if run.returncode:
                sys.exit(f"FAILED: {heading}\n{text}\n{run.stdout}{run.stderr}")
            print(f"ok      {heading}: {time.monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
