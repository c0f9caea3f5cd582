"""The way of a scene's hand: its waypoints, a trajectory for `haptic_server simulate` along them, and that run."""
import json
import math
import re
import subprocess

FIELD = r"\b{}\s*:\s*(-?[\d.eE+-]+)"


def number(text, name):
    found = re.search(FIELD.format(name), text)
    return float(found.group(1)) if found else 0.0


def rate_hz(scene_text):
    loop = re.search(r"\bloop\s*\{(.*?)\}", scene_text, re.S)
    return number(loop.group(1), "rate_hz") if loop and "rate_hz" in loop.group(1) else 1000.0


def waypoints(scene_text):
    """(t_s, position in m, rotation wxyz, buttons) of each."""
    text = re.sub(r"#.*", "", scene_text)
    found = []
    for start in re.finditer(r"\bwaypoint\s*\{", text):
        depth, end = 1, start.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        body = text[start.end():end - 1]
        place = re.search(r"p_WT_mm\s*\{(.*?)\}", body, re.S).group(1)
        turn = re.search(r"q_WT\s*\{(.*?)\}", body, re.S).group(1)
        rotation = [number(turn, axis) for axis in "wxyz"]
        norm = math.sqrt(sum(value * value for value in rotation))
        buttons = ("remove: true" in body) + 2 * ("add: true" in body)
        found.append((number(body, "time_s"), [number(place, axis) * 1e-3 for axis in "xyz"],
                      [value / norm for value in rotation], buttons))
    return found


def slerp(a, b, share):
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-value for value in b], -cosine
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-9:
        return a
    return [(math.sin((1 - share) * angle) * x + math.sin(share * angle) * y) / math.sin(angle) for x, y in zip(a, b)]


def write_trajectory(path, points, rate_hz):
    rows = ["t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons"]
    here = 0
    for tick in range(int(points[-1][0] * rate_hz)):
        t = tick / rate_hz
        while here + 2 < len(points) and points[here + 1][0] <= t:
            here += 1
        (from_s, p, q, buttons), (to_s, p_next, q_next, _) = points[here], points[here + 1]
        share = min(max((t - from_s) / (to_s - from_s), 0.0), 1.0)
        place = [x + share * (y - x) for x, y in zip(p, p_next)]
        rows.append(",".join(f"{value:.17g}" for value in [t, *place, *slerp(q, q_next, share)]) + f",{buttons}")
    path.write_text("\n".join(rows) + "\n")


class SimulateError(Exception):
    """One line: why haptic_server did not run."""


def simulate(server, scene, trajectory, trace, words=()):
    """Runs `haptic_server simulate` with these words more; returns what it tells."""
    command = [server, "simulate", "--scene", scene, "--trajectory", trajectory, "--trace", trace, *words]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    except OSError as error:
        raise SimulateError(f"{server}: {error.strerror}; build haptic_server first") from error
    if done.returncode:
        raise SimulateError(done.stderr.strip().removeprefix("error: "))
    return json.loads(done.stdout.splitlines()[-1])
