"""What accuracy costs: one way of the hand under every accuracy of a scene, and each one's time against its error.

    price_of_accuracy.py SCENE [--ticks N] [--plot FILE.png]

The error is the mean distance of the force on the hand from that of `exact`, in per cent of its mean, over ticks in
contact. Times are this computer's: give it nothing else to do.
"""
import argparse

import numpy as np

import bonemill
import plot


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--ticks", type=int, default=5000)
    parser.add_argument("--plot")
    options = parser.parse_args()
    scene = bonemill.Scene.load(options.scene)
    runs = {}
    for accuracy in ("exact", "balanced", "fast"):
        sim = scene.simulation(accuracy=accuracy)
        way = bonemill.scripted_hand(sim)
        hand = [way[name][: options.ticks] for name in ("positions_m", "orientations_wxyz")]
        runs[accuracy] = sim.run(*hand)  # no button: every run meets the same bone
    truth = runs["exact"]["force_n"]
    touching = np.linalg.norm(truth, axis=1) > 0.05
    if not touching.any():
        raise SystemExit(f"{options.scene}: its hand touches nothing in the first {options.ticks} ticks")
    mean = np.linalg.norm(truth[touching], axis=1).mean()
    rows = {name: (100 * np.linalg.norm(run["force_n"][touching] - truth[touching], axis=1).mean() / mean,
                   np.median(run["tick_us"][touching]), np.percentile(run["tick_us"][touching], 99))
            for name, run in runs.items()}
    print(f"{'accuracy':10s} {'error %':>8s} {'p50 us':>8s} {'p99 us':>8s}")
    for name, (error, p50, p99) in rows.items():
        print(f"{name:10s} {error:8.3f} {p50:8.1f} {p99:8.1f}")
    if options.plot:
        plot.lines(options.plot, "What accuracy costs", "error, % of the force", "tick in contact, us",
                   [row[0] for row in rows.values()],
                   {"p50": [row[1] for row in rows.values()], "p99": [row[2] for row in rows.values()]}, "linespoints")


if __name__ == "__main__":
    main()
