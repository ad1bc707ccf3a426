"""The scene of docs/tutorial/scene.md is one that `chladni` reads. Usage: scene_page.py PROGRAM_DIR"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path


def main(programs):
    page = (Path(__file__).parents[2] / "docs/tutorial/scene.md").read_text()
    scenes = re.findall(r"```toml\n(.*?)```", page, flags=re.S)
    if not scenes:
        sys.exit("FAILED: the page has no scene")
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.toml"
            path.write_text(scene)
            command = [programs / "chladni", "mesh", path, "--output", folder]
            run = subprocess.run(command, capture_output=True, text=True)
            print(run.stdout + run.stderr)
            if run.returncode:
                sys.exit("FAILED: chladni refuses the scene of the page")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
