"""Files that were made before the scene changed are not used without a word.

Usage: stale_files.py BIN_DIR

A small disc goes through `chladni run` and `squeal run`; then one key after the other is changed, and each program that
reads an older file must refuse it, name the key, and name the program that makes it anew.
"""

import sys
import tempfile
from pathlib import Path

from running import changed, run

DISC = """
name = "disc"

[mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_order = 2
element_size = 0.03
rings = [{ name = "track", radius = 0.13, nodes = 24 }]

[material.iron]
young = 9.15915e10
poisson = 0.3
density = 6300.0

[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02

[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"

[interface]
nodes = ["track", "hub"]

[reduce]
method = "craig-bampton"
modes = 10

[body]
fixed = ["hub"]
keep = { modes = 8 }

[squeal]
ring = "track"
thickness = 0.02
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 3.14159, to_rad_s = 62.8319, count = 5 }
friction = 0.6
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["eigenvalues"]
"""

GEO = """
size = 0.03;
Point(1) = {0, 0, 0, size};
radii[] = {0.025, 0.13, 0.162};
For i In {0:2}
  For q In {0:3}
    Point(10*i + q + 10) = {radii[i]*Cos(q*Pi/2), radii[i]*Sin(q*Pi/2), 0, size};
  EndFor
  For q In {0:3}
    Circle(10*i + q + 10) = {10*i + q + 10, 1, 10*i + (q + 1) % 4 + 10};
  EndFor
  Curve Loop(i + 1) = {10*i + 10, 10*i + 11, 10*i + 12, 10*i + 13};
EndFor
Transfinite Curve {20:23} = 4;
Plane Surface(1) = {2, 1};
Plane Surface(2) = {3, 2};
Physical Surface("disc") = {1, 2};
Physical Curve("inner_edge") = {10:13};
"""

# A change, what the error of squeal says has changed, and which program makes the body anew.
OF_BODY = (
    (('young = 9.15915e10', 'young = 2.1e11'), "material.iron.young = 210000000000 (was 91591500000)", "chladni run"),
    (("thickness = 0.02\n\n[[coupling", "thickness = 0.018\n\n[[coupling"), "section.thickness = 0.018 (was 0.02)", "chladni run"),
    (("element_size = 0.03", "element_size = 0.04"), "mesh.element_size = 0.04 (was 0.03)", "chladni run"),
    (("modes = 8 }", "modes = 9 }"), "body.keep.modes = 9 (was 8)", "chladni body"),
    (("modes = 8 }\n", 'modes = 8 }\ndamping = { type = "modal", ratio = 0.01 }\n'), 'body.damping.ratio = 0.01 (was not there)', "chladni body"),
)


# Another scene, whose part is the body of the disc.
BRAKE = """
name = "brake"
part = [{ name = "disc", body = "disc.body.h5" }, { name = "pad", body = "disc.body.h5" }]
contact = [{ face = "pad.lining", height = 0.01, stiffness = 1e6, preload = 1.0 }]

[squeal]
model = "assembly"
disc = "disc"
rings = ["track"]
thickness = 0.02
friction = 0.6
speeds = { from_rad_s = 3.14159, to_rad_s = 62.8319, count = 5 }
analyses = ["eigenvalues"]
"""


class Folder:
    """One in which the disc went through both programs."""

    def __init__(self, programs, folder, text=DISC):
        self.programs, self.folder, self.scene = programs, folder, folder / "disc.toml"
        self.scene.write_text(text)
        self.run("chladni", "run")
        self.run("squeal", "run")

    def run(self, program, subcommand, *words, code=0, scene=None):
        return run(self.programs / program, subcommand, scene or self.scene, "--output", self.folder, *words, code=code)

    def refused(self, program, subcommand, *mentions, before=()):
        """Refused with these words, and taken with --stale."""
        words = self.run(program, subcommand, code=1)
        for mention in mentions:
            if mention not in words:
                sys.exit(f"FAILED: {program} {subcommand} does not say {mention!r}:\n{words}")
        told = self.run(program, subcommand, "--stale")
        if mentions[0] not in told:
            sys.exit(f"FAILED: {program} {subcommand} --stale says nothing of {mentions[0]!r}:\n{told}")


