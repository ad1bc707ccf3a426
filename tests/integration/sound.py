"""From a coarse disc to its sound: powers, levels, the way back into the squeal, and mistakes.

Usage: sound.py PROGRAM_DIR
"""

import base64
import json
import re
import sys
import tempfile
import wave
from pathlib import Path

import h5py
import numpy as np

from running import changed, start, summary

DISC = (Path(__file__).parents[1] / "data/coarse_disc.toml").read_text()
SQUEAL = """
[squeal]
ring = "track"
thickness = 0.02
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 3.14159, to_rad_s = 62.8319, count = 40 }
friction = 0.6
contact = "bilateral"
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["critical-speed", "limit-cycle-direct"]
limit_cycle_direct = { speed_rad_s = 18.8495559 }
"""
SOUND = """
[sound]
microphones = [{ name = "above", position = [0.5, 0.0, 0.5] }, { name = "plane", position = [0.5, 0.1, 0.0] }]
harmonics = 3
wav = { microphone = "above", rate_Hz = 44100, duration_s = 0.5 }
"""


class Case:
    """A scene in a folder of its own."""

    def __init__(self, programs, folder, scene):
        self.programs, self.folder = programs, Path(folder)
        self.scene = self.folder / "scene.toml"
        self.scene.write_text(scene)

    def run(self, program, *arguments):
        return start(self.programs / program, *arguments, "--output", self.folder)

    def works(self, program, command, *arguments):
        """The summary of a run that must succeed."""
        return summary(self.programs / program, command, self.scene, *arguments, "--output", self.folder)

    def fails(self, program, command, *words):
        run = self.run(program, command, self.scene)
        assert run.returncode == 1, f"{words}: exit code {run.returncode}"
        assert len(run.stderr.strip().splitlines()) == 1, run.stderr
        for word in words:
            assert word in run.stderr, f"'{word}' is not in: {run.stderr}"


def check_sound(case):
    summary = case.works("chladni", "sound")
    tone = summary["tones"][0]
    assert 0 < tone["pressure_error"] < tone["power_error"] < 1e-4, tone
    assert abs(tone["far_power_W"] / tone["power_W"] - 1) < 1e-5, "power balance"
    above, plane = summary["microphones"]
    assert 135 < above["level_dB"] < 146, above
    assert plane["level_dB"] < 0, "exact cancellation in the plane of the disc"
    assert abs(above["level_of_peak_dB"] - above["level_dB"] - 3.0103) < 1e-3
    without, damped = (summary["feedback"][f"{x}_radiation"] for x in ("without", "with"))
    decay = summary["radiation"][0]["decay_1_s"]
    assert abs(without["growth_1_s"] - damped["growth_1_s"] - decay) < 0.02
    assert damped["critical_speed_rad_s"] > 1.1 * without["critical_speed_rad_s"]
    check_files(case, above)
    return summary


def check_files(case, above):
    name = case.folder / "coarse"
    with h5py.File(f"{name}.sound.h5") as sound:
        p = sound["microphones/pressure_re"][0, 0] + 1j * sound["microphones/pressure_im"][0, 0]
        assert np.isclose(abs(p), abs(complex(*above["pressure_Pa"][0])))
        assert sound["tones/1/meridian/3/triangles"].shape[1] == 3
    with wave.open(f"{name}.sound.wav") as sound:
        samples = np.frombuffer(sound.readframes(sound.getnframes()), np.int16)
        assert len(samples) == 22050 and abs(samples).max() == 32767
    assert "pressure_re" in Path(f"{name}.sound.vtu").read_text()


def sound_on_page(case):
    """What the page of `squeal report` holds of the sound; files of other steps may be older than the scene."""
    run = case.run("squeal", "report", case.scene)
    assert run.returncode == 0, run.stderr
    page = (case.folder / "coarse.report.html").read_text()
    return json.loads(re.search(r'id="content">(.*?)</script>', page, re.DOTALL)[1])["sound"]


