from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .camera import DepthCamera

__version__: str

class Error(ValueError): ...

@final
class StepResult:
    tick: int
    t_s: float
    force_n: NDArray[np.float64]
    torque_nm: NDArray[np.float64]
    tool_position_m: NDArray[np.float64]
    tool_orientation_wxyz: NDArray[np.float64]
    hand_position_m: NDArray[np.float64]
    hand_orientation_wxyz: NDArray[np.float64]
    contacts: int
    penetration_m: float
    removed_mm3: float
    added_mm3: float
    removed_voxels: int
    added_voxels: int
    tool: int
    buttons: int
    tick_us: float
    faults: list[str]
    events: list[str]
    effects: dict[str, float]

class Run:
    has_task: bool
    ticks: int
    period_s: float
    state_hash: int
    tools: list[str]
    burr_radius_m: float
    warnings: list[str]
    waypoints: list[tuple[float, NDArray[np.float64], NDArray[np.float64], int]]
    spacing_m: NDArray[np.float64]
    iso_density: int
    volume_pose: dict[str, NDArray[np.float64]]
    @property
    def tool(self) -> str: ...
    @tool.setter
    def tool(self, name: str | int) -> None: ...
    def step(self, position_m: ArrayLike, orientation_wxyz: ArrayLike | None = None, buttons: int = 0) -> StepResult: ...
    def run(self, positions_m: ArrayLike, orientations_wxyz: ArrayLike | None = None,
            buttons: ArrayLike | None = None, t_s: ArrayLike | None = None) -> dict[str, NDArray[Any]]: ...
    def voxels(self) -> NDArray[np.uint16]: ...
    def mesh(self) -> tuple[NDArray[np.float64], NDArray[np.uint32]]: ...
    def tool_mesh(self) -> tuple[NDArray[np.float32], NDArray[np.uint32]]: ...
    def depth(self, camera: DepthCamera) -> NDArray[np.float32]: ...
    def progress(self) -> dict[str, Any]: ...
    def begin_attempt(self) -> None: ...
    def judge(self) -> dict[str, Any]: ...

@final
class Checkpoint:
    ticks: int

@final
class Simulation(Run):
    def __init__(self, scene: str, settings: list[str] = ..., tool: str = ..., keep_inputs: bool = ...) -> None: ...
    def reset(self) -> None: ...
    def checkpoint(self) -> Checkpoint: ...
    def restore(self, checkpoint: Checkpoint) -> None: ...

@final
class Recording:
    path: str
    ticks: int
    length_s: float
    scene_name: str
    journal_id: str
    version: str
    start_unix_ns: int
    tools: list[str]
    problem: str
    attempts: list[dict[str, Any]]
    events: list[tuple[float, str]]
    def __init__(self, path: str) -> None: ...
    def hand(self) -> dict[str, NDArray[Any]]: ...

@final
class Replay(Run):
    has_left: bool
    is_at_end: bool
    is_restoring: bool
    def __init__(self, recording: Recording) -> None: ...
    def step_recorded(self) -> StepResult: ...
    def run_recorded(self, until_s: float | None = None, until_tick: int | None = None) -> dict[str, NDArray[Any]]: ...
    def restart(self) -> None: ...

def fault_names(faults: int) -> list[str]: ...
def figures() -> dict[str, tuple[str, str]]: ...
def read_trajectory(path: str) -> dict[str, NDArray[Any]]: ...
