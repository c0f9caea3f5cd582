"""Haptic bone milling, tick by tick: the very loop of a live session, driven from Python.

    import bonemill
    sim = bonemill.Scene.load("deploy/scenes/minimal.textproto").simulation(accuracy="balanced")
    way = bonemill.scripted_hand(sim)                   # 8 s, a row a tick
    columns = sim.run(**way)
    print(abs(columns["force_n"]).max(axis=0))
    print(sim.step(way["positions_m"][-1], way["orientations_wxyz"][-1]))

Lengths are metres, forces newtons, frames W (the scan's) and T (the tool's); other units stand in the names. What is
wrong with the input is a bonemill.Error, a ValueError with one line.
"""
from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._bonemill import (Checkpoint, Error, Recording, Replay, Run, Simulation, StepResult, __version__, fault_names,
                        figures, read_trajectory)
from .camera import DepthCamera

__all__ = ["ACCURACIES", "ADD", "Checkpoint", "DepthCamera", "Error", "LAWS", "REMOVE", "Recording", "Replay", "Run", "Scene", "Simulation",
           "StepResult", "__version__", "demonstrations", "fault_names", "figures", "gym", "read_recording", "read_trajectory", "replay", "scripted_hand"]

REMOVE, ADD = 1, 2  # buttons
ACCURACIES = ("fast", "balanced", "exact", "thesis_2012")
LAWS = ("gradient", "thesis_2012", "proxy_3dof", "vps", "penalty_sdf", "constraint")

Value = str | bool | int | float


class Scene:
    """A scene file: a bone, tools, a task, effects. It is read when a simulation is made of it."""

    def __init__(self, path: str | os.PathLike[str], settings: Sequence[str] = ()) -> None:
        self.path = pathlib.Path(path)
        self.settings = tuple(_listed(settings))

    @classmethod
    def load(cls, path: str | os.PathLike[str], settings: Sequence[str] = ()) -> Scene:
        """settings: PATH=VALUE each, in place of what the file says, as `simulate --set` has them."""
        if not pathlib.Path(path).is_file():
            raise Error(f"{os.fspath(path)}: there is no such scene file; bonemill's own lie in deploy/scenes or "
                        "/usr/share/bonemill/scenes")
        return cls(path, settings)

    def simulation(self, accuracy: str | None = None, law: str | None = None,
                   effects: Mapping[str, bool | Mapping[str, Value]] | None = None, settings: Sequence[str] = (),
                   tool: str | int = "", keep_inputs: bool = True) -> Simulation:
        """A run of the scene, before its first tick.

        accuracy: fast, balanced, exact or thesis_2012; by default what the scene says. law: gradient, thesis_2012,
        proxy_3dof, vps, penalty_sdf or constraint; another law than the gradient law has an accuracy of its own, and
        some effects do not go with it. effects: by name, True (with its defaults), some of its
        fields, or False for one of the scene's that shall not be; the scene's others stay. settings: PATH=VALUE each.
        tool: the first one's name or number from 1. keep_inputs: without, there are no checkpoints,
        and no 72 bytes a tick.
        """
        chosen = [*self.settings, *_accuracy_settings(accuracy, law), *_effect_settings(effects or {}), *_listed(settings)]
        return Simulation(os.fspath(self.path), chosen, str(tool), keep_inputs)

    def __repr__(self) -> str:
        return f"Scene({os.fspath(self.path)!r})"


def scripted_hand(run: Run) -> dict[str, NDArray[Any]]:
    """The way of the scene's own hand, a row a tick, as read_trajectory() gives it: straight between its waypoints,
    turning evenly, as if nothing could hold it up."""
    if len(run.waypoints) < 2:
        raise Error("the scene has no hand of its own (simulated_operator)")
    times, places, turns, buttons = (np.array(column) for column in zip(*run.waypoints))
    t_s = np.arange(int(times[-1] / run.period_s)) * run.period_s
    n = np.searchsorted(times, t_s, side="right").clip(1, len(times) - 1) - 1
    share = ((t_s - times[n]) / (times[n + 1] - times[n])).clip(0, 1)[:, None]
    a, b = turns[n], turns[n + 1]
    cosine = (a * b).sum(1, keepdims=True)
    b, angle = np.where(cosine < 0, -b, b), np.arccos(np.abs(cosine).clip(0, 1))
    small = angle < 1e-9
    sine = np.where(small, 1, np.sin(angle))
    orientations = np.where(small, a, (np.sin((1 - share) * angle) * a + np.sin(share * angle) * b) / sine)
    return {"t_s": t_s, "positions_m": places[n] + share * (places[n + 1] - places[n]),
            "orientations_wxyz": orientations, "buttons": buttons[n].astype(np.uint32)}


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """A recorded session (.mcap): what its hand did, its attempts and events. No tick runs."""
    return Recording(os.fspath(path))


def replay(recording: Recording | str | os.PathLike[str]) -> Replay:
    """A recorded session, run again tick by tick, to the same bits; at any tick step() goes on with another hand."""
    return Replay(recording if isinstance(recording, Recording) else read_recording(recording))


def _accuracy_settings(accuracy: str | None, law: str | None) -> list[str]:
    if accuracy is not None and accuracy not in ACCURACIES:
        raise Error(f"accuracy={accuracy!r}: expected one of {', '.join(ACCURACIES)}")
    if law is not None and law not in LAWS:
        raise Error(f"law={law!r}: expected one of {', '.join(LAWS)}")
    if accuracy is not None and law not in (None, "gradient", accuracy):
        raise Error(f"law={law!r} has an accuracy of its own: leave out accuracy={accuracy!r}")
    if law == "gradient" and accuracy == "thesis_2012":
        raise Error("law='gradient': accuracy='thesis_2012' is another law")
    preset = law if law not in (None, "gradient") else accuracy or ("balanced" if law else None)
    return [f"accuracy.preset={preset.upper()}"] if preset else []


def _effect_settings(effects: Mapping[str, bool | Mapping[str, Value]]) -> list[str]:
    if not isinstance(effects, Mapping):
        raise Error(f"effects: expected a mapping of names to True, False or fields, got {effects!r}")
    settings = []
    for name, fields in effects.items():
        if isinstance(fields, Mapping):
            settings.extend([f"effects.{name}.{field}={_text_of(value)}" for field, value in fields.items()]
                            or [f"effects.{name}={{}}"])
        elif isinstance(fields, (bool, np.bool_)):
            settings.append(f"effects.{name}={'{}' if fields else ''}")
        else:
            raise Error(f"effects: {name} is True, False or its fields, got {fields!r}")
    return settings


def _listed(settings: Sequence[str]) -> Sequence[str]:
    if isinstance(settings, str):
        raise Error(f"settings: expected a list of PATH=VALUE, got one text; write [{settings!r}]")
    return settings


def _text_of(value: Value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


from . import demonstrations, gym  # noqa: E402: both are made of what stands above
