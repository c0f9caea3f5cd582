# What bonemill and each of its commands say about themselves.
# shellcheck shell=bash

usage() {
    cat <<'TEXT'
Usage: bonemill [COMMAND] [options]
  start [SCENE]    start a session on this PC with the best hand it finds: haptic arm, SpaceMouse, gamepad or mouse
  prepare [SCENE]  make the phantoms that scenes read, before a class
  list             sessions that run, and scenes that can be started
  sessions         the last attempts of all classes: when, what, who, score
  stop [N|all]     end a session
  watch [HOST]     a window on a session of this PC, or of HOST
  host [SCENE]     start a session that other PCs watch
  invite NAME      let somebody join a session in a browser: prints a link and its QR code
  replay [FILE]    show a recorded session again, the last one or FILE
  what-if [FILE]   let a recorded session go on otherwise from a moment on, and see what would have come of it
  scan [FILE]      make a training case of a scan, in a window
  doctor           what this PC lacks, and what to type
  handbook [PAGE]  read how to use all this, in a browser
  window           all of this in a window: so does bonemill without a word, on a desktop
`bonemill COMMAND --help` says more, `bonemill --version` which one this is.
TEXT
}

session_options() {
    cat <<'TEXT'
  SCENE             name of a scene (bonemill list shows them), or a file (default: tooth_corridor)
  --device HAND     auto (default), simulated (the scripted hand of the scene), pointer, ...: see bonemill doctor
  --session N       number of the session (default: the first free one)
  --class NAME      whose attempts these are: table, class page and reports of all its sessions lie in one folder
                    (default: the date; bonemill list shows the folder)
  --no-viewer       without a window of its own
  --window-size WxH size of the window
  --seconds T       end after so many seconds
  --instructor-only carry out commands of instructors only, for examinations
  --no-enabling-switch
                    the device has no switch that must be held: it engages by itself while the force is small
TEXT
}

network_options() {
    cat <<'TEXT'
  --profile P       network: one-pc, lab, classroom, or a Cyclone DDS file (docs/howto/network.md)
  --interface I     this PC's interface to the others
  --peer ADDRESS    a PC to look for where multicast does not work; may be repeated
TEXT
    domain_option
}

domain_option() { echo "  --domain D        DDS domain, 0 (default) to 230"; }

