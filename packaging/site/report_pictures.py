"""Draws the pictures of docs/how-to/report.md and README.md: pages of `report` and `mesh` of the examples, as a browser shows them.

Usage: report_pictures.py PROGRAM_DIR OUTPUT_DIR, with chromium. Called by `./dev pages`.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
# name, page, sections that stay, width and height of the window
PICTURES = [
    ("report_page", "disc.report.html", "", 1400, 1010),
    ("report_cycle", "disc.report.html", "map limit-cycle", 1400, 1500),
    ("report_sound", "disc.report.html", "sound", 1400, 1330),
    ("report_phone", "disc.report.html", "modes campbell", 400, 1100),
    ("report_mesh", "vented_disc.mesh.html", "", 1300, 760),
]
# A window of a browser has 500 pixels at least, so each page is shown in a frame of its own width.
FRAME = '<body style="margin: 0"><iframe src="PAGE" width="WIDTH" height="HEIGHT" style="border: 0" scrolling="no"></iframe></body>'
KEEP = "<script>for (const section of document.querySelectorAll('section')) if (!'%s'.split(' ').includes(section.id)) section.remove();</script></body>"


def make(programs, folder):
    """The pages of the examples."""
    scene = ROOT / "examples/thesis_disc/scene.toml"
    for program, command in (("chladni", "run"), ("squeal", "run"), ("chladni", "sound"), ("squeal", "report")):
        subprocess.run([programs / program, command, scene, "--output", folder], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run([programs / "chladni", "mesh", ROOT / "examples/vented_disc/scene.toml", "--output", folder], check=True, stdout=subprocess.DEVNULL)


def photograph(folder, output, name, page, sections, width, height):
    """A section of a page, or its beginning, in 128 colours."""
    text = (folder / page).read_text()
    (folder / "shown.html").write_text(text.replace("</body>", KEEP % sections) if sections else text)
    frame = folder / "frame.html"
    frame.write_text(FRAME.replace("PAGE", "shown.html").replace("WIDTH", str(width)).replace("HEIGHT", str(height)))
    file = output / f"{name}.png"
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files", "--hide-scrollbars",
                    "--virtual-time-budget=4000", f"--user-data-dir={folder}/profile", f"--window-size={max(width, 500)},{height}",
                    f"--screenshot={file}", frame.as_uri()], check=True, capture_output=True, timeout=120)  # fmt: skip
    with Image.open(file) as picture:
        picture.convert("RGB").crop((0, 0, width, height)).quantize(128).save(file, optimize=True)
    print(f"wrote {file}")


def main(programs, output):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make(programs, folder)
        for picture in PICTURES:
            photograph(folder, output, *picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
