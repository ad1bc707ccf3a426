"""The page of `report`: what is in it, what it says without files, and how a browser draws it.

Usage: report.py PROGRAM_DIR [CHROMIUM [SCREENSHOT]]
"""

import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

from running import changed, start

ROOT = Path(__file__).parents[2]
SQUEAL = """
[squeal]
ring = "track"
thickness = 0.02
use_modes = "nodal-diameters 3"
speeds = { from_rad_s = 3.0, to_rad_s = 60.0, count = 20 }
friction = 0.6
contact = "bilateral"
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["eigenvalues", "critical-speed", "transient", "limit-cycle-direct", "limit-cycle-branch",
            "stability-map", "spectrum"]
map = { parameter = "stiffness", from = 1e6, to = 9e6, count = 10 }
transient = { speed_rad_s = 18.85, duration_s = 0.3, initial_pad_displacement = 6.8e-8 }
"""
# As the benchmark writes it, with a name that would end a script.
BENCHMARK = json.loads((ROOT / "docs/results/end_to_end.json").read_text())
BENCHMARK["studies"][0]["case"] = "disc </script>"

# Speeds up from rest: what the sections of orders and gradients show.
RUN_UP = (SQUEAL.replace("""analyses = ["eigenvalues", "critical-speed", "transient", "limit-cycle-direct", "limit-cycle-branch",
            "stability-map", "spectrum"]""", """analyses = ["critical-speed", "gradients", "transient", "spectrogram"]""")
          .replace("map = { parameter", "gradients = { speed_rad_s = 45.0 }  # map = { parameter")
          .replace("duration_s = 0.3,",
                   "duration_s = 1.0, speed_program = [{ t_s = 1.0, speed_rad_s = 45.0 }],"))
SCRIPT = """<script>
addEventListener("error", event => { document.body.dataset.error = event.message; });
</script><script>{
%s
}</script></body>"""

# What a reader does: picks the third mode, turns the body with a key, shows the mesh, and starts it.
READER = """
document.querySelector("tr[data-motion='2']").click();
document.body.dataset.motion = document.querySelector("select").value;
// In the browser's virtual time no frames are drawn; a timer stands in for them.
window.requestAnimationFrame = frame => setTimeout(() => frame(performance.now()), 16);
const before = window.viewer.turn;
document.getElementById("viewer").dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft"}));
document.body.dataset.turned = Number(window.viewer.turn !== before);
document.querySelector("input[type=checkbox]").click();
document.querySelector("button").click();
setTimeout(() => {
  document.body.dataset.phase = window.viewer.phase;
  document.body.dataset.painted = window.viewer.painted;
}, 1000);
"""

