"""A scene's file, and the folder that a program is given of it: volume.nrrd, trajectory.csv and scene.json.

The way of the hand is written in words, in mm of the body's frame B:
  {"at": [x, y, z]}                                      begins there
  {"to": [x, y, z], "mm_per_s": v, "as": PHASE}          goes there, with soft ends; "mill": true with the pedal down
  {"arc_deg": a, "axis": [x, y, z], "mm_per_s": v}       turns about the origin
  {"lean_deg": a, "axis": [x, y, z], "seconds": s}       turns the tool about its own point
  {"hold_s": s, "as": "hold"}                            stays
  {"loop": [[x, y, z], ...], "mm_per_s": v, "times": n}  goes by these points and back to where it was, n times
PHASE says what is measured on the part of constant speed: air, slide, press, mill; nothing without it."""
import csv
import dataclasses
import json
import pathlib

import numpy as np

import bodies
import nrrd

RATE_HZ = 1000
SOFT_S = 0.05  # of the speed's rise and fall
JUDGED_S = 0.05  # a hold is judged by its end
HERE = pathlib.Path(__file__).resolve().parent
COLUMNS = ["t_s", "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz", "buttons"]


@dataclasses.dataclass
class Way:
    """A row a tick, in B: the hand's places, turns and pedal, and the phase of each row ('' where nothing is measured)."""
    p: np.ndarray
    R: np.ndarray
    buttons: np.ndarray
    phase: np.ndarray
    loop: np.ndarray  # which round of a closed path, from 1; 0 elsewhere

    def holds(self):
        """(first, last + 1) of the judged end of each hold."""
        held = np.flatnonzero(np.diff(np.concatenate([[0], self.phase == "hold", [0]]).astype(int)))
        return [(last - int(JUDGED_S * RATE_HZ), last) for last in held[1::2]]


class _Walk:
    def __init__(self, shaft):
        self.rows, self.R, self.place = [], bodies.turn_of(shaft), None

    def add(self, p, phase="", buttons=0, loop=0):
        self.rows.append((np.array(p, float), self.R, buttons, phase, loop))
        self.place = np.array(p, float)

    def leg(self, length, speed, place_at, phase, buttons=0, loop=0):
        """Goes `length` metres; place_at(s) is where one is after s of them."""
        soft = min(SOFT_S, length / speed)
        seconds = length / speed + soft
        ticks = max(1, int(np.ceil(seconds * RATE_HZ)))
        t = np.arange(1, ticks + 1) / ticks * seconds
        ramp = lambda u: soft * (u / 2 - np.sin(np.pi * u) / (2 * np.pi))  # integral of (1 - cos) / 2
        late = length / speed - ramp((seconds - t) / soft)
        s = speed * np.where(t < soft, ramp(t / soft), np.where(t > seconds - soft, late, t - soft / 2))
        for time, way in zip(t, s):
            even = soft + 1 / RATE_HZ < time < seconds - soft
            self.add(place_at(way), phase if even else "", buttons, loop)

    def line(self, target, speed, phase="", buttons=0, loop=0):
        start, step = self.place, np.asarray(target) - self.place
        length = np.linalg.norm(step)
        self.leg(length, speed, lambda s: start + s / length * step, phase, buttons, loop)

    def do(self, step):
        phase, speed = step.get("as", ""), step.get("mm_per_s", 0) / 1e3
        if "at" in step:
            self.add(np.array(step["at"]) / 1e3)
        elif "to" in step:
            self.line(np.array(step["to"]) / 1e3, speed, phase, int(step.get("mill", False)))
        elif "arc_deg" in step:
            start, angle = self.place, np.deg2rad(step["arc_deg"])
            radius = np.linalg.norm(start - np.dot(start, step["axis"]) * np.array(step["axis"]))
            self.leg(abs(angle) * radius, speed,
                     lambda s: bodies.rotation(step["axis"], np.sign(angle) * s / radius) @ start, phase)
        elif "lean_deg" in step:
            ticks, start = int(step["seconds"] * RATE_HZ), self.R
            for n in range(1, ticks + 1):
                share = (1 - np.cos(np.pi * n / ticks)) / 2
                self.R = bodies.rotation(step["axis"], share * np.deg2rad(step["lean_deg"])) @ start
                self.add(self.place, phase)
        elif "loop" in step:
            home = self.place
            for round_ in range(1, step["times"] + 1):
                for point in [*(np.array(p) / 1e3 for p in step["loop"]), home]:
                    self.line(point, speed, phase, loop=round_)
        else:
            for _ in range(int(step["hold_s"] * RATE_HZ)):
                self.add(self.place, phase)


class Scene:
    """What a file of `scenes` says."""

    def __init__(self, path):
        self.told = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        self.name = pathlib.Path(path).stem
        self.tool, self.contact = self.told["tool"], self.told["contact"]
        self.radius = self.tool["radius_mm"] / 1e3
        body = self.told["body"]
        self.body = None if "file" in body else bodies.Body(body["kind"], body.get("size_mm", 0) / 1e3)
        place = self.told.get("placement", {"axis": [1, 0, 0], "turn_deg": 0, "shift_mm": [0, 0, 0]})
        self.placement = bodies.Placement(bodies.rotation(place["axis"], np.deg2rad(place["turn_deg"])), np.array(place["shift_mm"]) / 1e3)
        walk = _Walk(self.tool["shaft"])
        for step in self.told["way"]:
            walk.do(step)
        p, R, buttons, phase, loop = zip(*walk.rows)
        self.way = Way(np.array(p), np.array(R), np.array(buttons), np.array(phase), np.array(loop))

    def hand_W(self):
        """Places and quaternions (w, x, y, z) in W."""
        turns = np.array([bodies.quaternion(self.placement.R_WB @ R) for R in self.way.R])
        return self.placement.to_world(self.way.p), turns

    def missing(self, ct):
        """Why it cannot be run, or nothing."""
        wanted = self.told["body"].get("file")
        return f"{wanted} is not here (--ct FILE)" if wanted and not (ct and pathlib.Path(ct).is_file()) else ""

    def write(self, folder, ct=None):
        """The folder that a program is given."""
        folder.mkdir(parents=True, exist_ok=True)
        volume = self.told["volume"]
        if self.body:
            voxel, shape = volume["voxel_mm"] / 1e3, volume["voxels"]
            origin = -voxel * (np.array(shape) - 1) / 2
            nrrd.write(folder / "volume.nrrd", bodies.values(self.body, self.placement, shape, voxel, origin), voxel, origin)
        else:
            (folder / "volume.nrrd").write_bytes(pathlib.Path(ct).read_bytes())
        places, turns = self.hand_W()
        with open(folder / "trajectory.csv", "w", newline="", encoding="utf-8") as file:
            rows = csv.writer(file)
            rows.writerow(COLUMNS)
            for n, (p, q, pedal) in enumerate(zip(places, turns, self.way.buttons)):
                rows.writerow([f"{n / RATE_HZ:.3f}", *(repr(float(v)) for v in (*p, *q)), pedal])
        told = {"format": "haptic-milling-scene", "version": 1, "name": self.name, "rate_hz": RATE_HZ, "volume": volume,
                "tool": self.tool, "contact": self.contact}
        (folder / "scene.json").write_text(json.dumps(told, indent=2) + "\n", encoding="utf-8")


def files():
    return sorted((HERE / "scenes").glob("*.json"))
