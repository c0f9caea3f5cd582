#!/usr/bin/env python3
"""Turns what deploy/demo left behind (traces, server and device reports, pictures) into plots, report.md, report.json.

Python's standard library and gnuplot only.
"""

import argparse
import datetime
import json
import os
import pathlib
import platform
import shutil
import sys

from demo_plots import plot_run

# These are the mean haptic rates of Eriksson, Haptic Milling Simulation in Six Degrees-of-Freedom, KTH 2012, section 5.3:
# 20 s on a Pentium 4 with a point-shell scaling factor of 3.
THESIS_RATE_HZ = {"corridor": 983, "wall": 991}
WANTED_RATE_HZ = 995
TITLES = {
    "corridor": "Milling a straight corridor from the crown into the tooth (thesis, figure 34)",
    "wall": "Pressing the shaft against the wall of the milled hole (thesis, figure 35)",
    "skull": "Milling a pit into the mastoid of a CT head",
    "pedicle": "A corridor through the pedicle of a vertebra, with all effects",
}
FAULT_MEANING = {
    "overrun": "the tick's own work took longer than its period",
    "stale_device": "no fresh device sample: the force ramped to zero",
    "bad_device_pose": "the device sent an impossible pose: the last good one was kept",
    "solve": "no equilibrium found: the tool kept its pose",
    "motion_clamped": "the speed limit of the virtual coupling acted",
    "force_clamped": "the limit of force or torque on the hand acted",
    "shell_overflow": "some milled surface had no contact points",
    "contact_overflow": "more points near the tool than there is room for: some had no effect",
    "implausible_device": "device_daemon said what cannot be: it was refused",
    "early_samples": "device samples came faster than the loop's rate: ticks were held back",
    "stalled": "forces were out of balance, but no step towards balance was found in a tick: the tool stood still",
    "volume_full": "no memory for more changed bone: what would need it was not milled",
    "milling_cut_short": "more to mill than there is time for in a tick: the rest was milled later",
    "not_recorded": "the recording or the trace lacks something: the disk was full or slow",
    "fewer_samples": "the contact was sampled less finely than asked for: more was too much for a tick",
    "coarser_shell": "fewer contact points than asked for: more were too many for a tick",
}


def fail(message):
    sys.exit(f"demo_report: {message}")


# --- reading ---------------------------------------------------------------------------------------------------


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        fail(f"{path}: {error}")


def json_lines(path):
    """Returns every line of a log that is a JSON object."""
    found = []
    for line in path.read_text(errors="replace").splitlines() if path.exists() else []:
        if line.startswith("{"):
            found.append(json.loads(line))
    return found


def histogram_percentile(histogram, percent):
    """The histogram maps a latency in us to its count."""
    wanted = percent / 100 * sum(histogram.values())
    seen = 0
    for latency in sorted(histogram):
        seen += histogram[latency]
        if seen >= wanted:
            return latency
    return None


def read_cyclictest(path):
    """Returns the machine's own wake-up latency, or None where it could not be measured."""
    if not path.exists():
        return None
    thread = read_json(path)["thread"]["0"]
    histogram = {int(latency): count for latency, count in thread["histogram"].items()}
    return {
        "p50": histogram_percentile(histogram, 50),
        "p99": histogram_percentile(histogram, 99),
        "p99_9": histogram_percentile(histogram, 99.9),
        "max": thread["max"],
        "mean": round(thread["avg"], 3),
    }


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def memory_gib():
    for line in pathlib.Path("/proc/meminfo").read_text().splitlines():
        if line.startswith("MemTotal"):
            return round(int(line.split()[1]) / 2**20, 1)
    return None


def machine():
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "memory_gib": memory_gib(),
        "kernel": platform.release(),
        "preempt_rt": "PREEMPT_RT" in platform.version(),
        "load_average_1min": round(os.getloadavg()[0], 2),
    }


def real_time_remarks(log):
    """Returns what the server says about the machine's real-time abilities."""
    remarks = []
    for line in log.read_text(errors="replace").splitlines() if log.exists() else []:
        if "real time: " in line:
            remarks.append(line.split("real time: ", 1)[1])
    return remarks


def collect_run(out, name):
    trace = out / f"trace_{name}.csv"
    sound = out / f"sound_{name}.wav"
    report = read_json(out / "logs" / f"server_{name}.json")
    devices = json_lines(out / "logs" / f"device_{name}.log")
    return {
        "name": name,
        "title": TITLES.get(name, name),
        "trace": trace.name,
        "loop": report,
        "device": devices[-1] if devices else None,
        "cyclictest_us": read_cyclictest(out / "logs" / f"cyclictest_{name}.json"),
        "real_time_remarks": real_time_remarks(out / "logs" / f"server_{name}.log"),
        "thesis_rate_hz": THESIS_RATE_HZ.get(name),
        "sound": sound.name if sound.exists() else None,
        "leaning": read_json(out / "logs" / "leaning.json") if name == "corridor" else None,  # deploy/demo_leaning.py
    }


# --- pictures --------------------------------------------------------------------------------------------------


