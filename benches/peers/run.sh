#!/usr/bin/env bash
# Times explicit codes that anyone can install, and hexroll, on the same ring, one after the other on one core.
#
#   benches/peers/run.sh --install      fetches CalculiX and Akantu into the cache, then runs
#   benches/peers/run.sh                runs with what is there; what is missing is named and left out
#
# Options: --sizes 880,56320  --core 0  --only calculix,akantu,hexroll  --out FOLDER (default: target/peers)
# Nothing is installed into the system: packages are unpacked under ${XDG_CACHE_HOME:-~/.cache}/hexroll-peers.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cache=${XDG_CACHE_HOME:-$HOME/.cache}/hexroll-peers

say() { printf 'peers: %s\n' "$*" >&2; }

# Debian's packages, unpacked: no right to install is needed.
get_calculix() {
    local debs=$cache/debs
    [[ -x $cache/calculix/usr/bin/ccx ]] && return 0
    command -v apt-get >/dev/null || { say "no apt-get here: CalculiX is left out"; return 0; }
    mkdir -p "$debs/partial" "$cache/calculix"
    say "downloading calculix-ccx and what it needs"
    apt-get install --download-only --yes --no-install-recommends -qq \
        -o Debug::NoLocking=1 -o Dir::Cache::archives="$debs" calculix-ccx >&2 || {
        say "the package lists may be out of date: sudo apt-get update"
        return 0
    }
    local deb
    for deb in "$debs"/*.deb; do dpkg -x "$deb" "$cache/calculix"; done
}

# The wheel is for one version of Python.
get_akantu() {
    local python
    [[ -x $cache/akantu/bin/python ]] && return 0
    for python in python3.11 python3; do
        command -v "$python" >/dev/null && "$python" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' && break
        python=
    done
    [[ -n $python ]] || { say "Akantu's wheel needs Python 3.11: left out"; return 0; }
    mkdir -p "$cache"
    "$python" -m venv "$cache/akantu"
    "$cache/akantu/bin/pip" install --quiet akantu==5.0.7.post1 numpy scipy >&2 || {
        say "pip cannot install akantu: left out"
        rm -rf "$cache/akantu"
    }
}

arguments=()
for argument in "$@"; do
    if [[ $argument == --install ]]; then
        get_calculix
        get_akantu
    else
        arguments+=("$argument")
    fi
done
exec python3 "$here/compare.py" --cache "$cache" --root "$root" "${arguments[@]}"
