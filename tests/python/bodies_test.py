"""From the mesh to the squeal in this process. Usage: bodies_test.py FOLDER_OF_PROGRAMS"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from disc_scene import disc
from files_of import arrays_of

import chladni

PROGRAMS = Path(sys.argv.pop(1)) if __name__ == "__main__" else None


class Run(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene, cls.phases = disc(), []
        cls.run_of_disc = cls.scene.run(progress=lambda phase, part: cls.phases.append((phase, part)))

    def test_makes_what_the_programs_make(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.toml"
            path.write_text(self.scene.text)
            for program in ("chladni", "squeal"):
                subprocess.run([PROGRAMS / program, "run", path, "--output", folder], check=True, capture_output=True)
            theirs = chladni.Run(self.scene, folder)
            np.testing.assert_allclose(self.run_of_disc.body.modes.frequencies, theirs.body.modes.frequencies, rtol=1e-10)
            for kind in ("reduced", "body", "squeal"):
                shapes = [{name: array.shape for name, array in arrays_of(getattr(run, kind))} for run in (self.run_of_disc, theirs)]
                self.assertEqual(*shapes)
            self.assertAlmostEqual(self.run_of_disc.squeal.critical.speed, theirs.squeal.critical.speed, places=5)

    def test_tells_its_phases(self):
        names = [phase for phase, _ in self.phases]
        for phase in ("mesh", "assembly", "factorization", "fixed-interface modes", "projection", "critical-speed"):
            self.assertIn(phase, names)
        self.assertTrue(all(0.0 <= part <= 1.0 for _, part in self.phases))

    def test_names_all_axes_of_its_files(self):
        for file in (self.run_of_disc.reduced, self.run_of_disc.body, self.run_of_disc.squeal):
            for name, array in arrays_of(file):
                with self.subTest(f"{file.format} {name}"):
                    self.assertNotIn("axis_0", array.dims)
                    for dim, along in array.coords.items():
                        self.assertEqual(array.shape[array.dims.index(dim)], len(along))

    def test_shows_its_page(self):
        page = self.run_of_disc._repr_html_()
        self.assertIn("Modal body", page)
        self.assertIn("critical speed", page)

    def test_gives_a_body_for_other_pads(self):
        other = self.scene.with_keys({"squeal.friction": 0.5}).squeal(body=self.run_of_disc.body)
        self.assertNotEqual(other.critical.speed, self.run_of_disc.squeal.critical.speed)

    def test_ends_with_what_the_listener_raises(self):
        def refuse(phase, part):
            if phase == "projection":
                raise KeyboardInterrupt(phase)

        with self.assertRaisesRegex(KeyboardInterrupt, "projection"):
            self.scene.run(progress=refuse)
        self.assertEqual(len(self.scene.run().body.modes.frequencies), 12)


class Responses(unittest.TestCase):
    def test_are_arrays_over_frequencies_and_outputs(self):
        place = {"at": "track", "dofs": ["z"]}
        tap = {**place, "near": [0.13, 0.0, 0.0]}
        scene = disc(reduce={"method": "craig-bampton", "modes": 10, "resultants": ["disc"]},
                     response={"loads": [tap], "outputs": [place], "from_Hz": 100.0, "to_Hz": 900.0, "count": 9, "loss_factor": 0.01,
                               "section_forces": ["disc"]})  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            run = scene.run(folder)
            (Path(folder) / "scene.toml").write_text(scene.text)
            subprocess.run([PROGRAMS / "chladni", "response", f"{folder}/scene.toml", "--output", folder], check=True, capture_output=True)
            responses = chladni.open(f"{folder}/small.response.h5")
            (load,) = responses.loads.names
            H = responses[f"responses/{load}/H"]
            self.assertEqual((H.dims, H.unit, H.shape), (("frequency", "output"), "m/N", (9, 24)))
            # The driving point, mode by mode.
            modes = run.body.modes
            row = 6 * list(run.body.attachment.node_numbers).index(responses.loads.node_numbers[0]) + 2
            b, omega = modes.attachment_displacements[row], modes.frequencies.values
            Omega = responses.frequencies[4]
            exact = (b**2 / ((1 + 0.01j) * omega**2 - Omega**2)).sum()
            np.testing.assert_allclose(H.sel(frequency=Omega, output=load), exact, rtol=1e-12)
            for name, array in arrays_of(responses):
                with self.subTest(name):
                    self.assertNotIn("axis_0", array.dims)
                    for dim, along in array.coords.items():
                        self.assertEqual(array.shape[array.dims.index(dim)], len(along))
            self.assertIn("receptance", responses.describe())


class Refusal(unittest.TestCase):
    def test_names_what_is_wrong(self):
        with self.assertRaisesRegex(chladni.Error, r"scene:\d+: interface.nodes"):
            disc(interface={"nodes": ["trak", "hub"]})
        with self.assertRaisesRegex(chladni.Error, "body.fixed"):
            disc(body={"fixed": [], "keep": {"modes": 3}}).run()
        with self.assertRaisesRegex(chladni.Error, "squeal needs a body"):
            disc().squeal()
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(chladni.Error, "no such file; make it with"):
            disc().squeal(output=folder)

    def test_of_a_body_of_another_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            disc().run(folder)
            with self.assertRaisesRegex(chladni.Error, "section.*thickness|thickness"):
                disc(section=[{"group": "disc", "type": "shell", "material": "iron", "thickness": 0.03}]).squeal(output=folder)


PLATE = """SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 0.2, 0.1}; Mesh.MeshSizeMax = 0.03;
Physical Surface("disc") = {1}; Physical Curve("inner_edge") = {4};
"""


class MeshFile(unittest.TestCase):
    def test_is_read_from_the_folder_of_the_scene(self):
        keys = {**disc().to_dict(), "mesh": {"file": "plate.geo"}, "interface": {"nodes": ["hub"]}, "body": {"fixed": ["hub"]}}
        del keys["squeal"]
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "plate.geo").write_text(PLATE)
            run = chladni.Scene(keys, folder=folder).run()
            self.assertAlmostEqual(run.body.rigid_body.mass, 0.2 * 0.1 * 0.02 * 6300.0, places=9)
            self.assertIsNone(run.squeal)
            (Path(folder) / "plate.geo").write_text("Plane Surface(1) = {7};")
            with self.assertRaisesRegex(chladni.Error, "plate.geo"):
                chladni.Scene(keys, folder=folder).run()


if __name__ == "__main__":
    unittest.main()
