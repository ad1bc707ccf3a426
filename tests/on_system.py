"""`./dev test` and `./dev demo` on another Debian: a bare system in a folder and the committed files; as root. Adds a
section of that system to a page, in place of an earlier one; with one of the commands alone, the line of the other stays.

With `package`, the packages are made there, installed in another bare system, and the example is run by them.

Usage: on_system.py SUITE PAGE.md [test | demo | package]. Called by `./dev test-on SUITE`. The system stays in /var/tmp/chladni-SUITE,
so that a second call needs no download.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/tools"))
from compile_times import machine, processor_seconds, table  # noqa: E402
MIRROR = "http://deb.debian.org/debian"
MOUNTED = ("proc", "sys", "dev")
PACKAGES = ("g++", "cmake", "libpetsc-real-dev", "libslepc-real-dev", "libmumps-dev", "libgmsh-dev", "libhdf5-dev",
            "libeigen3-dev", "libopenmpi-dev")  # fmt: skip
COMMANDS = ("./dev test", "./dev demo", "./dev package")
EXAMPLE = "examples/thesis_disc/scene.toml"
WIDTH = 200  # of lines of compilers
SHOWN = 12  # last lines of a command that failed
HEAD = ["# Systems", "",
        "Written by `./dev test-on SUITE`: a bare Debian in a folder (debootstrap), then `./dev test`, `./dev demo` and `./dev package` of the "
        "committed files, without compiler cache. Warnings, which are no errors here, are counted.", ""]  # fmt: skip


def call(*command, **options):
    subprocess.run(command, check=True, **options)


def bare_system(suite, folder):
    """Debian as debootstrap leaves it; what is there is taken as it is."""
    if (folder / "etc/debian_version").exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    scripts = Path("/usr/share/debootstrap/scripts")
    script = [] if (scripts / suite).exists() else [str(scripts / "sid")]  # a suite that is newer than debootstrap
    call("debootstrap", "--variant=minbase", suite, str(folder), MIRROR, *script, stdout=subprocess.DEVNULL)
    (folder / "etc/apt/sources.list").write_text(f"deb {MIRROR} {suite} main\n")


@contextmanager
def mounted(folder):
    """With what programs expect of a kernel, and the network of this machine."""
    for name in ("resolv.conf", "hosts"):
        (folder / "etc" / name).write_text(Path("/etc", name).read_text())
    # The list of a testing Debian is valid for a week; a mirror that is behind is still a system to try.
    (folder / "etc/apt/apt.conf.d/99-mirror").write_text('Acquire::Check-Valid-Until "false";\n')
    made = []
    try:
        for name in MOUNTED:
            if not os.path.ismount(folder / name):
                call("mount", "--rbind", f"/{name}", str(folder / name))
                call("mount", "--make-rslave", str(folder / name))
                made.append(name)
        yield
    finally:
        for name in reversed(made):
            call("umount", "--recursive", "--lazy", str(folder / name))


def committed_files(folder):
    clone = folder / "root/chladni"
    call("rm", "-rf", str(clone))
    call("git", "clone", "--quiet", str(ROOT), str(clone))


def commit_of(clone):
    command = ["git", "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, cwd=clone, check=True, capture_output=True, text=True).stdout.strip()


def inside(folder, command):
    """(exit code, what it prints, seconds on the clock, seconds of processors) of a shell command in the clone."""
    start, used = time.monotonic(), processor_seconds()
    environment = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LC_ALL": "C.UTF-8", "CCACHE_DISABLE": "1"}
    run = subprocess.run(["chroot", str(folder), "sh", "-c", f"cd /root/chladni && {command}"], env=environment, text=True,
                         errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    return run.returncode, run.stdout, time.monotonic() - start, processor_seconds() - used


def versions(folder):
    _, printed, _, _ = inside(folder, f"dpkg-query -W -f '${{Package}} ${{Version}}\\n' {' '.join(PACKAGES)}")
    return dict(line.split(" ", 1) for line in printed.splitlines() if line.count(" ") == 1)


def outcome(command, code, printed, times, where=""):
    """Lines of the page, `where` behind the command."""
    tests = re.findall(r"(\d+)% tests passed, (\d+) tests failed out of (\d+)", printed)
    warnings = len(re.findall(r": warning: ", printed))
    packages = re.search(r"^== build: .*\[(\d+) s\]", printed, re.M)
    seconds, used = times
    minutes = f"{seconds / 60:.1f} minutes"
    if packages:
        minutes = f"{(seconds - int(packages[1])) / 60:.1f} minutes after the packages"
    minutes += f", {used / 60:.1f} minutes of processors"
    facts = [minutes, f"exit code {code}"]
    facts.append(f"{warnings} warnings")
    facts += [f"{failed} of {total} tests failed" for _, failed, total in tests]
    lines = [f"`{command}`{where}: {', '.join(facts)}.", ""]
    failed = re.findall(r"^\s*\d+ - (\S+ \((?!Skipped).*\))", printed, re.M)
    if failed:
        lines += ["Failed: " + ", ".join(failed) + ".", ""]
    if code:
        ends = [line.replace("/root/chladni/", "")[:WIDTH] for line in printed.strip().splitlines()[-SHOWN:]]
        lines += ["```text", *ends, "```", ""]
    return lines


def earlier(page, suite, command):
    """What the page says of a command on that system: nothing where it does not."""
    own = re.search(rf"(?ms)^## {suite}$(.*?)(?=^## |\Z)", page.read_text() if page.exists() else "")
    said = own and re.search(rf"(?ms)^`{re.escape(command)}`.*?(?=^`\./dev |\Z)", own[1])
    return [*said[0].strip().splitlines(), ""] if said else []


def installed_packages(suite, made_in):
    """The exit code, and lines of the page: the packages in a bare system of their own."""
    with tempfile.TemporaryDirectory(dir="/var/tmp") as name:
        folder = Path(name)
        bare_system(suite, folder)
        with mounted(folder):
            clone = folder / "root/chladni"
            (clone / "examples").mkdir(parents=True)
            for part in ("out/packages", "examples/thesis_disc"):
                shutil.copytree(made_in / "root/chladni" / part, clone / part)
            commands = ["apt-get -qq update && apt-get -qq install -y --no-install-recommends ./out/packages/chladni*.deb",
                        f"chladni run {EXAMPLE} --output out && squeal run {EXAMPLE} --output out"]  # fmt: skip
            lines = []
            for command in commands:
                code, printed, seconds, used = inside(folder, command)
                print(f"{seconds:8.0f} s  {code}  {command}", flush=True)
                lines += outcome(command, code, printed, (seconds, used), ", in a bare system without compiler")
                if code:
                    break
        return code, lines


def section(suite, folder, page, commands):
    """The exit code of the last command, and the lines of the page."""
    lines, code = [], 0
    commit = commit_of(folder / "root/chladni")
    for command in COMMANDS:
        if command not in commands:
            lines += earlier(page, suite, command)
            continue
        code, printed, seconds, used = inside(folder, command)
        (folder / "root" / (command.split()[-1] + ".log")).write_text(printed)
        print(f"{seconds:8.0f} s  {code}  {command}", flush=True)
        lines += outcome(command, code, printed, (seconds, used), f", commit {commit}, {time.strftime('%Y-%m-%d')}")
        if not code and command == "./dev package":
            code, tried = installed_packages(suite, folder)
            lines += tried
        if code and len(commands) > 1:
            break
    compiled = table(folder / "root/chladni/build/release")
    if compiled:
        lines += ["What was compiled for the last of them and those before, by the clock of each step:", "", *compiled, ""]
    debian = (folder / "etc/debian_version").read_text().strip()
    found = ["| package | version |", "| --- | --- |", *(f"| {name} | {version} |" for name, version in versions(folder).items())]
    return code, [f"## {suite}", "",
                  f"Debian {debian}, {machine()}.", "", *found, "",
                  *lines]  # fmt: skip


def with_section(page, suite, lines):
    """The page's text with this section, in the order of names."""
    parts = re.split(r"(?m)^## ", page.read_text())[1:] if page.exists() else []
    kept = {part.split("\n", 1)[0]: "## " + part.rstrip() for part in parts}
    kept[suite] = "\n".join(lines).rstrip()
    return "\n".join(HEAD) + "\n" + "\n\n".join(kept[name] for name in sorted(kept)) + "\n"


def main(suite, page, command=None):
    folder, page = Path(f"/var/tmp/chladni-{suite}"), Path(page)
    commands = [f"./dev {command}"] if command else COMMANDS
    if not set(commands) <= set(COMMANDS):
        sys.exit(f"on_system.py: test, demo and package are tried, not '{command}'; give one of them, or nothing for all")
    bare_system(suite, folder)
    with mounted(folder):
        committed_files(folder)
        code, lines = section(suite, folder, page, commands)
    page.write_text(with_section(page, suite, lines))
    sys.exit(code)


if __name__ == "__main__":
    main(*sys.argv[1:])
