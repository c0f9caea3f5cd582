"""Would the benchmark see it? Answers with a known mistake go in, and the figure must be the mistake's size.

    /usr/bin/python3 -m unittest -v test_benchmark          (in this folder)"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import bodies
import figures
import loop
import nrrd
import result as results
import scene as scenes
import truth

HERE = pathlib.Path(__file__).resolve().parent


def scene_of(name):
    return scenes.Scene(HERE / f"scenes/{name}.json")


def answer_of(scene, force_B=None, tool_B=None):
    count = len(scene.way.p)
    force = np.zeros((count, 3)) if force_B is None else force_B
    return figures.Answer(force, np.zeros((count, 3)), scene.way.p if tool_B is None else tool_B, np.full(count, 10.0), np.zeros(count))


def true_forces(scene, is_rigid=False, factor=1.0):
    """The truth where the hand holds, nothing elsewhere."""
    force = np.zeros((len(scene.way.p), 3))
    for a, b in scene.way.holds():
        force[a:b] = factor * truth.Truth(scene, is_rigid).at(scene.way.p[a], scene.way.R[a]).force
    return force


class Figures(unittest.TestCase):
    def test_a_stiffer_program_is_off_by_as_much(self):
        for name in ("plane", "sphere", "slot", "thin_wall"):
            scene = scene_of(name)
            for factor, off in ((1.0, 0.0), (1.1, 10.0), (0.9, 10.0)):
                told = figures.errors(scene, answer_of(scene, true_forces(scene, False, factor)), [])
                self.assertAlmostEqual(told["force_error"]["value"], off, 6, name)
                told = figures.errors(scene, answer_of(scene, true_forces(scene, True, factor)), [])
                self.assertAlmostEqual(told["rigid_force_error"]["value"], off, 6, name)

    def test_a_wrong_torque_shows(self):
        scene = scene_of("peg")
        answer = answer_of(scene, true_forces(scene))
        for a, b in scene.way.holds():
            answer.torque[a:b] = 1.2 * truth.Truth(scene, False).at(scene.way.p[a], scene.way.R[a]).torque
        self.assertAlmostEqual(figures.errors(scene, answer, ["turn"])["torque_error"]["value"], 20, 6)
        self.assertIsNone(figures.errors(scene, answer, [])["torque_error"]["value"])

    def test_friction_is_what_the_drag_does_not_explain(self):
        scene = scene_of("plane")
        speed = np.gradient(scene.way.p, axis=0) * scenes.RATE_HZ
        force = np.tile([0, 0, 2.0], (len(scene.way.p), 1)) - 3 * speed
        self.assertAlmostEqual(figures.drag(scene, answer_of(scene, force)), 3, 6)
        friction, step, _ = figures.sliding(scene, answer_of(scene, force), 3)
        self.assertLess(friction, 1e-6)
        self.assertLess(step, 1e-6)
        row = np.flatnonzero(scene.way.phase == "slide")[100]
        force[row, 0] += 0.1
        friction, step, _ = figures.sliding(scene, answer_of(scene, force), 3)
        self.assertAlmostEqual(friction, 5, 3)
        self.assertAlmostEqual(step, 0.1, 6)

    def test_a_lost_bone_has_no_friction(self):
        scene = scene_of("plane")
        friction, _, why = figures.sliding(scene, answer_of(scene), 0)
        self.assertIsNone(friction)
        self.assertIn("lost", why)

    def test_a_spring_gives_nothing_and_a_whirl_does(self):
        scene = scene_of("plane")
        spring = -100 * scene.way.p
        self.assertLess(abs(figures.energies(scene, answer_of(scene, spring))[0]), 1e-6)
        whirl = spring + 50 * np.cross([0, -1.0, 0], scene.way.p)
        area = self._area(scene)
        self.assertAlmostEqual(figures.energies(scene, answer_of(scene, whirl))[0], 2 * 50 * area * 1e6, 3)

    @staticmethod
    def _area(scene):
        """Of the second round in the plane of x and z, counted towards +y's left hand."""
        rows = np.flatnonzero(scene.way.loop == 2)
        x, z = scene.way.p[np.concatenate([[rows[0] - 1], rows])][:, (0, 2)].T
        return float(np.sum(x[:-1] * z[1:] - x[1:] * z[:-1]) / 2)

    def test_a_tool_beyond_the_wall_is_not_kept(self):
        scene = scene_of("thin_wall")
        force, tool = true_forces(scene), scene.way.p.copy()
        tool[:, 2] = 0.001
        self.assertEqual(figures.wall_kept(scene, answer_of(scene, force, tool)), 1)
        a, b = scene.way.holds()[1]
        tool[a:b, 2] = -0.001
        self.assertAlmostEqual(figures.wall_kept(scene, answer_of(scene, force, tool)), 2 / 3)


