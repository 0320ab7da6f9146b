#!/bin/sh
# check_thesis.sh CTEST BUILD: fails when a row of docs/thesis.md has no place for its words, says where something is but not
# what holds it, names a file that does not exist, or names a test that the build in the folder BUILD does not run.
set -u
ctest=$1
build=$2
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root" || exit 1
page=docs/thesis.md
tests=$("$ctest" --test-dir "$build" -N | sed -n 's/^ *Test *#[0-9]*: //p')
[ -n "$tests" ] || { echo "$build has no tests"; exit 1; }
failed=0
complain() { echo "$page:$*"; failed=1; }

# A row is | section | what | where | test | how |. Prints what is wrong with its form, and each name between backticks:
# line, column, name.
found=$(awk -F '|' '
    function names(column, text) {
        while (match(text, /`[^`]*`/)) {
            print FNR, column, substr(text, RSTART + 1, RLENGTH - 2)
            text = substr(text, RSTART + RLENGTH)
        }
    }
    function is_empty(text) { return text ~ /^ *$/ }
    !/^\|/ || /^\|---/ { next }
    NF != 7 { print FNR, "form", "the row has " NF - 2 " columns, not 5"; next }
    is_empty($6) { print FNR, "form", "the row does not say how" }
    !is_empty($4) && is_empty($5) { print FNR, "form", "the row names no test" }
    is_empty($4) && !is_empty($5) { print FNR, "form", "the row names a test of nothing" }
    { names("where", $4); names("test", $5) }
    END { if (NR == 0) print 0, "form", "the page is empty" }
' "$page")

while read -r line column name; do
    case $column in
        form) complain "$line: $name" ;;
        where) [ -e "$name" ] || complain "$line: there is no $name" ;;
        test)
            case $name in
                */*) [ -e "$name" ] || complain "$line: there is no $name" ;;
                *) printf '%s\n' "$tests" | grep -qxF "$name" || complain "$line: there is no test $name" ;;
            esac ;;
    esac
done << END
$found
END
exit $failed
