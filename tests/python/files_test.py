"""Files of Chladni in Python: values, units and axes; what is damaged. Usage: files_test.py FOLDER_OF_PROGRAMS"""

import math
import os
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy as np
from files_of import arrays_of

import chladni

PROGRAMS = Path(sys.argv.pop(1))
RIGID = Path(__file__).parents[2] / "examples/rigid_disc/scene.toml"
SCENE = chladni.Scene.read(RIGID).with_keys({"squeal.transient.duration_s": 0.5, "squeal.growth.duration_s": 0.5})


class File(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = SCENE.squeal()

    def test_holds_what_other_readers_find(self):
        with h5py.File(self.results.path) as theirs:
            for name, array in arrays_of(self.results):
                with self.subTest(name):
                    values = theirs[name].asstr()[:] if theirs[name].dtype.kind == "S" else theirs[name][()]
                    np.testing.assert_array_equal(array.values, values)
                    self.assertEqual(array.unit, theirs[name].attrs["unit"].decode())
            self.assertEqual(self.results.critical.speed, theirs["critical/speed"][()])
            self.assertEqual(self.results.transient.integrator, theirs["transient/integrator"].asstr()[()])

    def test_names_all_its_axes(self):
        for name, array in arrays_of(self.results):
            with self.subTest(name):
                self.assertNotIn("axis_0", array.dims)
                for dim, along in array.coords.items():
                    self.assertEqual(array.shape[array.dims.index(dim)], len(along))
        history = self.results.transient.history
        self.assertIs(history.pad_velocity.coords["time"], history.t)

    def test_says_what_it_does_not_hold(self):
        with self.assertRaisesRegex(AttributeError, "'stability_map'; there are .*eigenvalues"):
            self.results.stability_map
        with self.assertRaises(KeyError):
            self.results["eigenvalues/none"]
        self.assertNotIn("stability_map", self.results)
        self.assertIn("eigenvalues/lambda", self.results)

    def test_shows_itself_in_jupyter(self):
        self.assertIn("critical speed", self.results._repr_html_())
        with tempfile.TemporaryDirectory() as folder:
            run = SCENE.run(folder)
            page = run._repr_html_()
            self.assertIn("<iframe", page)
            self.assertIn("critical speed", page)
            self.assertIsNone(run.body)
            self.assertEqual(run.squeal.critical.speed, self.results.critical.speed)

    def test_is_gone_with_its_temporary_folder(self):
        results = SCENE.with_keys({"squeal.analyses": ["critical-speed"]}).squeal()
        path = results.path
        self.assertTrue(os.path.exists(path))
        del results
        self.assertFalse(os.path.exists(path))


    def test_is_read_by_several_threads(self):
        def read_and_write(_):
            own = SCENE.with_keys({"squeal.analyses": ["critical-speed"]}).squeal()
            return [chladni.open(self.results.path).critical.speed for _ in range(5)] + [own.critical.speed]

        with ThreadPoolExecutor(4) as pool:
            found = list(pool.map(read_and_write, range(12)))
        self.assertEqual(found, 12 * [6 * [self.results.critical.speed]])


class Damage(unittest.TestCase):
    """Each file is refused in the words of the program, and the interpreter lives on."""

    def refused(self, path):
        with self.assertRaises(chladni.Error) as caught:
            chladni.open(path)
        said = subprocess.run([PROGRAMS / "squeal", "info", path], capture_output=True, text=True).stderr.strip()
        self.assertEqual(str(caught.exception), said)

    def test_of_any_byte_is_told(self):
        results = SCENE.with_keys({"squeal.analyses": ["critical-speed"]}).squeal()
        whole = Path(results.path).read_bytes()
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/a.squeal.h5"
            for n in (0, 1, 100, 600, len(whole) // 2, len(whole) - 1):
                Path(path).write_bytes(whole[:n])
                with self.subTest(cut=n):
                    self.refused(path)
            for k in range(0, len(whole), len(whole) // 7):
                Path(path).write_bytes(whole[:k] + bytes([whole[k] ^ 255]) + whole[k + 1 :])
                with self.subTest(byte=k):
                    self.refused(path)

    def test_of_files_without_a_seal_ends_no_interpreter(self):
        results = SCENE.with_keys({"squeal.analyses": ["critical-speed"]}).squeal()
        bare = Path(results.path).read_bytes()[512:]
        generator = np.random.default_rng(1)
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/a.squeal.h5"
            for _ in range(40):
                damaged = bytearray(bare)
                for k in generator.integers(8, len(bare), 20):
                    damaged[k] = generator.integers(256)
                Path(path).write_bytes(damaged)
                try:
                    chladni.open(path)
                except chladni.Error as error:
                    self.assertIn("a.squeal.h5", str(error))

    def test_of_other_kinds_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            for path in (folder, f"{folder}/none.h5", str(RIGID)):
                with self.subTest(path):
                    self.refused(path)
            with h5py.File(f"{folder}/other.h5", "w") as file:
                file["x"] = math.pi
            with self.assertRaisesRegex(chladni.Error, "has no attribute 'format'"):
                chladni.open(f"{folder}/other.h5")
            with self.assertRaises(TypeError):
                chladni.open(None)


if __name__ == "__main__":
    unittest.main()
