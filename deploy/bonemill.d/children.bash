# What a script starts beside itself.

# end_with PID PROGRAM [WORD]... becomes the program, which gets SIGTERM when the shell PID ends that has started this
# with &: also when that one is killed and cannot say so. The small shell is there for the moment before the kernel knows
# whose death it shall watch.
end_with() {
    # shellcheck disable=SC2016
    exec setpriv --pdeathsig TERM sh -c '[ "$PPID" = "$0" ] && exec "$@"' "$@"
}