def check_body(folder):
    """`squeal run` and `squeal report` with a body of yesterday's scene."""
    for change, key, remedy in OF_BODY:
        folder.scene.write_text(changed(DISC, change))
        folder.refused("squeal", "run", "disc.body.h5", key, remedy)
        folder.refused("squeal", "report", "disc.body.h5", key, remedy)
    folder.scene.write_text(changed(DISC, OF_BODY[0][0]))
    folder.refused("chladni", "body", "disc.reduced.h5", OF_BODY[0][1], "chladni reduce")
    folder.scene.write_text(changed(DISC, OF_BODY[2][0]))
    export = (folder.programs / "chladni", "export", folder.scene, "--from", folder.folder, "--format", "nastran-dmig", "--output", folder.folder / "disc.dmig")
    words = run(*export, code=1)
    if OF_BODY[2][1] not in words:
        sys.exit(f"FAILED: chladni export does not say {OF_BODY[2][1]!r}:\n{words}")
    run(*export, "--stale")


def check_part(folder):
    """The body of an assembly's part, of which the scene that made it has changed."""
    brake = folder.folder / "brake.toml"
    brake.write_text(BRAKE)
    older, key, missing = "disc.body.h5 was made before", OF_BODY[1][1], 'no attachment nodes "lining"'
    for change, words, is_stale in (("", (), False), (OF_BODY[1][0], (), True), (OF_BODY[1][0], ("--stale",), True)):
        folder.scene.write_text(changed(DISC, change) if change else DISC)
        said = folder.run("squeal", "run", *words, code=1, scene=brake)
        if (older in said and key in said) != is_stale or (missing in said) != (not is_stale or bool(words)):
            sys.exit(f"FAILED: squeal run {' '.join(words)} of an assembly says of its part:\n{said}")


def check_results(folder):
    """A report shows no results of another study, and of another body."""
    folder.scene.write_text(changed(DISC, ("friction = 0.6", "friction = 0.5")))
    folder.refused("squeal", "report", "disc.squeal.h5", "squeal.friction = 0.5 (was 0.6)", "squeal run")
    folder.scene.write_text(changed(DISC, OF_BODY[3][0]))
    folder.run("chladni", "body")
    folder.refused("squeal", "report", "disc.squeal.h5", OF_BODY[3][1], "squeal run")


RADIATING = (("modes = 10\n", 'modes = 10\npictures = "all"\n'), ("friction = 0.6\n", "friction = 0.6\nradiation = true\n"))
SOUND = """
[sound]
microphones = [{ name = "above", position = [0.5, 0.0, 0.5] }]
"""
AIR = "medium = { density = 1.0, speed_of_sound = 343.0 }\n"


def check_radiation(folder):
    """`squeal run` with the damping by the sound of another air or another body; who listens changes nothing."""
    scene = changed(DISC, *RADIATING) + SOUND
    folder.scene.write_text(scene)
    folder.run("chladni", "run")
    folder.run("chladni", "sound", "--radiation")
    folder.run("squeal", "run")
    folder.scene.write_text(changed(scene, ("[0.5, 0.0, 0.5]", "[0.7, 0.0, 0.5]")))
    folder.run("squeal", "run")
    folder.scene.write_text(scene + AIR)
    folder.refused("squeal", "run", "disc.radiation.h5", "sound.medium.density = 1", "chladni sound", "--radiation")
    folder.scene.write_text(scene)
    folder.run("squeal", "run")
    folder.scene.write_text(scene + AIR)
    folder.refused("squeal", "report", "disc.squeal.h5", "sound.medium.density = 1", "squeal run")
    undamped = changed(scene, ("radiation = true", "radiation = false"))
    folder.scene.write_text(undamped + AIR)
    folder.run("squeal", "run")
    folder.scene.write_text(undamped)
    folder.run("squeal", "report")  # the air takes no part in these results
    folder.scene.write_text(changed(scene, OF_BODY[3][0]))
    folder.run("chladni", "body")
    folder.refused("squeal", "run", "disc.radiation.h5", OF_BODY[3][1], "chladni sound", "--radiation")


