"""Depth pictures, against bodies whose surface is known, and in what bonemill.gym observes."""
import json
import os
import subprocess
import sys
import time
import unittest

import numpy as np

import bonemill
import bonemill.gym
from place import BIN, BLOCK, TASK, Folder, run

VOXEL_M = 0.125e-3
DOWN = np.linspace([0, 0, 3e-3], [0, 0, 1.6e-3], 300)


def rays_of(camera):
    """Unit depth along each pixel's ray: (height, width, 3), in C."""
    edge = 2 * np.tan(np.radians(camera.fov_degrees) / 2) / camera.height
    x = edge * (np.arange(camera.width) + 0.5 - camera.width / 2)
    y = edge * (camera.height / 2 - np.arange(camera.height) - 0.5)
    return np.stack(np.broadcast_arrays(x, y[:, None], -1.0), axis=-1)


def rotated(q, v):
    w, u = q[0], np.asarray(q[1:])
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


class OfAPlate(Folder):
    """Its upper face is z = 1.25 mm; the grid ends 2.44 mm beside the middle."""

    def simulation(self):
        return bonemill.Scene.load(self.scene()).simulation()

    def test_a_plate_is_as_far_away_as_it_is(self):
        camera = bonemill.DepthCamera([0, 0, 11.25e-3], [1, 0, 0, 0], fov_degrees=20, width=60, height=40)
        seen = self.simulation().depth(camera)
        self.assertEqual((seen.shape, seen.dtype), ((40, 60), np.float32))
        inside = np.abs(rays_of(camera)[..., :2] * 10e-3).max(axis=-1) < 2.2e-3
        self.assertGreater(inside.sum(), 1000)
        np.testing.assert_allclose(seen[inside], 10e-3, atol=0.1 * VOXEL_M)
        aside = bonemill.DepthCamera([0, 0, 11.25e-3], [1, 0, 0, 0], fov_degrees=60, far_m=0.05)
        beyond = np.abs(rays_of(aside)[..., :2] * 10e-3).max(axis=-1) > 2.8e-3
        self.assertTrue((self.simulation().depth(aside)[beyond] == np.float32(0.05)).all())

    def test_a_slanted_look_is_perspective(self):
        at, eye = np.array([0, 0, 1.25e-3]), np.array([4e-3, -3e-3, 8e-3])
        camera = bonemill.DepthCamera.looking(eye, at, fov_degrees=12)
        way = rotated(camera.orientation_wxyz, rays_of(camera))
        expected = (at[2] - eye[2]) / way[..., 2]
        hits = np.abs((eye + expected[..., None] * way)[..., :2]).max(axis=-1) < 2.2e-3
        self.assertGreater(hits.sum(), 3000)
        np.testing.assert_allclose(self.simulation().depth(camera)[hits], expected[hits], atol=0.3 * VOXEL_M)

    def test_a_look_along_the_borders_of_the_voxels_comes_to_an_end(self):
        for voxels in (31, 63):
            made = run(BIN / "make_phantom", "body", "--kind", "slab", "--voxel-mm", 0.125, "--dims", *[voxels] * 3,
                       "--thickness-mm", 1, "--out", self.folder / "block.nrrd")
            self.assertEqual(made.returncode, 0, made.stderr)
            sim = self.simulation()
            for eye in ([0.03, 0, 0], [-0.03, 0, 0], [0, 0.03, 0]):
                camera = bonemill.DepthCamera.looking(eye, [0, 0, 0], width=85, height=85)
                begin = time.process_time()
                sides = sim.depth(camera)
                self.assertLess(time.process_time() - begin, 20, (voxels, eye))
                # The plate ends with the grid; its side is as far away as it is, above and below of it is nothing.
                self.assertAlmostEqual(sides[42, 42], 0.03 - voxels / 2 * VOXEL_M, delta=VOXEL_M)
                self.assertEqual(sides[0, 42], np.float32(camera.far_m))

    def test_the_hole_that_is_milled_and_the_tool_above_it_are_seen(self):
        sim = self.simulation()
        camera = bonemill.DepthCamera([0, 0, 11.25e-3], [1, 0, 0, 0], fov_degrees=20, width=81, height=81)
        whole = sim.depth(camera)
        sim.run(DOWN, buttons=bonemill.REMOVE)
        tool = sim.step(DOWN[-1]).tool_position_m
        middle = sim.depth(camera)[40, 40]
        self.assertAlmostEqual(middle, 11.25e-3 - (tool[2] + 1e-3), delta=0.02e-3)  # the top of the 1 mm ball
        way = rays_of(camera)
        offset = np.array([0, 0, 11.25e-3]) - tool
        a, b, c = (way**2).sum(-1), way @ offset, offset @ offset - 1e-6
        ball = np.where(b * b - a * c > 0.1e-6 * a, (-b - np.sqrt(np.maximum(b * b - a * c, 0))) / a, np.inf)
        seen = ball < np.inf
        self.assertGreater(seen.sum(), 200)
        np.testing.assert_allclose(sim.depth(camera)[seen], ball[seen], atol=0.05e-3)
        sim.run(DOWN[::-1])
        high = sim.run(np.linspace(DOWN[0], [0, 0, 2e-2], 300))
        self.assertGreater(high["tool_p_m"][-1, 2], camera.position_m[2])  # behind the camera
        hole = sim.depth(camera) - whole
        self.assertGreater(hole[40, 40], 0.3e-3)
        self.assertEqual(np.abs(hole[:5]).max(), 0)

    def test_a_camera_within_bone_or_within_the_tool_sees_what_is_behind(self):
        sim = self.simulation()
        self.assertLess(sim.depth(bonemill.DepthCamera([0, 0, 0], [1, 0, 0, 0])).max(), 1.1e-4)
        sim.step([0, 0, 4e-3])
        through = sim.depth(bonemill.DepthCamera([0, 0, 4e-3], [1, 0, 0, 0], width=3, height=3))
        self.assertAlmostEqual(through[1, 1], 1e-3, delta=0.02e-3)

    def test_what_is_wrong_is_one_line(self):
        sim = self.simulation()
        for words, fields in {"length 1": {"orientation_wxyz": [0.5, 0, 0, 0]}, "not finite": {"position_m": [0, 0, np.nan]},
                              "between 0 and 180": {"fov_degrees": 180}, "pixels": {"width": 0},
                              "whole numbers": {"height": 8.5}, "sees as far as": {"far_m": np.inf},
                              "expected 3 numbers": {"position_m": [0, 0]}}.items():
            camera = bonemill.DepthCamera(**({"position_m": [0, 0, 1e-2], "orientation_wxyz": [1, 0, 0, 0]} | fields))
            with self.subTest(words), self.assertRaisesRegex(bonemill.Error, words) as caught:
                sim.depth(camera)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(bonemill.Error, "along its own up"):
            bonemill.DepthCamera.looking([0, 0, 1], [0, 0, 0])