usage_of() {  # COMMAND
    case $1 in
        start)
            echo "Usage: bonemill start [SCENE] [options] [-- WORDS FOR haptic_server]"
            session_options
            network_options
            echo "Ctrl-C, closing the window, or bonemill stop ends everything in order." ;;
        prepare)
            echo "Usage: bonemill prepare [SCENE]"
            echo "Makes the phantoms that the scene reads, or without a word those of all scenes, as far as they are not there:"
            echo "some 30 s for all. Without it each is made when a session first comes to its scene." ;;
        host)
            echo "Usage: bonemill host [SCENE] --interface I [--profile lab|classroom] [options] [-- WORDS FOR haptic_server]"
            echo "The profile is lab unless said otherwise; the other PCs type: bonemill watch THIS-PC"
            session_options
            network_options ;;
        watch)
            echo "Usage: bonemill watch [HOST] [options] [-- WORDS FOR render_client]"
            echo "  HOST              name or address of the PC with the session; without it: a session of this PC"
            echo "  --session N       number of the session (default: the one that runs here; 1 on another PC)"
            network_options
            echo "  --list            print which sessions other PCs give, and end"
            echo "  --tab-separated   with --list, for programs: number, scene, start, PC, profile, interface, a line each"
            echo "  --role R          viewer, operator or instructor"
            echo "  --name NAME       what the others read in their list of viewers"
            echo "  --window-size WxH size of the window" ;;
        invite)
            echo "Usage: bonemill invite NAME [options]"
            echo "Prints a link, and its QR code, with which NAME joins a session of this PC in a browser; the session's port for"
            echo "guests is open for as long as this command runs (docs/howto/gateway.md)."
            echo "  --session N       number of the session (default: the one that runs)"
            echo "  --role R          observer (default), operator, instructor or examiner"
            echo "  --people N        so many may come with the link (default 1)"
            echo "  --expires TIME    the link ends after so long: 30m, 8h (default), 3d"
            echo "  --address HOST    how guests reach this PC (default: its address in the network)"
            echo "  --port P          the port (default: the first free one from 8443 on)"
            domain_option
            echo "  --in-background   return at once; guests may come until the session ends" ;;
        replay)
            echo "Usage: bonemill replay [FILE] [options] [-- WORDS FOR bonemill_lab replay]"
            echo "  FILE              a recording (default: the last session's; bonemill list shows the last ones), or an"
            echo "                    attempt's result (results/*.json): its recording, from 3 s before the worst moment on"
            echo "  --at S            begin at this second of the session"
            echo "  --against OTHER   compare with another attempt at the same scene, a recording (its last attempt) or a result:"
            echo "                    its tool goes along as a ghost, and colours tell who has removed what (docs/howto/replay.md)"
            echo "  --clip FILE.mp4   no window: write the seconds around --at (of a result: around its worst moment) as a video"
            echo "  --seconds T       so many of them (default 10)"
            echo "  --view A,E,D,X,Y,Z  the clip's camera: azimuth, elevation (degrees), distance, target (mm); default: the scene's"
            echo "  --session N       number of the session (default: the first free one)"
            echo "  --no-viewer       without a window of its own"
            echo "  --window-size WxH size of the window"
            network_options ;;
        what-if)
            echo "Usage: bonemill what-if [FILE] [--at S] WHAT IS OTHERWISE [options]"
            echo "Goes on from a moment of a recording, bit by bit as it was until then, and shows score, damage, heat and force"
            echo "beside what happened: here, as a page, and in a replay with the other tool as a ghost (docs/howto/replay.md)."
            echo "  FILE              a recording (default: the last session's), or an attempt's result (results/*.json)"
            echo "  --at S            from this second of the session on (default: 3 s before the worst moment of a result)"
            echo "  --shift-mm X,Y,Z  the hand elsewhere, in mm along the axes of the scene"
            echo "  --tool NAME       another tool of the scene"
            echo "  --accuracy NAME   another accuracy preset or contact law, as exact or vps"
            echo "  --pace F          the hand F times as fast"
            echo "  --expert          the expert's hand, where the task has one"
            echo "  --no-viewer       without the replay in a window"
            echo "  --window-size WxH size of the window"
            network_options ;;
        sessions)
            echo "Usage: bonemill sessions [--scene HASH] [--tab-separated]"
            echo "The last attempts of all classes of this user, the newest first: start, scene, trainee, score, and the result,"
            echo "as bonemill replay takes it; (no recording) where it was not recorded, or that is gone."
            echo "  --scene HASH      only attempts at this scene (its hash, as in a result), and experts' attempts at it, too"
            echo "  --tab-separated   for programs: result, recording, start, scene, trainee, score, a line each" ;;
        stop)
            echo "Usage: bonemill stop [N|all]"
            echo "Ends session N, or all sessions; without a word the one that runs. It waits until they have ended." ;;
        list)
            echo "Usage: bonemill list [--tab-separated]"
            echo "Sessions that run: number, scene, device, start, processes, logs, class folder. Then the scenes that can be"
            echo "started, and the last recordings."
            echo "  --tab-separated   for programs, a line each, with its kind first: scene (or case, one of your own): name, file,"
            echo "                    picture, phantoms that are made first, files that are missing; session: number, scene,"
            echo "                    device, start; recording: file, time, MB; interface: name" ;;
        scan)
            echo "Usage: bonemill scan [FILE]"
            echo "Opens the window in which a training case is made of a scan: FILE, a folder of DICOM, or what is chosen there."
            echo "The cases lie in ~/.local/share/bonemill/cases, and bonemill's window offers them. The same, step by step and"
            echo "without a window: deploy/make-case, installed as bonemill-make-case (docs/howto/cases.md)." ;;
        window)
            echo "Usage: bonemill [window] [options]"
            echo "A window to begin in: scenes and your own cases to click, the last sessions, sessions of other PCs, and how this"
            echo "PC is. What is clicked is what would be typed. The options go with all that is started."
            network_options ;;
        doctor)
            echo "Usage: bonemill doctor [--interface I] [--domain D] [--tab-separated]"
            echo "Says what this PC lacks, and what to type: programs, real time, network (of interface I, and a firewall's ports"
            echo "for domain D), display, OpenGL, devices, what was left running. It installs nothing. The exit code is 1 when no"
            echo "session can be started."
            echo "  --tab-separated   for programs, a line each: what is looked at, ok, better or MISSING, what it is, what to type;"
            echo "                    of a device: hand, its kind, ready or not ready, what it is, what to type" ;;
        handbook)
            echo "Usage: bonemill handbook [PAGE]"
            echo "Opens the handbook in the browser, and prints where it lies: tutorials, how to, reference, explanation."
            echo "  PAGE              a page as messages name it (docs/howto/security.md), or its name (security); another word is"
            echo "                    looked for, and the pages are named that have it" ;;
    esac
}
