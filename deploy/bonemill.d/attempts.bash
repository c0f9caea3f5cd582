# The last attempts of all classes, as their results tell of them.
# shellcheck shell=bash
# shellcheck disable=SC2154

readonly attempts_listed=12

classes_folder() { printf '%s/bonemill/classes\n' "$(home_folder XDG_DATA_HOME .local/share)"; }

# A result that cannot be read is passed over. An examination tells no score. Of one scene experts' attempts count, too.
list_attempts() {
    python3 - "$(classes_folder)" "$(recordings_folder)" "$attempts_listed" "$flags" "${option[scene]:-}" <<'PY'
import json, os, pathlib, sys, time

classes, recordings, count = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
scene_hash = sys.argv[5]


def one_line(text):
    return "".join(sign if sign.isprintable() else " " for sign in str(text))


def score_of(result):
    if result["exam"]:
        return "examination"
    if "total" in result:
        return "score %.0f of 100" % (100 * result["total"]["score"])
    return {True: "passed", False: "not passed"}.get(result.get("passed"), "no score")


def fields_of(file):
    with open(file, encoding="utf-8") as text:
        result = json.load(text)
    if scene_hash and result["scene"]["hash"] != scene_hash:
        raise ValueError("of another scene")
    start = time.strftime("%Y-%m-%d %H:%M", time.localtime(result["start_unix_ns"] / 1e9))
    journal = result["journal"] and recordings / os.path.basename(result["journal"])
    recording = journal if journal and journal.is_file() else ""
    scene = result["scene"]["title"] or result["scene"]["id"]
    return [one_line(field) for field in (file, recording, start, scene, result["pseudonym"], score_of(result))]


listed = []
parts = ["results", "experts"] if scene_hash else ["results"]
files = [file for part in parts for file in classes.glob(f"*/{part}/*.json")]
# A result's name begins with its time.
for file in sorted(files, key=lambda file: file.name, reverse=True):
    try:
        listed.append(fields_of(file))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        continue
    if len(listed) == count:
        break
for fields in listed:
    if "--tab-separated" in sys.argv[4]:
        print("\t".join(fields))
        continue
    file, recording, start, scene, trainee, score = fields
    print(f"  {start}  {scene:<28} {trainee:<16} {score:<16} {file}" + ("" if recording else " (no recording)"))
if not listed and "--tab-separated" not in sys.argv[4]:
    print(f"No attempt has left a result in {classes}")
PY
}