# A plot under a mouse: values, a box, Shift, the wheel with and without Ctrl, a double click; and its files.
LOOKER = """
const svg = document.querySelector("#campbell svg"), around = svg.getBoundingClientRect(), told = document.body.dataset;
const frame = svg.querySelector(".frame"), of = name => Number(frame.getAttribute(name));
svg.setPointerCapture = () => {};
const at = (u, v) => ({clientX: around.left + of("x") + u * of("width"), clientY: around.top + of("y") + v * of("height"),
                       bubbles: true, cancelable: true});
const point = (type, u, v, more) => svg.dispatchEvent(new PointerEvent(type, {...at(u, v), pointerType: "mouse", ...more}));
const numbers = () => [...svg.querySelectorAll("text")].map(text => text.textContent).join("|");
const way = [["pointerdown", 0.3, 0.3], ["pointermove", 0.5, 0.6], ["pointerup", 0.5, 0.6]];
const drag = more => { for (const [type, u, v] of way) point(type, u, v, more); };
const wheel = (target, ctrlKey) => !target.dispatchEvent(new WheelEvent("wheel", {...at(0.4, 0.4), deltaY: -100, ctrlKey}));
const whole = numbers();
point("pointermove", 0.4, 0.4);
told.readout = svg.closest("figure").querySelector(".readout").textContent;
drag();
told.zoomed = Number(numbers() !== whole);
const zoomed = numbers();
drag({shiftKey: true});
told.moved = Number(numbers() !== zoomed);
svg.dispatchEvent(new MouseEvent("dblclick", {bubbles: true}));
told.whole = Number(numbers() === whole);
told.wheel = [wheel(svg, false), wheel(svg, true), wheel(document.getElementById("viewer"), false),
              wheel(document.getElementById("viewer"), true)].map(Number).join("");
const files = [];
window.save = (name, type, text) => files.push(text);
const kinds = [...document.querySelectorAll("figure button")].filter(button => /^(SVG|CSV)$/.test(button.textContent));
kinds.forEach(button => button.click());
told.files = files.length;
told.buttons = kinds.length;
told.pictures = files.filter(text => text.startsWith("<svg") && !text.includes("var(--")).length;
told.lame = files.filter(text => /NaN|undefined|Infinity/.test(text)).length;
told.rpm = Number(/rpm/.test(document.getElementById("key-figures").textContent));
"""
# A finger scrolls the page over the body and turns it sideways; after a tap it turns it in all directions.
FINGER = """
const {viewer} = window, canvas = viewer.canvas, around = canvas.getBoundingClientRect(), told = document.body.dataset;
canvas.setPointerCapture = () => {};
const touch = (type, x, y) => canvas.dispatchEvent(new PointerEvent(type, {
  clientX: around.left + x, clientY: around.top + y, pointerType: "touch", pointerId: 7, bubbles: true}));
const drag = () => { touch("pointerdown", 50, 50); touch("pointermove", 90, 80); touch("pointerup", 90, 80); };
const look = () => `${viewer.turn.toFixed(3)} ${viewer.tilt.toFixed(3)}`;
const first = look();
told.free = getComputedStyle(canvas).touchAction;
drag();
const second = look();
touch("pointerdown", 50, 50); touch("pointerup", 50, 50);
told.held = getComputedStyle(canvas).touchAction;
drag();
told.looks = [first, second, look()].join(" ");
"""
# Bars of the gradients: the largest first, as long as their numbers say.
BARS = """
const told = document.body.dataset, bars = [...document.querySelectorAll("#gradients figure")].map(figure => ({
  widths: [...figure.querySelectorAll("rect")].map(bar => Number(bar.getAttribute("width")))}));
told.bars = bars.length;
told.sorted = Number(bars.every(({widths}) => widths.length > 1 && widths.every((w, i) => i === 0 || w <= widths[i - 1])));
"""
# The choice of a run shows all of it.
CHOOSER = """
document.querySelectorAll(".runs button")[1].click();
document.body.dataset.once = Number(["comparison", "modes", "origin"].every(id => document.querySelectorAll(`#${id}`).length === 1));
const bodies = [...document.querySelectorAll(".bodies canvas")], pixels = () => bodies.map(canvas => canvas.toDataURL());
const still = pixels();
bodies[1].dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft"}));
document.body.dataset.bodies = Number(bodies.length === 2 && pixels().every((picture, k) => picture !== still[k]));
document.body.dataset.scene = Number(document.querySelector("#origin pre").textContent.includes("friction = 0.7"));
"""

# The sections with a table whose last column the reader does not see.
CUT = """
document.body.dataset.cut = [...document.querySelectorAll(".scroll")].filter(box => box.scrollWidth > box.clientWidth)
                            .map(box => box.closest("section").id).join(" ");
"""


