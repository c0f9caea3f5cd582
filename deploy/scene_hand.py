"""Puts a planned hand into a scene's file: for deploy/plan-hand and deploy/make-training-bone."""
import dataclasses
import pathlib
import re
import subprocess
import tempfile

import hand_planner
import hand_plans

WAYPOINTS = re.compile(r"(?:^  waypoint .*\n)+", re.M)


def number(text, name):
    return float(re.search(rf"^ *{name}: *(-?[\d.]+)", text, re.M).group(1))


def scanned(scene, program, file):
    """Writes the densities that the server makes of the scene's scan; returns which of them is the bone's surface."""
    text = scene.read_text()
    first = re.search(r"waypoint .*?p_WT_mm \{ x: *(\S+) +y: *(\S+) +z: *(\S+)", text).groups()
    place = ",".join(f"{float(value) / 1000:.9g}" for value in first)
    trajectory = file.with_suffix(".csv")
    rows = [f"{t},{place},1,0,0,0,0" for t in ("0", "0.001")]
    trajectory.write_text("\n".join(["t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons", *rows]) + "\n")
    done = subprocess.run([program, "simulate", "--scene", scene, "--trajectory", trajectory, "--save-volume", file],
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        raise hand_planner.PlanError(done.stderr.strip())
    low, high = number(text, "window_low"), number(text, "window_high")
    return (number(text, "iso_value") - low) / (high - low) * 65535


def plan(scene, program, side=1, *, name=None, deeper_mm=0.0):
    """Plans the hand of a scene that has one already, by the plan of that name; its fields end so much deeper."""
    plan_of_scene = hand_plans.PLANS[name or scene.stem]
    fields = tuple(dataclasses.replace(field, deepest_mm=field.deepest_mm + deeper_mm) for field in plan_of_scene.fields)
    plan_of_scene = dataclasses.replace(plan_of_scene, fields=fields)
    labels = scene.parent / re.search(r'^ *label_path: *"(.*?)"', scene.read_text(), re.M).group(1)
    with tempfile.TemporaryDirectory() as folder:
        volume = pathlib.Path(folder) / "scan.nrrd"
        iso = scanned(scene, program, volume)
        waypoints = hand_planner.waypoints(plan_of_scene, volume, iso, labels, side)
    scene.write_text(WAYPOINTS.sub(lambda _: waypoints, scene.read_text(), count=1))
