"""Close the loop with your own device: a mass on a spring and a damper, dry friction, an amplifier's lag, an encoder.

    closed_loop.py SCENE [--delay TICKS]

SCENE has a block with a flat top and a ball of 1 mm for a tool. 24 devices and hands press it with 2 N
through DELAY ticks; the force of the last 0.2 s is quiet (N RMS about its mean at most 0.05) or buzzes. These are the
points of the stability grid on the plane (docs, "stability": loop_grid_plane_one_tick, loop_grid_plane_three_ticks).
"""
import argparse
import collections
import itertools
import math

import numpy as np

import bonemill

PUSH_N, QUIET_N, RADIUS_M, SUBSTEPS = 2.0, 0.05, 1e-3, 40
DEVICES = {  # mass kg, damping N s/m, dry friction N, amplifier Hz
    "light": (0.1, 0.5, 0.1, 1000),
    "typical": (0.25, 2, 0.2, 500),
    "heavy": (0.4, 5, 0.5, 200),
}
HANDS = {"none": (0, 0, 0), "soft": (0.05, 1, 50), "typical": (0.1, 8, 600), "stiff": (0.2, 15, 1000)}  # kg, N s/m, N/m
ENCODERS_M = (5e-6, 20e-6)


class Handle:
    """The device's handle with the hand on it, along z."""

    def __init__(self, device, hand, z, period_s):
        self.mass, self.damping = device[0] + hand[0], device[1] + hand[1]
        self.friction, self.stiffness = device[2], hand[2]
        self.z, self.v, self.drive, self.h = z, 0.0, 0.0, period_s / SUBSTEPS
        self.settled = -math.expm1(-2 * math.pi * device[3] * self.h)
        self.target = z - PUSH_N / self.stiffness if self.stiffness else z
        self.weight = 0.0 if self.stiffness else -PUSH_N

    def live(self, force):
        for _ in range(SUBSTEPS):
            self.drive += self.settled * (force - self.drive)
            middle = self.z + self.h / 2 * self.v
            pull = self.stiffness * (self.target - middle) + self.drive + self.weight
            momentum = self.mass * self.v + self.h * pull
            left = max(abs(momentum) - self.h * self.friction, 0.0)
            self.v = math.copysign(left, momentum) / (self.mass + self.h * self.damping)
            self.z = middle + self.h / 2 * self.v


def buzz(sim, top_m, device, hand, encoder_m, delay):
    sim.reset()
    handle = Handle(device, hand, top_m + RADIUS_M + 0.2e-3, sim.period_s)
    under_way, forces = collections.deque([0.0] * delay), []
    for tick in range(700):
        measured = round(handle.z / encoder_m) * encoder_m
        under_way.append(sim.step([0, 0, measured]).force_n[2])
        forces.append(under_way[-1])
        handle.live(under_way.popleft())
    return float(np.std(forces[500:]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--delay", type=int, default=1)
    options = parser.parse_args()
    sim = bonemill.Scene.load(options.scene).simulation(keep_inputs=False)
    top_m = sim.mesh()[0][:, 2].max()
    worst, buzzing = 0.0, []
    for (device, d), (hand, h), encoder_m in itertools.product(DEVICES.items(), HANDS.items(), ENCODERS_M):
        rms = buzz(sim, top_m, d, h, encoder_m, options.delay)
        worst = max(worst, rms)
        if rms > QUIET_N:
            buzzing.append(f"{device}/{hand}/{encoder_m * 1e6:.0f}um")
            print(f"{buzzing[-1]:24s} {rms:8.4f} N RMS")
    print(f"delay {options.delay}: worst {worst:.2g} N RMS, {100 * len(buzzing) / 24:.3g} % of 24 points buzz")


if __name__ == "__main__":
    main()
