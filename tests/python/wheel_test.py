"""The packages that pip installs: with PETSc, and without. Usage: wheel_test.py BUILD_FOLDER"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD = Path(sys.argv.pop(1)).resolve()
SOURCE = Path(__file__).resolve().parents[2]
WITH_FE = (BUILD / "libexec").exists()
SQUEAL = """
import chladni
rigid = chladni.Scene.read("examples/rigid_disc/scene.toml")
print(rigid.with_keys({"squeal.analyses": ["critical-speed"], "squeal.growth": None}).squeal().critical.speed)
"""
REDUCE = """
import chladni, scipy.sparse
K = scipy.sparse.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(50, 50))
print(chladni.reduce(K, scipy.sparse.identity(50), [0], modes=3), chladni.__file__)
"""


class Wheel(unittest.TestCase):
    def installed(self, *settings):
        """Runs programs with the package that pip has installed without a network, in a folder of its own."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--target", folder.name]
        subprocess.run([*pip, SOURCE, "--config-settings", f"build={BUILD}", *settings], check=True, capture_output=True)
        environment = {**os.environ, "PYTHONPATH": folder.name}
        return lambda text: subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, cwd=SOURCE, env=environment)

    def test_without_petsc_squeals(self):
        run = self.installed("--config-settings", "fe=off")
        done = run(SQUEAL)
        self.assertAlmostEqual(float(done.stdout), 29.777, places=3, msg=done.stderr)
        refused = run("import chladni; chladni.reduce")
        self.assertIn("needs python3-petsc4py, python3-slepc4py and a build with PETSc", refused.stderr)

    @unittest.skipUnless(WITH_FE, "built without PETSc")
    def test_with_petsc_reduces(self):
        done = self.installed()(REDUCE)
        self.assertIn("<Reduction to 1 masters and 3 modes>", done.stdout, done.stderr)
        self.assertNotIn(str(BUILD), done.stdout)


if __name__ == "__main__":
    unittest.main()
