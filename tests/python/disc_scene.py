"""A small disc between two pads, for tests."""

import chladni


def disc(**more):
    return chladni.Scene({
        "name": "small",
        "mesh": {"generator": "annulus", "inner_radius": 0.025, "outer_radius": 0.162, "element_order": 2, "element_size": 0.03,
                 "rings": [{"name": "track", "radius": 0.13, "nodes": 24}]},
        "material": {"iron": {"young": 9.15915e10, "poisson": 0.3, "density": 6300.0}},
        "section": [{"group": "disc", "type": "shell", "material": "iron", "thickness": 0.02}],
        "coupling": [{"type": "rigid", "name": "hub", "group": "inner_edge"}],
        "interface": {"nodes": ["track", "hub"]},
        "reduce": {"method": "craig-bampton", "modes": 10},
        "body": {"fixed": ["hub"], "keep": {"modes": 12}},
        "squeal": {"ring": "track", "thickness": 0.02, "friction": 0.6, "contact": "bilateral",
                   "speeds": {"from_rad_s": 3.0, "to_rad_s": 60.0, "count": 10},
                   "pads": [{"angle_deg": 0.0, "stiffness": 6e6, "damping": 0.0, "preload": 2000.0}],
                   "analyses": ["eigenvalues", "critical-speed"]},
        **more})  # fmt: skip
