# Sourced by scripts that report what their phases cost.
#
# phase NAME COMMAND...   runs a command, and adds a line to the file that PHASES names, if it is set: seconds of processor
#                         (user and system, all children), seconds of wall-clock time, NAME
# print_phases            prints that file as a table

phase() {
    local name=$1 status=0 TIMEFORMAT='%U %S %R' report
    shift
    report=$(mktemp)
    # The command's own error output passes by the report.
    { time "$@" 2>&3 || status=$?; } 3>&2 2>"$report" || true
    [ -z "${PHASES:-}" ] || tail -n 1 "$report" | awk -v name="$name" '{ print $1 + $2, $3, name }' >>"$PHASES"
    rm -f "$report"
    return $status
}

print_phases() {
    awk 'BEGIN { printf "%12s %12s  %s\n", "processor s", "wall-clock s", "phase" }
         { processor += $1; wall += $2; printf "%12.0f %12.0f  ", $1, $2; sub(/^[^ ]+ [^ ]+ /, ""); print }
         END { printf "%12.0f %12.0f  all\n", processor, wall }' FS=' ' "$PHASES"
}