def check_page(case, summary):
    """The page plays the sound and tells its levels; a sound of other microphones is left out, with a word."""
    sound, above = sound_on_page(case), summary["microphones"][0]
    assert np.isclose(sound["microphones"][0]["level_A_dB"], above["level_A_dB"], atol=1e-3), sound["microphones"]
    assert len(sound["tones"]) == len(summary["tones"]), sound["tones"]
    assert base64.b64decode(sound["wav"]) == (case.folder / "coarse.sound.wav").read_bytes()
    assert np.shape(sound["directivity"]["rms"]) == (len(sound["directivity"]["polar"]), len(sound["directivity"]["azimuth"]))
    scene = case.scene.read_text()
    case.scene.write_text(scene.replace("[0.5, 0.0, 0.5]", "[0.6, 0.0, 0.5]"))
    left_out = sound_on_page(case)["left_out"]
    assert "sound.microphones" in left_out and "`chladni sound" in left_out and "squeal run" not in left_out, left_out
    case.scene.write_text(scene)


def check_way_back(case, summary):
    """`squeal run` with `radiation = true` finds what `chladni sound` foretold."""
    case.scene.write_text(case.scene.read_text().replace("[squeal]", "[squeal]\nradiation = true"))
    (case.folder / "coarse.radiation.h5").unlink()
    case.fails("squeal", "run", "radiation.h5", "chladni sound", "--radiation")
    case.works("chladni", "sound", "--radiation")
    damped = case.works("squeal", "run")
    foretold = summary["feedback"]["with_radiation"]
    for key in ("critical_speed_rad_s",):
        assert np.isclose(damped[key], foretold[key], rtol=1e-6), key
    cycle = damped["limit_cycle_direct"]["pad_velocity_m_s"]
    assert np.isclose(cycle, foretold["pad_velocity_m_s"], rtol=1e-5)
    # The sound of the damped cycle is softer by what its velocity is smaller.
    softer = case.works("chladni", "sound")
    ratio = softer["microphones"][0]["level_dB"] - summary["microphones"][0]["level_dB"]
    assert -10 < ratio < -1, ratio


RINGS = """[sound]
outline = [{ from = [0.09, 0.012], to = [0.162, 0.012], thickness = 0.008 },
           { from = [0.09, -0.012], to = [0.162, -0.012], thickness = 0.008 }]
hub = "open"
harmonics = 1
"""
ONE_PIECE = """[sound]
outline = [{ from = [0.09, 0.0], to = [0.162, 0.0], thickness = 0.032 }]
hub = "open"
harmonics = 1
"""


def check_vanes(programs, folder):
    """Two rings joined by vanes sound as such, nearly as one piece; an outline of one of the rings is refused at once."""
    data = Path(__file__).parents[1] / "data"
    (folder / "ventilated_disc.geo").write_text((data / "ventilated_disc.geo").read_text())
    disc = (data / "ventilated_disc.toml").read_text() + SQUEAL.replace("18.8495559", "50.0")
    case = Case(programs, folder, disc + RINGS)
    case.works("chladni", "run")
    case.works("squeal", "run")
    rings = case.works("chladni", "sound")
    assert rings["surface_residual"] < 0.06, "what the vanes do to the rings between them"
    assert "792 of the 2376 nodes" in rings["notes"][0] and "vanes" in rings["notes"][0], rings["notes"]
    case.scene.write_text(disc + ONE_PIECE)
    whole = case.works("chladni", "sound")
    assert "notes" not in whole, whole["notes"]
    assert 0.9 < rings["power_W"] / whole["power_W"] < 1.1, "of one mode with and without air between the rings"
    lines = RINGS.splitlines(keepends=True)
    case.scene.write_text(disc + "".join([lines[0], lines[1].replace("},\n", "}]\n"), *lines[3:]]))
    case.fails("chladni", "sound", "(r, z) = (", "not between two of them", "outline")


