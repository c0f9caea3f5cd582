"""Milling as a learning environment with Gymnasium's interface: reset(), step(), render(), close(), two spaces.

Gymnasium is no dependency. Where it is installed, this is one of its environments, with its spaces.

    env = bonemill.gym.MillingEnv("deploy/scenes/tooth_cavity.textproto")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

An action moves the hand: (dx, dy, dz, rx, ry, rz, remove), each in -1 .. 1: shares of max_move_m along W's axes, of
max_turn_rad as a rotation vector in W, and above 0 the pedal is down. One step is ticks_per_step ticks of the loop.

An observation is float32, in this order (OBSERVED): the tool's place less the target's centre (m, W), its quaternion
w, x, y, z, the hand's place less the tool's (m, W), force on the hand (N, W), torque (N m, W), what was removed in the
step (mm3), the share of the target that is gone, the distance to the nearest protected structure (m; 0.1 where none is
nearer or known).

With depth=DepthCamera(...) an observation is a dict: "state", the above, and "depth", float32 (height, width), how far
what the camera sees is away along its axis, m, and far_m where nothing is: bone as it is milled, and the tool.

The reward of a step is the share of the target that it removed, less the share, of the target's size, that it removed
elsewhere (times overcut_weight), less 1 when it damaged a protected structure. With final_score the last step adds the
task's total, 0 to 1, or 0 where a gate failed. info has removed_mm3, target_share, is_damaged, and at the end of an
episode with final_score the judgement. An episode terminates when done_share of the target is gone or a
structure was damaged, and is truncated after max_seconds.
"""
from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import REMOVE, DepthCamera, Scene
from ._bonemill import Error, Run, Simulation, StepResult

__all__ = ["Box", "Dict", "MillingEnv", "OBSERVED", "Observer"]

OBSERVED = {"tool_offset_m": 3, "tool_orientation_wxyz": 4, "hand_offset_m": 3, "force_n": 3, "torque_nm": 3,
            "removed_mm3": 1, "target_share": 1, "protected_distance_m": 1}
_FAR_M = 0.1
_FASTEST_M_PER_S, _FASTEST_RAD_PER_S = 3.0, 60.0  # faster poses are not believed (docs: safety, "Jolts")

Observation = NDArray[np.float32]
Seen = Observation | dict[str, Observation]  # a dict with a depth picture

try:
    import gymnasium as _gymnasium  # type: ignore[import]
    _Environment: Any = _gymnasium.Env
except ImportError:
    _gymnasium, _Environment = None, object


class Box:
    """A box of float32 numbers, as gymnasium.spaces.Box, for where that is not installed."""

    def __init__(self, low: float, high: float, shape: tuple[int, ...]) -> None:
        self.low = np.full(shape, low, np.float32)
        self.high = np.full(shape, high, np.float32)
        self.shape, self.dtype = shape, np.dtype(np.float32)
        self._random = np.random.default_rng()

    def seed(self, seed: int | None = None) -> None:
        self._random = np.random.default_rng(seed)

    def sample(self) -> NDArray[np.float32]:
        """Uniform where the box is bounded, standard normal where it is not."""
        if not np.isfinite(self.low).all():
            return self._random.standard_normal(self.shape).astype(np.float32)
        return self._random.uniform(self.low, self.high).astype(np.float32)

    def contains(self, x: Any) -> bool:
        x = np.asarray(x)
        return x.shape == self.shape and bool(np.isfinite(x).all() and (x >= self.low).all() and (x <= self.high).all())

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)


class Dict:
    """Boxes by name, as gymnasium.spaces.Dict, for where that is not installed."""

    def __init__(self, spaces: dict[str, Box]) -> None:
        self.spaces = spaces

    def seed(self, seed: int | None = None) -> None:
        for n, space in enumerate(self.spaces.values()):
            space.seed(None if seed is None else seed + n)

    def sample(self) -> dict[str, NDArray[np.float32]]:
        return {name: space.sample() for name, space in self.spaces.items()}

    def contains(self, x: Any) -> bool:
        return (isinstance(x, dict) and x.keys() == self.spaces.keys() and
                all(space.contains(x[name]) for name, space in self.spaces.items()))

    def __getitem__(self, name: str) -> Box:
        return self.spaces[name]

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)


