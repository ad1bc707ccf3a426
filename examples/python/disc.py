"""A disc in ten lines: mesh, reduction, body and squeal. Usage: disc.py [FOLDER] [ELEMENT_SIZE]"""

import sys
from pathlib import Path

import chladni

scene = chladni.Scene.read(Path(__file__).parents[1] / "thesis_disc/scene.toml")
if len(sys.argv) > 2:  # larger elements, for a look
    scene["mesh.element_size"] = float(sys.argv[2])
scene["squeal.analyses"] = ["eigenvalues", "critical-speed"]
run = scene.run(output=sys.argv[1] if len(sys.argv) > 1 else None)
print("modes of the body, Hz:", (run.body.modes.frequencies.values / 6.283185).round(1)[:6])
print(f"squeals from {run.squeal.critical.speed:.4f} rad/s on, at {run.squeal.critical.frequency:.1f} Hz")
print("largest growth rate at 20 rad/s, 1/s:", run.squeal.eigenvalues.lambda_re.sel(speed=20.0).max().round(4))