class OfABall(Folder):
    def test_a_ball_is_as_round_as_it_is(self):
        made = run(BIN / "make_phantom", "body", "--kind", "sphere", "--voxel-mm", "0.125", "--radius-mm", "2",
                   "--dims", "48", "48", "48", "--out", self.folder / "block.nrrd")
        self.assertEqual(made.returncode, 0, made.stderr)
        sim = bonemill.Scene.load(self.scene()).simulation()
        eye = np.array([7e-3, 5e-3, -6e-3])
        camera = bonemill.DepthCamera.looking(eye, [0, 0, 0], up=[1, 0, 0], fov_degrees=30)
        way = rotated(camera.orientation_wxyz, rays_of(camera))
        a, b, c = (way**2).sum(-1), way @ eye, eye @ eye - 4e-6
        seen = sim.depth(camera)
        inside = b * b - a * c > 0.1 * 4e-6 * a
        self.assertGreater(inside.sum(), 1000)
        ball = (-b - np.sqrt(np.maximum(b * b - a * c, 0))) / a
        np.testing.assert_allclose(seen[inside], ball[inside], atol=VOXEL_M)
        self.assertLess(np.abs(seen[inside] - ball[inside]).mean(), 0.1 * VOXEL_M)
        misses = b * b - a * c < -0.1 * 4e-6 * a
        self.assertTrue((seen[misses] == np.float32(camera.far_m)).all())
        # A reproducible picture: the same bits again.
        np.testing.assert_array_equal(seen, sim.depth(camera))


class OfAnEnvironment(Folder):
    CAMERA = bonemill.DepthCamera.looking([6e-3, -6e-3, 8e-3], [0, 0, 1e-3], width=32, height=24, far_m=0.02)

    def test_an_observation_has_the_picture_beside_the_state(self):
        scene = self.scene(BLOCK + TASK)
        env, plain = bonemill.gym.MillingEnv(scene, depth=self.CAMERA), bonemill.gym.MillingEnv(scene)
        seen, _ = env.reset(seed=1)
        state, _ = plain.reset(seed=1)
        self.assertTrue(env.observation_space.contains(seen))
        self.assertTrue(env.observation_space.sample() in env.observation_space)
        self.assertFalse(env.observation_space.contains({"state": state}))
        np.testing.assert_array_equal(seen["state"], state)
        first = seen["depth"]
        for _ in range(25):
            seen, *rest = env.step([0, 0, -1, 0, 0, 0, 1])
            state, *same = plain.step([0, 0, -1, 0, 0, 0, 1])
            np.testing.assert_array_equal(seen["state"], state)
            self.assertEqual(rest, same)
        self.assertTrue(env.observation_space.contains(seen))
        self.assertGreater(np.abs(seen["depth"] - first).max(), 0.2e-3)

    def test_the_space_is_gymnasium_s_where_that_is(self):
        (self.folder / "gymnasium").mkdir()
        (self.folder / "gymnasium" / "__init__.py").write_text("from . import spaces\nclass Env:\n    pass\n")
        (self.folder / "gymnasium" / "spaces.py").write_text("""
class Box:
    def __init__(self, low, high, shape, dtype):
        self.shape = shape
class Dict:
    def __init__(self, spaces):
        self.spaces = spaces
""")
        code = ("import gymnasium, json, bonemill.gym as g\n"
                f"env = g.MillingEnv({str(self.scene(BLOCK + TASK))!r}, depth=g.DepthCamera([0, 0, 1e-2], [1, 0, 0, 0]))\n"
                "assert type(env.observation_space) is gymnasium.spaces.Dict\n"
                "print(json.dumps({name: box.shape for name, box in env.observation_space.spaces.items()}))")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              env=os.environ | {"PYTHONPATH": f"{self.folder}:{os.environ['PYTHONPATH']}"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout), {"state": [19], "depth": [84, 84]})


if __name__ == "__main__":
    unittest.main()
