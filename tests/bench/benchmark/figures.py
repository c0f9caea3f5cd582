"""What the figures are, and how an answer's are taken. This table is the definition; docs/reference/benchmark.md says it in words.

A figure is {"value": number, "unit": …}, or {"value": null, "unit": …, "reason": words}."""
import csv
import dataclasses

import numpy as np

import nrrd
import scene as scenes
import truth

UNITS = {
    "force_error": "%", "rigid_force_error": "%", "torque_error": "%", "rigid_torque_error": "%", "false_friction": "%",
    "free_drag": "N·s/m", "step_per_tick": "N", "closed_path_energy": "µJ", "closed_path_exchanged": "µJ", "wall_kept": "of presses",
    "removal_error": "%", "voxels_per_second": "1/s", "tick_p50": "µs", "tick_p99_9": "µs",
    "z_width": "N/mm", "z_width_drag": "N·s/m", "cut_to_screen_p99": "ms",
}
OF_SCENES = [name for name in UNITS if name not in ("z_width", "z_width_drag", "cut_to_screen_p99")]
BY_THE_CLOCK = ("voxels_per_second", "tick_p50", "tick_p99_9")
LEAST_NORMAL_N = 0.05  # with less the tool has lost the bone
NEEDED = ["fx_n", "fy_n", "fz_n", "px_m", "py_m", "pz_m"]


def figure(name, value=None, reason=""):
    """`value` is null with a reason, never without."""
    if value is None or not np.isfinite(value):
        return {"value": None, "unit": UNITS[name], "reason": reason or "it is no finite number"}
    return {"value": float(f"{value:.6g}"), "unit": UNITS[name]}


@dataclasses.dataclass
class Answer:
    """What a program wrote, force and torque in the body's frame B."""
    force: np.ndarray
    torque: np.ndarray  # or None
    tool: np.ndarray
    tick_us: np.ndarray  # or None
    removed: np.ndarray  # voxels, or None


def read_answer(scene, path):
    """Raises ValueError with what is wrong."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if len(rows) != len(scene.way.p):
        raise ValueError(f"{path.name} has {len(rows)} rows, and the trajectory {len(scene.way.p)}")
    lacks = [name for name in NEEDED if name not in rows[0]]
    if lacks:
        raise ValueError(f"{path.name} has no column {lacks[0]}")

    def columns(*names):
        if names[0] not in rows[0]:
            return None
        lacking = [name for name in names if name not in rows[0]]
        if lacking:
            raise ValueError(f"{path.name} has {names[0]} without {lacking[0]}")
        try:
            return np.array([[float(row[name]) for name in names] for row in rows])
        except (TypeError, ValueError):
            raise ValueError(f"{path.name} has no number in some row of {', '.join(names)}") from None

    place = scene.placement
    torque, tick, removed = columns("tx_nm", "ty_nm", "tz_nm"), columns("tick_us"), columns("removed_voxels")
    answer = Answer(force=place.turned_to_body(columns("fx_n", "fy_n", "fz_n")),
                    torque=None if torque is None else place.turned_to_body(torque),
                    tool=place.to_body(columns("px_m", "py_m", "pz_m")),
                    tick_us=None if tick is None else tick[:, 0],
                    removed=None if removed is None else removed[:, 0])
    if not (np.isfinite(answer.force).all() and np.isfinite(answer.tool).all()):
        raise ValueError(f"{path.name} has numbers that are not finite")
    return answer


def share_off(felt, true):
    """Root mean square of the difference over that of the truth, in %."""
    felt, true = np.array(felt), np.array(true)
    return 100 * np.sqrt(np.sum((felt - true) ** 2) / np.sum(true ** 2))


def errors(scene, answer, can):
    """Held hands against both truths: each tick of the end of each hold."""
    told = {}
    for prefix, is_rigid in (("", False), ("rigid_", True)):
        known = [] if not scene.body else [(span, truth.Truth(scene, is_rigid).at(scene.way.p[span[0]], scene.way.R[span[0]]))
                                           for span in scene.way.holds()]
        forces = [(answer.force[a:b], t.force) for (a, b), t in known if t and np.linalg.norm(t.force) > 0]
        turns = [(a, b, t) for (a, b), t in known if t and np.linalg.norm(t.torque) > 0]
        felt = [f for part, _ in forces for f in part]
        true = [t for part, t in forces for _ in part]
        no_truth = "no closed form is known here" if scene.way.holds() else "the hand holds nowhere in this scene"
        told[prefix + "force_error"] = figure(prefix + "force_error", share_off(felt, true) if felt else None, no_truth)
        name = prefix + "torque_error"
        if not turns:
            told[name] = figure(name, None, "the hand turns nowhere in this scene")
        elif answer.torque is None or "turn" not in can:
            told[name] = figure(name, None, "the program has no torque")
        else:
            felt_turns = [torque for a, b, _ in turns for torque in answer.torque[a:b]]
            told[name] = figure(name, share_off(felt_turns, [t.torque for a, b, t in turns for _ in range(b - a)]))
    return told


def drag(scene, answer):
    """Force against the motion in free air, over speed: N·s/m."""
    air = scene.way.phase == "air"
    if not air.any():
        return None
    speed = np.gradient(scene.way.p, axis=0)[air] * scenes.RATE_HZ
    return float(-np.sum(answer.force[air] * speed) / np.sum(speed ** 2))


def sliding(scene, answer, free_drag):
    """False friction (%) and the largest step of the force (N), or words why not."""
    slide = np.flatnonzero(scene.way.phase == "slide")
    if not len(slide):
        return None, None, "the hand slides nowhere in this scene"
    together = slide[1:][np.diff(slide) == 1]
    step = np.linalg.norm(answer.force[together] - answer.force[together - 1], axis=1).max()
    if not scene.body:
        return None, step, "the way out of a scanned bone is not known exactly"
    if free_drag is None:
        return None, step, "the scene plane, which tells the drag in free air, has not been run"
    normal = scene.body.normal(scene.way.p[slide])
    speed = np.gradient(scene.way.p, axis=0)[slide] * scenes.RATE_HZ
    force = answer.force[slide] + free_drag * speed
    into = np.sum(force * normal, axis=1)
    if into.min() < LEAST_NORMAL_N:
        return None, step, f"the tool lost the bone: {max(into.min(), 0):.2f} N at the least"
    return 100 * (np.linalg.norm(force - into[:, None] * normal, axis=1) / into).max(), step, ""


def energies(scene, answer):
    """Work on the hand in a closed path, the largest of the rounds after the first, and what went to and fro in it, µJ."""
    given, exchanged = [], []
    for round_ in range(2, scene.way.loop.max() + 1):
        rows = np.flatnonzero(scene.way.loop == round_)
        rows = np.concatenate([[rows[0] - 1], rows])
        work = np.sum((answer.force[rows][1:] + answer.force[rows][:-1]) / 2 * np.diff(scene.way.p[rows], axis=0), axis=1)
        given.append(1e6 * work.sum())
        exchanged.append(1e6 * np.abs(work).sum() / 2)
    return (max(given), max(exchanged)) if given else (None, None)


def wall_kept(scene, answer):
    """The share of presses after which the tool is still on the side that it came from."""
    if not scene.body or scene.body.kind != "wall" or not scene.way.holds():
        return None
    return float(np.mean([(answer.tool[a:b, 2] > 0).all() and (answer.force[a:b, 2] > 0).all() for a, b in scene.way.holds()]))


def bone_volume(values, iso, spacing, refine=3):
    """What lies within the surface of a trilinear volume, by points between the voxels."""
    total, share = 0, (np.arange(refine) + 0.5) / refine
    v = values.astype(float)
    for x in share:
        a = v[:-1] + x * (v[1:] - v[:-1])
        for y in share:
            b = a[:, :-1] + y * (a[:, 1:] - a[:, :-1])
            for z in share:
                total += np.count_nonzero(b[:, :, :-1] + z * (b[:, :, 1:] - b[:, :, :-1]) >= iso)
    return total / refine ** 3 * np.prod(spacing)


def removal(scene, before, after):
    """The error of what is gone beside what was swept, %, or words why not."""
    wanted = truth.removed_volume(scene)
    if not wanted:
        return None, "no closed form is known here" if (scene.way.buttons == 1).any() else "nothing is milled in this scene"
    if not after.is_file():
        return None, "the program writes no volume_after.nrrd"
    old, spacing, _ = nrrd.read(before)
    new, _, _ = nrrd.read(after)
    if new.shape != old.shape:
        raise ValueError(f"{after.name} has another shape than the scene's volume")
    changed = np.argwhere(old != new)
    if not len(changed):
        return -100.0, ""
    box = tuple(slice(max(a - 1, 0), b + 2) for a, b in zip(changed.min(0), changed.max(0)))
    iso = scene.told["volume"]["iso_value"]
    return 100 * ((bone_volume(old[box], iso, spacing) - bone_volume(new[box], iso, spacing)) / wanted - 1), ""


def of_scene(scene, folder, out, can, free_drag=None):
    """All figures of a scene. `free_drag` is what the scene plane told, N·s/m; in that scene its own counts."""
    answer = read_answer(scene, out / "answer.csv")
    told = errors(scene, answer, can)
    own_drag = drag(scene, answer)
    friction, step, why = sliding(scene, answer, free_drag if own_drag is None else own_drag)
    if step is None and (scene.way.phase == "mill").any():
        mill = np.flatnonzero(scene.way.phase == "mill")
        step = np.linalg.norm(answer.force[mill] - answer.force[mill - 1], axis=1).max()
    given, exchanged = energies(scene, answer)
    gone, gone_why = removal(scene, folder / "volume.nrrd", out / "volume_after.nrrd")
    told |= {
        "false_friction": figure("false_friction", friction, why),
        "free_drag": figure("free_drag", own_drag, "the scene plane tells it"),
        "step_per_tick": figure("step_per_tick", step, "the hand neither slides nor mills in this scene"),
        "closed_path_energy": figure("closed_path_energy", given, "there is no closed path in this scene"),
        "closed_path_exchanged": figure("closed_path_exchanged", exchanged, "there is no closed path in this scene"),
        "wall_kept": figure("wall_kept", wall_kept(scene, answer), "there is no thin wall in this scene"),
        "removal_error": figure("removal_error", gone, gone_why),
    }
    ticks = answer.tick_us
    for name, percent in (("tick_p50", 50), ("tick_p99_9", 99.9)):
        told[name] = figure(name, None if ticks is None else np.percentile(ticks, percent), "the program does not tell its ticks' time")
    return told | {"voxels_per_second": _rate(scene, answer)}


def _rate(scene, answer):
    name = "voxels_per_second"
    if not (scene.way.buttons == 1).any():
        return figure(name, None, "nothing is milled in this scene")
    if answer.removed is None or answer.tick_us is None:
        return figure(name, None, "the program does not tell voxels and ticks' time")
    cutting = answer.removed > 0
    return figure(name, 1e6 * answer.removed[cutting].sum() / answer.tick_us[cutting].sum() if cutting.any() else 0.0)
