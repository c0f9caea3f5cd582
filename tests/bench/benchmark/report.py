"""A result in words and pictures: report.md, errors.png, forces.png."""
import pathlib
import sys

import figures
import scene as scenes
import truth

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "deploy"))
from demo_plots import data_block, gnuplot, terminal  # noqa: E402

COLOURS = ("#104020", "#208040", "#70c070", "#808080", "#2060c0", "#e08020", "#9050b0", "#c03040", "#00a0a0")
PRESSED = ("plane", "sphere", "slot", "peg", "thin_wall")
# Of each column of the table: its head, the figure, the scenes, and which of several is told.
COLUMNS = (
    *((f"force error, {scene.replace('_', ' ')} %", "force_error", (scene,), max) for scene in PRESSED),
    ("peg's torque %", "torque_error", ("peg",), max),
    ("rigid: force, worst %", "rigid_force_error", PRESSED, max),
    ("false friction, ball, worst %", "false_friction", ("plane", "sphere", "slot"), max),
    ("edge %", "false_friction", ("edge_slide",), max),
    ("step, worst mN", "step_per_tick", ("plane", "sphere", "slot", "edge_slide"), max),
    ("closed path, µJ", "closed_path_energy", ("plane", "sphere", "slot"), max),
    ("walls kept", "wall_kept", ("thin_wall",), max),
    ("hole %", "removal_error", ("break_through",), max),
    ("groove %", "removal_error", ("groove",), max),
    ("voxels/ms", "voxels_per_second", ("groove",), max),
    ("tick p99.9, worst µs", "tick_p99_9", None, max),
    ("Z-width N/mm", "z_width", (), max),
)
FACTORS = {"step, worst mN": 1e3, "voxels/ms": 1e-3}
TRUTH = "truth"


def cell(program, head, name, wanted, choose):
    """A figure, or –: where one of its scenes has none, the worst is not known."""
    if wanted == ():
        values = [program["figures"].get(name, {"value": None})["value"]]
    else:
        scenes_run = program["scenes"]
        values = [scenes_run[scene][name]["value"] for scene in (scenes_run if wanted is None else wanted) if scene in scenes_run]
    if not values or None in values:
        return "–"
    return f"{FACTORS.get(head, 1) * choose(values):.3g}"


def is_busy(machine):
    """Did other programs take the ticks' time? The benchmark itself is one load."""
    return machine["load_before"] > 1 or machine["load_after"] > 2


def table(result):
    """A row a program. Of a busy machine it tells no times: they are in the file."""
    columns = [column for column in COLUMNS if column[1] not in figures.BY_THE_CLOCK or not is_busy(result["machine"])]
    lines = ["| program | " + " | ".join(head for head, *_ in columns) + " |", "|---|" + "--:|" * len(columns)]
    for program in result["programs"]:
        lines.append(f"| {program['name']} | " + " | ".join(cell(program, *column) for column in columns) + " |")
    return "\n".join(lines)


def every_figure(result):
    """All of it, a table for each scene, and why what is missing is missing."""
    lines = []
    names = [program["name"] for program in result["programs"]]
    for scene in dict.fromkeys(name for program in result["programs"] for name in program["scenes"]):
        lines += ["", f"### {scene}", "", "| figure | unit | " + " | ".join(names) + " |", "|---|---|" + "--:|" * len(names)]
        for figure in figures.OF_SCENES:
            told = [program["scenes"][scene][figure] for program in result["programs"]]
            if any(one["value"] is not None for one in told):
                cells = ("–" if one["value"] is None else f"{one['value']:.3g}" for one in told)
                lines.append(f"| {figure} | {figures.UNITS[figure]} | " + " | ".join(cells) + " |")
    lines += ["", "### Why there is a –", ""]
    for program in result["programs"]:
        reasons = {}
        for scene, told in [*program["scenes"].items(), ("all", program["figures"])]:
            for figure, one in told.items():
                if one["value"] is None and "in this scene" not in one["reason"] and "tells it" not in one["reason"]:
                    reasons.setdefault(one["reason"], []).append(f"{scene} {figure}")
        lines += [f"- {program['name']}: {reason} ({', '.join(places)})" for reason, places in reasons.items()]
    return "\n".join(lines)


