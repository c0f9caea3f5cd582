# bonemill doctor: what this PC lacks for a session, in plain words, and what to type.
# shellcheck shell=bash
# shellcheck disable=SC2154

fine() { printf '  ok       %s\n' "$1"; }
advise() { printf '  better   %s\n             %s\n' "$1" "$2"; }

doctor() {
    read_words doctor "--interface --domain --tab-separated" "$@"
    [[ -z $operand ]] || fail "doctor takes no word (see: bonemill doctor --help)"
    open_state
    if [[ $flags == *" --tab-separated "* ]]; then look_at_all | as_table; else look_at_all; fi
}

look_at_all() {
    local can_start=true
    echo "Programs:"
    look_at_programs || can_start=false
    echo "Real time:"
    { "$share/check-realtime" 2>&1 || true; } | sed 's/^/  /'
    echo "Network:"
    look_at_network
    echo "Display:"
    look_at_display
    echo "Devices:"
    look_at_devices
    echo "Sessions:"
    look_at_sessions
    if [[ $can_start == false ]]; then
        echo "No session can be started yet: see MISSING under Programs."
        exit 1
    fi
    echo "A session can be started: bonemill start"
}

# as_table: what the doctor says, for programs. What is looked at, how it is (ok, better, MISSING), what it is, and what to
# type, a line each. Of devices: "hand", its kind, how it is (ready, not ready), what it is, and what to type.
as_table() {
    awk '
        function tell() { if (line != "") print line commands; line = commands = "" }
        /^[A-Z].*:$/ { tell(); section = substr($0, 1, length($0) - 1); next }
        { gsub(/\t/, " ") }
        section == "Devices" && match(substr($0, 20), /^(ready|not ready) +/) {
            tell(); kind = substr($0, 3, 17); sub(/ +$/, "", kind)
            state = substr($0, 20, 9) ~ /^ready/ ? "ready" : "not ready"
            line = "hand\t" kind "\t" state "\t" substr($0, 20 + RLENGTH); next
        }
        section == "Devices" && match($0, /^ +type +/) { commands = "\t" substr($0, RLENGTH + 1); next }
        section == "Devices" && line != "" && match($0, /^             +/) { line = line ": " substr($0, RLENGTH + 1); next }
        match($0, /^ +(ok|better|MISSING) +/) { tell(); line = section "\t" $1 "\t" substr($0, RLENGTH + 1); next }
        line != "" && match($0, /^             +/) { commands = commands "\t" substr($0, RLENGTH + 1); next }
        { tell() }
        END { tell() }'
}

look_at_programs() {
    local message
    if message=$( (need_programs "${all_programs[@]}") 2>&1); then fine "built, in $bin"; return; fi
    printf '  MISSING  %s\n' "${message#bonemill: }"
    return 1
}

# The one that this PC's way to all others leads over; nothing where there is none.
interface_to_others() { awk '$2 == "00000000" {print $1; exit}' /proc/net/route 2>/dev/null || true; }

look_at_network() {
    local interface=${option[interface]:-}
    fine "on this PC alone, nothing is needed"
    [[ -n $interface ]] || interface=$(interface_to_others)
    if [[ -z $interface ]]; then
        advise "this PC has no way to others: fine, unless they shall watch" "then: bonemill doctor --interface NAME"
        return
    fi
    echo "  For viewers on other PCs:"
    { "$share/check-network" --interface "$interface" --domain "${option[domain]:-0}" 2>&1 || true; } | sed 's/^/  /'
}

look_at_display() {
    local renderer=""
    if ! has_display; then
        advise "there is none (DISPLAY is not set): no window, but sessions run and pictures can be written" \
            "on a desktop: open a terminal there; pictures: bonemill watch -- --offscreen --out pictures"
        return
    fi
    fine "${WAYLAND_DISPLAY:-${DISPLAY:-}}"
    if command -v glxinfo >/dev/null; then
        renderer=$(timeout 10 glxinfo -B 2>/dev/null | sed -n 's/^OpenGL renderer string: //p' || true)
    fi
    if [[ $renderer =~ llvmpipe|softpipe|swrast|Software ]] || [[ -z $renderer ]] && ! has_graphics_card; then
        advise "OpenGL: the processor draws, more slowly and with simpler pictures" \
            "nothing to do without a graphics card; with one, install its driver: sudo apt install libgl1-mesa-dri"
    else
        fine "OpenGL: ${renderer:-a graphics card is there}"
    fi
}

# Its device file must also be ours to open: without, the processor draws although there is a card.
has_graphics_card() {
    local node
    for node in /dev/dri/renderD* /dev/nvidia0; do [[ ! -r $node || ! -w $node ]] || return 0; done
    return 1
}

look_at_devices() {
    if [[ ! -x $bin/device_daemon ]]; then
        advise "nobody can look before the programs are built" "see Programs"
    else
        { timeout 20 "$bin/device_daemon" --list 2>&1 || true; } |
            sed 's/^/  /; s/device_daemon --scene FILE --device/bonemill start --device/'
    fi
}

look_at_sessions() {
    local file number process name owner found=false
    for file in "$state"/*.session; do
        number=$(basename -- "$file" .session)
        [[ -f $file ]] || continue
        if is_running "$number"; then
            read_session "$number"
            fine "session $number runs (${session[scene]})"
        else
            fine "session $number died; what it left is cleared away now"
        fi
    done
    while read -r process name number owner; do
        if [[ $owner != "$UID" ]] || is_supervised "$process"; then continue; fi
        advise "$name of session $number runs without bonemill: started by hand, or left over" "kill $process"
        found=true
    done < <(running_programs)
    [[ $found == true ]] || fine "nothing was left running"
}

# is_supervised PID: is it in the list of a session that runs?
is_supervised() {
    local number
    while read -r number; do
        read_session "$number"
        [[ "${session[programs]}," != *" $1,"* ]] || return 0
    done < <(running_sessions)
    return 1
}
