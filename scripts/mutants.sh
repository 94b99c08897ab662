#!/usr/bin/env bash
# Plants each fault of tests/mutants/mutants.tsv in a copy of the tree, builds, runs the named test binaries, and
# lists the tests that noticed. Fails if a fault went unnoticed, or could not be planted.
#
#   scripts/mutants.sh [NAME ...]     default: all
#
# Every fault leaves a row in target/mutants/rows, so that the run can be taken in slices; docs/mutants.md is put together
# from the rows there are (`scripts/mutants.sh none` does only that).
set -uo pipefail
cd "$(dirname "$0")/.."

list=tests/mutants/mutants.tsv
copy=target/mutants/tree
rows=target/mutants/rows
page=docs/mutants.md
mkdir -p "$copy" "$rows"
commit=${COMMIT:-$(git describe --always --dirty 2>/dev/null || echo unknown)}

# A fresh copy of what is built. Times are kept, so that only what changes is compiled again: the planted file, which
# perl writes anew, and the one planted before, which is touched.
refresh() {
    tar --exclude=./target --exclude=./.git --exclude=./runs -cf - . | tar -xf - -C "$copy"
    [[ ! -s target/mutants/planted ]] || touch "$copy/$(<target/mutants/planted)"
}

# plant FILE TEXT REPLACEMENT: the text must stand there exactly once.
plant() {
    FIND=$2 REPLACE=$3 perl -0777 -i -pe '
        my $n = () = /\Q$ENV{FIND}\E/g;
        die "stands $n times, not once: $ENV{FIND}\n" if $n != 1;
        s/\Q$ENV{FIND}\E/$ENV{REPLACE}/;
    ' "$copy/$1"
}

# Failing tests of the binaries, one a line; the log of a build that failed goes to stderr.
failing() {
    local arguments=() binary
    for binary in "$@"; do
        [[ $binary == lib ]] && arguments+=(--lib) || arguments+=(--test "$binary")
    done
    (cd "$copy" && cargo test --workspace --locked --no-fail-fast --target-dir ../build "${arguments[@]}" 2>&1) >target/mutants/log
    grep -q '^error\(\[\|: could not compile\)' target/mutants/log && { cat target/mutants/log >&2; return 2; }
    # Names from the list at a binary's end, with the binary, which cargo announces before its tests.
    awk '$1 == "Running" { n = split($(NF - 1), part, "/"); sub(/\.rs$/, "", part[n])
                           binary = part[n] == "main" ? part[n - 1] : part[n] }
         $0 == "failures:" { listing = 1; next }
         listing && /^    [^ ]+$/ { print binary "::" $1; next }
         { listing = 0 }' target/mutants/log | sort -u
}

# write_page: every fault of the list, in its order.
write_page() {
    local name file text replacement binaries count=0 noticed=0 body=
    while IFS=$'\t' read -r name file text replacement binaries; do
        [[ $name == \#* || -z $name ]] && continue
        count=$((count + 1))
        if [[ -e $rows/$name ]]; then
            body+=$(<"$rows/$name")$'\n'
            grep -q '\*\*' "$rows/$name" || noticed=$((noticed + 1))
        else
            body+="| $name | $file | not run |  |"$'\n'
        fi
    done <"$list"
    {
        printf '# Planted faults\n\n'
        printf 'Faults that the test suite must notice. `make mutants` plants each of them (`%s`) in a copy of the tree,\n' "$list"
        printf 'builds it, and runs the test binaries that ought to notice.\n\n'
        printf '%s of %s noticed.\n\n' "$noticed" "$count"
        printf '| fault | file | tests that fail | at commit |\n| --- | --- | --- | --- |\n%s' "$body"
    } >"$page"
}

unnoticed=0
while IFS=$'\t' read -r name file text replacement binaries; do
    [[ $name == \#* || -z $name ]] && continue
    [[ $# -gt 0 && " $* " != *" $name "* ]] && continue
    refresh
    echo "$file" >target/mutants/planted
    if ! plant "$file" "$text" "$replacement"; then
        echo "$name: cannot be planted in $file"
        unnoticed=$((unnoticed + 1))
        continue
    fi
    # shellcheck disable=SC2086 # a list of names
    tests=$(failing $binaries) || { echo "$name: does not build"; unnoticed=$((unnoticed + 1)); continue; }
    [[ -n $tests ]] || unnoticed=$((unnoticed + 1))
    printf '| %s | %s | %s | %s |\n' "$name" "$file" \
        "$(paste -sd, <<<"${tests:-**none**}" | sed 's/,/, /g')" "$commit" | tee "$rows/$name"
done <"$list"
write_page
echo "$unnoticed unnoticed or not planted; $page"
[[ $unnoticed -eq 0 ]]
