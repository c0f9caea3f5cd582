"""What a hand should feel, by closed forms and integrals of one variable; docs/reference/benchmark.md derives them.

Two truths, both static and without friction, in SI and the body's frame B. The hand holds the tool by a spring k (and a turn
spring k_r). `bed`: the bone's surface pushes with kappa times the depth on every area that lies inside of the tool, along the
tool's distance: the minimum of E(pose) = kappa/2 ∫ depth² dA + k/2 |x - x_hand|². `rigid`: kappa without bound, the tool at the
nearest place that it can reach without entering the bone (Zilles and Salisbury). brute_force.py computes both otherwise."""
import dataclasses

import numpy as np

GAUSS = np.polynomial.legendre.leggauss(64)


@dataclasses.dataclass
class Answer:
    """Force and torque on the hand, and the tool's place beside the hand's and its lean (rad, the hand's own way)."""
    force: np.ndarray
    torque: np.ndarray
    place: np.ndarray
    lean: float = 0.0


def bisect(function, low, high):
    """Where a falling function is zero."""
    for _ in range(45):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) > 0 else (low, middle)
    return (low + high) / 2


def integral(function, low, high, parts=8):
    edges = np.linspace(low, high, parts + 1)
    half = np.diff(edges)[:, None] / 2
    x = edges[:-1, None] + half * (1 + GAUSS[0])
    return float(np.sum(half * GAUSS[1] * function(x)))


def on_plane(kappa, radius, depth):
    """Push of a plane on a ball: pi kappa (R - d) d²."""
    return np.pi * kappa * (radius - depth) * depth ** 2 if depth > 0 else 0.0


def on_sphere(kappa, radius, sphere, depth):
    """Push of a ball of bone on a ball."""
    if depth <= 0:
        return 0.0
    far = sphere + radius - depth
    return np.pi * kappa * sphere * ((radius * depth ** 2 - depth ** 3) / far + (radius * depth ** 3 / 3 - depth ** 4 / 4) / far ** 2)


def on_peg_sideways(kappa, radius, hole, half_length, offset):
    """Push of a hole's wall on a peg with round ends whose axis is `offset` off the hole's: -dE/d offset of
    kappa/2 hole ∫ (2 half_length (R - rho)² + ends(rho)) d theta, rho the way from the wall's points to the peg's axis."""
    def share(theta):
        rho = np.sqrt(hole ** 2 + offset ** 2 - 2 * hole * offset * np.cos(theta))
        a = np.sqrt(np.maximum(radius ** 2 - rho ** 2, 0))
        # d/d rho of both round ends, 2 ∫ (R - sqrt(rho² + z²))² dz from 0 to a
        ends = 4 * (rho * a - radius * rho * np.arcsinh(a / rho))
        pressed = np.maximum(radius - rho, 0)
        slope = np.where(pressed > 0, -4 * half_length * pressed + ends, 0)
        return slope * (offset - hole * np.cos(theta)) / rho
    cosine = (hole ** 2 + offset ** 2 - radius ** 2) / (2 * hole * offset)
    if cosine >= 1:
        return 0.0
    widest = np.arccos(max(cosine, -1))
    return -kappa * hole * integral(share, 0, widest)  # both halves of the circle


def lean_energy_slope(kappa, radius, hole, half_length, lean):
    """dE/d lean of a peg that leans about its middle in a hole, by the wall's points inside of it (theta, z)."""
    thetas, zs = 200, 1600  # cells: a quarter of the wall, at their middles
    long = 1.12 * half_length
    theta, z = np.meshgrid((np.arange(thetas) + 0.5) / thetas * np.pi / 2, ((np.arange(zs) + 0.5) / zs * 2 - 1) * long, indexing="ij")
    x, y = hole * np.cos(theta), hole * np.sin(theta)
    along = x * np.sin(lean) + z * np.cos(lean)
    across = x * np.cos(lean) - z * np.sin(lean)
    over = np.maximum(np.abs(along) - half_length, 0)
    rho = np.sqrt(across ** 2 + y ** 2 + over ** 2)
    slope = (-across * along + np.sign(along) * over * across) / rho  # d rho / d lean
    field = np.where(rho < radius, -(radius - rho) * slope, 0)
    cell = hole * np.pi / 2 / thetas * 2 * long / zs
    return 4 * kappa * cell * np.sum(field)  # the other quarters are the same, turned


