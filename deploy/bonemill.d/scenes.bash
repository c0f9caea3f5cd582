# Scenes: which there are, which file is meant, and the phantoms that they read.
# shellcheck shell=bash
# shellcheck disable=SC2154

scene_names() { (cd "$share/scenes" && for file in *.textproto; do echo "${file%.textproto}"; done); }

# Each with the first sentence of the comment that it begins with.
list_scenes() {
    local name
    while read -r name; do
        printf '  %-16s %s\n' "$name" "$(sed -n '/^#/!q; s/^# *//p' "$share/scenes/$name.textproto" | paste -sd ' ' | sed 's/\. .*/./')"
    done < <(scene_names)
}

# home_folder VARIABLE DEFAULT: the XDG folder of this user that the variable names.
home_folder() {
    [[ -n ${!1:-}${HOME:-} ]] || fail "neither $1 nor HOME is set: nobody says where to write"
    printf '%s\n' "${!1:-$HOME/$2}"
}

# Sessions may start at the same moment, and one may read what is there already: only newer files are copied, by one at a
# time; the one before stays beside it with ~, as somebody may have changed it. Descriptor 8 is the lock's.
copy_scenes() {
    local file mine
    flock 8
    for file in "$share"/scenes/*; do
        mine=$scenes/${file##*/}
        [[ ! -e $mine || ! $file -nt $mine ]] || cp --preserve=timestamps -- "$mine" "$mine~" || return 1
    done
    cp --update --preserve=timestamps -- "$share"/scenes/* "$scenes"
}

# Scenes read phantoms from ../../build/data. In an installed tree that is nobody's to write, so there a scene is used from
# a copy in the user's own data folder.
own_scenes() {
    if [[ $installed == true ]]; then
        data=$(home_folder XDG_DATA_HOME .local/share)/bonemill/build/data
        scenes=${data%/build/data}/deploy/scenes
        { mkdir -p -- "$scenes" && copy_scenes 8>"$scenes/.lock"; } || fail "the scenes cannot be copied to $scenes"
    else
        scenes=$share/scenes data=$(realpath -m -- "$share/../build/data")
    fi
}

# find_scene WORD: a name is that of our own scene, whatever files lie about.
find_scene() {
    own_scenes
    if [[ $1 != */* && -f $scenes/$1.textproto ]]; then
        scene=$scenes/$1.textproto
    elif [[ -f $1 ]]; then
        scene=$(realpath -- "$1")
    else
        fail "there is no scene '$1': there are $(scene_names | paste -sd ' '), or give a file"
    fi
    scene_name=$(basename -- "$scene" .textproto)
}

# missing_phantoms SCENE: prints which phantoms the scene reads that are not there, as file names.
missing_phantoms() {
    local path
    while read -r path; do
        path=$(realpath -m -- "$(dirname -- "$1")/$path")
        [[ $path != "$data"/* || -e $path ]] || basename -- "$path" .nrrd
    done < <(sed -nE 's/^ *(label_)?path: *"([^"/][^"]*)".*/\2/p' "$1")
}

# phantom_of FILE: the name under which make-phantoms makes it; fails where it is no phantom.
phantom_of() {
    local name=${1%_labels}
    [[ $1 != skull_labels ]] || name=$1
    case $name in
        tooth | bone_block | clay_block | vertebra | temporal_bone | third_molar | skull_labels) echo "$name" ;;
        *) return 1 ;;
    esac
}

# Prints the names of the scenes beside this one that lack phantoms and nothing else.
makeable_scenes() {
    local each file
    for each in "$(dirname -- "$scene")"/*.textproto; do
        [[ -n $(missing_phantoms "$each") ]] || continue
        while read -r file; do phantom_of "$file" >/dev/null || continue 2; done < <(missing_phantoms "$each")
        basename -- "$each" .textproto
    done
}

make_phantoms() {
    local file name made=" "
    while read -r file; do
        name=$(phantom_of "$file") ||
            fail "$scene_name needs $data/$file.nrrd, which is no phantom: the first lines of $scene say where it comes from"
        [[ $made != *" $name "* ]] || continue  # a scan and its labels are made at once
        made+="$name "
        say "making the phantom $name, once: some seconds"
        # Two sessions that start side by side do not write the same file.
        flock "$state/phantoms.lock" "$share/make-phantoms" --bin "$bin" --out "$data" "$name" >>"$logs/phantoms.log" 2>&1 9>&- ||
            fail "the phantom $name could not be made: $(tail -n 1 "$logs/phantoms.log")"
    done < <(missing_phantoms "$scene")
}

# Makes what the scene of this name or file lacks, or each of our own. The server asks for it, too, when somebody chooses a
# scene that lacks its phantom.
prepare_scenes() {
    local name names=("$operand")
    logs=$state
    if [[ -z $operand ]]; then
        find_scene tooth_corridor
        mapfile -t names < <(makeable_scenes)
    fi
    for name in "${names[@]}"; do
        find_scene "$name"
        make_phantoms
    done
    say "what ${operand:-each scene} reads is there"
}