def errors_picture(path, result):
    """Bars of the force error by scene, a colour for each program."""
    shown = [scene for scene in PRESSED if any(scene in program["scenes"] for program in result["programs"])]
    script, plots = [], []
    for n, program in enumerate(result["programs"]):
        values = [program["scenes"].get(scene, {}).get("force_error", {"value": None})["value"] for scene in shown]
        bars = (f"\"{scene}\" {'NaN' if value is None else max(value, 0.011)}" for scene, value in zip(shown, values))
        script.append(f"$p{n} << E\n" + "\n".join(bars) + "\nE\n")
        plots.append(f"$p{n} using 2:xtic(1) title \"{program['name']}\" noenhanced lc rgb '{COLOURS[n % len(COLOURS)]}'")
    gnuplot("".join(script) + f"""
{terminal(path, 1100, 520)}
set title "force of a held hand: apart from the truth of the bed (no bar: no figure)"
set style data histogram
set style fill solid 0.9
set boxwidth 0.9
set logscale y
set yrange [0.01:1000]
set ylabel "%, root mean square"
set xtics noenhanced
set grid ytics lc rgb "#dddddd"
set key outside right
plot {", ".join(plots)}
""")


def forces_picture(path, result, scene, answers):
    """The force along the face's normal in the scene plane, a panel for each program; circles are the bed's truth."""
    bed = truth.Truth(scene, is_rigid=False)
    true = [((a + b) / 2 / scenes.RATE_HZ, bed.at(scene.way.p[a], scene.way.R[a]).force[2]) for a, b in scene.way.holds()]
    programs = [program["name"] for program in result["programs"] if program["name"] in answers]
    script = data_block(TRUTH, true)
    for n, name in enumerate(programs):
        force = answers[name].force[:, 2]
        script += data_block(f"f{n}", [(t / scenes.RATE_HZ, f) for t, f in list(enumerate(force))[::4]])
    rows = -(-len(programs) // 3)
    script += f"""
{terminal(path, 1200, 60 + 240 * rows)}
set multiplot layout {rows},3 title "{scene.name}: force along the face's normal; circles: truth of the bed where the hand holds" noenhanced
set yrange [-0.2:3.2]
set xrange [0:{len(scene.way.p) / scenes.RATE_HZ:.2f}]
set grid lc rgb "#dddddd"
set xlabel "time, s"
set ylabel "N"
unset key
"""
    for n, name in enumerate(programs):
        script += (f"set title \"{name}\" noenhanced offset 0,-0.6\n"
                   f"plot $f{n} using 1:2 with lines lw 1.5 lc rgb '{COLOURS[n % len(COLOURS)]}', "
                   f"${TRUTH} using 1:2 with points pt 6 ps 1.6 lc rgb '#000000'\n")
    gnuplot(script)


def write(out, result, chosen):
    machine = result["machine"]
    remark = (f"{result['date']}, commit {result['commit']}, {machine['processor']}, {machine['cores']} cores, {machine['system']}. "
              f"Load of the machine (1 min) {machine['load_before']} before, {machine['load_after']} after: where it is above 1 before "
              "or 2 after, the times are bounds, and the first table has none.")
    left_out = "".join(f"\n{scene} is left out: {why}.\n" for scene, why in result["scenes_left_out"].items())
    pictures = []
    if any(scene.name in PRESSED for scene in chosen):
        errors_picture(out / "errors.png", result)
        pictures.append("![force error by scene](errors.png)")
    plane = next((scene for scene in chosen if scene.name == "plane"), None)
    answers = {}
    for program in result["programs"] if plane else []:
        if program["scenes"]["plane"]["force_error"]["value"] is not None:
            folder = out / "programs" / folder_of(program["name"])
            answers[program["name"]] = figures.read_answer(plane, folder / "plane" / "answer.csv")
    if answers:
        forces_picture(out / "forces.png", result, plane, answers)
        pictures.append("![force over time in the scene plane](forces.png)")
    (out / "report.md").write_text(f"# Benchmark of haptic milling\n\n{remark}\n{left_out}\n{table(result)}\n\n" + "\n\n".join(pictures) +
                                   f"\n\n## Every figure\n{every_figure(result)}\n", encoding="utf-8")


def folder_of(name):
    """Where a program's answers lie."""
    return "".join(letter if letter.isalnum() else "_" for letter in name)