class Removal(unittest.TestCase):
    def test_a_hole_is_measured_and_half_of_it_too(self):
        scene = scene_of("break_through")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            scene.write(folder)
            values, spacing, origin = nrrd.read(folder / "volume.nrrd")
            grid = np.stack(np.meshgrid(*(origin[a] + spacing[a] * np.arange(values.shape[a]) for a in range(3)), indexing="ij"), axis=-1)
            p_B = scene.placement.to_body(grid)
            middle = scene.way.p[0]
            hole = np.hypot(p_B[..., 0] - middle[0], p_B[..., 1] - middle[1]) - scene.radius
            for share, want in ((1.0, 0.0), (0.5, -50.0)):
                inside = hole if share == 1 else np.maximum(hole, p_B[..., 0] - middle[0])
                gone = np.clip(np.rint(bodies.ISO * (1 + inside / (bodies.RAMP_VOXELS * spacing[0]))), 0, bodies.FULL)
                nrrd.write(folder / "after.nrrd", np.minimum(values, gone).astype(np.uint16), spacing[0], origin)
                self.assertAlmostEqual(figures.removal(scene, folder / "volume.nrrd", folder / "after.nrrd")[0], want, delta=1.5)
            self.assertEqual(figures.removal(scene, folder / "volume.nrrd", folder / "volume.nrrd")[0], -100)


class Wall:
    """A program in this process: a spring."""

    def __init__(self, stiffness):
        self.scene, self.stiffness = scene_of("plane"), stiffness

    def force(self, z):
        return self.stiffness * max(self.scene.radius - z, 0.0)


class ClosedLoop(unittest.TestCase):
    def test_a_soft_wall_is_quiet_and_a_hard_one_is_not(self):
        soft = loop.press(Wall(3000))
        self.assertTrue(soft.is_quiet)
        self.assertAlmostEqual(soft.rendered, 3000, delta=1)
        self.assertFalse(loop.press(Wall(60000)).is_quiet)


