"""bonemill.Scene and Simulation: the tick of `haptic_server simulate`, one call a tick."""
import json
import resource
import threading
import unittest

import numpy as np

import bonemill
from place import BIN, BLOCK, SCENES, TASK, Folder, run

DOWN = np.linspace([0, 0, 3e-3], [0.2e-3, 0.1e-3, 1.6e-3], 300)


def written(path, way):
    numbers = np.column_stack([np.arange(len(way["t_s"])) * 1e-3, way["positions_m"], way["orientations_wxyz"]])
    rows = (",".join(repr(float(x)) for x in row) + f",{pressed}\n" for row, pressed in zip(numbers, way["buttons"]))
    path.write_text("t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n" + "".join(rows))
    return path


class OfABlock(Folder):
    def simulation(self, **options):
        return bonemill.Scene.load(self.scene()).simulation(**options)

    def test_step_and_run_come_to_the_same_bits(self):
        one, other = self.simulation(), self.simulation()
        columns = one.run(DOWN, buttons=bonemill.REMOVE)
        results = [other.step(position, buttons=bonemill.REMOVE) for position in DOWN]
        self.assertEqual(one.state_hash, other.state_hash)
        np.testing.assert_array_equal(columns["force_n"], [result.force_n for result in results])
        np.testing.assert_array_equal(columns["tool_p_m"], [result.tool_position_m for result in results])
        self.assertAlmostEqual(columns["removed_mm3"].sum(), sum(result.removed_mm3 for result in results))
        self.assertGreater(columns["removed_mm3"].sum(), 0.5)
        self.assertGreater(np.linalg.norm(columns["force_n"], axis=1).max(), 0.005)

    def test_the_force_on_a_plane_is_the_coupling_s(self):
        sim = self.simulation()
        for _ in range(400):
            result = sim.step([0, 0, 2.2e-3])  # the ball's lowest point 0.05 mm in, no button
        self.assertGreater(result.contacts, 0)
        np.testing.assert_allclose(result.force_n[:2], 0, atol=2e-3)
        # The coupling of 3 N/mm holds what contact carries: the hand is that much lower than the tool.
        lower = result.tool_position_m[2] - result.hand_position_m[2]
        self.assertAlmostEqual(result.force_n[2], 3000 * lower, delta=2e-3)
        self.assertGreater(result.force_n[2], 0.02)

    def test_a_checkpoint_is_restored_to_the_bit(self):
        sim = self.simulation()
        sim.run(DOWN[:200], buttons=1)
        checkpoint, then = sim.checkpoint(), sim.state_hash
        sim.tool = "4 mm"
        after = sim.run(DOWN[200:], buttons=1)
        end = sim.state_hash
        sim.restore(checkpoint)
        self.assertEqual((sim.ticks, sim.state_hash, sim.tool), (200, then, "2 mm"))
        sim.tool = "4 mm"
        again = sim.run(DOWN[200:], buttons=1)
        self.assertEqual(sim.state_hash, end)
        np.testing.assert_array_equal(after["force_n"], again["force_n"])
        sim.reset()
        sim.restore(checkpoint)
        self.assertEqual(sim.state_hash, then)
        with self.assertRaisesRegex(bonemill.Error, "keeps no inputs"):
            self.simulation(keep_inputs=False).checkpoint()

    def test_voxels_are_one_array_that_is_brought_up_to_date(self):
        sim = self.simulation()
        voxels = sim.voxels()
        before = voxels.copy()
        self.assertEqual(voxels.shape, (40, 40, 40))
        removed = sim.run(DOWN, buttons=1)["removed_voxels"].sum()
        np.testing.assert_array_equal(voxels, before)
        self.assertIs(sim.voxels(), voxels)
        gone = (before >= sim.iso_density) & (voxels < sim.iso_density)
        self.assertEqual(gone.sum(), removed)
        other = self.simulation()
        other.run(DOWN, buttons=1)
        np.testing.assert_array_equal(other.voxels(), voxels)
        sim.reset()
        np.testing.assert_array_equal(sim.voxels(), before)
        with self.assertRaises(ValueError):
            voxels[0, 0, 0] = 1

    def test_the_mesh_is_closed_and_has_the_bone_s_volume(self):
        sim = self.simulation()
        sim.run(DOWN, buttons=1)
        vertices, triangles = sim.mesh()
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        self.assertTrue((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())
        a, b, c = (vertices[triangles[:, n]] for n in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        voxels = (sim.voxels() >= sim.iso_density).sum() * np.prod(sim.spacing_m)
        self.assertAlmostEqual(volume / voxels, 1, delta=0.06)
        tool, _ = sim.tool_mesh()
        np.testing.assert_allclose(np.linalg.norm(tool, axis=1), sim.burr_radius_m, rtol=0.01)

    def test_what_is_wrong_is_one_line(self):
        sim = self.simulation()
        scene = bonemill.Scene.load(self.scene())
        wrong = {
            "position_m: expected 3 numbers": lambda: sim.step([0, 0]),
            "orientation_wxyz: expected 4": lambda: sim.step([0, 0, 0], [1, 0, 0]),
            "not finite": lambda: sim.step([0, np.nan, 0]),
            "quaternion is 0": lambda: sim.step([0, 0, 0], [0, 0, 0, 0]),
            r"positions_m: expected an array of shape \(N, 3\)": lambda: sim.run(np.zeros((5, 2))),
            r"orientations_wxyz: .*\(5, 4\)": lambda: sim.run(np.zeros((5, 3)), np.zeros((4, 4))),
            "buttons: expected": lambda: sim.run(np.zeros((5, 3)), buttons=[1, 2]),
            "no such scene file": lambda: bonemill.Scene.load(self.folder / "no.textproto"),
            "unknown field": lambda: scene.simulation(settings=["volume.colour=3"]),
            "unknown field `glitter`": lambda: scene.simulation(effects={"glitter": True}),
            "cannot be taken away": lambda: scene.simulation(effects={"time_removal": False}),
            "expected one of fast": lambda: scene.simulation(accuracy="best"),
            "accuracy of its own": lambda: scene.simulation(accuracy="exact", law="vps"),
            "no tool of the scene": lambda: scene.simulation(tool="saw"),
            "no task to judge": sim.judge,
            "cannot be opened": lambda: bonemill.read_recording(self.folder / "no.mcap"),
        }
        for words, call in wrong.items():
            with self.subTest(words), self.assertRaisesRegex(bonemill.Error, words) as caught:
                call()
            self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(sim.ticks, 0, "what was refused has not run")

    def test_one_thread_at_a_time(self):
        sim = self.simulation()
        refused, stop = [], threading.Event()

        def poke():
            while not stop.is_set():
                try:
                    sim.step([0, 0, 5e-3])
                except bonemill.Error as error:
                    refused.append(str(error))

        thread = threading.Thread(target=poke)
        thread.start()
        ran = 0
        while not refused and ran < 200:
            try:
                sim.run(np.tile(DOWN[-1], (2000, 1)))
                ran += 1
            except bonemill.Error as error:
                refused.append(str(error))
        stop.set()
        thread.join()
        self.assertTrue(refused)
        self.assertIn("one thread at a time", refused[0])

    def test_a_million_steps_leak_nothing(self):
        sim = self.simulation(keep_inputs=False)

        def megabytes():
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

        def steps(count):
            for _ in range(count):
                sim.step(DOWN[0])

        steps(100_000)
        before = megabytes()
        steps(900_000)
        self.assertLess(megabytes() - before, 2)


class OfATask(Folder):
    def test_progress_counts_what_is_gone_of_each_zone(self):
        sim = bonemill.Scene.load(self.scene(BLOCK + TASK)).simulation()
        start = sim.progress()
        self.assertAlmostEqual(start["ideal_mm3"], 2 * np.pi, delta=0.4)
        np.testing.assert_allclose(start["target_centre_m"], [0, 0, 0.25e-3], atol=0.13e-3)
        columns = sim.run(DOWN, buttons=1)
        now = sim.progress()
        self.assertAlmostEqual(now["removed_mm3"], columns["removed_voxels"].sum() * 0.125**3, places=6)
        self.assertGreater(now["ideal_removed_mm3"], 0.2)
        self.assertEqual(now["zones"][0]["removed_mm3"], now["ideal_removed_mm3"])
        judged = sim.judge()
        self.assertEqual(judged, sim.judge())
        self.assertAlmostEqual(judged["figures"]["target.removed"],
                               100 * now["ideal_removed_mm3"] / now["ideal_mm3"], delta=1e-6)
        sim.step(DOWN[-1])
        with self.assertRaisesRegex(bonemill.Error, "was judged after 300 ticks"):
            sim.judge()


class OfShippedScenes(Folder):
    TICKS = 300

    def test_run_is_simulate(self):
        """From where each scene's own hand first presses its pedal, or from the middle of its way."""
        for file in sorted(SCENES.glob("*.textproto")):
            with self.subTest(file.stem):
                try:
                    sim = bonemill.Scene.load(file).simulation()
                except bonemill.Error as error:
                    self.assertIn("make-phantoms", str(error) + "make-phantoms" * ("invesalius" in str(error)))
                    continue  # its volume is made by a longer run, or comes with a package
                way = bonemill.scripted_hand(sim)
                pressed = np.flatnonzero(way["buttons"])
                first = pressed[0] if len(pressed) else len(way["t_s"]) // 2
                way = {name: column[first:first + self.TICKS] for name, column in way.items()}
                told = run(BIN / "haptic_server", "simulate", "--scene", file, "--trajectory",
                           written(self.folder / "way.csv", way))
                self.assertEqual(told.returncode, 0, told.stderr)
                sim.run(*(way[name] for name in ("positions_m", "orientations_wxyz", "buttons")))
                self.assertEqual(f"{sim.state_hash:016x}", json.loads(told.stdout)["state_hash"])


if __name__ == "__main__":
    unittest.main()
