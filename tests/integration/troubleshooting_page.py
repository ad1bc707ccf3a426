"""The messages that docs/how-to/troubleshooting.md quotes are those of the sources. Usage: troubleshooting_page.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

ROOMS = ("common", "linear", "mesh", "plate", "reduce", "mbs_export", "squeal", "sound", "scene", "report", "cases", "cli", "plugin")
TEXT = r'"(?:[^"\\\n]|\\.)*"'


def messages(root):
    """The texts of all sources, with the pieces of each joined."""
    for room in ROOMS:
        for file in (root / room).rglob("*.[ch]pp"):
            for run in re.finditer(rf"{TEXT}(?:\s*{TEXT})*", file.read_text()):
                yield "".join(piece[1:-1] for piece in re.findall(TEXT, run[0])).replace('\\"', '"').replace("{}", "N")


def quoted(page):
    """What stands in quotation marks in the first cell of each row."""
    for line in page.splitlines():
        if line.startswith("| ") and not line.startswith("| symptom"):
            yield from re.findall(r'"([^"`]+)"', line.split(" | ")[0])


def main(root):
    texts = "\n".join(messages(root))
    words = list(quoted((root / "docs/how-to/troubleshooting.md").read_text()))
    unknown = [word for word in words if word not in texts]
    print("\n".join(f"FAILED: no program says {word!r}" for word in unknown) or f"the programs say all {len(words)} messages of the page")
    sys.exit(bool(unknown) or len(words) < 20)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
