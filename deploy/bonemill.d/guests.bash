# bonemill invite: a gateway for a session's guests, and a link for one of them.
# shellcheck shell=bash
# shellcheck disable=SC2154

readonly first_port=8443 most_ports=50

# The address under which this PC's first network knows it.
own_address() { ip -o -4 addr show scope global 2>/dev/null | awk '{sub("/.*", "", $4); print $4; exit}'; }

is_port_taken() { (: <>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

# Prints "PORT SESSION" of each gateway of this PC.
running_gateways() {
    local folder words i port number
    for folder in /proc/[0-9]*; do
        { mapfile -d '' -t words; } 2>/dev/null <"$folder/cmdline" || continue
        [[ ${words[0]:-} == */render_client ]] || continue
        port="" number=1
        for i in "${!words[@]}"; do
            [[ ${words[i]} != --serve ]] || port=${words[i + 1]##*:}
            [[ ${words[i]} != --session ]] || number=${words[i + 1]:-}
        done
        [[ -z $port ]] || echo "$port $number"
    done
}

# choose_port: into `port`, the one of this session's gateway, or one that is free; `is_served` says which.
choose_port() {
    local gateways
    gateways=$(running_gateways | sort -u)
    is_served=true
    port=${option[port]:-$(awk -v n="${option[session]}" '$2 == n {print $1; exit}' <<<"$gateways")}
    if [[ -n $port ]] && grep -qx "$port ${option[session]}" <<<"$gateways"; then return; fi
    is_served=false
    if [[ -n $port ]]; then
        ! is_port_taken "$port" || fail "port $port is open already, and not for session ${option[session]}: give another --port"
        return
    fi
    for ((port = first_port; port < first_port + most_ports; ++port)); do is_port_taken "$port" || return 0; done
    fail "the ports $first_port to $((port - 1)) are all open already: give another --port"
}

# serve_guests NAME WORD...: the words say which session. All is looked at before the invitation is written.
serve_guests() {
    local name=$1 host=${option[address]:-$(own_address)} port is_served link words
    shift
    : "${host:=localhost}"
    [[ $host =~ ^[][A-Za-z0-9.:_-]+$ ]] || fail "--address $host: give a name or an address of this PC"
    choose_port
    [[ $flags != *" --in-background "* || $is_served == true || -n ${session[script]:-} ]] ||
        fail "session ${option[session]} was not started by bonemill: leave --in-background out"
    words=(--name "$name" --role "${option[role]:-observer}" --gateway "https://$host:$port")
    [[ -z ${option[people]:-} ]] || words+=(--people "${option[people]}")
    [[ -z ${option[expires]:-} ]] || words+=(--expires "${option[expires]}")
    link=$("$share/security/invite" "${words[@]}" | grep -o 'https://[^ ]*#[^ ]*') || exit 2
    say "this link is for $name alone; the browser asks once whether it may trust this PC:"
    printf '\n%s\n\n' "$link"
    if command -v qrencode >/dev/null; then qrencode -t UTF8 -- "$link"; else say "with the package qrencode there would be a QR code"; fi
    if [[ $is_served == true ]]; then say "guests come through the gateway that serves port $port"; return; fi
    [[ $flags != *" --in-background "* ]] || { serve_behind "$port" "$@"; return; }
    say "guests may come as long as this runs; Ctrl-C ends it"
    exec "$bin/render_client" --serve "0.0.0.0:$port" "$@" "${extra[@]}"
}

# serve_behind PORT WORD...: until the session ends, which was started by session[script].
serve_behind() {
    local port=$1 tenth behind
    shift
    # shellcheck disable=SC2016
    setsid bash -c '"$@" & gateway=$!; tail --pid="$0" -f /dev/null & watch=$!; wait -n; kill "$gateway" "$watch" 2>/dev/null' \
        "${session[script]}" "$bin/render_client" --serve "0.0.0.0:$port" "$@" "${extra[@]}" \
        >>"${session[logs]}/gateway.log" 2>&1 </dev/null &
    behind=$!
    for ((tenth = 0; tenth < 300; ++tenth)); do
        ! is_port_taken "$port" || return 0
        kill -0 "$behind" 2>/dev/null || break
        sleep 0.1
    done
    kill -- "-$behind" 2>/dev/null || true
    fail "the gateway does not open port $port: see ${session[logs]}/gateway.log"
}