def require(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")
    print(f"ok      {what}")


def run(program, *arguments, code=0):
    done = start(program, *arguments)
    require(done.returncode == code, f"{program.name} {arguments[0]} ends with {code}: {done.stderr.strip()}")
    return done


def content_of(page):
    return json.loads(re.search(r'id="content">(.*?)</script>', page, re.DOTALL)[1])


def make_disc(programs, folder):
    scene = folder / "scene.toml"
    text = (ROOT / "tests/data/coarse_disc.toml").read_text()
    scene.write_text(text.replace("[body]", "sylvester = true\n\n[body]") + SQUEAL)
    missing = run(programs / "squeal", "report", scene, "--output", folder, code=1)
    require("chladni run" in missing.stderr, "without files the message says how to make them")
    run(programs / "chladni", "run", scene, "--output", folder)
    run(programs / "squeal", "run", scene, "--output", folder)
    (folder / "bench.json").write_text("{}")
    bad = run(programs / "squeal", "report", scene, "--output", folder, "--benchmark", folder / "bench.json", code=1)
    require("end_to_end.json" in bad.stderr, "JSON without the key is refused")
    require(not list(folder.glob("*.html")), "a refusal leaves no page")
    (folder / "bench.json").write_text(json.dumps(BENCHMARK))
    run(programs / "squeal", "report", scene, "--output", folder, "--benchmark", folder / "bench.json")
    return next(folder.glob("*.report.html"))


def look_at_disc(page, folder):
    text = page.read_text()
    links = [link for link in re.findall(r"https?://[^\s\"'<]*", text) if "www.w3.org/2000/svg" not in link]
    require(not links, f"nothing is loaded from elsewhere: {links}")
    require(len(text) < 4e6, f"the page is small: {len(text) / 1e6:.2f} MB")
    content = content_of(text)
    json_of_squeal = content["critical"]["speed"]
    require(3 < json_of_squeal < 60, f"critical speed {json_of_squeal} rad/s")
    mode = content["modes"][6]
    require(mode["diameters"] == 3 and 0 < mode["estimate"] < 0.01, f"mode 7 with diameters and error: {mode}")
    # What turns with the normal of a thick plate moves in the plane.
    require(mode["circles"] == 0 and mode["in_plane"] < 0.1, f"it moves along the axis without a nodal circle: {mode}")
    require({look["diameters"] for look in content["campbell"]["looks"]} == {3}, "the branches are told by their nodal diameters")
    require(mode["bound"] >= mode["estimate"], "the certified bound is above the estimate")
    names = [motion["name"] for motion in content["surface"]["motions"]]
    require(any("Limit cycle" in name for name in names), "the limit cycle can be looked at")
    require("im" in content["surface"]["motions"][-1], "the least stable motion travels")


def other_pages(programs, folder):
    """A beam without squeal, and squeal without a body."""
    beam = ROOT / "examples/beam/supported.toml"
    run(programs / "chladni", "run", beam, "--output", folder / "beam")
    run(programs / "chladni", "report", beam, "--output", folder / "beam")
    rigid = folder / "rigid.toml"
    rigid.write_text(changed((ROOT / "examples/rigid_disc/scene.toml").read_text(),
                             ("duration_s = 6.0", "duration_s = 1.0"), ("duration_s = 10.0", "duration_s = 2.0")))  # fmt: skip
    run(programs / "squeal", "run", rigid, "--output", folder / "rigid")
    run(programs / "squeal", "report", rigid, "--output", folder / "rigid")
    return [next((folder / name).glob("*.report.html")) for name in ("beam", "rigid")]


def make_comparison(programs, page):
    """The disc beside itself with more friction, in a folder of its own; and what does not go together."""
    scene, other = page.parent / "scene.toml", page.parent / "other"
    other.mkdir()
    shutil.copy(page.parent / "disc.body.h5", other)
    rougher = other / "scene.toml"
    rougher.write_text(scene.read_text().replace("friction = 0.6", "friction = 0.7"))
    run(programs / "squeal", "run", rougher, "--output", other)
    both = ("report", scene, rougher, "--output", page.parent)
    odd = run(programs / "squeal", *both, "--output", other, "--output", other, code=1)
    require("2 scenes and 3 folders" in odd.stderr, "folders that go with no scene are refused")
    run(programs / "squeal", *both, "--output", other)
    return next(page.parent.glob("*.comparison.html"))


def make_run_up(programs, page):
    folder = page.parent / "run_up"
    folder.mkdir()
    shutil.copy(page.parent / "disc.body.h5", folder)
    text = (ROOT / "tests/data/coarse_disc.toml").read_text().replace("[body]", "sylvester = true\n\n[body]") + RUN_UP
    (folder / "scene.toml").write_text(text)
    run(programs / "squeal", "run", folder / "scene.toml", "--output", folder)
    run(programs / "squeal", "report", folder / "scene.toml", "--output", folder)
    return next(folder.glob("*.report.html"))


def browse(chromium, page, *more):
    profile = tempfile.mkdtemp(dir=page.parent)
    command = [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
               "--disable-background-networking", "--disable-component-update", "--disable-sync",
               "--enable-logging=stderr", "--virtual-time-budget=3000", "--window-size=1280,3000",
               f"--user-data-dir={profile}", *more, page.as_uri()]  # fmt: skip
    return start(*command, timeout=120)


def draw(chromium, page, needed):
    shown = browse(chromium, page, "--dump-dom")
    said = [line for line in shown.stderr.splitlines() if "CONSOLE" in line]
    require(not said, f"{page.name}: the console is silent {said}")
    require('data-state="drawn"' in shown.stdout, f"{page.name}: is drawn")
    sections = re.findall(r'<section id="([a-z-]+)"', shown.stdout)
    require(set(needed) <= set(sections), f"{page.name}: has the sections {sections}")
    empty = re.findall(r'NaN|undefined|Infinity', re.sub(r"<script.*?</script>", "", shown.stdout, flags=re.DOTALL))
    require(not empty, f"{page.name}: no number failed {empty}")


def used(chromium, page, reader, *more):
    """What the body of a copy of the page tells, with a reader in it."""
    copy = page.with_name("used.html")
    copy.write_text(page.read_text().replace("</body>", SCRIPT % reader))
    shown = browse(chromium, copy, "--dump-dom", *more).stdout
    state = dict(re.findall(r'data-([a-z]+)="([^"]*)"', re.search(r"<body[^>]*>", shown)[0]))
    require("error" not in state, f"nothing fails in use: {state}")
    return state


def is_whole(chromium, page):
    """Around the widths at which the list beside the picture gets its place, and those of common screens."""
    for width in (980, 1020, 1300, 1400):
        cut = used(chromium, page, CUT, f"--window-size={width},3000")["cut"]
        require(not cut, f"{page.name}: no table is cut in a window of {width} pixels {cut}")


def look_closer(chromium, page):
    state = used(chromium, page, LOOKER)
    require("rad/s" in state["readout"] and "rpm" in state["readout"], f"the plot tells its values: {state['readout']}")
    require(state["zoomed"] == state["moved"] == state["whole"] == "1", "a box zooms, Shift moves, a double click shows the whole")
    require(state["wheel"] == "0101", "the wheel scrolls the page unless Ctrl is held")
    files, pictures = int(state["files"]), int(state["pictures"])
    require(files == int(state["buttons"]) == 2 * pictures > 10, "each plot is saved as SVG and as CSV")
    require(state["lame"] == "0" and state["rpm"] == "1", "no number of a file failed, and speeds are told in rpm too")


def use(chromium, page):
    state = used(chromium, page, READER)
    require(state["motion"] == "2" and state["turned"] == "1", "a row shows its mode, a key turns the body")
    require(float(state["phase"]) > 0, "the motion plays")
    require(int(state["painted"]) > 20000, f"{state['painted']} pixels of the body are painted")


def touch(chromium, page):
    state = used(chromium, page, FINGER)
    (turn, tilt), (turned, same), (further, tilted) = zip(*[iter(state["looks"].split())] * 2)
    require(state["free"] == "pan-y" and turned != turn and same == tilt, f"a finger turns the body sideways and scrolls the page: {state}")
    require(state["held"] == "none" and further != turned and tilted != same, "after a tap it turns the body in all directions")


def photograph(chromium, page, file):
    browse(chromium, page, f"--screenshot={file}")
    from matplotlib.image import imread

    pixels = imread(file)[..., :3]
    red, blue = pixels[..., 0], pixels[..., 2]
    for name, part in (("blue", blue > red + 0.3), ("orange", red > blue + 0.3)):
        require(part.sum() > 5000, f"{file}: {part.sum()} pixels are {name}")


def main(programs, chromium=None, screenshot=None):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        page = make_disc(programs, folder)
        look_at_disc(page, folder)
        beam, rigid = other_pages(programs, folder)
        both, run_up = make_comparison(programs, page), make_run_up(programs, page)
        if chromium is None:
            return
        draw(chromium, page, ["modes", "campbell", "map", "limit-cycle", "errors", "summary", "origin"])
        draw(chromium, beam, ["modes", "errors", "summary"])
        draw(chromium, rigid, ["campbell", "summary"])
        draw(chromium, both, ["comparison", "modes", "campbell", "limit-cycle", "origin"])
        draw(chromium, run_up, ["gradients", "orders"])
        is_whole(chromium, page)
        use(chromium, page)
        touch(chromium, page)
        bars = used(chromium, run_up, BARS)
        require(int(bars["bars"]) > 1 and bars["sorted"] == "1", f"the gradients are bars, the largest first: {bars}")
        look_closer(chromium, page)
        chosen = used(chromium, both, CHOOSER)
        require(chosen["bodies"] == "1", "the bodies of two runs stand beside each other and turn together")
        require(chosen["once"] == chosen["scene"] == "1", "the other run is shown in place of the first")
        photograph(chromium, page, screenshot or str(folder / "page.png"))


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
