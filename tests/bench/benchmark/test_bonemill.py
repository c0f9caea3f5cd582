"""Our own law in the benchmark: `balanced` keeps the figures that docs/reference/benchmark.md tells of it.

    PYTHONPATH=build/release/python /usr/bin/python3 -m unittest -v test_bonemill          (in this folder)"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import report
import result as results
from figures import BY_THE_CLOCK

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parents[2] / "docs/reference/benchmark.md"
MEASURED = HERE.parents[2] / "docs/benchmark.json"


class Bonemill(unittest.TestCase):
    def test_balanced_has_the_figures_that_are_told_of_it(self):
        told = next(program for program in results.read(MEASURED)["programs"] if program["name"] == "bonemill balanced")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, str(HERE / "run"), "--quick", "--program", "balanced", "--out", folder], check=True, capture_output=True)
            measured = results.read(pathlib.Path(folder) / "result.json")["programs"][0]["scenes"]
        compared = 0
        for scene, figures in measured.items():
            for name, figure in figures.items():
                value, before = figure["value"], told["scenes"][scene][name]["value"]
                if name in BY_THE_CLOCK:
                    continue
                self.assertEqual(value is None, before is None, f"{scene} {name}")
                if value is not None:
                    self.assertAlmostEqual(value, before, delta=max(0.1 * abs(before), 1e-4), msg=f"{scene} {name}")
                    compared += 1
        self.assertGreater(compared, 10)

    def test_the_page_has_the_table_of_the_measured_file(self):
        self.assertIn(report.table(results.read(MEASURED)), PAGE.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
