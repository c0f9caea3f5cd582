"""The plots of deploy/demo and deploy/study: what gnuplot makes of a trace."""

import csv
import math
import statistics
import subprocess
import sys


def read_trace(path):
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def gnuplot(script):
    result = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True, check=False)
    if result.returncode:
        sys.exit(f"gnuplot: {result.stderr.strip()}")


def terminal(path, width, height):
    """The picture's kind goes by the ending of its name. A path of quotes and backslashes would end gnuplot's text."""
    kind = "svg enhanced background rgb 'white'" if str(path).endswith(".svg") else "pngcairo"
    name = str(path).replace("'", "''")
    return f"set terminal {kind} size {width},{height} font \"DejaVu Sans,11\"\nset output '{name}'"


def rate_in_windows(rows, window_s=0.1):
    """Returns the ticks per second in windows of window_s."""
    counts = {}
    for row in rows:
        index = int(row["t_s"] / window_s + 1e-6)  # 0.3 s divided by 0.1 s is a little below 3
        counts[index] = counts.get(index, 0) + 1
    whole = range(max(counts)) if counts else []  # The last window is not full.
    return [((i + 0.5) * window_s, counts.get(i, 0) / window_s) for i in whole]


def nominal_rate(rows):
    """The loop's rate: what most of the ticks keep, to 50 Hz."""
    gap_s = statistics.median(later["t_s"] - row["t_s"] for row, later in zip(rows, rows[1:]))
    return 50 * round(1 / gap_s / 50) if gap_s > 0 else 1000


def shaft_direction(row):
    """Returns the tool's +y (along the shaft, to the hand) in the world, a point on the unit sphere."""
    w, x, y, z = (row[f"spo_q{c}"] for c in "wxyz")
    return (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))


def data_block(name, rows):
    lines = [" ".join(f"{value:.9g}" for value in row) for row in rows]
    return f"${name} << END_OF_DATA\n" + "\n".join(lines) + "\nEND_OF_DATA\n"


TIME_AXIS = 'set xlabel "time, s"\n'
TICK_PANEL = f"""{TIME_AXIS}set ylabel "tick, µs"
set y2label "contacts"
set y2tics
set ytics nomirror
set key top left
plot $compute using 1:3 axes x1y2 with lines lc rgb "#c0a060" title "contacts", $compute using 1:2 with lines lc rgb "#2050a0" title "tick's own work"
"""


def rate_panel(rows):
    nominal = nominal_rate(rows)
    return f"""
set ylabel "rate, Hz"
set yrange [0:{1.2 * nominal:g}]
plot {nominal} with lines dt 2 lc rgb "#888888" title "nominal", $rate with steps lw 1.5 lc rgb "#2050a0" title "haptic rate, 100 ms windows"
"""


def plot_time_series(rows, title, path, live=True):
    """Force and torque; what the machine did, rate and ticks, only of a live run."""
    force = [(r["t_s"], r["fx_n"], r["fy_n"], r["fz_n"], math.hypot(r["fx_n"], r["fy_n"], r["fz_n"])) for r in rows]
    torque = [
        (r["t_s"], *(1e3 * r[f"t{c}_nm"] for c in "xyz"), 1e3 * math.hypot(r["tx_nm"], r["ty_nm"], r["tz_nm"]))
        for r in rows
    ]
    compute = [(r["t_s"], r["tick_us"], r["contacts"]) for r in rows]
    components = "".join(
        f'${{block}} using 1:{column} with lines lc rgb "{colour}" title "{axis}", '
        for column, axis, colour in ((2, "x", "#d06050"), (3, "y", "#50a060"), (4, "z", "#5080d0"))
    )
    norm = '${block} using 1:5 with lines lc rgb "#202020" title "norm"'
    gnuplot(
        data_block("rate", rate_in_windows(rows))
        + data_block("force", force)
        + data_block("torque", torque)
        + data_block("compute", compute)
        + f"""
{terminal(path, 1200, 1300 if live else 750)}
set multiplot layout {4 if live else 2},1 title "{title}" font ",14"
set lmargin 10
set rmargin 10
set grid lc rgb "#dddddd"
set xrange [0:{max(r["t_s"] for r in rows):.3f}]
set key top right horizontal
{rate_panel(rows) if live else ""}set yrange [*:*]
set ylabel "force on the hand, N"
plot {(components + norm).replace("${block}", "$force")}
{"" if live else TIME_AXIS}set ylabel "torque on the hand, N·mm"
plot {(components + norm).replace("${block}", "$torque")}
{TICK_PANEL if live else ""}"""
    )


def plot_orientation(rows, title, path):
    points = [(*shaft_direction(r), r["t_s"]) for r in rows[::5]]
    centre = [sum(p[a] for p in points) / len(points) for a in range(3)]
    reach = max(1e-4, 1.1 * max(abs(p[a] - centre[a]) for p in points for a in range(3)))
    zoom = "".join(f"set {a}range [{c - reach:.9g}:{c + reach:.9g}]\n" for a, c in zip("xyz", centre))
    tics = "".join(f'set {a}tics {2 * reach / 3:.2g} format "%.3g"\n' for a in "xyz")
    gnuplot(
        data_block("path", points)
        + f"""
{terminal(path, 1400, 700)}
set multiplot layout 1,2 title "{title}: shaft direction on the unit sphere" font ",14"
set palette rgbformulae 33,13,10
set cblabel "time, s" offset 1
set cbrange [0:{rows[-1]["t_s"]:.3f}]
set xlabel "x"
set ylabel "y"
set zlabel "z" offset 2
set view equal xyz
set view 65,40,1.1
set xyplane 0
set parametric
set isosamples 25,25
set urange [0:2*pi]
set vrange [-pi/2:pi/2]
set xrange [-1:1]
set yrange [-1:1]
set zrange [-1:1]
splot cos(u)*cos(v),sin(u)*cos(v),sin(v) with lines lc rgb "#d8d8d8" lw 0.3 notitle, $path using 1:2:3:4 with linespoints pt 7 ps 0.5 lc palette title "whole sphere"
unset parametric
unset view
set view 65,40,1.1
{zoom}{tics}set title "zoomed: {2 * reach:.3g} wide ({math.degrees(2 * math.asin(min(1, reach))):.2g}°)"
splot $path using 1:2:3:4 with linespoints pt 7 ps 0.5 lc palette notitle
"""
    )


def plot_run(out, run):
    """Makes the plots of one run; with fewer than two ticks there is nothing to plot."""
    rows = read_trace(out / run["trace"])
    if len(rows) < 2:
        return {}
    name, title = run["name"], run["title"]
    plots = {"time": f"plot_{name}.png", "orientation": f"orientation_{name}.png"}
    plot_time_series(rows, title, out / plots["time"])
    plot_orientation(rows, title, out / plots["orientation"])
    return plots
