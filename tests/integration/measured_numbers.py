"""A time, a size of memory or a number of DOFs stands in a page only where `./dev bench pages` writes it from docs/results/, or where it is a
limit that a source has. Usage: measured_numbers.py SOURCE_DIR
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
    ("docs/explanation/theory.md", "20,000 DOFs", "cases/mesh_errors.hpp", "most_halved = 20'000"),
    ("docs/explanation/squeal.md", "20,000 DOFs", "cases/mesh_errors.hpp", "most_halved = 20'000"),
    ("docs/how-to/meshes.md", "20,000 DOFs", "cases/mesh_errors.hpp", "most_halved = 20'000"),
    ("docs/how-to/meshes.md", "30 MB", "report/fe/vtu.cpp", "most_marks = 30'000'000"),
    ("docs/how-to/meshes.md", "15 minutes", "mesh/mesher.cpp", ": 900.0;"),
    ("docs/how-to/report.md", "4 MB", "report/page/sound.cpp", "most_wav_bytes = 4'000'000"),
    ("docs/how-to/building.md", "4 GiB", "docs/results/systems.md", "1 core, 4 GiB"),
    ("docs/reference/file_formats.md", "10 s", "common/files/trial_reading.cpp", "cpu_s = unsigned(10 + file_size / (10 * MiB))"),
    ("docs/reference/file_formats.md", "1 s", "common/files/trial_reading.cpp", "cpu_s = unsigned(10 + file_size / (10 * MiB))"),
    ("docs/reference/file_formats.md", "10 MiB", "common/files/trial_reading.cpp", "cpu_s = unsigned(10 + file_size / (10 * MiB))"),
    ("docs/reference/file_formats.md", "60 s", "common/files/trial_reading.cpp", "wall_s = unsigned(60 + file_size / MiB)"),
    ("docs/reference/file_formats.md", "128 MiB", "common/files/hdf5_objects.hpp", "(std::uint64_t{128} << 20) + 16 * file_size"),
    ("docs/reference/file_formats.md", "4 GiB", "squeal/transient/wav.cpp", "a WAV file holds up to 4 GiB"),
    ("docs/reference/file_formats.md", "12 hours", "squeal/transient/wav.cpp", "a WAV file holds up to 4 GiB"),  # 2^32 / (2 * 48000) s
]
# What was measured on a day that they name, and is not measured again: what changed, what was decided, what was found.
DATED = ("CHANGELOG.md", "docs/explanation/decisions/", "docs/explanation/findings.md", "docs/results/", "tests/")


def prose(page):
    """Its text without code and without what a program writes, line numbers kept."""
    blank = lambda found: re.sub(r"[^\n]", " ", found[0])
    return CODE.sub(blank, QUOTED.sub(blank, FENCE.sub(blank, page.read_text())))


def typed(root, page):
    """The numbers of a page that nothing holds."""
    name, text = page.relative_to(root).as_posix(), prose(page)
    held = {words for of, words, _, _ in LIMITS if of == name}
    for found in NUMBER.finditer(text):
        if " ".join(found[0].split()) not in held:
            yield f"{name}:{text.count(chr(10), 0, found.start()) + 1}: {found[0]!r} was typed: quote a result (benchmarks/claims.py, QUOTES), or leave it out"


def outdated(root):
    """The limits that a page or a source has no more."""
    for page, words, source, line in LIMITS:
        if words not in " ".join((root / page).read_text().split()):
            yield f"{page} says nothing of {words!r} any more"
        if line not in (root / source).read_text():
            yield f"{source} has no {line!r} for the {words} of {page}"


def main(root):
    pages = [page for page in tracked(root) if page.suffix == ".md" and not page.relative_to(root).as_posix().startswith(DATED)]
    found = [*(line for page in pages for line in typed(root, page)), *outdated(root)]
    print("\n".join(f"FAILED: {line}" for line in found) or f"no measured number was typed into {len(pages)} pages")
    sys.exit(bool(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