def _box(low: float, high: float, *shape: int) -> Any:
    return _gymnasium.spaces.Box(low, high, shape, np.float32) if _gymnasium else Box(low, high, shape)


def _observed(depth: DepthCamera | None) -> Any:
    state = _box(-np.inf, np.inf, sum(OBSERVED.values()))
    if depth is None:
        return state
    spaces = {"state": state, "depth": _box(0, depth.far_m, depth.height, depth.width)}
    return _gymnasium.spaces.Dict(spaces) if _gymnasium else Dict(spaces)


class Observer:
    """What an agent sees of a run, and what it is paid for; the run has a task."""

    def __init__(self, run: Run, overcut_weight: float) -> None:
        self.run, self.overcut_weight = run, overcut_weight
        self.progress = run.progress()

    def target_share(self) -> float:
        return float(self.progress["ideal_removed_mm3"] / self.progress["ideal_mm3"])

    def observe(self, result: StepResult, removed_mm3: float) -> Observation:
        tool_m = result.tool_position_m
        distance = result.effects.get("protected_distance_mm", np.nan) * 1e-3
        near = min(float(np.nan_to_num(distance, nan=_FAR_M)), _FAR_M)
        observation: Observation = np.concatenate(
            [tool_m - self.progress["target_centre_m"], result.tool_orientation_wxyz, result.hand_position_m - tool_m,
             result.force_n, result.torque_nm, [removed_mm3, self.target_share(), near]]).astype(np.float32)
        return observation

    def reward(self, removed_mm3: float, is_damaged: bool) -> float:
        """Of a step; before observe()."""
        if removed_mm3 == 0:
            return -float(is_damaged)
        before, self.progress = self.progress, self.run.progress()
        gained = self.progress["ideal_removed_mm3"] - before["ideal_removed_mm3"]
        elsewhere = self.progress["removed_mm3"] - before["removed_mm3"] - gained
        return float((gained - self.overcut_weight * elsewhere) / self.progress["ideal_mm3"]) - float(is_damaged)