def check_solid(programs, folder):
    """A disc of solids sounds as the same disc of shells: to 3 % in power, which a thickness of a sixteenth of its radius leaves between the theories."""
    scene = (Path(__file__).parents[2] / "examples/solid_disc/scene.toml").read_text()
    solid = re.sub(r"use_modes.*\Z", SQUEAL[SQUEAL.index("use_modes"):] + SOUND.replace("harmonics = 3", "harmonics = 1"), scene, flags=re.DOTALL)
    solid = changed(solid, ("modes = 40\n\n", 'modes = 40\npictures = "all"\n\n'))
    shell = changed(re.sub(r"extrude = .*\n|ring = \{.*\n|\{ name = \"upper\".*\n", "", solid), ('"solid_disc"', '"shell"'), ('name = "lower"', 'name = "track"'),
                    (", z = -0.01", ""), ('"upper", "lower", "hub"', '"track", "hub"'), ('type = "solid"', 'type = "shell"\nthickness = 0.02'),
                    ("contact_planes = [-0.01, 0.01]", 'ring = "track"\nthickness = 0.02'))  # fmt: skip
    found = []
    for text in (solid, shell):
        case = Case(programs, folder, text)
        case.works("chladni", "run")
        case.works("squeal", "run")
        found.append(case.works("chladni", "sound"))
    power = [one["tones"][0]["power_W"] for one in found]
    decay = [one["radiation"][0]["decay_1_s"] for one in found]
    level = [one["microphones"][0]["level_dB"] for one in found]
    print(f"solid beside shell: {power} W, {decay} 1/s, {level} dB")
    assert abs(power[0] / power[1] - 1) < 0.03 and abs(decay[0] / decay[1] - 1) < 0.03 and abs(level[0] - level[1]) < 0.15


def check_mistakes(case):
    good = case.scene.read_text()

    def mistaken(old, new, *words):
        assert old in good, old
        case.scene.write_text(good.replace(old, new))
        case.fails("chladni", "sound", *words)

    mistaken("[0.5, 0.0, 0.5]", "[0.1, 0.0, 0.005]", "above", "inside the body")
    mistaken("harmonics = 3", "element_size = 0.3", "too coarse", "element_size = ")
    mistaken("harmonics = 3", "layer_thickness = 0.01", "layer", "layer_thickness = ")
    mistaken("harmonics = 3", "inner_radius = 0.1", "inner_radius", "0.162")
    mistaken('harmonics = 3', 'cycle = "transient"', "no limit cycle", "limit-cycle")
    mistaken('use_modes = "nodal-diameters 3"', 'use_modes = "nodal-diameters 2"', "squeal.use_modes", "squeal run")
    (case.folder / "coarse.squeal.h5").unlink()
    case.scene.write_text(good)
    case.fails("chladni", "sound", "squeal.h5", "squeal run")
    case.scene.write_text(good.replace(SOUND, ""))
    case.fails("chladni", "sound", "[sound]")


def check_late(case):
    """What is known when a later step cannot be done stays: holes at which the two modes of a pair radiate differently."""
    scene = case.scene.read_text().replace(SOUND, "")
    case.scene.write_text(scene + "[sound]\nholes = [{ circle_radius = 0.13, radius = 0.016, count = 6 }]\nelement_size = 0.048\nedge_size = 0.02\n")
    found = case.works("chladni", "sound", "--radiation")
    assert "feedback" not in found and len(found["radiation"]) == 2, found
    assert "changes around the circumference" in found["notes"][0], found["notes"]


def main(programs):
    scene = 'name = "coarse"\n' + DISC.replace("modes = 20", 'modes = 20\npictures = "all"') + SQUEAL + SOUND
    with tempfile.TemporaryDirectory() as folder:
        case = Case(programs, folder, scene)
        case.works("chladni", "run")
        case.works("squeal", "run")
        summary = check_sound(case)
        check_page(case, summary)
        check_way_back(case, summary)
        # Results that the sound has damped would be older than any change of the air.
        case.scene.write_text(scene)
        case.works("squeal", "run")
        check_mistakes(case)
        check_late(case)
    with tempfile.TemporaryDirectory() as folder:
        check_vanes(programs, Path(folder))
        check_solid(programs, Path(folder))
    print("the disc sounds, and every mistake is named")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