def check_spelling(folder):
    """What changes no value is no change: spelling, title, comments, what later steps need."""
    changes = (('name = "disc"\n', 'name = "disc"\ntitle = "A disc"  # of iron\n'), ("thickness = 0.02\n\n[[coupling", "thickness = 2e-2\n\n[[coupling"), ("friction = 0.6", "friction = 0.60"))
    folder.scene.write_text(changed(DISC, *changes))
    folder.run("squeal", "run")
    folder.run("squeal", "report")
    folder.scene.write_text(changed(DISC, ("friction = 0.6", "friction = 0.5")))
    folder.run("squeal", "run")

# What `chladni static` needs besides.
LOADED = """
[[support]]
group = "hub"
type = "clamped"

[[load]]
type = "gravity"
acceleration = [0.0, 0.0, -9.81]
"""
PICTURES = {"mesh": ["disc.mesh.vtu", "disc.mesh.html"], "modes": ["disc.modes.vtu"], "static": ["disc.static.vtu"]}


def check_mesh_file(programs, folder):
    """A mesh file that another program wrote anew."""
    geometry = folder / "plate.geo"
    geometry.write_text(GEO)
    text = DISC[DISC.index("[material") :]
    mesh = 'name = "disc"\n\n[mesh]\nfile = "plate.geo"\nelement_order = 2\nrings = [{ name = "track", radius = 0.13, nodes = 24 }]\n\n'
    made = Folder(programs, folder, mesh + text)
    geometry.write_text(changed(geometry.read_text(), ("size = 0.03;", "size = 0.025;")))
    made.refused("squeal", "run", "the mesh file", "plate.geo", "chladni run")


def pictures_of_two(folder, other):
    """Pictures of one scene are not replaced by those of another one of its name either."""
    texts = {scene: scene.read_text() for scene in (folder.scene, other)}
    for scene, text in texts.items():
        scene.write_text(text + LOADED)
    for name, files in PICTURES.items():
        folder.run("chladni", name)
        before = [(folder.folder / file).read_bytes() for file in files]
        words = folder.run("chladni", name, scene=other, code=1)
        if files[0] not in words or "disc.toml" not in words or "--overwrite" not in words:
            sys.exit(f"FAILED: what is in the way of chladni {name} is not said:\n{words}")
        if before != [(folder.folder / file).read_bytes() for file in files]:
            sys.exit(f"FAILED: chladni {name} touched the other scene's files")
        folder.run("chladni", name)
        folder.run("chladni", name, "--overwrite", scene=other)
        folder.run("chladni", name, scene=other)
    for scene, text in texts.items():
        scene.write_text(text)


def check_name(folder):
    """Two scenes of one name in one folder."""
    other = folder.folder / "other.toml"
    other.write_text(changed(DISC, ("thickness = 0.02\n\n[[coupling", "thickness = 0.018\n\n[[coupling")))
    before = (folder.folder / "disc.reduced.h5").read_bytes()
    words = folder.run("chladni", "run", scene=other, code=1)
    if "disc.toml" not in words or "--overwrite" not in words:
        sys.exit(f"FAILED: what is in the way is not said:\n{words}")
    if (folder.folder / "disc.reduced.h5").read_bytes() != before:
        sys.exit("FAILED: the other scene's file was touched")
    pictures_of_two(folder, other)
    folder.run("chladni", "run", "--overwrite", scene=other)
    folder.run("chladni", "run", scene=other)
    folder.scene.unlink()
    folder.scene = folder.folder / "renamed.toml"
    other.rename(folder.scene)
    folder.run("chladni", "run")  # the scene that wrote them is no longer there


if __name__ == "__main__":
    programs = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as root:
        for name in ("disc", "geo"):
            (Path(root) / name).mkdir()
        disc = Folder(programs, Path(root) / "disc")
        check_spelling(disc)
        disc = Folder(programs, Path(root) / "disc")
        check_body(disc)
        disc = Folder(programs, Path(root) / "disc")
        check_part(disc)
        disc = Folder(programs, Path(root) / "disc")
        check_results(disc)
        disc = Folder(programs, Path(root) / "disc")
        check_radiation(disc)
        check_mesh_file(programs, Path(root) / "geo")
        disc = Folder(programs, Path(root) / "disc")
        check_name(disc)
    print("older files are refused by name, key and remedy, and taken with --stale")
