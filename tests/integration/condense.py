"""Condensed bodies of an assembly: they keep its eigenvalues, pass the checks, know the scenes they come from, and serve all analyses.

Usage: condense.py PROGRAM_DIR
"""

import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

import h5py
import numpy
from running import changed, run, start

EXAMPLE = Path(__file__).parents[2] / "examples/brake"
UP_TO_HZ, TOLERANCE = 2000.0, 3e-3


def expect(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")
    print(f"ok     {what}")


def with_condensed(text):
    small, n = re.subn(r'(name = "(\w+)"[^\n]*\nbody = )"[^"]+"', r'\1"brake.condensed/\2.body.h5"', text)
    assert n == 4
    return small


def eigenvalues(programs, folder, scene):
    run(programs / "squeal", "run", scene, "--output", folder / "out", "--overwrite")
    with h5py.File(folder / "out/brake.squeal.h5") as f:
        speeds = f["eigenvalues/speeds"][:]
        return speeds, f["eigenvalues/lambda_re"][:] + 1j * f["eigenvalues/lambda_im"][:]


def band(values, up_to_Hz):
    return [v for v in values if 0 < v.imag <= 2 * numpy.pi * up_to_Hz]


def farthest(some, others):
    return max(abs(numpy.array(others) - one).min() / abs(one) for one in some)


def refused(programs, scene, folder, more, words):
    done = start(programs / "squeal", "condense", scene, "--output", folder / "out", *more)
    expect(done.returncode != 0 and words in done.stderr, f"refused: {words}: {done.stderr.strip()}")


def main(programs, folder):
    for file in EXAMPLE.glob("*"):
        shutil.copy(file, folder)
    for name in ("disc", "pad", "caliper"):
        run(programs / "chladni", "run", folder / f"{name}.toml", "--output", folder / "out")
    scene = folder / "scene.toml"
    text = changed(scene.read_text(), ("count = 16", "count = 4"), ('"critical-speed", ', ""), (', "stability"', ""))
    scene.write_text(text)
    condense = (programs / "squeal", "condense", scene, "--output", folder / "out", "--up-to-Hz", f"{UP_TO_HZ:g}")
    summary = folder / "condense.json"
    printed = run(*condense, "--tolerance", str(TOLERANCE), "--json", summary)
    told = json.loads(summary.read_text())
    before, after = (sum(part[key] for part in told["parts"]) for key in ("coordinates_before", "coordinates"))
    expect(after < before and told["error"] <= TOLERANCE, f"{before} coordinates become {after}, error {told['error']:.1e}")
    expect("brake.condensed/outer.body.h5" in printed and str(after) in printed, "the table names files and sizes")

    small = folder / "small.toml"
    small.write_text(with_condensed(text))
    speeds, large = eigenvalues(programs, folder, scene)
    _, few = eigenvalues(programs, folder, small)
    expect(few.shape[1] == after, f"{few.shape[1]} eigenvalues of the small brake")
    for speed, exact, found in zip(speeds, large, few, strict=True):
        missed = farthest(band(exact, UP_TO_HZ), found)
        invented = farthest(band(found, 0.99 * UP_TO_HZ), exact)
        expect(max(missed, invented) < 2 * TOLERANCE, f"at {speed:g} rad/s off by {missed:.1e}, {invented:.1e} the other way")

    for part in ("disc", "outer", "inner", "caliper"):
        done = start(programs / "chladni", "check", folder / f"out/brake.condensed/{part}.body.h5")
        expect(done.returncode == 0, f"{part}: a sound body {done.stdout if done.returncode else ''}")
    done = start(programs / "chladni", "export", folder / "out/brake.condensed/outer.body.h5", "--format", "fmu",
                 "--output", folder / "outer.fmu")  # fmt: skip
    expect(done.returncode != 0 and "is condensed for the vibrations of one brake" in done.stderr, f"no export: {done.stderr.strip()}")
    gradients = changed(with_condensed(text), ('analyses = ["eigenvalues"]', 'analyses = ["gradients"]\ngradients = { speed_rad_s = 30.0 }'))
    small.write_text(gradients)
    run(programs / "squeal", "run", small, "--output", folder / "out", "--overwrite")
    expect(True, "gradients of the small brake")

    small.write_text(with_condensed(text))
    pad = folder / "pad.toml"
    pad.write_text(changed(pad.read_text(), ("thickness = 0.006", "thickness = 0.007")))
    done = start(programs / "squeal", "run", small, "--output", folder / "out", "--overwrite")
    expect(done.returncode != 0 and "section.thickness" in done.stderr, f"stale: {done.stderr.strip()}")
    done = start(*condense, "--overwrite")
    expect(done.returncode != 0 and "section.thickness" in done.stderr, f"stale: {done.stderr.strip()}")
    run(*condense, "--overwrite", "--stale")

    refused(programs, small, folder, ("--stale", "--up-to-Hz", "2000"), "brake.condensed/disc.body.h5 is a condensed body")
    refused(programs, scene, folder, ("--stale", "--up-to-Hz", "1e-2"), "no oscillation below 0.01 Hz")
    refused(programs, scene, folder, ("--stale",), "--up-to-Hz")
    refused(programs, scene, folder, ("--stale", "--up-to-Hz", "2000", "--tolerance", "0"), "--tolerance")
    refused(programs, folder / "disc.toml", folder, ("--up-to-Hz", "2000"), "no table [squeal]")
    oscillator = folder / "oscillator.toml"
    shutil.copy(next((EXAMPLE.parent / "oscillator").glob("*.toml")), oscillator)
    refused(programs, oscillator, folder, ("--up-to-Hz", "2000"), "no bodies of an assembly to condense")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        main(Path(sys.argv[1]), Path(name))
