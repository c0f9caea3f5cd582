"""The bones that have an exact shape: how far a point is outside of each, and the volume that is made of it.

Lengths are metres. A body has a frame B of its own, in which its scene is written; `Placement` puts it askew into the world
W, whose axes are the voxels', so that no face lies along a voxel's."""
import dataclasses

import numpy as np

ISO, FULL = 32768, 65535
RAMP_VOXELS = 2  # the value falls from full to nothing over this many voxels on either side of the surface


def rotation(axis, angle):
    """The matrix that turns by `angle` about `axis` (Rodrigues)."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def turn_of(axis):
    """The least rotation that leads +y, the tool's way to the hand, to this axis."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    normal = np.cross([0, 1, 0], axis)
    if np.linalg.norm(normal) < 1e-12:
        return np.eye(3) if axis[1] > 0 else rotation([1, 0, 0], np.pi)
    return rotation(normal, np.arccos(np.clip(axis[1], -1, 1)))


def quaternion(matrix):
    """w, x, y, z with w >= 0; the turns of the scenes stay well below 180 degrees."""
    w = np.sqrt(max(0.0, 1 + np.trace(matrix))) / 2
    if w < 1e-3:
        raise ValueError("a turn by 180 degrees has no unique quaternion here")
    return np.array([w, *(np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]]) / (4 * w))])


def matrix_of(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


@dataclasses.dataclass(frozen=True)
class Placement:
    R_WB: np.ndarray
    p_WB: np.ndarray

    def to_world(self, p_B):
        return np.asarray(p_B) @ self.R_WB.T + self.p_WB

    def to_body(self, p_W):
        return (np.asarray(p_W) - self.p_WB) @ self.R_WB

    def turned_to_body(self, v_W):
        return np.asarray(v_W) @ self.R_WB


class Body:
    """`kind` with its sizes: plane (bone below z = 0), wall (bone from z = -thickness to 0), sphere (about the origin), slot
    (bone where |x| > half_width), hole (bone farther than the radius from the z axis)."""

    def __init__(self, kind, size=0.0):
        self.kind, self.size = kind, size

    def outside(self, p_B):
        """Signed distance of points (…, 3): negative in the bone."""
        x, y, z = np.moveaxis(np.asarray(p_B, float), -1, 0)
        return {
            "plane": lambda: z,
            "wall": lambda: np.abs(z + self.size / 2) - self.size / 2,
            "sphere": lambda: np.sqrt(x * x + y * y + z * z) - self.size,
            "slot": lambda: self.size - np.abs(x),
            "hole": lambda: self.size - np.hypot(x, y),
        }[self.kind]()

    def normal(self, p_B):
        """The unit vector out of the bone, by differences of the distance."""
        p_B, h = np.asarray(p_B, float), 1e-7
        steps = h * np.eye(3)
        gradient = np.stack([self.outside(p_B + s) - self.outside(p_B - s) for s in steps], axis=-1)
        return gradient / np.linalg.norm(gradient, axis=-1, keepdims=True)


def values(body, placement, shape, voxel, origin_W):
    """The volume (x, y, z) of a body: ISO on its surface."""
    axes = [origin_W[a] + voxel * np.arange(shape[a]) for a in range(3)]
    out = np.empty(shape, np.uint16)
    for i, x in enumerate(axes[0]):
        plane = np.stack(np.broadcast_arrays(x, axes[1][:, None], axes[2][None, :]), axis=-1)
        outside = body.outside(placement.to_body(plane))
        out[i] = np.clip(np.rint(ISO * (1 - outside / (RAMP_VOXELS * voxel))), 0, FULL)
    return out
