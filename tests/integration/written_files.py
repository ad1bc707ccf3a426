"""What the programs write is whole or not there, whatever happens meanwhile, and an error is told as one.

Usage: written_files.py PROGRAM_DIR
"""

import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py

from running import changed, start

OSCILLATOR = (Path(__file__).parents[2] / "examples/oscillator/scene.toml").read_text()
ANALYSES = 'analyses = ["eigenvalues", "critical-speed", "growth", "limit-cycle"]'
SHORT = changed(OSCILLATOR, (ANALYSES, 'analyses = ["eigenvalues"]'))
LONG = changed(OSCILLATOR, ("duration_s = 2.0", "duration_s = 2000.0"))
DISC = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()
RESULTS = "oscillator.squeal.h5"


def files(folder):
    return sorted(path.name for path in folder.iterdir())


class Case:
    """A folder with the scene `scene.toml` and a folder `out`; collects what is wrong."""

    def __init__(self, programs, folder, scene):
        self.squeal, self.chladni = programs / "squeal", programs / "chladni"
        self.folder, self.out, self.wrong = folder, folder / "out", []
        self.out.mkdir()
        (folder / "scene.toml").write_text(scene)

    def words(self, *options):
        return [str(self.squeal), "run", "scene.toml", "--output", "out", *map(str, options)]

    def run(self, *options, **more):
        return start(*self.words(*options), cwd=self.folder, **more)

    def expect(self, holds, claim):
        if not holds:
            self.wrong.append(claim)

    def expect_error(self, done, *said):
        lines = done.stderr.strip().splitlines()
        self.expect(done.returncode == 1, f"ends with {done.returncode}: {done.stderr}")
        self.expect(0 < len(lines) <= 2, f"{len(lines)} lines on stderr: {done.stderr}")
        for text in said:
            self.expect(text in done.stderr, f"does not say '{text}': {done.stderr}")

    def begin(self):
        """A run that is at its costly work."""
        running = subprocess.Popen(self.words(), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(1.5)
        return running


def failed(case):
    """Old results do not stay when a later run fails at its first analysis."""
    case.expect(case.run().returncode == 0, "the run that is to be followed fails")
    scene = changed(SHORT, ('analyses = ["eigenvalues"]', 'analyses = ["limit-cycle-direct"]\nlimit_cycle_direct = { speed_rad_s = 20.0 }'), ("friction = 0.185", "friction = 0.01"))
    (case.folder / "scene.toml").write_text(scene)
    case.expect_error(case.run())
    with h5py.File(case.out / RESULTS) as results:
        case.expect("eigenvalues" not in results and "failure" in results, "old results stay without a mark")


def with_room(n_bytes):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (n_bytes, n_bytes))

    return {"preexec_fn": limit, "restore_signals": False}


def full_disk(case):
    done = case.run(**with_room(2000))
    case.expect_error(done, RESULTS)
    case.expect("older file" not in done.stderr, f"speaks of a file that is not there: {done.stderr}")
    case.expect(not files(case.out), f"left behind: {files(case.out)}")


def full_disk_from_the_start(case):
    """The work is not done first."""
    words = (case.chladni, "run", "scene.toml", "--output", "out")
    # Without memory shared between processes: Open MPI 5 has it in files, for which there is no room either.
    alone = {**os.environ, "OMPI_MCA_btl": "self"}
    case.expect_error(start(*words, cwd=case.folder, timeout=20, env=alone, **with_room(0)), "is there room?")
    case.expect(not files(case.out), f"left behind: {files(case.out)}")


