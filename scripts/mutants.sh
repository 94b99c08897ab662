#!/usr/bin/env bash
# Plants each fault of tests/mutants/mutants.tsv in a copy of the tree, builds, runs the named test binaries, and
# lists the tests that noticed. Fails if a fault went unnoticed.
#
#   scripts/mutants.sh [NAME ...]     default: all
set -uo pipefail
cd "$(dirname "$0")/.."

copy=target/mutants/tree
mkdir -p "$copy"
table=target/mutants/found.md
unnoticed=0

# A fresh copy of what is built. Times are kept, so that only what changes is compiled again: the planted file, which
# perl writes anew, and the one planted before, which is touched.
planted=
refresh() {
    tar --exclude=./target --exclude=./.git --exclude=./runs -cf - . | tar -xf - -C "$copy"
    [[ -z $planted ]] || touch "$copy/$planted"
}

# plant FILE TEXT REPLACEMENT: the text must stand there exactly once.
plant() {
    FIND=$2 REPLACE=$3 perl -0777 -i -pe '
        my $n = () = /\Q$ENV{FIND}\E/g;
        die "stands $n times, not once: $ENV{FIND}\n" if $n != 1;
        s/\Q$ENV{FIND}\E/$ENV{REPLACE}/;
    ' "$copy/$1"
}

# Names of failing tests of the binaries, one a line; the log of a build that failed goes to stderr.
failing() {
    local arguments=() binary
    for binary in "$@"; do
        [[ $binary == lib ]] && arguments+=(--lib) || arguments+=(--test "$binary")
    done
    (cd "$copy" && cargo test --locked --no-fail-fast --target-dir ../build "${arguments[@]}" 2>&1) >target/mutants/log
    grep -q '^error\(\[\|: could not compile\)' target/mutants/log && { cat target/mutants/log >&2; return 2; }
    sed -n 's/^test \(.*\) \.\.\. FAILED$/\1/p' target/mutants/log | sort -u
}

printf '| fault | file | noticed by |\n| --- | --- | --- |\n' >"$table"
while IFS=$'\t' read -r name file text replacement binaries; do
    [[ $name == \#* || -z $name ]] && continue
    [[ $# -gt 0 && " $* " != *" $name "* ]] && continue
    refresh
    planted=$file
    if ! plant "$file" "$text" "$replacement"; then
        echo "$name: cannot be planted in $file"
        unnoticed=$((unnoticed + 1))
        continue
    fi
    # shellcheck disable=SC2086 # a list of names
    tests=$(failing $binaries) || { echo "$name: does not build"; unnoticed=$((unnoticed + 1)); continue; }
    [[ -n $tests ]] || unnoticed=$((unnoticed + 1))
    printf '| %s | %s | %s |\n' "$name" "$file" "$(paste -sd, <<<"${tests:-**nobody**}" | sed 's/,/, /g')" | tee -a "$table"
done <tests/mutants/mutants.tsv
echo "$unnoticed unnoticed; table in $table"
[[ $unnoticed -eq 0 ]]
