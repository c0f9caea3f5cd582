"""The truths once more, by code that knows neither a closed form nor a symmetry: only how far points are outside of the bone
and of the tool.

The bed's energy is a sum over points strewn evenly in space: those within a thin shell about the surface, moved onto it, stand
for its area (shell's volume / thickness). Forces are differences of that energy. The rigid place is right when the tool there
touches without entering, and none of many places nearer to the hand is free. What is swept is counted point by point."""
import numpy as np

import bodies

SHELL = 10e-6  # half of its thickness, m
CELL = 40e-6  # cells are at most so long
POINTS = 500_000
STEP, TURN = 2e-8, 1e-8  # of the differences, m and rad


def strewn(count):
    """Even places in the unit cube (Roberts' R3)."""
    g = 1.2207440846057596  # g^4 = g + 1
    return (0.5 + np.outer(np.arange(1, count + 1), g ** -np.arange(1.0, 4.0))) % 1


def tool_distance(scene, p, R, points):
    """Signed distance of points to a ball, or to a segment along the tool's y made thick."""
    local, half = (points - p) @ R, scene.tool.get("half_length_mm", 0) / 1e3
    over = local[:, 1] - np.clip(local[:, 1], -half, half)
    return np.sqrt(local[:, 0] ** 2 + over ** 2 + local[:, 2] ** 2) - scene.radius


def touched_cells(scene, p, R):
    """Middles and edge of the cells in which tool and shell may both be: a cube, cut in eight again and again."""
    edge = 2.2 * (scene.radius + scene.tool.get("half_length_mm", 0) / 1e3)
    middles = np.array([p])
    corners = np.stack(np.meshgrid([-1, 1], [-1, 1], [-1, 1]), axis=-1).reshape(-1, 3)
    while edge > CELL and len(middles):
        middles, edge = (middles[:, None, :] + edge / 4 * corners).reshape(-1, 3), edge / 2
        near = edge * np.sqrt(3) / 2 + SHELL
        middles = middles[(np.abs(scene.body.outside(middles)) <= near) & (tool_distance(scene, p, R, middles) <= near)]
    return middles, edge


class Bed:
    """The surface near a touching tool, as points that stand for equal areas."""

    def __init__(self, scene, kappa, p, R):
        self.scene, self.kappa = scene, kappa
        middles, edge = touched_cells(scene, p, R)
        in_cell = max(POINTS // max(len(middles), 1), 1)
        shift = np.random.default_rng(1).uniform(size=(len(middles), 1, 3))  # each cell its own, lest the errors add up
        points = (middles[:, None, :] + edge * ((strewn(in_cell) + shift) % 1 - 0.5)).reshape(-1, 3)
        outside = scene.body.outside(points)
        in_shell = np.abs(outside) < SHELL
        points, outside = points[in_shell], outside[in_shell]
        self.points = points - outside[:, None] * scene.body.normal(points)
        self.area = edge ** 3 / in_cell / (2 * SHELL)

    def energy(self, p, R):
        depth = np.maximum(-tool_distance(self.scene, p, R, self.points), 0)
        return self.kappa / 2 * self.area * np.sum(depth ** 2)

    def push(self, p, R):
        """Force and torque (about the tool's point) of the bone on the tool."""
        force, torque = np.zeros(3), np.zeros(3)
        for a, e in enumerate(np.eye(3)):
            force[a] = (self.energy(p - STEP * e, R) - self.energy(p + STEP * e, R)) / (2 * STEP)
            back, on = bodies.rotation(e, -TURN) @ R, bodies.rotation(e, TURN) @ R
            torque[a] = (self.energy(p, back) - self.energy(p, on)) / (2 * TURN)
        return force, torque


def deepest(scene, p, R, points):
    """How far a tool made of these points of its axis (T) enters the bone at most; `p` may be many places."""
    axis = np.asarray(p)[..., None, :] + points @ R.T
    return scene.radius - scene.body.outside(axis).min(axis=-1)


def axis_points(scene):
    half = scene.tool.get("half_length_mm", 0) / 1e3
    return np.stack([np.zeros(201), np.linspace(-half, half, 201), np.zeros(201)], axis=-1) if half else np.zeros((1, 3))


def rim(scene):
    """Of a cylinder with a rounded edge: the circle that the edge is round about; the tool is that circle, made thick."""
    edge, half = scene.tool["edge_mm"] / 1e3, scene.tool["half_length_mm"] / 1e3
    angle = np.linspace(0, 2 * np.pi, 721)
    r = scene.radius - edge
    return np.stack([r * np.cos(angle), np.full_like(angle, edge - half), r * np.sin(angle)], axis=-1), edge


def swept(scene, count=200_000):
    """What the pedal's way sweeps out of the bone, m³: points strewn in its box, asked one by one."""
    path = scene.way.p[scene.way.buttons == 1][::10]
    low, high = path.min(0) - scene.radius, path.max(0) + scene.radius
    points = low + strewn(count) * (high - low)
    points = points[scene.body.outside(points) < 0]
    gone = np.zeros(len(points), bool)
    for p in path:
        left = np.flatnonzero(~gone)
        gone[left[((points[left] - p) ** 2).sum(axis=1) < scene.radius ** 2]] = True
    return gone.sum() / count * np.prod(high - low)
