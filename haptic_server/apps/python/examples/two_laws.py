"""Two contact laws on your own scan: the same hand, and what differs.

    two_laws.py SCENE [--laws gradient,constraint] [--set PATH=VALUE]... [--ticks N] [--plot FILE.png]

For another bone than the scene's: --set volume.path=/home/me/scan.nrrd, and what else it wants (docs, "volumes").
"""
import argparse

import numpy as np

import bonemill
import plot


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--laws", default="gradient,constraint")
    parser.add_argument("--set", action="append", default=[], dest="settings")
    parser.add_argument("--ticks", type=int, default=5000)
    parser.add_argument("--plot")
    options = parser.parse_args()
    scene = bonemill.Scene.load(options.scene, options.settings)
    runs = {}
    for law in options.laws.split(","):
        sim = scene.simulation(law=law)
        way = bonemill.scripted_hand(sim)
        run = sim.run(*(way[name][: options.ticks] for name in ("positions_m", "orientations_wxyz", "buttons")))
        force = np.linalg.norm(run["force_n"], axis=1)
        runs[law] = run["t_s"], force
        apart = np.linalg.norm(run["hand_p_m"] - run["tool_p_m"], axis=1)
        print(f"{law:12s} force p95 {np.percentile(force, 95):7.3f} N, largest {force.max():7.3f} N, hand from tool p95 "
              f"{1e3 * np.percentile(apart, 95):6.3f} mm, removed {run['removed_mm3'].sum():8.3f} mm3")
    if options.plot:
        t = next(iter(runs.values()))[0]
        plot.lines(options.plot, "Force on the hand", "s", "N", t, {law: force for law, (_, force) in runs.items()})


if __name__ == "__main__":
    main()
