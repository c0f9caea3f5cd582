# Runs one session: starts its three programs, starts again what dies, and ends all of them in order.
# Every program is told by the kernel to end (PR_SET_PDEATHSIG) when this script dies, in whatever way.
# shellcheck shell=bash
# shellcheck disable=SC2154

readonly restart_after_s=2 most_restarts=3
declare -A title=([server]=haptic_server [device]=device_daemon [viewer]=render_client)
declare -A pid=() started_s=() due_s=() restarts=([server]=0 [device]=0 [viewer]=0)
end_code="" recording="" clip=""
roles=()
makeable=()  # scenes whose phantoms are made when somebody chooses them

run_session() {
    find_scene "${operand:-tooth_corridor}"
    open_state
    take_number "${option[session]:-}"
    make_log_folder
    make_class_folder
    say "session $number of $scene_name; logs in $logs"
    [[ -z $class_folder ]] || say "the class' table and reports: $class_folder"
    make_phantoms
    mapfile -t makeable < <(makeable_scenes)
    ask_real_time
    roles=(server device)
    go_on
}

# A recorded session is shown as a live one, with its own server and without a hand.
run_replay() {
    find_recording "$operand"
    find_against
    scene_name=replay class_folder="" title[server]=bonemill_lab option[device]=none
    open_state
    take_number "${option[session]:-}"
    make_log_folder
    say "session $number, a replay of $recording; logs in $logs"
    roles=(server)
    [[ -z ${option[clip]:-} ]] || begin_clip
    go_on
}

# It says what came out; the replay is a look at it, and can be had later.
run_what_if() {
    local other words=()
    find_recording "$operand"
    [[ -n ${option[at]:-} ]] || fail "say with --at from which second on (see: bonemill what-if --help)"
    [[ " ${flags}" != *" --expert "* ]] || words+=(--expert)
    for word in shift-mm tool accuracy pace; do
        [[ -z ${option[$word]:-} ]] || words+=("--$word" "${option[$word]}")
    done
    other=$(what_if_path)
    "$bin/bonemill_lab" session what-if "$recording" --at "${option[at]}" --out "$other" "${words[@]}" || exit
    if [[ $flags == *" --no-viewer "* ]] || ! has_display; then return; fi
    option[against]=$other option[at]=$(before "${option[at]}" 3)
    operand=$recording
    run_replay
}

# A video off screen, of a replay that waits for each picture. Who looks at another session meanwhile has the processors first.
begin_clip() {
    clip=$(realpath -m -- "${option[clip]}")
    : "${option[seconds]:=10}"
    option[at]=$(before "${option[at]:-0}" "$(awk -v seconds="${option[seconds]}" 'BEGIN { print seconds / 2 }')")
    extra+=(--paused)
    renice -n 10 $$ >/dev/null || true
}

# Starts the programs of `roles` and a window, and stays until they end.
go_on() {
    local role
    choose_viewer
    # What the shell itself notes, as "Killed", goes to a log: the user hears of it in our words.
    exec {terminal}>&2 2>>"$logs/bonemill.log"
    exec {never}<> <(:)  # Nothing ever comes here: reading from it is a pause that a signal cuts short.
    exec {device_words}<> "$logs/device.log"
    trap 'end_code=0' INT TERM HUP
    trap : PIPE
    trap end_session EXIT
    for role in "${roles[@]}"; do launch "$role"; done
    [[ $flags == *" --no-viewer "* ]] || launch viewer
    say_how_to_watch
    supervise
    exit "$end_code"
}

