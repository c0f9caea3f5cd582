"""bonemill.gym keeps Gymnasium's promises, without Gymnasium."""
import unittest

import numpy as np

import bonemill.gym
from place import BLOCK, TASK, Folder

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
            self.assertTrue(env.action_space.contains(action))
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
        with self.assertRaisesRegex(bonemill.Error, "needs a task"):
            bonemill.gym.MillingEnv(self.scene(BLOCK))


if __name__ == "__main__":
    unittest.main()
