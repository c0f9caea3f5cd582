"""Figure 34 of the thesis: force and torque on the hand while a corridor is milled from the crown into the tooth.

    corridor_figure.py deploy/scenes/tooth_corridor.textproto [--plot FILE.png]

The scene's own hand mills, as if nothing could hold it up.
"""
import argparse

import numpy as np

import bonemill
import plot


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--plot")
    options = parser.parse_args()
    sim = bonemill.Scene.load(options.scene).simulation()
    way = bonemill.scripted_hand(sim)
    run = sim.run(way["positions_m"], way["orientations_wxyz"], way["buttons"])
    force, torque = (np.linalg.norm(run[name], axis=1) for name in ("force_n", "torque_nm"))
    milling = run["removed_voxels"] > 0
    print(f"{sim.ticks} ticks, {run['removed_mm3'].sum():.2f} mm3 removed in {milling.sum()} of them; force "
          f"p50 {np.median(force[milling]):.3f} N, largest {force.max():.3f} N; largest torque {1e3 * torque.max():.3f} N mm")
    if options.plot:
        plot.lines(options.plot, "The corridor (thesis, figure 34)", "s", "N, N mm", run["t_s"],
                   {"force, N": force, "torque, N mm": 1e3 * torque})


if __name__ == "__main__":
    main()