make_log_folder() {
    local parent try name
    parent=$(home_folder XDG_STATE_HOME .local/state)/bonemill
    name=$(date +%Y-%m-%d_%H-%M-%S)_${scene_name//[^A-Za-z0-9_-]/_}
    mkdir -p -- "$parent" || fail "the log folder $parent cannot be made"
    for try in "" _2 _3 _4 _5 _6 _7 _8 _9; do
        logs=$parent/$name$try
        mkdir -- "$logs" 2>/dev/null && return
    done
    fail "no log folder can be made in $parent"
}

# Who says himself where results go needs no folder of ours.
make_class_folder() {
    class_folder=""
    [[ " ${extra[*]} " != *" --export-dir"* && " ${extra[*]} " != *" --class-table"* ]] || return 0
    class_folder=$(classes_folder)/${option[class]:-$(date +%F)}
    (umask 077; mkdir -p -- "$class_folder") || fail "the class' folder $class_folder cannot be made"
}

ask_real_time() {
    "$share/check-realtime" >/dev/null 2>&1 ||
        say "this PC does not grant real time: going on without, good for a look (bonemill doctor says what to type)"
}

choose_viewer() {
    [[ -z $clip ]] || return 0
    [[ $flags != *" --no-viewer "* ]] || return 0
    has_display && return
    flags+="--no-viewer "
    say "there is no display here: going on without a window"
}

# command_of ROLE: into the variable `words`.
command_of() {
    case $1 in
        server)
            if [[ -n $recording ]]; then replay_words; return; fi
            words=("$bin/haptic_server" --scene "$scene" --session "$number" --until-device-leaves --resume)
            mapfile -t -O "${#words[@]}" words < <(network_words)
            [[ ${#makeable[@]} -eq 0 ]] || words+=(--launcher "$self" "${makeable[@]/#/--makes=}")
            [[ -z $class_folder ]] || words+=(--export-dir "$class_folder")
            [[ $flags != *" --instructor-only "* ]] || words+=(--instructor-only)
            words+=("${extra[@]}") ;;
        device)
            words=("$bin/device_daemon" --scene "$scene" --session "$number")
            words+=(--device "${option[device]:-auto}" --stop-dir "$logs")
            mapfile -t -O "${#words[@]}" words < <(network_words)
            [[ $flags != *" --no-enabling-switch "* ]] || words+=(--no-enabling-switch)
            # Whoever watches says in the window what comes after the script.
            [[ ${option[device]:-} != simulated || $flags == *" --no-viewer "* ]] || words+=(--hold)
            [[ -z ${option[seconds]:-} ]] || words+=(--seconds "${option[seconds]}") ;;
        viewer)  # Whoever sits here has the hand, so the window may command, as it may on one PC.
            words=("$bin/render_client" --session "$number" --role operator)
            mapfile -t -O "${#words[@]}" words < <(network_words)
            if [[ -n $clip ]]; then clip_words; else words+=(--launcher "$self"); fi
            [[ -z $recording || -n $clip ]] || words+=(--recording "$recording")
            [[ -z $class_folder ]] || words+=(--class-folder "$class_folder")
            [[ -z ${option[window-size]:-} ]] || words+=(--size "${option[window-size]}") ;;
    esac
}

replay_words() {
    words=("$bin/bonemill_lab" replay "$recording" --session "$number")
    mapfile -t -O "${#words[@]}" words < <(network_words)
    [[ -z ${option[at]:-} ]] || words+=(--at "${option[at]}")
    words+=(--classes "$(classes_folder)" --recordings "$(recordings_folder)")
    [[ -z ${option[against]:-} ]] || words+=(--against "${option[against]}")
    words+=("${extra[@]}")
}

clip_words() {
    local view
    words+=(--offscreen --video "$clip" --seconds "${option[seconds]}" --wait-complete --lead-replay "${option[at]}")
    IFS=, read -ra view <<<"${option[view]:-}"
    [[ ${#view[@]} -eq 0 ]] || words+=(--camera-azimuth-deg "${view[0]}" --camera-elevation-deg "${view[1]}"
        --camera-distance-mm "${view[2]}" --camera-target-mm "${view[@]:3}")
}

# launch ROLE. A process group of its own keeps the terminal's Ctrl-C from it, so that the order of the end is ours.
launch() {
    local words
    command_of "$1"
    end_with "$$" setsid "${words[@]}" \
        >>"$logs/$1.log" 2>&1 </dev/null 9>&- {never}<&- {terminal}>&- {device_words}<&- &
    pid[$1]=$!
    started_s[$1]=$SECONDS
    unset "due_s[$1]"
    write_session
}

# The file appears whole, so that a reader never sees half of it.
write_session() {
    local role programs=""
    for role in server device viewer; do [[ -z ${pid[$role]:-} ]] || programs+=", ${title[$role]} ${pid[$role]}"; done
    : "${since:=$(date +%H:%M:%S)}"
    printf '%s\n' "scene=$scene_name" "device=${option[device]:-auto}" "since=$since" "logs=$logs" "class=$class_folder" "script=$$" \
        "profile=${option[profile]:-}" "interface=${option[interface]:-}" "domain=${option[domain]:-}" \
        "programs=$programs" >"$state/$number.new"
    mv -f -- "$state/$number.new" "$state/$number.session"
}

say_how_to_watch() {
    [[ -z ${option[profile]:-} || ${option[profile]} == one-pc ]] ||
        say "viewers on other PCs: bonemill watch --profile ${option[profile]} --interface THEIRS --session $number" \
            "(without multicast: bonemill watch $(uname -n) --session $number)"
    [[ -z $clip ]] || return 0
    if [[ -n ${pid[viewer]:-} ]]; then say "close the window or press Ctrl-C to end"; else say "Ctrl-C ends it, or: bonemill stop $number"; fi
}

is_alive() { [[ -n ${pid[$1]:-} ]] && kill -0 "${pid[$1]}" 2>/dev/null; }
pause() { read -rt "$1" <&"$never" || true; }

supervise() {
    local role
    while [[ -z $end_code ]]; do
        pause 0.2
        relay_device_words
        for role in "${!pid[@]}"; do is_alive "$role" || has_ended "$role"; done
        for role in "${!due_s[@]}"; do
            [[ -n $end_code ]] || ((SECONDS < due_s[$role])) || launch "$role"
        done
    done
}

# What the device warns of, and that it is over, is for whoever holds it, and which hand was found.
relay_device_words() {
    local line
    while IFS= read -r line <&"$device_words"; do
        [[ $line =~ \ device_daemon\ ((warn|warning|error)\ |info\ (the hand is |haptic_server answers))(.*) ]] || continue
        [[ $line == *"real time: "* ]] || say "device: ${BASH_REMATCH[3]}${BASH_REMATCH[4]}"
    done
}

# has_ended ROLE: what an end means for the session.
has_ended() {
    local role=$1 code=0
    [[ -z $end_code ]] || return 0
    wait "${pid[$role]}" || code=$?
    unset "pid[$role]"
    case $role:$code in
        viewer:0) [[ -n $clip ]] && end_because 0 "the clip is written: $clip" && return
            end_because 0 "the window was closed" ;;
        server:0)
            if [[ -n $recording ]]; then end_because 0 "somebody has ended the replay"; return; fi
            end_because 0 "the hand has finished, or somebody has ended haptic_server" ;;
        device:0) end_because 0 "the hand has finished, or somebody has ended device_daemon" ;;
        *:2) end_with_error "$role" "$code" ;;
        viewer:*) if [[ -n $clip ]]; then end_with_error "$role" "$code"; else restart "$role" "$code"; fi ;;
        *) restart "$role" "$code" ;;
    esac
}

