# bonemill invite: a gateway for a session's guests, and a link for one of them.
# shellcheck shell=bash
# shellcheck disable=SC2154

# The address under which this PC's first network knows it.
own_address() { ip -o -4 addr show scope global 2>/dev/null | awk '{sub("/.*", "", $4); print $4; exit}'; }

# serve_guests NAME WORD...: the words say which session.
serve_guests() {
    local name=$1 host=${option[address]:-$(own_address)} port=${option[port]:-8443} link words
    shift
    : "${host:=localhost}"
    words=(--name "$name" --role "${option[role]:-observer}" --gateway "https://$host:$port")
    [[ -z ${option[people]:-} ]] || words+=(--people "${option[people]}")
    [[ -z ${option[expires]:-} ]] || words+=(--expires "${option[expires]}")
    link=$("$share/security/invite" "${words[@]}" | grep -o 'https://[^ ]*#[^ ]*') || exit 2
    say "this link is for $name alone; the browser asks once whether it may trust this PC:"
    printf '\n%s\n\n' "$link"
    if command -v qrencode >/dev/null; then qrencode -t UTF8 -- "$link"; else say "with the package qrencode there would be a QR code"; fi
    if is_port_taken "$port"; then
        say "port $port is open already: guests come through the gateway that serves it"
        return
    fi
    [[ $flags != *" --in-background "* ]] || { serve_behind "$port" "$@"; return; }
    say "guests may come as long as this runs; Ctrl-C ends it"
    exec "$bin/render_client" --serve "0.0.0.0:$port" "$@" "${extra[@]}"
}

# serve_behind PORT WORD...: until the session ends, which was started by session[script].
serve_behind() {
    local port=$1 tenth
    shift
    [[ -n ${session[script]:-} ]] || fail "session ${option[session]} was not started by bonemill: leave --in-background out"
    setsid bash -c '"$@" & gateway=$!; tail --pid="$0" -f /dev/null; kill "$gateway"' "${session[script]}" \
        "$bin/render_client" --serve "0.0.0.0:$port" "$@" "${extra[@]}" >>"${session[logs]}/gateway.log" 2>&1 </dev/null &
    for ((tenth = 0; tenth < 50; ++tenth)); do ! is_port_taken "$port" || return 0; sleep 0.1; done
    fail "the gateway does not open port $port: see ${session[logs]}/gateway.log"
}

is_port_taken() { (: <>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }
