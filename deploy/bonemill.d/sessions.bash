# Which sessions of this user run. Whoever runs session N holds the lock N.lock in the state folder, so a session that died
# in whatever way is never taken for a living one; N.session tells of it, one key=value a line.
# shellcheck shell=bash

# The folder may lie in /tmp, where anyone could have made it before: it must be ours alone, and no link.
open_state() {
    state=${XDG_RUNTIME_DIR:-/tmp}/bonemill-$UID
    mkdir -m 700 -- "$state" 2>/dev/null || true
    [[ -d $state && ! -L $state && $(stat -c %u:%a -- "$state") == "$UID:700" ]] ||
        fail "$state is not a folder that only you can use: remove it, or set XDG_RUNTIME_DIR to a folder of yours"
}

# is_running N: it removes what a dead session left.
is_running() { ! flock -n "$state/$1.lock" rm -f -- "$state/$1.session"; }

# Prints the numbers of the sessions that run.
running_sessions() {
    local file number
    for file in "$state"/*.session; do
        number=$(basename -- "$file" .session)
        [[ -f $file ]] && is_running "$number" && echo "$number"
    done | sort -n
}

# read_session N: into the variable `session`.
declare -A session=()
read_session() {
    local key value
    session=([scene]="" [device]="" [since]="" [logs]="" [class]="" [script]="" [profile]="" [interface]="" [domain]="" [programs]="")
    while IFS='=' read -r key value; do session[$key]=$value; done 2>/dev/null <"$state/$1.session" || true
}

list_sessions() {
    local number numbers
    mapfile -t numbers < <(running_sessions)
    [[ ${#numbers[@]} -gt 0 ]] || { echo "No session runs. To start one: bonemill start"; return; }
    echo "Sessions that run:"
    for number in "${numbers[@]}"; do
        read_session "$number"
        printf '  %-3s %-16s device %s, since %s, processes: bonemill %s%s, logs in %s, class in %s\n' "$number" \
            "${session[scene]}" "${session[device]}" "${session[since]}" "${session[script]}" "${session[programs]}" \
            "${session[logs]}" "${session[class]:-no folder}"
    done
}

# Prints "PID NAME SESSION OWNER" of every server, replay and daemon of this PC, whoever started it.
running_programs() {
    local folder name words number i
    for folder in /proc/[0-9]*; do
        { read -r name; } 2>/dev/null <"$folder/comm" || continue
        [[ $name == haptic_server || $name == device_daemon || $name == bonemill_lab ]] || continue
        { mapfile -d '' -t words; } 2>/dev/null <"$folder/cmdline" || continue
        [[ $name != bonemill_lab || " ${words[*]} " == *" replay "* ]] || continue
        number=1
        for i in "${!words[@]}"; do
            [[ ${words[i]} != --session ]] || number=${words[i + 1]:-}
            [[ ${words[i]} != --session=* ]] || number=${words[i]#*=}
        done
        [[ ${#words[@]} -eq 0 ]] || echo "${folder#/proc/} $name $number $(stat -c %u "$folder" 2>/dev/null || true)"
    done
}

# take_number [N]: holds the lock of this number, or of the first free one, on descriptor 9 for as long as this process
# lives. Programs that were started by hand, or by others, have their numbers, too.
take_number() {
    local used
    used=" $(running_programs | awk '{print $3}' | paste -sd ' ') "
    if [[ -n ${1:-} ]]; then
        { [[ $used != *" $1 "* ]] && lock_number "$1"; } || fail "session $1 runs already: leave --session out, or end it with: bonemill stop $1"
        return
    fi
    for ((number = 1; number < 10000; ++number)); do
        [[ $used == *" $number "* ]] || ! lock_number "$number" || return 0
    done
    fail "no session number is free"
}

# What a dead session left goes, lest it be taken for this one: its process number may be somebody else's by now.
lock_number() {
    number=$1
    exec 9>"$state/$number.lock"
    flock -n 9 && rm -f -- "$state/$number.session"
}

# A stopped script (Ctrl-Z) goes on for as long as it takes to end.
ask_to_end() {
    read_session "$1"
    kill -TERM "${session[script]}" 2>/dev/null || true
    kill -CONT "${session[script]}" 2>/dev/null || true
}

await_end() {
    local tenth
    for ((tenth = 0; tenth < 400; ++tenth)); do
        is_running "$1" || { say "session $1 has ended"; return; }
        sleep 0.1
    done
    fail "session $1 does not end: bonemill list tells its process, kill -9 ends that at once, and its programs with it"
}

# Recordings of this user's sessions, the newest first, as haptic_server names them: SESSION_SCENE_TIME.mcap.
recordings_folder() { printf '%s/bonemill/recordings\n' "$(home_folder XDG_STATE_HOME .local/state)"; }
newest_recordings() {
    local folder
    folder=$(recordings_folder)
    [[ ! -d $folder ]] || find "$folder" -maxdepth 1 -type f -name '*.mcap' -printf '%T@ %p\n' | sort -rn | cut -d ' ' -f 2-
}

list_recordings() {
    local file all
    mapfile -t all < <(newest_recordings)
    for file in "${all[@]:0:10}"; do
        printf '  %-16s %6s MB  %s\n' "$(date -r "$file" '+%Y-%m-%d %H:%M')" "$(($(stat -c %s -- "$file") / 1000000))" "$file"
    done
}

# result_fields RESULT.json: prints its recording, and the second of its worst moment.
result_fields() {
    python3 - "$1" <<'PY'
import json, sys
with open(sys.argv[1], encoding="utf-8") as file:
    result = json.load(file)
worst = max(result.get("moments", []), key=lambda moment: moment["severity"], default=None)
print(result.get("journal", ""))
print(worst["t_s"] if worst else "")
PY
}

# before SECOND LEAD: prints the second so much before it, from 0 on.
before() { awk -v second="$1" -v lead="$2" 'BEGIN { print (second > lead ? second - lead : 0) }'; }

# An attempt's result says which recording it is in, and when its worst moment is: a replay begins just before it.
read_result() {
    local fields
    mapfile -t fields < <(result_fields "$1" 2>/dev/null)
    [[ -n ${fields[0]:-} ]] || fail "$1 is no result of an attempt with a recording"
    recording=$(recordings_folder)/$(basename -- "${fields[0]}")
    [[ -z ${fields[1]:-} || -n ${option[at]:-} ]] || option[at]=$([[ -n ${option[clip]:-} ]] && echo "${fields[1]}" || before "${fields[1]}" 3)
}

# path_of_recording NAME: a file, or the name of one of the user's own recordings.
path_of_recording() {
    local file=$1
    [[ -f $file || $file == */* ]] || file=$(recordings_folder)/$file
    realpath -m -- "$file"
}

# find_recording [FILE]: a file, the name of one of the user's own, an attempt's result, or the newest one.
find_recording() {
    local all
    mapfile -t all < <(newest_recordings)
    recording=${1:-${all[0]:-}}
    [[ -n $recording ]] || fail "no session has been recorded in $(recordings_folder): name a file, as: bonemill replay session.mcap"
    if [[ $recording == *.json ]]; then read_result "$recording"; fi
    recording=$(path_of_recording "$recording")
    [[ -f $recording ]] || fail "there is no recording $(basename -- "$recording") (bonemill list shows the last ones)"
}

# A new name for what might have been from here on: the recording's, with the moment and a number.
what_if_path() {
    local stem folder number=1
    folder=$(recordings_folder)/what_if
    mkdir -p -- "$folder" || fail "$folder cannot be made"
    stem=$folder/$(basename -- "$recording" .mcap)_at_${option[at]}
    while [[ -e ${stem}_$number.mcap || -e ${stem}_$number.html || -e ${stem}_$number.json ]]; do ((++number)); done
    echo "${stem}_$number.mcap"
}

# find_against: the other attempt, as a whole path.
find_against() {
    [[ -n ${option[against]:-} ]] || return 0
    option[against]=$(path_of_recording "${option[against]}")
    [[ -f ${option[against]} ]] ||
        fail "there is no file ${option[against]} to compare with: bonemill sessions lists attempts, bonemill list recordings"
}