complain() { printf 'bonemill: %s\n' "$*" >&"$terminal" || true; }
end_because() { end_code=$1; say "$2: session $number ends"; }

end_with_error() {  # ROLE CODE
    local what
    what=$(grep -a 'error: ' "$logs/$1.log" | tail -n 1 | sed 's/.*error: //' || true)
    end_code=$2
    complain "${title[$1]}: ${what:-it left with code $2, see $logs/$1.log}"
}

# haptic_server goes on from its recording, where it makes one.
bone_after_restart() {
    if [[ -n $recording ]]; then echo "the replay begins anew"; return; fi
    if [[ " ${extra[*]} " == *" --no-recording "* ]]; then echo "the bone will be whole again"; else echo "what was milled is kept"; fi
}

restart() {  # ROLE CODE
    local role=$1 how="left with code $2" more=""
    (($2 <= 128)) || how="was ended by signal $(($2 - 128))"
    if ((restarts[$role] == most_restarts)); then
        end_code=1
        complain "${title[$role]} $how again, after $most_restarts restarts: session $number ends, see $logs/$role.log"
        return
    fi
    [[ $role != server ]] || more="; $(bone_after_restart)"
    due_s[$role]=$((started_s[$role] + restart_after_s + 1))  # Whole seconds: one more, lest it be less than said.
    restarts[$role]=$((restarts[$role] + 1))
    say "${title[$role]} $how: it is started again (${restarts[$role]} of $most_restarts)$more"
    write_session
}

# The force goes to zero before anything else ends, and what was milled is still sent to the viewers.
end_session() {
    trap '' INT TERM HUP
    trap - EXIT
    end_program device 5
    end_program server 20
    end_program viewer 5
    clear_link
    rm -f -- "$state/$number.session"
    [[ -s $logs/bonemill.log ]] || rm -f -- "$logs/bonemill.log"
    say "session $number has ended; logs in $logs"
    exit "${end_code:-1}"
}

# A program that was killed, and that no other has followed, leaves its link: memory and semaphores on which nobody lives.
# common/ipc/link_place.h has the key.
clear_link() {
    local key
    key=$(printf '0x%08x' $((number ^ 0x424d0000)))
    [[ $(ipcs -m 2>/dev/null | awk -v key="$key" '$1 == key {print $6}') != [1-9]* ]] || return 0
    ipcrm -M "$key" 2>/dev/null || true
    ipcrm -S "$key" 2>/dev/null || true
}

end_program() {  # ROLE LIMIT_S
    local tenth code=0
    [[ -n ${pid[$1]:-} ]] || return 0
    kill -TERM "${pid[$1]}" 2>/dev/null || true
    for ((tenth = 0; tenth < $2 * 10; ++tenth)); do
        is_alive "$1" || break
        pause 0.1
    done
    if is_alive "$1"; then
        say "${title[$1]} did not end within $2 s: it is killed"
        kill -KILL -- "-${pid[$1]}" 2>/dev/null || true  # This is its group: what it started goes, too.
    fi
    wait "${pid[$1]}" || code=$?
    # Wrong input of one is mostly wrong input of the others, and was said already.
    ((code != 2 || ${end_code:-0} != 2)) || return 0
    # It says so when it could not do its last work, as to write a file.
    ((code == 0 || code > 128)) || { end_code=$code; complain "${title[$1]} left with code $code, see $logs/$1.log"; }
}
