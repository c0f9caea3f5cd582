#!/usr/bin/env python3
"""Torque and orientation of a hand that leans, for deploy/demo: the hand of a scene keeps its shaft so upright that the wall of what it
mills is never touched. This one goes the same way, and leans while the pedal is down.

    deploy/demo_leaning.py SCENE.textproto --server build/release/bin/haptic_server --out DIR

It runs without real time. DIR gets trace_leaning.csv, plot_leaning.png, orientation_leaning.png and logs/leaning.json."""
import argparse
import json
import math
import pathlib
import sys

import scene_way
from demo_plots import plot_orientation, plot_time_series, read_trace

MOST_DEGREES = 6  # So the neck of the tooth's 2 mm burr touches the wall once the burr is some 3 mm below the crown.
GROWS_FOR = 0.4   # share of the milling in which the lean comes
TITLE = "The corridor, milled by a hand that leans (thesis, figure 34)"


def fail(message):
    print(f"demo_leaning: {message}", file=sys.stderr)
    sys.exit(2)


def product(a, b):
    (w, x, y, z), (v, i, j, k) = a, b
    return [w * v - x * i - y * j - z * k, w * i + x * v + y * k - z * j, w * j - x * k + y * v + z * i, w * k + x * j - y * i + z * v]


def leaning(points):
    """The same waypoints; the shaft leans about the burr and goes once round while the pedal is down."""
    milling = [t for t, _, _, buttons in points if buttons & 1]
    if not milling or milling[0] == milling[-1]:
        fail("the scene's hand mills nothing")
    begin, end = milling[0], milling[-1]
    leant = []
    for t, place, turn, buttons in points:
        share = (t - begin) / (end - begin)
        half = math.radians(MOST_DEGREES) / 2 * (max(0.0, min(1.0, share / GROWS_FOR)) if share <= 1 else 0.0)
        around = 2 * math.pi * share
        lean = [math.cos(half), math.sin(half) * math.cos(around), math.sin(half) * math.sin(around), 0.0]
        leant.append((t, place, product(lean, turn), buttons))
    return leant


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--server", type=pathlib.Path, required=True, help="haptic_server")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder")
    options = parser.parse_args()
    out, trace = options.out, options.out / "trace_leaning.csv"
    try:
        (out / "logs").mkdir(parents=True, exist_ok=True)
        text = options.scene.read_text()
        trajectory = out / "logs" / "leaning_way.csv"
        scene_way.write_trajectory(trajectory, leaning(scene_way.waypoints(text)), scene_way.rate_hz(text))
        told = scene_way.simulate(options.server, options.scene, trajectory, trace)
        rows = read_trace(trace)
        plot_time_series(rows, TITLE, out / "plot_leaning.png", live=False)
        plot_orientation(rows, TITLE, out / "orientation_leaning.png")
        (out / "logs" / "leaning.json").write_text(json.dumps({**told, "title": TITLE, "most_degrees": MOST_DEGREES}) + "\n")
    except scene_way.SimulateError as error:
        fail(error)
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
