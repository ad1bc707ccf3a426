"""`chladni mesh` writes the mesh with its groups, so that the curve of a STEP file can be found by its number, and
refuses groups that do not exist after that.

Usage: mesh_picture.py PROGRAM_DIR [CHROMIUM]
"""

import base64
import json
import math
import re
import struct
import sys
import tempfile
from pathlib import Path

from report import browse, is_whole
from running import run

# Gmsh writes the STEP file: a plate of 200 mm x 100 mm with a hole of radius 20 mm.
MAKER = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 200, 100};
Disk(2) = {60, 50, 0, 20};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Save "plate.step";
Mesh.MeshSizeMax = 20;
"""
SCENE = """name = "plate"
[mesh]
file = "plate.step"
element_order = 2
element_size = 0.02
[material.iron]
young = 9e10
poisson = 0.3
density = 7200.0
[[section]]
type = "shell"
group = "surface_1"
material = "iron"
thickness = 0.01
[interface]
nodes = ["HOLE"]
[reduce]
method = "guyan"
"""
# What a reader does: points at the hole in the list, then clicks it, then clicks it in the picture.
READER = """<script>
addEventListener("error", event => { document.body.dataset.error = event.message; });
const row = [...document.querySelectorAll("tr[data-group]")].find(row => row.cells[0].textContent === "HOLE");
const state = document.body.dataset, {viewer} = window, hole = Number(row.dataset.group);
state.all = viewer.named.join(" ");
row.dispatchEvent(new PointerEvent("pointerenter", {pointerType: "mouse"}));
state.pointed = viewer.named.join(" ");
row.dispatchEvent(new PointerEvent("pointerleave"));
const box = viewer.canvas.getBoundingClientRect(), node = viewer.groups[hole].nodes[0];
const at = {clientX: box.left + viewer.x[node] * box.width / viewer.canvas.width,
            clientY: box.top + viewer.y[node] * box.height / viewer.canvas.height, pointerId: 1, bubbles: true};
viewer.canvas.setPointerCapture = () => {};
viewer.canvas.dispatchEvent(new PointerEvent("pointermove", at));
state.found = viewer.pointed === hole;
for (const kind of ["pointerdown", "pointerup"]) viewer.canvas.dispatchEvent(new PointerEvent(kind, at));
state.chosen = row.className;
state.legend = document.querySelector("figure .note").textContent;
state.accent = viewer.pixels.filter(pixel => (pixel & 0xffffff) === (213 | 94 << 8)).length;
</script>"""


def vtu_array(text, name):
    found = re.search(rf'type="(\w+)" Name="{re.escape(name)}"[^>]*>\n(.*?)\n', text)
    assert found, f"the .vtu has no array {name!r}"
    code, size = {"Float64": ("d", 8), "Int64": ("q", 8), "UInt8": ("B", 1)}[found[1]]
    data = base64.b64decode(found[2])[8:]
    return struct.unpack(f"<{len(data) // size}{code}", data)


def content_of(page):
    return json.loads(re.search(r'id="content">(.*?)</script>', page.read_text(), re.DOTALL)[1])


def hole_of(page):
    """The circle of radius 20 mm among the curves: how a reader finds it by its length."""
    groups = content_of(page)["groups"]
    near = [group for group in groups if abs(group["size"] - 2 * math.pi * 0.02) < 1e-4]
    assert len(near) == 1 and near[0]["kind"] == "curve", near
    low, high = near[0]["extents"][0]
    assert abs(low - 0.04) < 1e-9 and abs(high - 0.08) < 1e-9, near
    surface = next(group for group in groups if group["name"] == "surface_1")
    area = 0.2 * 0.1 - math.pi * 0.02**2
    assert surface["kind"] == "surface" and abs(surface["size"] - area) < 1e-3 * area, surface
    return near[0]["name"]


def check_vtu(file, hole):
    text = file.read_text()
    x = vtu_array(text, "points")
    marked = vtu_array(text, f"group {hole}")
    ends = (0, *vtu_array(text, "offsets"))
    nodes = vtu_array(text, "connectivity")
    edges = [nodes[a:b] for a, b, mark in zip(ends, ends[1:], marked) if mark]
    assert edges and all(len(edge) == 3 for edge in edges), "the hole is lines of order 2"
    for node in {node for edge in edges for node in edge}:
        radius = math.hypot(x[3 * node] - 0.06, x[3 * node + 1] - 0.05)
        assert abs(radius - 0.02) < 1e-9, f"a node of {hole} at radius {radius}"
    assert sum(vtu_array(text, "group surface_1")) == sum(kind in (69, 70) for kind in vtu_array(text, "types"))
    try:
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    except ImportError:
        print("no VTK here (package python3-vtk9): its reader is not asked")
        return
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    cells = reader.GetOutput().GetCellData()
    assert cells.GetArray(f"group {hole}").GetRange() == (0.0, 1.0), "VTK reads the marks of the hole"


def use(chromium, page, hole):
    copy = page.with_name("used.html")
    copy.write_text(page.read_text().replace("</body>", READER.replace("HOLE", hole) + "</body>"))
    shown = browse(chromium, copy, "--dump-dom")
    assert "CONSOLE" not in shown.stderr, shown.stderr
    state = dict(re.findall(r'data-([a-z]+)="([^"]*)"', re.search(r"<body[^>]*>", shown.stdout)[0]))
    assert state["state"] == "drawn" and "error" not in state, state
    assert {hole, "surface_1"} <= set(state["all"].split()), f"names stand in the picture: {state}"
    assert state["pointed"] == hole, f"pointing at a row shows the name of its group: {state}"
    assert state["found"] == "true" and state["chosen"] == "chosen", f"the curve is found in the picture: {state}"
    assert state["legend"].startswith(f"{hole}: curve"), state
    assert int(state["accent"]) > 200, f"the curve is seen: {state}"


def main(programs, chromium=None):
    chladni = programs.resolve() / "chladni"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "maker.geo").write_text(MAKER)
        run(chladni, "mesh", folder / "maker.geo", "--trust-mesh", "--output", folder / "made", cwd=folder)
        scene, out = folder / "scene.toml", folder / "out"
        scene.write_text(SCENE)
        said = run(chladni, "mesh", scene, "--output", out, code=1)
        line = SCENE.splitlines().index('nodes = ["HOLE"]') + 1
        assert f'scene.toml:{line}: interface.nodes[1] = "HOLE": no such ring, edge or coupling' in said, said
        assert "wrote " in said, said
        hole = hole_of(out / "plate.mesh.html")
        assert f'"{hole}"' in said, said
        check_vtu(out / "plate.mesh.vtu", hole)
        refused = run(chladni, "reduce", scene, "--output", out, code=1)
        assert refused.splitlines()[-1] == said.splitlines()[-1], f"{refused}\nis not\n{said}"
        scene.write_text(SCENE.replace("HOLE", hole))
        said = run(chladni, "mesh", scene, "--output", out)
        page = out / "plate.mesh.html"
        assert said.splitlines()[-1] == f"wrote {page}", said
        assert "://" not in page.read_text().replace("http://www.w3.org/2000/svg", ""), "nothing is loaded"
        if chromium:
            use(chromium, page, hole)
            is_whole(chromium, page)


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
