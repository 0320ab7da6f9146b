#!/bin/sh
# Fails when a source or a page cites a work that docs/references.md does not list, when that list holds a work that
# nobody cites, when a page names a file of the project that does not exist, or when something was left to be done later.
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root" || exit 1
export LC_ALL=C.UTF-8
bibliography=docs/references.md
failed=0
complain() { echo "$*"; failed=1; }

texts=$({ scripts/sources; find . -path ./build -prune -o -path ./out -prune -o -path ./.git -prune -o \
    \( -name '*.md' -o -name '*.inl' -o -name '*.raymo' -o -name '*.def' \) -type f -print | sed 's|^\./||'; } | sort -u)

# A citation is a name, two digits and perhaps a letter, then perhaps where in the work: [Wijk86 3.5, (3.1)].
key='[A-Z][A-Za-z]*[0-9][0-9][a-z]\{0,1\}'
known=$(sed -n "s/^- \*\*\[\($key\)\]\*\*.*/\1/p" "$bibliography" | sort)
[ "$known" = "$(printf '%s\n' "$known" | uniq)" ] || complain "$bibliography: a key is listed twice"
cited=$(printf '%s\n' "$texts" | grep -vx "$bibliography" | xargs grep -oh "\[${key}[],; ]" | sed 's/[],; []//g' | sort -u)
for name in $cited; do
    printf '%s\n' "$known" | grep -qx "$name" ||
        complain "[$name] is cited but not listed in $bibliography: $(printf '%s\n' "$texts" | xargs grep -l "\[$name" | head -n 1)"
done
for name in $known; do
    printf '%s\n' "$cited" | grep -qx "$name" || complain "$bibliography: nobody cites [$name]"
done

# shellcheck disable=SC2016,SC2013
# Paths in pages: what stands between backticks and begins with a folder of the project.
for page in $(printf '%s\n' "$texts" | grep '\.md$'); do
    for path in $(grep -o '`\(raymo\|apps\|tests\|bench\|examples\|docs\|cmake\|scripts\)/[A-Za-z0-9_./-]*`' "$page" | tr -d '`' | sort -u); do
        [ -e "$path" ] || complain "$page: there is no $path"
    done
    # Links to files beside the page.
    for path in $(grep -o '](\([^)#:]*\))' "$page" | sed 's/^](//; s/)$//' | sort -u); do
        [ -e "$(dirname "$page")/$path" ] || complain "$page: there is no $path"
    done
done

later='TO''DO|FIX''ME|X''XX'
left=$(printf '%s\n' "$texts" | xargs grep -nwE "$later") && complain "left for later:
$left"
exit $failed
