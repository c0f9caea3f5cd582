"""A result as a file: JSON, checked when it is written and when it is read. docs/reference/benchmark.md describes it."""
import datetime
import json
import os
import pathlib
import platform
import subprocess

from figures import UNITS

FORMAT, VERSION = "haptic-milling-benchmark", 1
MACHINE = ("processor", "cores", "system", "load_before", "load_after")


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def load_1_min():
    return round(os.getloadavg()[0], 2)


def commit():
    """Of the benchmark itself; `unknown` outside of a checkout, with `, changed` where files differ from it."""
    here = pathlib.Path(__file__).resolve().parent

    def git(*words):
        try:
            return subprocess.run(["git", *words], cwd=here, capture_output=True, text=True, check=False).stdout.strip()
        except OSError:
            return ""
    name = git("rev-parse", "--short=8", "HEAD")
    return (name + (", changed" if git("status", "--porcelain", "--", ".") else "")) if name else "unknown"


def begin(quick):
    return {"format": FORMAT, "version": VERSION, "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
            "commit": commit(), "is_quick": quick,
            "machine": {"processor": processor(), "cores": os.cpu_count(), "system": platform.platform(), "load_before": load_1_min()},
            "scenes_left_out": {}, "programs": []}


def _faults_of_figure(place, name, told):
    if name not in UNITS:
        yield f"{place}: {name} is no figure"
    elif told.get("unit") != UNITS[name]:
        yield f"{place}: {name} is in {UNITS[name]}"
    elif set(told) != ({"value", "unit", "reason"} if told.get("value") is None else {"value", "unit"}):
        yield f"{place}: {name} has a value, or null and a reason"
    elif told["value"] is None and not told["reason"]:
        yield f"{place}: {name} is null without a reason"
    elif told["value"] is not None and (isinstance(told["value"], bool) or not isinstance(told["value"], (int, float))):
        yield f"{place}: {name} is no number"


def faults(result):
    """What is wrong with a result, in words; an empty list if nothing is."""
    if not isinstance(result, dict) or result.get("format") != FORMAT or result.get("version") != VERSION:
        return [f"it is no {FORMAT} of version {VERSION}"]
    found = [f"it has no {key}" for key in ("date", "commit", "is_quick", "machine", "scenes_left_out", "programs") if key not in result]
    found += [f"machine has no {key}" for key in MACHINE if key not in result.get("machine", {})]
    for program in result.get("programs", []):
        name = program.get("name", "a program without a name")
        found += [f"{name} has no {key}" for key in ("version", "notes", "can", "scenes", "figures") if key not in program]
        places = {name: program.get("figures", {})} | {f"{name}, {scene}": told for scene, told in program.get("scenes", {}).items()}
        for place, figures in places.items():
            found += [fault for figure, told in figures.items() for fault in _faults_of_figure(place, figure, told)]
    return found


def write(path, result):
    wrong = faults(result)
    if wrong:
        raise ValueError("; ".join(wrong))
    path.write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def read(path):
    result = json.loads(path.read_text(encoding="utf-8"))
    wrong = faults(result)
    if wrong:
        raise ValueError(f"{path}: " + "; ".join(wrong))
    return result