def choose_pictures(out, name, ticks):
    """Chooses three pictures, copies them beside the report and returns their names: "before" shows the whole bone before
    the device came, "during" the middle of the run, "after" the last one while the loop ran."""
    folder = out / f"frames_{name}"
    chosen = {"before": folder / "before" / "frame_0000.png"}
    # Frames of the very end may already say that the server is gone.
    frames = [f for f in json_lines(out / "logs" / f"client_{name}.log") if 0 < f.get("tick", 0) < ticks - 100]
    if frames:
        half = ticks / 2
        chosen["during"] = folder / min(frames, key=lambda frame: abs(frame["tick"] - half))["file"]
        chosen["after"] = folder / frames[-1]["file"]
    pictures = {}
    for moment, source in chosen.items():
        if source.exists():
            shutil.copyfile(source, out / f"{name}_{moment}.png")
            pictures[moment] = f"{name}_{moment}.png"
    return pictures


# --- report ----------------------------------------------------------------------------------------------------


def number(value, digits=1):
    return "–" if value is None else f"{value:.{digits}f}"


def rate_table(runs):
    lines = [
        "| run | mean loop rate | slowest second | thesis, 2012 | dropped ticks | faults (ticks) |",
        "|---|---|---|---|---|---|",
    ]
    for run in runs:
        loop = run["loop"]
        thesis = f"{run['thesis_rate_hz']} Hz" if run["thesis_rate_hz"] else "–"
        faults = ", ".join(f"{name} ({count})" for name, count in loop["fault_ticks"].items()) or "none"
        lines.append(
            f"| {run['name']} | **{loop['mean_rate_hz']:.1f} Hz** | {loop['slowest_second_hz']:.0f} Hz | {thesis} "
            f"| {loop['dropped_ticks']} of {loop['ticks'] + loop['dropped_ticks']} | {faults} |"
        )
    return lines


def timing_table(runs):
    lines = ["| run | µs | p50 | p99 | p99.9 | max |", "|---|---|---|---|---|---|"]
    for run in runs:
        loop = run["loop"]
        rows = [
            ("tick's own work", loop["tick_compute_us"]),
            ("wake-up to force written", loop["force_ready_us"]),
            ("wake-up latency of the tick", loop["wakeup_latency_us"]),
            ("wake-up latency, machine idle (cyclictest)", run["cyclictest_us"]),
        ]
        for label, values in rows:
            if values is None:
                lines.append(f"| {run['name']} | {label} | not measured here | | | |")
            else:
                columns = " | ".join(number(values[key]) for key in ("p50", "p99", "p99_9", "max"))
                lines.append(f"| {run['name']} | {label} | {columns} |")
    return lines


def contact_table(runs):
    lines = [
        "| run | contacts, mean | contacts, max | force, max | torque, max | deepest penetration | bone removed |",
        "|---|---|---|---|---|---|---|",
    ]
    for run in runs:
        loop = run["loop"]
        lines.append(
            f"| {run['name']} | {loop['contacts_mean']:.0f} | {loop['contacts_max']} | {loop['force_max_n']:.2f} N "
            f"| {1e3 * loop['torque_max_nm']:.1f} N·mm | {loop['penetration_max_mm']:.3f} mm "
            f"| {loop['removed_mm3']:.2f} mm³ ({loop['removed_voxels']} voxels) |"
        )
    return lines


def effect_lines(runs):
    """Returns what the effects of a scene measured; nothing where no run has any."""
    lines = []
    for run in runs:
        figures = [
            f"{figure['words']} {figure['value']:.3g} {figure['unit']}" for figure in run["loop"].get("effects", [])
        ]
        if figures:
            lines.append(f"- {run['name']}: " + ", ".join(figures) + ".")
    return ["", "Effects (docs/reference/effects.md):", "", *lines] if lines else []


def verdict(runs):
    """Returns one plain sentence per verification run."""
    lines = []
    for run in runs:
        if run["thesis_rate_hz"] is None:
            continue
        rate = run["loop"]["mean_rate_hz"]
        met = "meets" if rate >= WANTED_RATE_HZ else "**misses**"
        lines.append(
            f"- {run['name']}: {rate:.1f} Hz {met} the wanted {WANTED_RATE_HZ} Hz "
            f"(thesis: {run['thesis_rate_hz']} Hz at point-shell scaling factor 3)."
        )
    return lines


def machine_lines(report):
    host = report["machine"]
    kind = "PREEMPT_RT" if host["preempt_rt"] else "not PREEMPT_RT"
    lines = [
        f"{host['processor']}, {host['cores']} cores, {host['memory_gib']} GiB, Linux {host['kernel']} ({kind}); "
        f"load average at the end {host['load_average_1min']}.",
        "",
    ]
    if not report["has_real_time"]:
        lines.append(
            "**This machine did not grant real-time scheduling or locked memory: everything ran with"
            "out them, as one process among others.**"
        )
    else:
        lines.append("The loops of haptic_server and device_daemon ran under SCHED_FIFO with locked memory.")
    remarks = sorted({remark for run in report["runs"] for remark in run["real_time_remarks"]})
    return lines + ["", *(f"- {remark}" for remark in remarks)]


