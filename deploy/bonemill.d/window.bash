# bonemill without a word: the window to begin in. It asks for what it shows, and starts what is clicked, by the commands
# of this script; what they tell programs, a tab between the fields, is made here.
# shellcheck shell=bash
# shellcheck disable=SC2154

can_show_window() { [[ -x $bin/start_window ]] && has_display; }

window() {
    local words=()
    read_words window "$network_names" "$@"
    [[ -z $operand ]] || fail "window takes no word (see: bonemill window --help)"
    need_programs start_window
    has_display || fail "there is no display here: bonemill --help says what can be typed"
    mapfile -t words < <(network_words)
    exec "$bin/start_window" --launcher "$self" -- "${words[@]}"
}

cases_folder() { printf '%s/bonemill/cases\n' "$(home_folder XDG_DATA_HOME .local/share)"; }

scan() {
    local maker=$here/make-case folder number=1
    [[ $installed == false ]] || maker=$here/bonemill-make-case
    read_words scan "" "$@"
    need_programs case_window
    has_display || fail "there is no display here: $maker --help says how a case is made without"
    folder=$(cases_folder)
    while [[ -e $folder/case_$number ]]; do ((++number)); done
    mkdir -p -- "$folder" || fail "the folder $folder cannot be made"
    exec "$maker" --window --out "$folder/case_$number" ${operand:+"$operand"}
}

# tell KIND FIELD...: a line for programs.
tell() {
    local IFS=$'\t'
    printf '%s\n' "$*"
}

tell_list() {
    local name file number
    if [[ -d $share/scenes ]]; then
        own_scenes
        while read -r name; do tell_scene scene "$name" "$scenes/$name.textproto"; done < <(scene_names)
        while IFS= read -r file; do
            tell_scene case "$(basename -- "$file" .textproto)" "$file"
        done < <(find "$(cases_folder)" -mindepth 2 -maxdepth 2 -name '*.textproto' 2>/dev/null | sort)
    fi
    while read -r number; do
        read_session "$number"
        tell session "$number" "${session[scene]}" "${session[device]}" "${session[since]}"
    done < <(running_sessions)
    while IFS= read -r file; do
        tell recording "$file" "$(date -r "$file" '+%Y-%m-%d %H:%M')" "$(($(stat -c %s -- "$file") / 1000000))"
    done < <(newest_recordings | head -n 10)
    while read -r name; do tell interface "$name"; done < <(interfaces_to_others)
}

# tell_scene KIND NAME FILE
tell_scene() {
    local picture=${3%.textproto}.png lacks file
    [[ -f $picture ]] || picture=""
    lacks=$(while read -r file; do phantom_of "$file" >/dev/null || echo "$file.nrrd"; done < <(missing_phantoms "$3")
        sed -nE 's#^ *(label_)?path: *"(/[^"]+)".*#\2#p' "$3" | while read -r file; do [[ -e $file ]] || echo "$file"; done)
    tell "$1" "$2" "$3" "$picture" \
        "$(while read -r file; do phantom_of "$file" || true; done < <(missing_phantoms "$3") | sort -u | paste -sd ' ')" "${lacks//$'\n'/ }"
}

# That which leads to all others comes first.
interfaces_to_others() {
    { interface_to_others; find /sys/class/net -mindepth 1 ! -name lo -printf '%f\n' | sort; } | awk '!seen[$0]++'
}

# Sessions that other PCs give: what a viewer hears of them within two seconds.
list_others() {
    local words=() line
    : "${option[interface]:=$(interface_to_others)}"
    [[ -z ${option[interface]} ]] || : "${option[profile]:=lab}"
    mapfile -t words < <(network_words)
    while IFS= read -r line; do
        [[ $line =~ ^session\ ([0-9]+):\ (.*)\ since\ ([0-9:]+)(\ on\ (.*))?$ && ${BASH_REMATCH[5]} != "$(uname -n)" ]] || continue
        if [[ $flags == *" --tab-separated "* ]]; then
            tell "${BASH_REMATCH[@]:1:3}" "${BASH_REMATCH[5]}" "${option[profile]:-}" "${option[interface]}"
        else
            printf '%s\n' "$line"
        fi
    done < <("$bin/render_client" --list "${words[@]}" --log-level error 2>/dev/null)
}
