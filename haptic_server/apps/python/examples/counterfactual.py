"""What if? A recorded session up to a moment, then as it happened and otherwise, side by side.

    counterfactual.py SESSION.mcap --at SECONDS [--shift-mm X Y Z] [--tool NAME]

Both runs are the same to the bit up to that moment. Then the recorded hand goes on, shifted, and with another burr
of the scene where one is named; orders of the session (pause, put the bone back) are not repeated there. Printed: removed bone, force, heat and damage where the scene has them, and the score.
"""
import argparse

import numpy as np

import bonemill

SUMMED = {"force_n": "largest force N", "removed_mm3": "removed mm3", "temperature_c": "hottest C",
          "damaged_mm3": "damaged mm3"}


def told(columns):
    """One figure a column: what a run was like from that moment on."""
    row = {}
    for name, label in SUMMED.items():
        if name not in columns:
            continue
        values = columns[name]
        row[label] = {"removed_mm3": np.sum, "damaged_mm3": lambda v: v[-1]}.get(
            name, lambda v: np.linalg.norm(v, axis=1).max() if v.ndim == 2 else np.nanmax(v))(values)
    return row


def score(run):
    if not run.has_task:
        return {}
    judgement = run.judge()
    return {"score": 100 * judgement["total"]["score"]} if "total" in judgement else {}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("session")
    parser.add_argument("--at", type=float, required=True)
    parser.add_argument("--shift-mm", type=float, nargs=3, default=(0, 0, 0))
    parser.add_argument("--tool")
    options = parser.parse_args()
    recording = bonemill.read_recording(options.session)
    happened, otherwise = bonemill.replay(recording), bonemill.replay(recording)
    happened.run_recorded(until_s=options.at)
    otherwise.run_recorded(until_s=options.at)
    assert happened.state_hash == otherwise.state_hash
    first = happened.ticks
    if options.tool:
        otherwise.tool = options.tool
    hand = recording.hand()
    shift = np.array(options.shift_mm) * 1e-3
    rows = {"as it happened": told(happened.run_recorded()),
            "otherwise": told(otherwise.run(hand["positions_m"][first:] + shift, hand["orientations_wxyz"][first:],
                                            hand["buttons"][first:]))}
    rows["as it happened"] |= score(happened)
    rows["otherwise"] |= score(otherwise)
    print(f"from {recording.hand()['t_s'][first]:.3f} s on")
    for label in rows["otherwise"]:
        print(f"{label:18s}" + "".join(f"{name} {row[label]:10.4f}   " for name, row in rows.items()))


if __name__ == "__main__":
    main()
