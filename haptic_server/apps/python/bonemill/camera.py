"""Where a camera stands that sees how far things are away."""
from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._bonemill import Error

__all__ = ["DepthCamera"]


@dataclasses.dataclass(frozen=True)
class DepthCamera:
    """A pin-hole camera in frame W, whose picture Run.depth() makes: its axes are x right, y up, z out of the picture.

    position_m: (3,). orientation_wxyz: (4,), from its axes to W's. fov_degrees: the field of view from the upper to the
    lower edge. width, height: pixels. far_m: what lies farther is not seen.
    """
    position_m: Sequence[float]
    orientation_wxyz: Sequence[float]
    fov_degrees: float = 40.0
    width: int = 84
    height: int = 84
    far_m: float = 0.3

    def __post_init__(self) -> None:
        for name in ("position_m", "orientation_wxyz"):  # so that cameras are equal where their numbers are
            if isinstance(getattr(self, name), np.ndarray):
                object.__setattr__(self, name, tuple(getattr(self, name).tolist()))

    @classmethod
    def looking(cls, from_m: ArrayLike, at_m: ArrayLike, up: ArrayLike = (0, 0, 1), **rest: Any) -> DepthCamera:
        """One that stands there and looks at that place (m, W), with this way (W) up in the picture."""
        back = np.asarray(from_m, float) - np.asarray(at_m, float)
        right = np.cross(np.asarray(up, float), back)
        if not np.linalg.norm(right) > 1e-9 * np.linalg.norm(back):
            raise Error(f"from_m={from_m!r}, at_m={at_m!r}, up={up!r}: a camera does not look along its own up")
        z, x = back / np.linalg.norm(back), right / np.linalg.norm(right)
        return cls(tuple(np.asarray(from_m, float)), _quaternion(np.column_stack([x, np.cross(z, x), z])), **rest)


def _quaternion(R: Any) -> tuple[float, ...]:
    """w, x, y, z of a rotation matrix: the eigenvector of Bar-Itzhack's symmetric matrix."""
    K = np.array([[R[0, 0] + R[1, 1] + R[2, 2], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
                  [0, R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
                  [0, 0, R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
                  [0, 0, 0, R[2, 2] - R[0, 0] - R[1, 1]]])
    return tuple(float(x) for x in np.linalg.eigh(K, UPLO="U")[1][:, -1])
