"""The image of packaging/Containerfile, built by buildah as root, and the example that docs/how-to/building.md runs in it. The
image that it starts from is a bare Debian made by debootstrap, so that nothing comes from elsewhere than Debian. Adds a section
to a page, in place of an earlier one.

Usage: in_container.py PAGE.md. Called by `./dev test-on container`.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import on_system

SUITE = "trixie"
BASE, IMAGE = f"docker.io/library/debian:{SUITE}-slim", "localhost/chladni"
BUILDAH = ["buildah", "--storage-driver=vfs"]
EXAMPLE = "chladni run examples/thesis_disc/scene.toml --output out"


def buildah(*arguments):
    return subprocess.run([*BUILDAH, *arguments], check=True, text=True, stdout=subprocess.PIPE).stdout.strip()


def base_image():
    """A bare Debian under the name that the Containerfile starts from."""
    with tempfile.TemporaryDirectory(dir="/var/tmp") as name:
        folder = Path(name, "system")
        on_system.bare_system(SUITE, folder)
        container = buildah("from", "scratch")
        buildah("copy", "--quiet", container, str(folder), "/")
    buildah("commit", "--quiet", "--rm", container, BASE)


def timed(*command, folder):
    """(exit code, what it prints, seconds)"""
    start = time.monotonic()
    run = subprocess.run(command, cwd=folder, text=True, errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return run.returncode, run.stdout, time.monotonic() - start


def in_image(folder):
    """Exit code of the last command, and lines of the page."""
    lines = []
    build = [*BUILDAH, "build", "--isolation=chroot", "--pull-never", "--file=packaging/Containerfile", f"--tag={IMAGE}", "."]
    code, printed, seconds = timed(*build, folder=folder)
    lines += on_system.outcome("buildah build --file packaging/Containerfile --tag chladni .", code, printed, seconds)
    if code:
        return code, lines
    container = buildah("from", "--pull-never", IMAGE)
    try:
        run = [*BUILDAH, "run", "--isolation=chroot", "--volume", f"{folder}:/work", container, "--", *EXAMPLE.split()]
        code, printed, seconds = timed(*run, folder=folder)
        if not code and not (folder / "out/disc.body.h5").exists():
            raise SystemExit("the example ended well but left no out/disc.body.h5")
        left = "` in it" if code else "` in it leaves `out/disc.body.h5"
        return code, lines + on_system.outcome(EXAMPLE + left, code, printed, seconds)
    finally:
        buildah("rm", container)


def main(page):
    base_image()
    with tempfile.TemporaryDirectory(dir="/var/tmp") as name:
        folder = Path(name, "chladni")
        subprocess.run(["git", "clone", "--quiet", str(on_system.ROOT), str(folder)], check=True)
        code, lines = in_image(folder)
        commit = on_system.commit_of(folder)
    head = ["## container", "", f"Debian {SUITE}, commit {commit}, {time.strftime('%Y-%m-%d')}, {buildah('--version')}.", ""]
    Path(page).write_text(on_system.with_section(Path(page), "container", [*head, *lines]))
    sys.exit(code)


if __name__ == "__main__":
    main(*sys.argv[1:])