def full_devices(case):
    (case.folder / "full").symlink_to("/dev/full")
    case.expect_error(case.run("--json", "full"), "full", "No space left")
    with open("/dev/full", "w", encoding="ascii") as full:
        done = subprocess.run(case.words(), cwd=case.folder, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    case.expect_error(done, "No space left")


def summary_into_a_pipe(case):
    (case.folder / "pipe").symlink_to("/proc/self/fd/1")
    done = case.run("--json", "pipe")
    case.expect('{"program": "squeal"' in done.stdout, f"no summary on stdout: {done.stdout}{done.stderr}")
    case.expect((case.folder / "pipe").is_symlink(), "the link to the pipe was replaced")


def no_work_in_vain(case):
    case.expect_error(case.run("--json", "nowhere/summary.json"), "nowhere/summary.json")
    case.expect(not files(case.out), f"worked before it tried to write: {files(case.out)}")
    (case.folder / "folder").mkdir()
    case.expect_error(case.run("--json", "folder"), "folder: is a folder")


def ended_by(case, number):
    running = case.begin()
    try:
        case.expect_error(case.run(timeout=20), RESULTS, "another run")
        running.send_signal(number)
        code = running.wait(20)
    finally:
        running.kill()
    case.expect(code == -number, f"ends with {code} instead of {-number}")
    case.expect(files(case.out) == [RESULTS], f"files after signal {number}: {files(case.out)}")
    with h5py.File(case.out / RESULTS) as results:
        case.expect("growth" in results, "what was finished is lost")
        missing = [name.decode() for name in results["missing"][()]]
        case.expect(missing == ["transient", "limit-cycle"], f"says that {missing} are missing")
    done = start(case.squeal, "report", "scene.toml", "--output", "out", cwd=case.folder)
    case.expect(done.returncode == 0, f"no report of unfinished results: {done.stderr}")
    page = (case.out / "oscillator.report.html").read_text()
    case.expect("missing: transient, limit-cycle; the run was interrupted" in page, "the page does not say what is missing")


def interrupted(case):
    ended_by(case, signal.SIGINT)


def terminated(case):
    ended_by(case, signal.SIGTERM)


def killed(case):
    running = case.begin()
    running.kill()
    running.wait()
    orphan, own = f"{RESULTS}.tmp-0123456789ab", f"{RESULTS}.tmp-of-mine"
    for name in (orphan, own):
        (case.out / name).touch()
    (case.folder / "scene.toml").write_text(SHORT)
    done = case.run()
    case.expect(done.returncode == 0, f"cannot follow a run that was killed: {done.stderr}")
    case.expect(files(case.out) == [RESULTS, own], f"files after a run that was killed: {files(case.out)}")


def kept_reduction(case):
    line = DISC[: DISC.index("keep =")].count("\n") + 1
    (case.folder / "scene.toml").write_text(changed(DISC, ("modes = 30", "modes = 5000")))
    disc = (case.chladni, "run", "scene.toml", "--output", "out")
    case.expect_error(
        start(*disc, cwd=case.folder),
        f"scene.toml:{line}: body.keep.modes = 5000: ",
        "chladni body scene.toml --output out",
    )
    case.expect(files(case.out) == ["disc.reduced.h5"], f"the reduction is lost: {files(case.out)}")
    (case.folder / "scene.toml").write_text(DISC)
    done = start(case.chladni, "body", "scene.toml", "--output", "out", cwd=case.folder)
    case.expect(done.returncode == 0, f"no body of the reduction that was kept: {done.stderr}")
    with h5py.File(case.out / "disc.body.h5") as body:
        case.expect(body["provenance/scene"][()].decode() == DISC, "the body tells another scene")
        of_reduction = body["provenance/reduction_scene"][()].decode()
        case.expect(of_reduction == changed(DISC, ("modes = 30", "modes = 5000")), "no scene of the reduction")


def passes(programs, scene, check):
    with tempfile.TemporaryDirectory() as folder:
        case = Case(programs, Path(folder).resolve(), scene)
        check(case)
    print(f"{'FAILED' if case.wrong else 'ok':8}{check.__name__}: {'; '.join(case.wrong)}", flush=True)
    return not case.wrong


def main(programs):
    cases = [
        (OSCILLATOR, full_disk),
        (SHORT, failed),
        (SHORT, full_devices),
        (SHORT, summary_into_a_pipe),
        (SHORT, no_work_in_vain),
        (LONG, interrupted),
        (LONG, terminated),
        (LONG, killed),
    ]
    if (programs / "chladni").exists():
        cases += [(DISC, kept_reduction), (DISC, full_disk_from_the_start)]
    return all([passes(programs, scene, check) for scene, check in cases])


if __name__ == "__main__":
    sys.exit(not main(Path(sys.argv[1]).resolve()))
