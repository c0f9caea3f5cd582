# Completes the words of bonemill and of its programs by what they say of themselves.
# shellcheck shell=bash

_bonemill_options() { "$@" --help 2>/dev/null | grep -oE -- '(^|[ ,|[])--[a-z][a-z-]*' | tr -d ' ,|[' | sort -u; }

_bonemill() {
    local program=$1 word=$2 before=$3 words=""
    COMPREPLY=()
    if [[ ${program##*/} != bonemill ]]; then
        [[ $word != -* ]] || words=$(_bonemill_options "$program")
    elif [[ $COMP_CWORD == 1 ]]; then
        words=$("$program" --help | sed -nE 's/^  ([a-z-]+) .*/\1/p')
    elif [[ $word == -* ]]; then
        words=$(_bonemill_options "$program" "${COMP_WORDS[1]}")
    elif [[ ${COMP_WORDS[1]} == @(start|host) && $before != -* ]]; then
        words=$("$program" list | sed -n '/^Scenes/,/^[^ S]/s/^  \([a-z_]*\) .*/\1/p')
    elif [[ ${COMP_WORDS[1]} == stop ]]; then
        words="all $("$program" list | sed -n '/^Sessions/,/^Scenes/s/^  \([0-9]*\) .*/\1/p')"
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _bonemill bonemill bonemill-make-case bonemill-study haptic_server device_daemon render_client \
    bonemill_lab make_phantom ares_emulator bonemill_bridge_force_dimension bonemill_bridge_haply bonemill_bridge_igtl \
    bonemill_bridge_ros2 bonemill_bridge_touch bonemill_igtl bonemill_ros2
