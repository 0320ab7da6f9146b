#!/bin/sh
# Fails when a source is not formatted as .clang-format says. Other versions than 14 break lines differently, so without
# that one the test is skipped (exit code 77).
command -v clang-format-14 > /dev/null || { echo "clang-format-14 is not installed"; exit 77; }
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root" || exit 1
scripts/sources | xargs clang-format-14 --dry-run --Werror
