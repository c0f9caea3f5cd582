"""The thesis' figures 34 and 35 of any session: haptic rate, force, torque and the tool's axis over 20 s, from a trace.

  deploy/study figures TRACE.csv --out DIR [--from S] [--seconds S] [--svg]

TRACE.csv is what haptic_server or haptic_server simulate wrote with --trace."""

import argparse
import pathlib
import re
import sys

from demo_plots import plot_orientation, plot_time_series, read_trace

NEEDED = ("t_s", "fx_n", "fy_n", "fz_n", "tx_nm", "ty_nm", "tz_nm", "tick_us", "contacts", "spo_qw", "spo_qx", "spo_qy", "spo_qz")


def fail(message):
    print(f"study figures: {message}", file=sys.stderr)
    sys.exit(2)


def read_window(path, begin, seconds):
    """The rows of the window, with times that begin at 0."""
    try:
        rows = read_trace(path)
    except OSError as error:
        fail(f"{path}: cannot be read ({error.strerror})")
    except (ValueError, TypeError, UnicodeDecodeError):
        fail(f"{path}: is no trace; name what haptic_server wrote with --trace")
    missing = [name for name in NEEDED if rows and name not in rows[0]]
    if missing:
        fail(f"{path}: is no trace, it has no column {missing[0]}; name what haptic_server wrote with --trace")
    start = rows[0]["t_s"] + begin if rows else 0
    window = [dict(row, t_s=row["t_s"] - start) for row in rows if start <= row["t_s"] < start + seconds]
    if len(window) < 2:
        fail(f"{path}: has fewer than two ticks from {begin:g} s on for {seconds:g} s")
    return window


def main():
    parser = argparse.ArgumentParser(prog="study figures", description="haptic rate, force, torque and axis of a session")
    parser.add_argument("trace", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder")
    parser.add_argument("--from", dest="begin", type=float, default=0, help="seconds after the first tick")
    parser.add_argument("--seconds", type=float, default=20, help="length of the window, as in the thesis 20")
    parser.add_argument("--svg", action="store_true", help="SVG instead of PNG")
    options = parser.parse_args()
    if not (options.begin >= 0 and 0 < options.seconds <= 3600):
        fail("--from must not be negative, --seconds above 0 and at most 3600")
    rows = read_window(options.trace, options.begin, options.seconds)
    options.out.mkdir(parents=True, exist_ok=True)
    ending = ".svg" if options.svg else ".png"
    name = re.sub(r"[^\w .-]|_", " ", options.trace.stem)  # gnuplot reads quotes, _ and ^ as its own
    title = f"{name}, {options.seconds:g} s from {options.begin:g} s"
    paths = []
    for plot, name in ((plot_time_series, "traces"), (plot_orientation, "axis")):
        paths.append(options.out / (name + ending))
        plot(rows, title, paths[-1])
    print("\n".join(map(str, paths)))


main()
