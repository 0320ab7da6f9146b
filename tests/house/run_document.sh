#!/bin/sh
# run_document.sh RAYMO PAGE FOLDER: runs what a page of the manual shows, in FOLDER.
#
#   ```raymo            a whole program: `raymo check` must accept it
#   ```raymo cup.raymo  the same, and commands further down find it under that name
#   ```raymo cup.raymo exit 1   a program that must be refused with that exit code
#   ```xml plate.svg    a file that programs further down read
#   ```console          lines "$ command" are run and must succeed; the lines below one are what it prints
#   ```console exit 1   the same for commands that end with that exit code
#
# A line "..." of the expected output stands for any number of lines. Other blocks are not run.
set -u
raymo=$1
page=$2
folder=$3
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder" || exit 1
PATH=$(dirname "$raymo"):$PATH
export PATH NO_COLOR=1

# One file a block: its first line tells kind, argument and line, the rest is the block.
awk '
    /^```/ && inside { inside = 0; close(name); next }
    /^```(raymo|console|xml [a-z])/ && !skipping {
        inside = 1; name = sprintf("block-%03d", ++count)
        info = substr($0, 4); print info, "@" FNR > name; next
    }
    /^```/ { skipping = !skipping; next }
    inside { print > name }
' "$page"

failed=0
complain() { echo "$page:$line: $*"; failed=1; }

# matches EXPECTED ACTUAL: equal line by line, where "..." in EXPECTED stands for any lines.
matches() {
    awk -v expected="$1" '
        BEGIN { while ((getline text < expected) > 0) want[++n] = text }
        { have[++m] = $0 }
        function fits(i, j) {
            while (i <= n) {
                if (want[i] == "...") {
                    for (; j <= m + 1; ++j) if (fits(i + 1, j)) return 1
                    return 0
                }
                if (j > m || want[i++] != have[j++]) return 0
            }
            return j > m
        }
        END { exit !fits(1, 1) }' "$2"
}

run_command() {  # uses command, expected, status
    sh -c "$command" > actual.txt 2>&1
    got=$?
    if [ "$got" -ne "$status" ]; then
        complain "\$ $command: exit code $got, not $status"
        cat actual.txt
    elif [ -s expected.txt ] && ! matches expected.txt actual.txt; then
        complain "\$ $command: prints"
        cat actual.txt
    fi
}

for block in block-*; do
    [ -e "$block" ] || break
    read -r kind first second third _ < "$block"
    line=$(sed -n '1s/.*@//p' "$block")
    if [ "$kind" = xml ]; then
        sed 1d "$block" > "$first"
    elif [ "$kind" = raymo ]; then
        case $first in @*) name=$block.raymo ;; *) name=$first ;; esac
        sed 1d "$block" > "$name"
        status=0
        [ "$second" = exit ] && status=$third
        raymo check "$name" > actual.txt 2>&1
        got=$?
        [ "$got" -eq "$status" ] || { complain "raymo check: exit code $got, not $status"; cat actual.txt; }
    else
        status=0
        [ "$first" = exit ] && status=$second
        command=
        : > expected.txt
        sed 1d "$block" > commands.txt
        while IFS= read -r text; do
            case $text in
                '$ '*)
                    [ -z "$command" ] || run_command
                    command=${text#'$ '}
                    : > expected.txt ;;
                *) printf '%s\n' "$text" >> expected.txt ;;
            esac
        done < commands.txt
        [ -z "$command" ] || run_command
    fi
done
exit $failed
