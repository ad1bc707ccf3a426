"""docs/reference/scene.md is what the program prints, and its table is complete.

Each key that a reader asks for has a row, each row is asked for, and each key of the examples is in it.
Usage: scene_reference.py PROGRAM_DIR
"""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
READERS = [file for file in (ROOT / "scene").glob("*.cpp") if file.name != "keys.cpp"]
ASKED = re.compile(
    r'\b(?:has|number|numbers|integer|integers|text|texts|truth|table|tables|choice<[\w:]+>|is_\w+|'
    r'read_vector|read_by_component|read_profile|read_rotation|read_translation|read_shear_factor|or_wall|'
    r'stiffness|damping|read_place|read_component_list|read_mode_list)\(\s*(?:\w+,\s*)?"(\w+)"')  # fmt: skip


def fail_on(what, names):
    if names:
        sys.exit(f"FAILED: {what}: {', '.join(sorted(names))}")
    print(f"ok      no {what}")


def paths_of(table, prefix=""):
    """The key paths of a parsed scene, lists of tables without places."""
    for key, value in table.items():
        path = f"{prefix}{key}"
        yield path
        for inner in value if isinstance(value, list) else [value]:
            if isinstance(inner, dict):
                yield from paths_of(inner, path + ".")


def main(programs):
    printed = subprocess.run([programs / "squeal", "scene-reference"], capture_output=True, text=True, check=True).stdout
    document = (ROOT / "docs/reference/scene.md").read_text()
    rows = re.findall(r"^\| `([\w.*]+)` \|", printed, re.M)
    fail_on("row without a meaning", {line.split("`")[1] for line in printed.splitlines() if line.startswith("| `") and line.endswith("|  |")})
    names = {row.split(".")[-1] for row in rows} - {"*"}
    source = "".join(file.read_text() for file in READERS)
    fail_on("key that is read but has no row in scene/keys", set(ASKED.findall(source)) - names)
    fail_on("row that nobody reads", {name for name in names if f'"{name}"' not in source})
    patterns = [re.compile(re.escape(row).replace(r"\*", r"[^.]+") + "$") for row in rows]
    scenes = [*ROOT.glob("examples/*/*.toml"), *ROOT.glob("tests/data/*.toml")]
    used = {path for scene in scenes for path in paths_of(tomllib.loads(scene.read_text()))}
    fail_on("key of the examples without a row", {path for path in used if not any(p.match(path) for p in patterns)})
    if document != printed:
        sys.exit("FAILED: docs/reference/scene.md is out of date: squeal scene-reference > docs/reference/scene.md")
    print(f"ok      docs/reference/scene.md is up to date, {len(rows)} keys in {len(scenes)} scenes")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