class Truth:
    """The truths of a scene's held hands. kappa is None for the rigid one."""

    def __init__(self, scene, is_rigid):
        self.scene, self.body, contact = scene, scene.body, scene.contact
        self.kappa = None if is_rigid else 1e9 * contact["stiffness_n_per_mm3"]
        self.k, self.k_turn = 1e3 * contact["coupling_n_per_mm"], 1e-3 * contact["turn_nmm_per_rad"]
        self.radius = scene.radius
        self.half = scene.tool.get("half_length_mm", 0) / 1e3

    def at(self, p_hand, R_hand):
        """What is felt there, or None where no closed form is known."""
        shape, kind = self.scene.tool["shape"], self.body.kind
        if shape == "cylinder":
            return self._edge(p_hand, R_hand) if self.kappa is None else None
        if shape == "capsule":
            return self._peg(p_hand, R_hand)
        if kind in ("plane", "wall"):  # a wall is felt from where the tool came, however far the hand is
            return self._along(p_hand, np.array([0, 0, 1.0]), self.radius - p_hand[2], lambda d: on_plane(self.kappa, self.radius, d))
        if kind == "sphere":
            far = np.linalg.norm(p_hand)
            sphere = self.body.size
            return self._along(p_hand, p_hand / far, sphere + self.radius - far, lambda d: on_sphere(self.kappa, self.radius, sphere, d))
        return self._slot(p_hand)

    def _along(self, p_hand, normal, depth, push):
        """Pressed along one line: k (depth - d) = push(d)."""
        d = 0.0 if self.kappa is None else bisect(lambda d: self.k * (depth - d) - push(d), 0, max(depth, 0))
        lifted = max(depth - d, 0)
        return Answer(self.k * lifted * normal, np.zeros(3), p_hand + lifted * normal)

    def _slot(self, p_hand):
        x, side = abs(p_hand[0]), np.sign(p_hand[0]) * np.array([1.0, 0, 0])
        gap = self.body.size - self.radius
        push = lambda at: on_plane(self.kappa, self.radius, at - gap) - on_plane(self.kappa, self.radius, -at - gap)
        at = min(x, gap) if self.kappa is None else bisect(lambda at: self.k * (x - at) - push(at), 0, x)
        return Answer(-self.k * (x - at) * side, np.zeros(3), p_hand - (x - at) * side)

    def _peg(self, p_hand, R_hand):
        gap = self.body.size - self.radius
        axis = R_hand @ np.array([0, 1.0, 0])
        lean = float(np.arccos(np.clip(axis[2], -1, 1)))
        x = np.hypot(*p_hand[:2])
        if lean < 1e-9:
            side = np.array([p_hand[0], p_hand[1], 0]) / x
            push = lambda at: on_peg_sideways(self.kappa, self.radius, self.body.size, self.half, at)
            at = min(x, gap) if self.kappa is None else bisect(lambda at: self.k * (x - at) + push(at), 0, x)
            return Answer(-self.k * (x - at) * side, np.zeros(3), p_hand - (x - at) * side)
        about = np.cross([0, 0, 1], axis) / np.sin(lean)
        if self.kappa is None:
            at = min(lean, float(np.arcsin(gap / self.half)))
        else:
            push = lambda a: lean_energy_slope(self.kappa, self.radius, self.body.size, self.half, a)
            at = bisect(lambda a: self.k_turn * (lean - a) - push(a), 0, lean)
        return Answer(np.zeros(3), -self.k_turn * (lean - at) * about, p_hand, at)

    def _edge(self, p_hand, R_hand):
        """The lowest point of a leaning cylinder with a rounded edge; that the tool turns a little under it is left out."""
        edge = self.scene.tool["edge_mm"] / 1e3
        cosine = (R_hand @ np.array([0, 1.0, 0]))[2]
        reach = (self.half - edge) * cosine + (self.radius - edge) * np.sqrt(1 - cosine ** 2) + edge
        return self._along(p_hand, np.array([0, 0, 1.0]), reach - p_hand[2], None)


def removed_volume(scene):
    """What the ball sweeps out of the bone, m³, or None."""
    told, r = scene.told.get("removed"), scene.radius
    if not told:
        return None
    if "hole_mm" in told:
        return np.pi * r ** 2 * told["hole_mm"] / 1e3
    d, length = told["groove_deep_mm"] / 1e3, told["groove_long_mm"] / 1e3
    across = r ** 2 * np.arccos((r - d) / r) - (r - d) * np.sqrt(2 * r * d - d ** 2)
    return across * length + np.pi * d ** 2 * (3 * r - d) / 3
