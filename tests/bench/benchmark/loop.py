"""Z-width: the stiffest wall that a program renders quietly in a closed loop, beside what moving through air costs.

The device is that of the stability tests: 0.25 kg, 2 N·s/m and 0.2 N of friction, amplifier of 500 Hz, encoder of 5 µm, one tick
late; on it a hand of 0.1 kg, 8 N·s/m, 600 N/m that presses the ball of the scene plane with 2 N, for a second. It is quiet when
over the second half the force stays within 0.05 N and the handle within 10 µm (root mean square about the mean). The coupling's
stiffness is doubled until that fails or a hand in free air feels more than 3 N·s/m (damping the air away would buy any wall),
at most to 150 N/mm, then bisected to 5 %; the bed is 1, 4 and 16 times as stiff as in the scene, in proportion to the coupling.
The figure is the most that is rendered: the change of force over the hand's place, ±20 µm about where it came to rest."""
import collections
import contextlib
import dataclasses
import json
import math
import subprocess
import threading

import numpy as np

import bodies

MASS, DAMPING, FRICTION, AMPLIFIER_HZ, ENCODER = 0.25, 2.0, 0.2, 500.0, 5e-6
HAND_MASS, HAND_DAMPING, HAND_STIFFNESS, PUSH = 0.1, 8.0, 600.0, 2.0
TICK, SUBSTEPS, TICKS = 1e-3, 20, 1000
MOST_S, MOST_LETTERS = 120, 1000  # for a press with the way back; of a line
QUIET_N, QUIET_M, RESOLUTION, MOST_DRAG, DRAG_SLACK = 0.05, 10e-6, 1.05, 3.0, 1.01
LEAST_N_PER_MM, MOST_N_PER_MM = 0.1, 150.0
BED_FACTORS, PROBE, AIR_SPEED = (1, 4, 16), 20e-6, 0.05


class Program:
    """A program's own loop: a line with a pose in, a line with a wrench out."""

    def __init__(self, command, folder, scene, most_s=MOST_S):
        self.scene = scene
        self.turn = bodies.quaternion(scene.placement.R_WB @ scene.way.R[0])
        self.process = subprocess.Popen([*command, str(folder), "--loop"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, bufsize=1)
        self.timer = threading.Timer(most_s, self.process.kill)
        self.timer.start()
        if self._line() != "ready":
            self.close()
            raise ValueError("its loop did not begin")

    def _line(self):
        return self.process.stdout.readline(MOST_LETTERS).strip()

    def force(self, z):
        """Along the face's normal, with the ball's middle z over the face."""
        pose = [*self.scene.placement.to_world(np.array([0.0, 0.0, z])), *self.turn]
        self.process.stdin.write(" ".join(repr(float(value)) for value in pose) + " 0\n")
        self.process.stdin.flush()
        words = self._line().split()
        if len(words) < 3:
            raise ValueError("its loop ended")
        return float(self.scene.placement.turned_to_body([float(w) for w in words[:3]])[2])

    def close(self):
        with contextlib.suppress(OSError):  # it has left
            self.process.stdin.close()
        self.process.wait()  # the timer sees to it
        self.timer.cancel()
        self.process.stdout.close()


@dataclasses.dataclass
class Pressed:
    is_quiet: bool
    rest: float  # m, where it ended
    rendered: float = 0.0  # N/m
    drag: float = 0.0  # N·s/m


class Handle:
    """The device's handle with the hand on it, along the normal; friction takes what momentum it can."""

    def __init__(self, z):
        self.z, self.v, self.drive, self.h = z, 0.0, 0.0, TICK / SUBSTEPS
        self.settled = -math.expm1(-2 * math.pi * AMPLIFIER_HZ * self.h)
        self.target = z - PUSH / HAND_STIFFNESS

    def live(self, force):
        mass, damping = MASS + HAND_MASS, DAMPING + HAND_DAMPING
        for _ in range(SUBSTEPS):
            self.drive += self.settled * (force - self.drive)
            middle = self.z + self.h / 2 * self.v
            momentum = mass * self.v + self.h * (HAND_STIFFNESS * (self.target - middle) + self.drive)
            left = max(abs(momentum) - self.h * FRICTION, 0.0)
            self.v = math.copysign(left, momentum) / (mass + self.h * damping)
            self.z = middle + self.h / 2 * self.v


def press(program):
    handle, late, forces, places = Handle(program.scene.radius + 0.1e-3), collections.deque([0.0]), [], []
    for _ in range(TICKS):
        late.append(program.force(round(handle.z / ENCODER) * ENCODER))
        forces.append(late[-1])
        places.append(handle.z)
        handle.live(late.popleft())
    is_quiet = np.std(forces[TICKS // 2:]) <= QUIET_N and np.std(places[TICKS // 2:]) <= QUIET_M and np.mean(forces[TICKS // 2:]) > 0.1
    if not is_quiet:
        return Pressed(False, handle.z)
    rest = float(np.mean(places[TICKS // 2:]))
    felt = []
    for z in (rest - PROBE, rest + PROBE):
        for _ in range(200):
            force = program.force(z)
        felt.append(force)
    return Pressed(True, rest + PROBE, (felt[0] - felt[1]) / (2 * PROBE))


def drag_in_air(program, start):
    """The hand goes up from there."""
    for n in range(300):
        force = program.force(start + AIR_SPEED * TICK * n)
    return -force / AIR_SPEED


class Search:
    def __init__(self, command, scene, scratch):
        self.command, self.scene, self.scratch = command, scene, scratch

    def _tell(self, stiffness, bed_factor):
        told = json.loads((self.scratch / "scene.json").read_text(encoding="utf-8"))
        contact = dict(self.scene.contact)
        contact["stiffness_n_per_mm3"] *= bed_factor * stiffness / contact["coupling_n_per_mm"]
        told["contact"] = contact | {"coupling_n_per_mm": stiffness}
        (self.scratch / "scene.json").write_text(json.dumps(told), encoding="utf-8")

    def at(self, stiffness, bed_factor):
        self._tell(stiffness, bed_factor)
        program = Program(self.command, self.scratch, self.scene)
        try:
            pressed = press(program)
            pressed.drag = drag_in_air(program, pressed.rest)
            pressed.is_quiet &= pressed.drag <= MOST_DRAG * DRAG_SLACK
            return pressed
        finally:
            program.close()

    def widest_with(self, bed_factor):
        """The press at the stiffest coupling that is quiet."""
        low = self.scene.contact["coupling_n_per_mm"]
        best = self.at(low, bed_factor)
        while not best.is_quiet and low > LEAST_N_PER_MM:
            low /= 2
            best = self.at(low, bed_factor)
        high = 2 * low
        while best.is_quiet and high <= MOST_N_PER_MM and (tried := self.at(high, bed_factor)).is_quiet:
            low, best, high = high, tried, 2 * high
        while best.is_quiet and high / low > RESOLUTION and high <= MOST_N_PER_MM:
            middle = math.sqrt(low * high)
            tried = self.at(middle, bed_factor)
            low, best, high = (middle, tried, high) if tried.is_quiet else (low, best, middle)
        return best

    def widest(self):
        """(rendered N/m, drag N·s/m), or a reason why there is none."""
        quiet = [best for best in (self.widest_with(factor) for factor in BED_FACTORS) if best.is_quiet]
        if not quiet:
            return None, None, "it is quiet at no stiffness that was tried"
        best = max(quiet, key=lambda pressed: pressed.rendered)
        return best.rendered, best.drag, ""
