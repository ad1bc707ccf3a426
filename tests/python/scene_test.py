"""Scenes in Python: the same checks, words and numbers as the program's. Usage: scene_test.py FOLDER_OF_PROGRAMS"""

import json
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
import unittest
from pathlib import Path

import numpy as np

import chladni
from chladni.toml_text import toml_text

PROGRAMS = Path(sys.argv.pop(1)) if __name__ == "__main__" else None  # processes of a sweep read this file again
RIGID = Path(__file__).parents[2] / "examples/rigid_disc/scene.toml"
QUICK = {"squeal.analyses": ["eigenvalues", "critical-speed"], "squeal.growth": None, "squeal.transient": None}


def squeal(*words):
    return subprocess.run([PROGRAMS / "squeal", *map(str, words)], capture_output=True, text=True)


class Scene(unittest.TestCase):
    def test_is_refused_with_the_words_of_the_program(self):
        text = RIGID.read_text()
        wrong = {
            "a word": text.replace('contact = "bilateral"', 'contact = "bilatral"'),
            "a key": text.replace("friction", "frictoin"),
            "a number": text.replace("friction = 0.6", "friction = -1"),
            "no TOML": "[squeal",
            "nothing": "",
        }
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/scene.toml"
            for name, scene in wrong.items():
                Path(path).write_text(scene)
                with self.subTest(name), self.assertRaises(chladni.Error) as caught:
                    chladni.Scene.read(path)
                with self.subTest(name):
                    self.assertEqual(str(caught.exception), squeal("run", path, "--output", folder).stderr.strip())
                if name != "nothing":
                    with self.subTest(name), self.assertRaisesRegex(chladni.Error, "^scene:"):
                        chladni.Scene(scene)

    def test_keeps_its_keys_on_the_way_through_python(self):
        for file in RIGID.parents[1].glob("*/*.toml"):
            with self.subTest(file.parent.name):
                keys = tomllib.loads(file.read_text())
                self.assertEqual(tomllib.loads(toml_text(keys)), keys)
        odd = {"a b": {'"\\\n\x7f': [1, 2.0, True, "ä", {"x": []}]}, "e": 1e22, "n": np.int64(3), "t": np.True_, "v": np.ones(2)}
        again = tomllib.loads(toml_text(odd))
        self.assertEqual(again["a b"], odd["a b"])
        self.assertEqual((again["e"], again["n"], again["t"], again["v"]), (1e22, 3, True, [1.0, 1.0]))
        with self.assertRaisesRegex(TypeError, "has no place in a scene"):
            toml_text({"x": object()})

    def test_takes_keys_one_by_one_and_stays_where_one_is_refused(self):
        scene = chladni.Scene.read(RIGID)
        scene["squeal.pads[0].stiffness"] = 5e6
        self.assertEqual(scene["squeal.pads[0].stiffness"], 5e6)
        with self.assertRaisesRegex(chladni.Error, r"squeal.friction = -1: must be >= 0"):
            scene["squeal.friction"] = -1
        self.assertEqual(scene["squeal.friction"], 0.6)
        with self.assertRaises(KeyError):
            scene["squeal.no_such_key"]
        again = pickle.loads(pickle.dumps(scene))
        self.assertEqual(again.text, scene.text)


