"""Recorded attempts as demonstrations for learning from people: what bonemill.gym.MillingEnv would have seen and done.

    for demonstration in bonemill.demonstrations.of(recording, study="study"):
        demonstration.observations, demonstration.actions, demonstration.rewards, demonstration.score

A step is ticks_per_step ticks, as in the environment; an action is how far the hand went and turned in it, as shares of
max_move_m and max_turn_rad, and may exceed 1 where a person was quicker than the environment allows: clipped_share says
how often. The session runs again for it, to its bits.
"""
from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import REMOVE, replay
from ._bonemill import Error, Recording, Replay, StepResult
from .gym import Observer, product_of, score_of

__all__ = ["Demonstration", "consenting", "of"]


@dataclasses.dataclass
class Demonstration:
    """One attempt of one trainee."""
    trainee: str
    observations: NDArray[np.float32]  # (N, observation)
    actions: NDArray[np.float32]       # (N, 7): from each observation to the next
    rewards: NDArray[np.float64]       # (N,): of each action
    clipped_share: float               # of the actions: these exceed the environment's bounds
    score: float | None                # the task's total, 0 to 1; 0 where a gate failed, None where there is none


def consenting(study: str | os.PathLike[str]) -> set[str]:
    """Pseudonyms of a study's participants who have consented and not withdrawn."""
    folder = pathlib.Path(study) / "participants"
    if not folder.is_dir():
        raise Error(f"{os.fspath(study)}: is no study (it has no participants)")
    people = (json.loads(file.read_text(encoding="utf-8")) for file in folder.glob("*/participant.json"))
    return {person["pseudonym"] for person in people if person.get("consent") and not person.get("withdrawn")}


def of(recording: Recording, study: str | os.PathLike[str] | None = None, *, ticks_per_step: int = 5,
       max_move_m: float = 0.0005, max_turn_rad: float = 0.02, overcut_weight: float = 1.0) -> Iterator[Demonstration]:
    """The attempts of a session that have ended, one after the other; with a study only of those who consent."""
    allowed = consenting(study) if study is not None else None
    for attempt in recording.attempts:
        if attempt["has_ended"] and (allowed is None or attempt["trainee"] in allowed):
            run = replay(recording)
            run.run_recorded(until_tick=attempt["begin_tick"])
            yield _demonstration(run, attempt, ticks_per_step, max_move_m, max_turn_rad, overcut_weight)


def _demonstration(run: Replay, attempt: dict[str, Any], ticks: int, move_m: float, turn_rad: float,
                   overcut_weight: float) -> Demonstration:
    before = run.step_recorded()
    while run.is_restoring and not run.is_at_end:  # the attempt has ordered the bone back
        before = run.step_recorded()
    run.begin_attempt()
    observer = Observer(run, overcut_weight)
    observations, actions, rewards = [], [], []
    observations.append(observer.observe(before, 0.0))
    while not run.is_at_end and run.ticks <= attempt["end_tick"]:
        results = [run.step_recorded() for _ in range(ticks) if not run.is_at_end]
        removed = sum(result.removed_mm3 for result in results)
        is_damaged = any("protected_damaged" in result.events for result in results)
        actions.append(_action(before, results[-1], move_m, turn_rad))
        rewards.append(observer.reward(removed, is_damaged))
        observations.append(observer.observe(results[-1], removed))
        before = results[-1]
    done = np.array(actions, np.float32).reshape(-1, 7)
    return Demonstration(attempt["trainee"], np.array(observations[:-1], np.float32).reshape(len(done), -1), done,
                         np.array(rewards), float((np.abs(done) > 1).any(axis=1).mean()) if len(done) else 0.0,
                         score_of(run.judge()) if len(done) else None)


def _action(before: StepResult, after: StepResult, move_m: float, turn_rad: float) -> NDArray[np.float32]:
    w, x, y, z = product_of(after.hand_orientation_wxyz, before.hand_orientation_wxyz * [1, -1, -1, -1])
    axis = np.array([x, y, z]) * (1 if w >= 0 else -1)
    sine = float(np.linalg.norm(axis))
    turn = axis * (2 * np.arctan2(sine, abs(w)) / sine) if sine > 1e-12 else axis * 2
    move = after.hand_position_m - before.hand_position_m
    action: NDArray[np.float32] = np.concatenate(
        [move / move_m, turn / turn_rad, [1.0 if after.buttons & REMOVE else -1.0]]).astype(np.float32)
    return action