def fault_lines(runs):
    names = sorted({name for run in runs for name in run["loop"]["fault_ticks"]})
    if not names:
        return ["No fault was raised."]
    return [f"- `{name}`: {FAULT_MEANING.get(name, 'see docs')}." for name in names]


def run_section(run):
    lines = [f"## {run['title']}", ""]
    if run["pictures"]:
        moments = list(run["pictures"])
        lines += ["| " + " | ".join(moments) + " |", "|" + "---|" * len(moments)]
        lines += ["| " + " | ".join(f"![{m}]({run['pictures'][m]})" for m in moments) + " |", ""]
    for label, plot in (("rate, force, torque, tick over time", "time"), ("shaft orientation", "orientation")):
        if plot in run["plots"]:
            lines += [f"![{label}]({run['plots'][plot]})", ""]
    device = run["device"]
    if device:
        lines += [
            f"Device side: {device['ticks']} ticks at {device['rate_hz']:.1f} Hz, {device['late_answers']} late answers "
            f"of the server, {device['stops']} stops, hand at most {device['device']['max_tracking_mm']:.2f} mm from "
            "where it wanted to be.",
            "",
        ]
    if run["sound"]:
        lines += [f"What it sounded like: [{run['sound']}]({run['sound']}).", ""]
    lines += [f"Every tick: [{run['trace']}]({run['trace']}) (columns: docs/reference/simulate.md).", ""]
    return lines


def leaning_section(told):
    """Returns nothing where no hand leant."""
    if told is None:
        return []
    return [
        f"## {told['title']}", "", "![force and torque over time](plot_leaning.png)", "",
        "![shaft orientation](orientation_leaning.png)", "",
        f"The same way, without real time, with the shaft leaning by up to {told['most_degrees']}° and round once: it touches the "
        f"bore's wall. Torque at most {1e3 * told['max_torque_nm']:.1f} N·mm, force {told['max_force_n']:.2f} N. "
        "Every tick: [trace_leaning.csv](trace_leaning.csv).", "",
    ]


LIMITS = """- Hand and device are simulated: a hand impedance that follows waypoints and reacts to the force, on an emulated
  six-legged device whose dimensions are placeholders. No person felt this.
- The thesis' runs were made by hand on other bone with a scaling factor of 3; the rates compare, the curves only in kind.
- All three programs shared this machine, and the viewer drew on the processor. On two cores that costs latency.
- The force is that of the scene's accuracy preset (`balanced` unless it says otherwise); its error against a converged
  solution: docs/explanation/accuracy.md. Removal is by time, as in the thesis, and so depends on more than force;
  only in `pedicle` by energy.
- cyclictest ran right before each run, while the server idled, not during it: it would disturb what it measures."""


def cut_lines(seconds, runs):
    if seconds is None:
        return []
    sentence = f"The runs were cut to {seconds:g} s: scenarios that last longer were not finished"
    if any(run["name"] == "wall" for run in runs):
        sentence += ", and the wall run has no finished hole unless an earlier whole demo left one"
    return [f"**{sentence}.**", ""]


def write_markdown(out, report):
    runs = report["runs"]
    lines = [
        "# bonemill demo",
        "",
        f"{report['date']}. Each run went in real time through haptic_server, device_daemon and render_client.",
        "",
        *cut_lines(report["cut_to_s"], runs),
        *verdict(runs),
        "",
        *rate_table(runs),
        "",
        "## Timing",
        "",
        *timing_table(runs),
        "",
        "A tick may take 1000 µs. The wake-up latency is the machine's share, the tick's own work is ours.",
        "",
        "## Contact and milling",
        "",
        *contact_table(runs),
        *effect_lines(runs),
        "",
        "## Faults",
        "",
        *fault_lines(runs),
        "",
        "## Machine",
        "",
        *machine_lines(report),
        "",
    ]
    for run in runs:
        lines += run_section(run) + leaning_section(run["leaning"])
    lines += ["## What this does not show", "", LIMITS, ""]
    (out / "report.md").write_text("\n".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder with traces and logs/")
    parser.add_argument("--seconds", type=float, help="the runs were cut to so many seconds")
    parser.add_argument("names", nargs="+", help="runs, as in trace_NAME.csv")
    arguments = parser.parse_args()
    out = arguments.out
    runs = [collect_run(out, name) for name in arguments.names]
    for run in runs:
        run["pictures"] = choose_pictures(out, run["name"], run["loop"]["ticks"])
        run["plots"] = plot_run(out, run)
    report = {
        "date": datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
        "machine": machine(),
        "has_real_time": not any(remark.startswith("going on without") for run in runs for remark in run["real_time_remarks"]),
        "cut_to_s": arguments.seconds,
        "runs": runs,
    }
    (out / "report.json").write_text(json.dumps(report, indent=2, ensure_ascii=False) + "\n")
    write_markdown(out, report)


if __name__ == "__main__":
    main()