class Results(unittest.TestCase):
    def test_are_those_of_the_program(self):
        scene = chladni.Scene.read(RIGID).with_keys(QUICK)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.toml").write_text(scene.text)
            squeal("run", f"{folder}/scene.toml", "--output", folder, "--json", f"{folder}/s.json")
            theirs = chladni.open(f"{folder}/rigid.squeal.h5")
            summary = json.loads(Path(f"{folder}/s.json").read_text())
        ours = scene.squeal()
        self.assertEqual(ours.critical.speed, summary["critical_speed_rad_s"])
        np.testing.assert_array_equal(ours.eigenvalues["lambda"], theirs.eigenvalues["lambda"])
        self.assertEqual(ours.eigenvalues.lambda_re.unit, "1/s")
        again = pickle.loads(pickle.dumps(ours))
        np.testing.assert_array_equal(again.eigenvalues["lambda"], theirs.eigenvalues["lambda"])

    def test_of_analyses_before_one_that_failed_are_kept(self):
        scene = chladni.Scene.read(RIGID).with_keys({
            **QUICK, "squeal.analyses": ["critical-speed", "limit-cycle-direct"],
            "squeal.limit_cycle_direct": {"speed_rad_s": 4.0}})  # a stable one  # fmt: skip
        with self.assertRaises(chladni.Error) as caught:
            scene.squeal()
        self.assertGreater(caught.exception.results.critical.speed, 0.0)

    def test_of_a_sweep_come_in_the_order_of_the_variants(self):
        scene = chladni.Scene.read(RIGID).with_keys({**QUICK, "squeal.analyses": ["critical-speed"]})
        frictions = [0.4, 0.5, 0.6]
        found = [r.critical.speed for r in chladni.sweep(scene, [{"squeal.friction": mu} for mu in frictions], processes=2)]
        self.assertEqual(found, [scene.with_keys({"squeal.friction": mu}).squeal().critical.speed for mu in frictions])
        self.assertEqual(len(set(found)), 3)

    def test_by_a_generator_are_those_of_the_program(self):
        ranges = {"squeal.friction": (0.4, 0.6), "squeal.pads[0].preload": (2000.0, 4000.0)}
        for method in ("sobol", "latin-hypercube"):
            variants = chladni.samples(ranges, 5, method, seed=3)
            self.assertEqual(variants, chladni.samples(ranges, 5, method, seed=3))
            for key, (low, high) in ranges.items():
                # Each fifth of a range, or each quarter for the sequence, holds one of the first points.
                parts = 4 if method == "sobol" else 5
                places = {int(parts * (variant[key] - low) / (high - low)) for variant in variants[:parts]}
                self.assertEqual(places, set(range(parts)), (method, key))
        scene = chladni.Scene.read(RIGID).with_keys({**QUICK, "squeal.analyses": ["critical-speed"]})
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "scene.toml").write_text(scene.text)
            chladni.write_samples(f"{folder}/samples.csv", variants)
            done = squeal("sweep", f"{folder}/scene.toml", "--samples", f"{folder}/samples.csv", "--output", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            lines = Path(folder, f"{scene.name}.sweep.csv").read_text().splitlines()
        self.assertTrue(lines[0].startswith("variant,squeal.friction,squeal.pads[1].preload,critical_speed_rad_s,"), lines[0])
        found = [float(line.split(",")[3]) for line in lines[1:]]
        self.assertEqual(found, [scene.with_keys(variant).squeal().critical.speed for variant in variants])


LONG = """
import chladni, sys
scene = chladni.Scene.read(sys.argv[1])
print("begins", flush=True)
try:
    scene.squeal()  # without a listener: what runs Python hears of signals by itself
except KeyboardInterrupt:
    print("interrupted")
"""


class Work(unittest.TestCase):
    def test_ends_on_ctrl_c(self):
        scene = chladni.Scene.read(RIGID).with_keys({"squeal.analyses": ["transient"], "squeal.growth": None,
                                                     "squeal.transient.duration_s": 3000.0})  # fmt: skip
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(scene.text)
            file.flush()
            process = subprocess.Popen([sys.executable, "-c", LONG, file.name], stdout=subprocess.PIPE, text=True)
            process.stdout.readline()
            time.sleep(1.0)  # in the transient then, of minutes
            process.send_signal(signal.SIGINT)
            start = time.monotonic()
            self.assertEqual(process.communicate(timeout=60)[0].splitlines()[-1], "interrupted")
            self.assertLess(time.monotonic() - start, 20.0)

    def test_ends_with_what_the_listener_raises(self):
        def refuse(phase, part):
            raise ZeroDivisionError(phase)

        with self.assertRaisesRegex(ZeroDivisionError, "eigenvalues"):
            chladni.Scene.read(RIGID).squeal(progress=refuse)

    def test_leaves_the_interpreter_to_other_threads(self):
        turns, done = [0], threading.Event()

        def turn():
            while not done.is_set():
                turns[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=turn)
        thread.start()
        before = turns[0]
        chladni.Scene.read(RIGID).with_keys({"squeal.analyses": ["transient"], "squeal.growth": None}).squeal()
        done.set()
        thread.join()
        self.assertGreater(turns[0] - before, 20)


if __name__ == "__main__":
    unittest.main()
