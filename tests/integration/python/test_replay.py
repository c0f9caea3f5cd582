"""bonemill.Recording and Replay: a session to its bits, and another hand from a moment on."""
import unittest

import numpy as np

import bonemill
from place import TESTS, Folder, run, without_memory


class OfASession(Folder):
    def setUp(self):
        super().setUp()
        made = run(TESTS / "recorded_session_maker", self.folder)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.state_hash = int(made.stdout.split()[0], 16)
        self.recording = bonemill.read_recording(self.folder / "session.mcap")

    def test_it_is_read_without_a_tick(self):
        self.assertEqual(self.recording.ticks, 3000)
        self.assertEqual(self.recording.problem, "")
        hand = self.recording.hand()
        self.assertEqual(hand["positions_m"].shape, (3000, 3))
        self.assertEqual(hand["t_s"][0], 0)
        self.assertTrue((np.diff(hand["t_s"]) > 0).all())
        self.assertGreater(len(self.recording.events), 0)

    def test_it_runs_again_to_its_bits(self):
        replay = bonemill.replay(self.recording)
        columns = replay.run_recorded()
        self.assertTrue(replay.is_at_end)
        self.assertEqual(len(columns["t_s"]), 3000)
        self.assertEqual(replay.state_hash, self.state_hash)
        with self.assertRaisesRegex(bonemill.Error, "ends after 3000"):
            replay.step_recorded()
        end = replay.voxels().copy()
        replay.restart()
        self.assertTrue((replay.voxels() != end).any())
        replay.run_recorded()
        self.assertEqual(replay.state_hash, self.state_hash)
        np.testing.assert_array_equal(replay.voxels(), end)

    def test_without_memory_it_stays_in_one_piece(self):
        done = without_memory(f"sim = bonemill.replay({str(self.folder / 'session.mcap')!r})\n"
                              "begin, step = sim.restart, lambda: (sim.tool, sim.has_left, sim.step_recorded())")
        self.assertEqual(done.stdout.split("\n")[0], "MemoryError", done.stderr)
        self.assertIn("half way between two states: restart()", done.stdout)
        self.assertTrue(done.stdout.endswith("begun\n"), done.stdout + done.stderr)

    def test_it_runs_to_a_time_or_a_tick(self):
        t_s, replay = self.recording.hand()["t_s"], bonemill.replay(self.recording)
        for tick in (1, 2, 65, 100, 399, 1023, 1024, 1025):
            replay.run_recorded(until_s=t_s[tick])
            self.assertEqual(replay.ticks, tick)
        replay.run_recorded(until_s=t_s[1100] + 1e-4)
        self.assertEqual(replay.ticks, 1101)
        replay.run_recorded(until_tick=1200)
        self.assertEqual(replay.ticks, 1200)
        with self.assertRaisesRegex(bonemill.Error, "NaN"):
            replay.run_recorded(until_s=np.nan)

    def test_who_leaves_while_the_bone_is_put_back_sees_it_come_back(self):
        replay, hand = bonemill.replay(self.recording), self.recording.hand()
        replay.run_recorded(until_tick=1801)  # the order to put the bone back is taken up in tick 1800
        self.assertTrue(replay.is_restoring)
        replay.voxels()
        for tick in range(1801, 2001):
            replay.step(hand["positions_m"][tick] + [0, 0, 3e-3], hand["orientations_wxyz"][tick])
        self.assertFalse(replay.is_restoring)
        fresh = bonemill.replay(self.recording)
        np.testing.assert_array_equal(replay.voxels(), fresh.voxels())

    def test_another_hand_goes_on_from_a_moment(self):
        one, other, same = (bonemill.replay(self.recording) for _ in range(3))
        for replay in (one, other, same):
            replay.run_recorded(until_s=0.9)
        self.assertEqual(one.state_hash, other.state_hash)
        first, hand = one.ticks, self.recording.hand()
        rest = slice(first, first + 200)
        way = hand["positions_m"][rest], hand["orientations_wxyz"][rest], hand["buttons"][rest]
        removed = [replay.run(way[0] + [0, 0, lift], *way[1:])["removed_mm3"].sum()
                   for replay, lift in ((one, 0), (other, 0.3e-3), (same, 0))]
        self.assertTrue(one.has_left)
        self.assertEqual(one.state_hash, same.state_hash)
        self.assertLess(removed[1], removed[0], "0.3 mm higher removes less")
        with self.assertRaisesRegex(bonemill.Error, "its own times"):
            one.run(way[0][:1], t_s=[100])
        with self.assertRaisesRegex(bonemill.Error, "another hand has gone on"):
            one.step_recorded()
        one.restart()
        one.run_recorded()
        self.assertEqual(one.state_hash, self.state_hash)


if __name__ == "__main__":
    unittest.main()
