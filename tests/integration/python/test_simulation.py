"""bonemill.Scene and Simulation: the tick of `haptic_server simulate`, one call a tick."""
import ast
import json
import os
import pathlib
import shutil
import signal
import threading
import warnings
import unittest

import numpy as np

import bonemill
from place import BIN, BLOCK, SCENES, SOURCE, TASK, Folder, run, without_memory

DOWN = np.linspace([0, 0, 3e-3], [0.2e-3, 0.1e-3, 1.6e-3], 300)


def written(path, way):
    numbers = np.column_stack([way["t_s"], way["positions_m"], way["orientations_wxyz"]])
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

    def test_an_effect_that_is_taken_away_was_never_there(self):
        def hash_of(listed, **options):
            sim = bonemill.Scene.load(self.scene(BLOCK.replace("time_removal { }", listed))).simulation(**options)
            sideways = np.linspace([0, 0, 0], [1e-3, 0, 0], len(DOWN))
            sim.run(DOWN + sideways, buttons=(np.arange(len(DOWN)) >= 230).astype(int))  # it rubs, then mills
            return sim.state_hash

        without, with_it = hash_of("time_removal { }"), "time_removal { } surface_friction { coefficient: 0.5 }"
        self.assertNotEqual(hash_of(with_it), without)
        self.assertEqual(hash_of(with_it, effects={"surface_friction": False}), without)
        self.assertEqual(hash_of(with_it, effects={"surface_friction": np.False_}), without)
        self.assertEqual(hash_of(with_it, effects={"surface_friction": False, "time_removal": False}), hash_of(""))

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
        # What was chosen for the next tick comes back, too, and a judgement does not stay.
        sim.reset()
        sim.tool = 2
        chosen = sim.checkpoint()
        sim.tool = "2 mm"
        sim.restore(chosen)
        self.assertEqual(sim.tool, "4 mm")
        with self.assertRaisesRegex(bonemill.Error, "of another scene"):
            self.simulation(settings=["contact.stiffness_n_per_mm3=500"]).restore(checkpoint)
        with self.assertRaisesRegex(bonemill.Error, "keeps no inputs"):
            self.simulation(keep_inputs=False).checkpoint()

    def test_ctrl_c_ends_a_restore(self):
        sim = self.simulation()
        sim.run(np.tile([0, 0, 5e-3], (100_000, 1)))
        checkpoint, then = sim.checkpoint(), sim.state_hash
        sim.reset()
        threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            sim.restore(checkpoint)
        self.assertLess(sim.ticks, checkpoint.ticks, "it was run to the end all the same")
        for call in (lambda: sim.step([0, 0, 5e-3]), sim.checkpoint):
            with self.assertRaisesRegex(bonemill.Error, r"half way between two states: reset\(\) or restore\(\)"):
                call()
        sim.restore(checkpoint)
        self.assertEqual((sim.ticks, sim.state_hash), (checkpoint.ticks, then))
        sim.step([0, 0, 5e-3])

    def test_without_memory_it_stays_in_one_piece(self):
        """A beginning that fails leaves a run that says so, and that can begin anew."""
        made = run(BIN / "make_phantom", "body", "--kind", "slab", "--dims", "300", "300", "300", "--thickness-mm", "30",
                   "--out", self.folder / "block.nrrd")
        self.assertEqual(made.returncode, 0, made.stderr)
        done = without_memory("sim = bonemill.Scene.load(%r).simulation()\nbegin, step = sim.reset, lambda: sim.step([0, 0, 0.02])"
                              % str(self.scene()))
        self.assertEqual(done.stdout.split("\n")[0], "MemoryError", done.stderr)
        self.assertIn("half way between two states: reset()", done.stdout)
        self.assertTrue(done.stdout.endswith("begun\n"), done.stdout + done.stderr)

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
            "pose is not finite": lambda: sim.step([0, np.nan, 0]),
            "of length 0.0+, not 1": lambda: sim.step([0, 0, 0], [0, 0, 0, 0]),
            "of length 0.99": lambda: sim.step([0, 0, 0], [0.99, 0, 0, 0]),
            "millimetres": lambda: sim.step([0, 0, 1.4]),
            "position_m: expected real numbers": lambda: sim.step("abc"),
            "rows of equal length": lambda: sim.run([[0, 0, 0], [0, 0]]),
            "row 200: the hand's pose is not finite": lambda: sim.run(np.where(np.arange(300)[:, None] == 200, np.nan, DOWN)),
            "buttons: expected whole numbers": lambda: sim.step([0, 0, 0], buttons=1.0),
            "got -1": lambda: sim.run(np.zeros((2, 3)), buttons=[0, -1]),
            "got 8589934592": lambda: sim.run(np.zeros((1, 3)), buttons=[2**33]),
            "row 1: the tick's time is not after": lambda: sim.run(np.zeros((2, 3)), t_s=[1, 1]),
            "expected a list of PATH=VALUE": lambda: scene.simulation(settings="a=b"),
            "expected a mapping": lambda: scene.simulation(effects=["thermal"]),
            r"positions_m: expected an array of shape \(N, 3\)": lambda: sim.run(np.zeros((5, 2))),
            r"orientations_wxyz: .*\(5, 4\)": lambda: sim.run(np.zeros((5, 3)), np.zeros((4, 4))),
            r"t_s: expected an array of shape \(5,\)": lambda: sim.run(np.zeros((5, 3)), t_s=[0, 1]),
            "time is not finite": lambda: sim.run(np.zeros((1, 3)), t_s=[np.inf]),
            "buttons: expected an array": lambda: sim.run(np.zeros((5, 3)), buttons=[1, 2]),
            "no such scene file": lambda: bonemill.Scene.load(self.folder / "no.textproto"),
            "unknown field": lambda: scene.simulation(settings=["volume.colour=3"]),
            "unknown field `glitter`": lambda: scene.simulation(effects={"glitter": True}),
            "has no `thermal` to take away": lambda: scene.simulation(effects={"thermal": False}),
            "thermal is True, False or its fields, got 1": lambda: scene.simulation(effects={"thermal": 1}),
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

    def must_refuse_a_second(self, first, second, rounds):
        """Two threads in one run: one is refused, and nothing worse happens."""
        refused, stop = [], threading.Event()

        def attempt(call):
            try:
                call()
            except bonemill.Error as error:
                refused.append(str(error))

        def others():
            while not stop.is_set():
                attempt(second)

        thread = threading.Thread(target=others)
        thread.start()
        for _ in range(rounds):
            attempt(first)
        stop.set()
        thread.join()
        self.assertTrue(refused)
        self.assertIn("one thread at a time", refused[0])

    def test_one_thread_at_a_time(self):
        sim = self.simulation()
        self.must_refuse_a_second(lambda: sim.run(np.tile(DOWN[-1], (2000, 1))), lambda: sim.step([0, 0, 5e-3]), 20)

    def test_a_run_that_begins_anew_is_nobody_else_s(self):
        sim = self.simulation()
        self.must_refuse_a_second(sim.reset, lambda: (sim.state_hash, sim.ticks, sim.spacing_m), 40)

    def test_rows_that_are_not_believed_are_told_of(self):
        with self.assertWarnsRegex(RuntimeWarning, "1 of 3 rows were not believed"):
            self.simulation().run([[0, 0, 3e-3], [0, 0, 3e-3], [0, 0, 13e-3]])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.simulation().run(DOWN)

    # Eight bytes a step would make 2.7 MB.
    def test_steps_leak_nothing(self):
        sim = self.simulation(keep_inputs=False)
        way = np.vstack([DOWN[:250], DOWN[249::-1]])  # into the bone, and out

        def megabytes():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20

        def steps(count):
            for _ in range(count // len(way)):
                for position in way:
                    sim.step(position, buttons=bonemill.REMOVE)

        steps(50_000)
        before = megabytes()
        steps(350_000)
        self.assertEqual(sim.ticks, 400_000)
        self.assertLess(megabytes() - before, 2)

    def test_the_types_name_what_is_there(self):
        named = ast.parse((pathlib.Path(bonemill.__file__).parent / "_bonemill.pyi").read_text()).body
        for entry in named:
            if isinstance(entry, ast.ClassDef) and entry.name != "Error":
                names = {part.target.id if isinstance(part, ast.AnnAssign) else part.name for part in entry.body
                         if isinstance(part, (ast.AnnAssign, ast.FunctionDef))} - {"__init__"}
                there = {name for name in vars(getattr(bonemill, entry.name)) if not name.startswith("_")}
                self.assertEqual(names, there, entry.name)
            elif isinstance(entry, ast.FunctionDef):
                self.assertTrue(callable(getattr(bonemill, entry.name)))


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
        checkpoint = sim.checkpoint()
        sim.step(DOWN[-1])
        with self.assertRaisesRegex(bonemill.Error, "was judged after 300 ticks"):
            sim.judge()
        sim.restore(checkpoint)
        self.assertEqual(sim.judge(), judged)
        self.assertAlmostEqual(judged["figures"]["time.session"], 0.299, places=6)
        sim.begin_attempt()
        sim.run(DOWN[::-1][:101])
        self.assertAlmostEqual(sim.judge()["figures"]["time.session"], 0.1, places=6)


class OfShippedScenes(Folder):
    TICKS = 300
    WITHOUT_A_PHANTOM = {"mastoid", "tooth_wall"}  # their volumes come with a Debian package, and from the demo

    def setUp(self):
        """Scenes and phantoms lie to each other as in the repository; the largest phantom is a coarse one."""
        super().setUp()
        self.scenes = shutil.copytree(SCENES, self.folder / "deploy" / "scenes")
        data = self.folder / "build" / "data"
        data.mkdir(parents=True)
        bone = data / "temporal_bone"
        for words in ([BIN / "make_phantom", "temporal_bone", "--voxel-mm", 0.5, "--out", f"{bone}.nrrd",
                       "--labels", f"{bone}_labels.nrrd"], ["touch", f"{bone}.made"],
                      [SOURCE / "deploy" / "make-phantoms", "--bin", BIN, "--out", data]):
            made = run(*words)
            self.assertEqual(made.returncode, 0, made.stderr)

    def test_run_is_simulate(self):
        """From where each scene's own hand first presses its pedal, or from the middle of its way."""
        for file in sorted(self.scenes.glob("*.textproto")):
            with self.subTest(file.stem):
                try:
                    sim = bonemill.Scene.load(file).simulation()
                except bonemill.Error as error:
                    self.assertIn(file.stem, self.WITHOUT_A_PHANTOM, error)
                    self.skipTest(str(error))
                way = bonemill.scripted_hand(sim)
                pressed = np.flatnonzero(way["buttons"])
                first = pressed[0] if len(pressed) else len(way["t_s"]) // 2
                way = {name: column[first:first + self.TICKS] for name, column in way.items()}
                told = run(BIN / "haptic_server", "simulate", "--scene", file, "--trajectory",
                           written(self.folder / "way.csv", way))
                self.assertEqual(told.returncode, 0, told.stderr)
                sim.run(**way)
                self.assertEqual(f"{sim.state_hash:016x}", json.loads(told.stdout)["state_hash"])


if __name__ == "__main__":
    unittest.main()
