"""How the benchmarks of bodies run `chladni`, and their beam."""

import json
import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CHLADNI = ROOT / "build/release/bin/chladni"
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1",
                   OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def run(command, folder, text):
    """One command on a scene; returns its summary, or the message with which it refused."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(text)
    done = subprocess.run([CHLADNI, command, folder / "scene.toml", "--output", folder, "--json", folder / "out.json"],
                          env=ENVIRONMENT, capture_output=True, text=True, check=False)
    return json.loads((folder / "out.json").read_text()) if done.returncode == 0 else done.stderr.strip()


def only(folder, pattern):
    return next(folder.glob(pattern))


def beam(elements=300, modes=100, body='fixed = ["A"]\nkeep = { modes = 40 }', length=1.0, beside_A=None):
    """The beam of the examples; `beside_A` is the distance of a fourth attachment node D from A, over the length."""
    text = (ROOT / "examples/beam/cantilever.toml").read_text()
    text = text[:text.index("[body]")].replace("elements = 300", f"elements = {elements}")
    text = text.replace("modes = 100", f"modes = {modes}").replace('resultants = ["beam"]', 'pictures = "none"')
    text = text.replace("end = [1.0,", f"end = [{length},").replace("0.3333333333333333", str(length / 3))
    text = text.replace('{ name = "C", distance = 1.0 },', f'{{ name = "C", distance = {length} }},')
    if beside_A:
        text = text.replace(f"elements = {elements}", f"element_size = {length / elements!r}")
        text = text.replace('{ name = "B"', f'{{ name = "D", distance = {beside_A * length!r} }},\n  {{ name = "B"')
        text = text.replace('nodes = ["A", "B", "C"]', 'nodes = ["A", "B", "C", "D"]')
    return text + f"[body]\n{body}\n"