class Run(unittest.TestCase):
    """The whole command, with the program of one page."""

    def run_it(self, folder, *words):
        return subprocess.run([sys.executable, str(HERE / "run"), "--out", folder, *words], capture_output=True, text=True, check=False)

    def test_ten_percent_more_stiffness_is_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            program = str(HERE / "adapters/pure_python")
            done = self.run_it(folder, "--quick", "--scene", "thin_wall", "--program", "pure_python",
                               "--program", f"{program} --stiffer 1.1")
            self.assertEqual(done.returncode, 0, done.stderr)
            result = results.read(pathlib.Path(folder) / "result.json")
            right, stiffer = (program["scenes"]["thin_wall"]["rigid_force_error"]["value"] for program in result["programs"])
            self.assertLess(right, 3)
            self.assertAlmostEqual(stiffer, 10, delta=3)
            self.assertGreater((pathlib.Path(folder) / "errors.png").stat().st_size, 5000)
            self.assertIn("| pure python 2 |", (pathlib.Path(folder) / "report.md").read_text(encoding="utf-8"))
            answers = pathlib.Path(folder).glob("programs/*/thin_wall/answer.csv")
            self.assertEqual(len({answer.read_bytes() for answer in answers}), 2, "both say that they are pure python")

    def test_what_a_program_cannot_do_is_null_with_its_words(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_it(folder, "--quick", "--scene", "edge_slide", "--scene", "ct_spine", "--program", "pure_python")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("ct_spine is left out", done.stdout)
            told = results.read(pathlib.Path(folder) / "result.json")["programs"][0]["scenes"]["edge_slide"]
            self.assertEqual({one["value"] for one in told.values()}, {None})
            self.assertIn("no tool but a ball", told["step_per_tick"]["reason"])

    def test_wrong_words_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            for words in (["--program", "no_such_program"], ["--scene", "moon"], ["--program", "/bin/true"]):
                self.assertEqual(self.run_it(folder, *words).returncode, 2, words)

    def test_a_wrong_answer_is_refused(self):
        scene = scene_of("thin_wall")
        rows = len(scene.way.p)
        zeros = [["0"] * 6] * rows
        for table, words in (([figures.NEEDED, ["0"] * 6], "1 rows"), ([figures.NEEDED, *zeros[1:], ["0"] * 5], "no number"),
                             ([[*figures.NEEDED, "tx_nm"], *([row + ["0"] for row in zeros])], "ty_nm"),
                             ([figures.NEEDED, *zeros[1:], ["nan"] * 6], "finite")):
            with tempfile.TemporaryDirectory() as name:
                path = pathlib.Path(name) / "answer.csv"
                with open(path, "w", newline="", encoding="utf-8") as file:
                    csv.writer(file).writerows(table)
                with self.assertRaisesRegex(ValueError, words):
                    figures.read_answer(scene, path)

    def test_a_volume_of_another_shape_is_refused(self):
        scene = scene_of("groove")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            nrrd.write(folder / "before.nrrd", np.zeros((4, 4, 4), np.uint16), 1e-3, (0, 0, 0))
            nrrd.write(folder / "after.nrrd", np.zeros((4, 4, 5), np.uint16), 1e-3, (0, 0, 0))
            with self.assertRaisesRegex(ValueError, "shape"):
                figures.removal(scene, folder / "before.nrrd", folder / "after.nrrd")
            (folder / "after.nrrd").write_bytes(b"NRRD0004\ntype: uint16\n\n")
            with self.assertRaisesRegex(ValueError, "after.nrrd"):
                figures.removal(scene, folder / "before.nrrd", folder / "after.nrrd")

    def test_a_program_that_never_answers_is_ended(self):
        silent = ["/bin/sh", "-c", "echo ready; exec sleep 1000"]
        with self.assertRaises(ValueError):
            program = loop.Program(silent, pathlib.Path("."), scene_of("plane"), most_s=0.5)
            try:
                program.force(0.0)
            finally:
                program.close()
        self.assertIsNotNone(program.process.returncode)


class ResultFile(unittest.TestCase):
    def result(self):
        told = results.begin(True)
        told["machine"]["load_after"] = 0.0
        plane = {"force_error": figures.figure("force_error", 1.5)}
        told["programs"].append({"name": "p", "version": "1", "notes": "", "can": [], "figures": {}, "scenes": {"plane": plane}})
        return told, plane

    def test_a_right_one_is_right(self):
        told, _ = self.result()
        self.assertEqual(results.faults(json.loads(json.dumps(told))), [])

    def test_mistakes_are_named(self):
        for wrong in ({"value": 1.0, "unit": "N"}, {"value": "1", "unit": "%"}, {"value": None, "unit": "%"},
                      {"value": None, "unit": "%", "reason": ""}):
            told, plane = self.result()
            plane["force_error"] = wrong
            self.assertEqual(len(results.faults(told)), 1, wrong)
        told, plane = self.result()
        plane["beauty"] = figures.figure("force_error", 1.0)
        self.assertEqual(results.faults(told), ["p, plane: beauty is no figure"])
        self.assertTrue(results.faults({"format": "another"}))


if __name__ == "__main__":
    unittest.main()
