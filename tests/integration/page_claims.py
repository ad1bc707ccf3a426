"""What pages claim without a program that writes it. A time, a size of memory or a number of DOFs stands in prose only where `./dev bench pages`
writes it from docs/results/, or where it is a limit that a source has; messages in docs/how-to/troubleshooting.md are those of the sources.

Usage: page_claims.py SOURCE_DIR
"""

import re
import sys
from pathlib import Path

from links import CODE, FENCE, tracked

UNIT = r"(?:million DOFs|DOFs|[kMGT]i?B|(?:CPU )?(?:s|ms|min|h|seconds?|minutes?|hours?))"
NUMBER = re.compile(rf"(?<![\w.,/^-])\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?\s{UNIT}\b(?![-/²^])")
QUOTED = re.compile(r"<!-- bench: [\w ]+ -->.*?<!-- end -->|<!-- made by ./dev bench: begin -->.*?<!-- made by ./dev bench: end -->", re.S)
# Numbers that were not measured: the page, its words, and the source and the line that has the limit.
LIMITS = [
    *((f"docs/{page}.md", "20,000 DOFs", "cases/mesh_errors.hpp", "most_halved = 20'000")
      for page in ("explanation/theory", "explanation/squeal", "how-to/meshes")),
    ("docs/how-to/meshes.md", "30 MB", "report/fe/vtu.cpp", "most_marks = 30'000'000"),
    ("docs/how-to/meshes.md", "15 minutes", "mesh/mesher.cpp", ": 900.0;"),
    ("docs/how-to/report.md", "4 MB", "report/page/sound.cpp", "most_wav_bytes = 4'000'000"),
    ("docs/how-to/building.md", "4 GiB", "docs/results/systems.md", "1 core, 4 GiB"),
    *(("docs/reference/file_formats.md", words, f"common/files/{source}", line) for words, source, line in (
        ("10 s", "trial_reading.cpp", "cpu_s = unsigned(10 + file_size / (10 * MiB))"),
        ("1 s", "trial_reading.cpp", "cpu_s = unsigned(10 + file_size / (10 * MiB))"),
        ("10 MiB", "trial_reading.cpp", "cpu_s = unsigned(10 + file_size / (10 * MiB))"),
        ("60 s", "trial_reading.cpp", "wall_s = unsigned(60 + file_size / MiB)"),
        ("128 MiB", "hdf5_objects.hpp", "(std::uint64_t{128} << 20) + 16 * file_size"))),
    *(("docs/reference/file_formats.md", words, "squeal/transient/wav.cpp", "a WAV file holds up to 4 GiB")
      for words in ("4 GiB", "12 hours")),  # 2^32 / (2 * 48000) s
]  # fmt: skip
# What was measured on a day that they name, and is not measured again: what changed, what was decided, what was found.
DATED = ("CHANGELOG.md", "docs/explanation/decisions/", "docs/explanation/findings.md", "docs/results/", "tests/")
ROOMS = ("common", "linear", "mesh", "plate", "reduce", "mbs_export", "squeal", "sound", "scene", "report", "cases", "cli", "plugin")
TEXT = r'"(?:[^"\\\n]|\\.)*"'


def typed(root):
    """The measured numbers of pages that nothing holds."""
    blank = lambda found: re.sub(r"[^\n]", " ", found[0])
    for page in tracked(root):
        name = page.relative_to(root).as_posix()
        if page.suffix != ".md" or name.startswith(DATED):
            continue
        text = CODE.sub(blank, QUOTED.sub(blank, FENCE.sub(blank, page.read_text())))
        held = {words for of, words, _, _ in LIMITS if of == name}
        for found in NUMBER.finditer(text):
            if " ".join(found[0].split()) not in held:
                line = text.count("\n", 0, found.start()) + 1
                yield f"{name}:{line}: {found[0]!r} was typed: quote a result (benchmarks/claims.py, QUOTES), or leave it out"


def outdated(root):
    """The limits that a page or a source has no more."""
    for page, words, source, line in LIMITS:
        if words not in " ".join((root / page).read_text().split()):
            yield f"{page} says nothing of {words!r} any more"
        if line not in (root / source).read_text():
            yield f"{source} has no {line!r} for the {words} of {page}"


def unsaid(root):
    """What stands in quotation marks in the first cell of a row of troubleshooting, and in no text of a source."""
    files = [file for room in ROOMS for file in (root / room).rglob("*.[ch]pp")]
    runs = (run[0] for file in files for run in re.finditer(rf"{TEXT}(?:\s*{TEXT})*", file.read_text()))
    said = "\n".join("".join(piece[1:-1] for piece in re.findall(TEXT, run)).replace('\\"', '"').replace("{}", "N") for run in runs)
    for row in re.findall(r"^\| (?!symptom)(.*?) \| ", (root / "docs/how-to/troubleshooting.md").read_text(), re.M):
        yield from (f"no program says {words!r}" for words in re.findall(r'"([^"`]+)"', row) if words not in said)


def main(root):
    found = [*typed(root), *outdated(root), *unsaid(root)]
    print("\n".join(f"FAILED: {line}" for line in found) or "no measured number was typed, and the programs say the messages of troubleshooting")
    sys.exit(bool(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