class MillingEnv(_Environment):  # type: ignore[misc]
    """One scene, one episode after the other."""

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: str | None = None
    reward_range = (-float("inf"), float("inf"))
    spec = None

    def __init__(self, scene: Scene | str | os.PathLike[str], *, ticks_per_step: int = 5, max_seconds: float = 60,
                 max_move_m: float = 0.0005, max_turn_rad: float = 0.02, overcut_weight: float = 1.0,
                 done_share: float = 0.95, start_jitter_m: float = 0.0005, final_score: bool = False,
                 depth: DepthCamera | None = None, **simulation: Any) -> None:
        """simulation: what Scene.simulation() takes. depth: a camera whose picture each observation has, too; without,
        no picture is made. reset(seed) moves the start by start_jitter_m at most."""
        if depth is not None and not isinstance(depth, DepthCamera):
            raise Error(f"depth={depth!r}: expected a DepthCamera, or None for no pictures")
        if not isinstance(ticks_per_step, int) or ticks_per_step < 1:
            raise Error(f"ticks_per_step={ticks_per_step}: expected a whole number from 1 on")
        if not (math.isfinite(max_seconds) and max_seconds > 0):
            raise Error(f"max_seconds={max_seconds}: expected seconds, more than 0")
        if "keep_inputs" in simulation:
            raise Error("keep_inputs: an environment has no checkpoints; reset() begins anew")
        scene = scene if isinstance(scene, Scene) else Scene.load(scene)
        self.sim: Simulation = scene.simulation(keep_inputs=False, **simulation)
        if not self.sim.has_task:
            raise Error(f"{scene.path}: an environment needs a task (assessment), which this scene has not")
        period_s = ticks_per_step * self.sim.period_s
        if max_move_m / period_s > _FASTEST_M_PER_S or max_turn_rad / period_s > _FASTEST_RAD_PER_S:
            raise Error(f"max_move_m={max_move_m}, max_turn_rad={max_turn_rad} in {period_s} s: a hand goes at most "
                        f"{_FASTEST_M_PER_S} m/s and turns at most {_FASTEST_RAD_PER_S} rad/s, else it is not believed")
        self.ticks_per_step, self.max_seconds = ticks_per_step, max_seconds
        self.max_move_m, self.max_turn_rad = max_move_m, max_turn_rad
        self.overcut_weight, self.done_share = overcut_weight, done_share
        self.start_jitter_m, self.final_score, self.depth = start_jitter_m, final_score, depth
        self.action_space = _box(-1, 1, 7)
        self.observation_space = _observed(depth)
        self._random = np.random.default_rng()
        if not self.sim.waypoints:
            raise Error(f"{scene.path}: an environment begins where the scene's own hand does, and it has none")
        _, self._start_m, self._start_wxyz, _ = self.sim.waypoints[0]
        self._is_over: bool | None = None  # None: no episode has begun

    @property
    def unwrapped(self) -> MillingEnv:
        return self

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Seen, dict[str, Any]]:
        """Begins an episode with the scanned bone; equal seeds and actions give equal bits."""
        if seed is not None:
            if seed < 0:
                raise Error(f"seed={seed}: expected 0 or more")
            self._random = np.random.default_rng(seed)
            self.action_space.seed(seed)
        if self.sim.ticks:
            self.sim.reset()
        jitter = self._random.uniform(-1, 1, 3) * self.start_jitter_m
        self._hand_m, self._hand_wxyz = self._start_m + jitter, self._start_wxyz.copy()
        self._observer = Observer(self.sim, self.overcut_weight)
        self._is_over = False
        result = self.sim.step(self._hand_m, self._hand_wxyz)
        return self._seen(self._observer.observe(result, 0.0)), {}

    def step(self, action: ArrayLike) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        try:
            a = np.asarray(action, float)
        except (TypeError, ValueError):
            raise Error(f"action: expected 7 finite numbers, got {action!r}") from None
        if a.shape != (7,) or not np.isfinite(a).all():
            raise Error(f"action: expected 7 finite numbers, got {action!r}")
        if self._is_over is None:
            raise Error("no episode has begun: call reset() first")
        if self._is_over:
            raise Error("this episode is over: reset() begins another one")
        a = a.clip(-1, 1)
        positions, orientations = self._way(a[:3] * self.max_move_m, a[3:6] * self.max_turn_rad)
        removed, is_damaged, result = 0.0, False, None
        for position, orientation in zip(positions, orientations):
            result = self.sim.step(position, orientation, REMOVE if a[6] > 0 else 0)
            removed += result.removed_mm3
            is_damaged |= "protected_damaged" in result.events
        assert result is not None
        reward = self._observer.reward(removed, is_damaged)
        observation = self._observer.observe(result, removed)
        share = self._observer.target_share()
        terminated = is_damaged or share >= self.done_share
        truncated = self.sim.ticks * self.sim.period_s >= self.max_seconds
        self._is_over = bool(terminated or truncated)
        info: dict[str, Any] = {"removed_mm3": removed, "target_share": share, "is_damaged": is_damaged}
        if self._is_over and self.final_score:
            info["judgement"] = judgement = self.sim.judge()
            reward += score_of(judgement) or 0.0
        return self._seen(observation), reward, terminated, truncated, info

    def render(self) -> None:
        """There are no pictures but depth: mesh() and voxels() of self.sim are the bone."""

    def close(self) -> None:
        """Nothing is held but memory."""

    def _seen(self, state: Observation) -> Seen:
        return state if self.depth is None else {"state": state, "depth": self.sim.depth(self.depth)}

    def _way(self, move: NDArray[Any], turn: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """The hand's poses of one step's ticks, evenly apart."""
        shares = np.arange(1, self.ticks_per_step + 1) / self.ticks_per_step
        positions = self._hand_m + shares[:, None] * move
        orientations = np.array([product_of(rotation_of(share * turn), self._hand_wxyz) for share in shares])
        self._hand_m, self._hand_wxyz = positions[-1], orientations[-1] / np.linalg.norm(orientations[-1])
        return positions, orientations


def score_of(judgement: dict[str, Any]) -> float | None:
    """The task's total, 0 to 1; 0 where a gate failed, None where the task has no total."""
    if "total" not in judgement:
        return None
    return float(judgement["total"]["score"]) if judgement.get("passed", True) else 0.0


def rotation_of(turn: NDArray[Any]) -> NDArray[Any]:
    """The quaternion w, x, y, z of a rotation vector."""
    angle = float(np.linalg.norm(turn))
    if angle < 1e-12:
        return np.array([1.0, 0, 0, 0])
    return np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) / angle * turn])


def product_of(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])
