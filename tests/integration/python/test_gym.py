"""bonemill.gym keeps Gymnasium's promises, without Gymnasium."""
import json
import os
import subprocess
import sys
import unittest

import numpy as np

import bonemill.demonstrations
import bonemill.gym
from place import BLOCK, TASK, TESTS, Folder, run

DOWN = [0, 0, -1, 0, 0, 0, 1]


class OfABlock(Folder):
    def env(self, **options):
        return bonemill.gym.MillingEnv(self.scene(BLOCK + TASK), **options)

    def test_the_protocol(self):
        env = self.env()
        observation, info = env.reset(seed=3)
        self.assertIsInstance(info, dict)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual(observation.dtype, np.float32)
        for _ in range(20):
            action = env.action_space.sample()
            self.assertTrue(action in env.action_space)
            observation, reward, terminated, truncated, info = env.step(action)
            self.assertTrue(env.observation_space.contains(observation))
            self.assertIsInstance(reward, float)
            self.assertIsInstance(terminated, bool)
            self.assertIsInstance(truncated, bool)
            self.assertIsInstance(info, dict)
        self.assertIs(env.unwrapped, env)
        env.close()

    def test_equal_seeds_and_actions_are_equal_episodes(self):
        def episode(env, seed):
            first, _ = env.reset(seed=seed)
            steps = [env.step(DOWN) for _ in range(25)]
            return np.array([first, *(step[0] for step in steps)]), [step[1] for step in steps], env.sim.state_hash

        env = self.env()
        one, other, again = episode(env, 1), episode(env, 2), episode(self.env(), 1)
        np.testing.assert_array_equal(one[0], again[0])
        self.assertEqual(one[1:], again[1:])
        self.assertNotEqual(one[2], other[2])

    def test_the_reward_is_the_target_s_share_less_the_overcut(self):
        env = self.env(start_jitter_m=0)
        env.reset(seed=0)
        total = sum(env.step(DOWN)[1] for _ in range(5))
        progress = env.sim.progress()
        elsewhere = progress["removed_mm3"] - progress["ideal_removed_mm3"]
        self.assertGreater(progress["ideal_removed_mm3"], 0)
        self.assertAlmostEqual(total, (progress["ideal_removed_mm3"] - elsewhere) / progress["ideal_mm3"], places=9)

    def test_an_episode_ends(self):
        env = self.env(max_seconds=0.05, final_score=True)
        env.reset(seed=0)
        ends = [env.step([0] * 7)[2:4] for _ in range(10)]
        self.assertEqual(ends[-1], (False, True))
        self.assertNotIn(True, [end[1] for end in ends[:-2]])
        with self.assertRaisesRegex(bonemill.Error, "episode is over"):
            env.step(DOWN)
        env.reset()
        self.assertEqual(env.sim.ticks, 1)

    def test_what_is_wrong_is_one_line(self):
        env = self.env()
        env.reset(seed=0)
        with self.assertRaisesRegex(bonemill.Error, "expected 7 finite numbers"):
            env.step([0, 0, 1])
        with self.assertRaisesRegex(bonemill.Error, "expected 7 finite numbers"):
            env.step([np.nan] * 7)
        for words, options in {"whole number": {"ticks_per_step": 2.5}, "more than 0": {"max_seconds": np.nan},
                               "not believed": {"max_move_m": 0.1}, "no checkpoints": {"keep_inputs": True}}.items():
            with self.assertRaisesRegex(bonemill.Error, words):
                self.env(**options)
        with self.assertRaisesRegex(bonemill.Error, "reset"):
            self.env().step(DOWN)
        with self.assertRaisesRegex(bonemill.Error, "0 or more"):
            env.reset(seed=-1)
        with self.assertRaisesRegex(bonemill.Error, "needs a task"):
            bonemill.gym.MillingEnv(self.scene(BLOCK))


class WithGymnasium(Folder):
    def test_it_is_one_of_its_environments(self):
        """By a stand-in that asks what its wrappers ask."""
        (self.folder / "gymnasium").mkdir()
        (self.folder / "gymnasium" / "__init__.py").write_text("""
from . import spaces
class Env:
    pass
class Wrapper(Env):
    def __init__(self, env):
        assert isinstance(env, Env) and isinstance(env.action_space, spaces.Box), env
        self.env = env
""")
        (self.folder / "gymnasium" / "spaces.py").write_text("""
class Box:
    def __init__(self, low, high, shape, dtype):
        self.low, self.high, self.shape, self.dtype = low, high, shape, dtype
    def seed(self, seed):
        pass
""")
        scene = self.scene(BLOCK + TASK)
        done = subprocess.run(
            [sys.executable, "-c", "import gymnasium, bonemill; e = gymnasium.Wrapper(bonemill.gym.MillingEnv(%r)).env; "
             "print(e.reset(seed=1)[0].shape)" % str(scene)], capture_output=True, text=True,
            env=os.environ | {"PYTHONPATH": f"{self.folder}:{os.environ['PYTHONPATH']}"})
        self.assertEqual(done.stdout.strip(), "(19,)", done.stderr)


class OfASession(Folder):
    def test_attempts_become_demonstrations_of_those_who_consent(self):
        made = run(TESTS / "recorded_session_maker", self.folder, "--with-attempts")
        self.assertEqual(made.returncode, 0, made.stderr)
        recording = bonemill.read_recording(self.folder / "session.mcap")
        everybody = list(bonemill.demonstrations.of(recording))
        self.assertEqual([demonstration.trainee for demonstration in everybody], ["P1", "P2"])
        one = everybody[0]
        self.assertEqual(one.observations.shape[1], sum(bonemill.gym.OBSERVED.values()))
        self.assertEqual(len(one.actions), len(one.observations))
        self.assertEqual(len(one.rewards), len(one.actions))
        self.assertEqual(set(one.actions[:, 6]), {1.0})
        # What the hand did in a step is what the action says.
        hand, first = recording.hand(), recording.attempts[0]["begin_tick"]
        moved = hand["positions_m"][first + 5] - hand["positions_m"][first]
        np.testing.assert_allclose(one.actions[0, :3] * 0.0005, moved, atol=2e-5)
        for name, consent, withdrawn in (("P1", True, True), ("P2", True, False), ("P3", False, False)):
            place = self.folder / "study" / "participants" / name
            place.mkdir(parents=True)
            (place / "participant.json").write_text(
                json.dumps({"pseudonym": name, "consent": consent, "withdrawn": withdrawn}))
        allowed = list(bonemill.demonstrations.of(recording, study=self.folder / "study"))
        self.assertEqual([demonstration.trainee for demonstration in allowed], ["P2"])
        with self.assertRaisesRegex(bonemill.Error, "is no study"):
            next(bonemill.demonstrations.of(recording, study=self.folder / "nowhere"))


if __name__ == "__main__":
    unittest.main()
