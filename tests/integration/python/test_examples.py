"""The examples run, and say what the docs say of them."""
import pathlib
import re
import sys
import unittest

from place import BLOCK, SOURCE, TESTS, Folder, run

EXAMPLES = SOURCE / "haptic_server" / "apps" / "python" / "examples"
WAY = """simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 2.6 } q_WT { w: 1 } }
  waypoint { time_s: 0.2 p_WT_mm { z: 2.1 } q_WT { w: 1 } }
  waypoint { time_s: 0.6 p_WT_mm { x: 0.5 z: 2.1 } q_WT { w: 1 } }
}
"""


class Examples(Folder):
    def example(self, name, *words):
        done = run(sys.executable, EXAMPLES / f"{name}.py", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_the_closed_loop_is_the_stability_grid_s_row(self):
        """With its tool, its voxels and its wall, on the plane: docs/research/stability_cases.csv."""
        rows = dict(re.findall(r"^(loop_grid_plane_\w+),\w+,[\d.]+,balanced,(\S+)", next(
            path for path in SOURCE.glob("docs/**/stability_cases.csv")).read_text(), re.M))
        self.assertEqual(rows["loop_grid_plane_one_tick"], "<1e-6")
        scene = self.scene(BLOCK + "contact { thinnest_wall_mm: 2 }")
        worst = re.search(r"worst (\S+) N RMS", self.example("closed_loop", scene, "--delay", "1"))[1]
        self.assertLess(float(worst), 1e-6)
        share = re.search(r"(\S+) % of 24", self.example("closed_loop", scene, "--delay", "3"))[1]
        self.assertEqual(float(share), float(rows["loop_grid_plane_three_ticks"]))

    def test_accuracy_and_laws(self):
        scene = self.scene(BLOCK + WAY)
        picture = self.folder / "price.png"
        told = self.example("price_of_accuracy", scene, "--plot", picture)
        errors = dict((name, float(error)) for name, error in re.findall(r"^(\w+) +([\d.]+) ", told, re.M))
        self.assertEqual(errors["exact"], 0)
        self.assertLessEqual(errors["balanced"], errors["fast"])
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        told = self.example("two_laws", scene, "--laws", "gradient,constraint", "--plot", self.folder / "laws.png")
        forces = [float(force) for force in re.findall(r"force p95 +([\d.]+)", told)]
        self.assertEqual(len(forces), 2)
        self.assertGreater(min(forces), 0.1)

    def test_the_figure_of_the_thesis(self):
        told = self.example("corridor_figure", self.scene(BLOCK + WAY), "--plot", self.folder / "corridor.png")
        self.assertGreater(float(re.search(r"largest (\S+) N;", told)[1]), 0.1)

    def test_what_if(self):
        self.assertEqual(run(TESTS / "recorded_session_maker", self.folder, "--without-orders").returncode, 0)
        told = self.example("counterfactual", self.folder / "session.mcap", "--at", "0.9", "--shift-mm", "0", "0", "0.3")
        happened, otherwise = map(float, re.search(
            r"removed mm3 +as it happened +(\S+) +otherwise +(\S+)", told).groups())
        self.assertLess(otherwise, happened)


if __name__ == "__main__":
    unittest.main()
