"""How the scripts of the gallery run the programs, and what an entry of the gallery is."""

import json
import os
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1",
                   OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


@dataclass(frozen=True)
class Number:
    """A quantity as the text of the source has it and as we compute it; `source` is None where the text has none."""

    quantity: str
    unit: str
    source: float | None
    ours: float


@dataclass(frozen=True)
class Entry:
    """One figure of the source: the picture of ours, the numbers beside each other, and a remark."""

    figure: str  # "5.3", or "4.12, 4.13"
    title: str
    images: tuple
    remark: str
    numbers: tuple = field(default_factory=tuple)


def replaced(text, pattern, by):
    """The text with its only match of the pattern exchanged."""
    new, n = re.subn(pattern, by, text)
    if n != 1:
        raise SystemExit(f"studies.py: a scene has {n} times: {pattern}")
    return new


def run(program, command, folder, text=None):
    """Runs a command on folder/scene.toml, which gets the text if there is one; returns its summary."""
    folder.mkdir(parents=True, exist_ok=True)
    if text is not None:
        (folder / "scene.toml").write_text(text)
    summary = folder / f"{command}.{program.name}.json"
    words = [program, command, folder / "scene.toml", "--output", folder, "--json", summary]
    done = subprocess.run(list(map(str, words)), env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{program.name} {command}: {done.stderr}")
    return json.loads(summary.read_text())
