#!/usr/bin/env bash
# The long check: every scene from end to end on the CPU engine in f64, and, if there is an adapter, on the GPU
# engine, whose run is compared with the CPU's. Results stay in runs/verify/<scene>/{cpu,gpu,compare.txt}.
#
#   scripts/verify.sh [scenes/NAME.toml ...]     default: all
set -uo pipefail
cd "$(dirname "$0")/.."

cargo build --release --locked || exit 1
# Tests too long for every day (large linear systems, whole implicit rolling runs, fine meshes) are marked as ignored.
cargo test -p hexroll --release --locked --test implicit -- --ignored --test-threads 1 || exit 1
cargo test -p hexroll --release --locked --test rolling -- --ignored || exit 1
cargo test -p hexroll --release --locked --test verification --test hard_cases -- --ignored || exit 1
hexroll() { cargo run --release --locked --quiet -- "$@"; }

passed=0 failed=0 skipped=0
count() { # count WORD SCENE WHAT
    printf '%-8s %s %s\n' "$1" "$2" "$3"
    case $1 in passed) passed=$((passed + 1)) ;; failed) failed=$((failed + 1)) ;; *) skipped=$((skipped + 1)) ;; esac
}

# The GPU engine's run. 1: failed, 2: there is no adapter.
run_gpu() { # run_gpu SCENE FOLDER
    local status=0
    hexroll run "$1" --engine gpu --out "$2/gpu" 2> >(tee "$2/gpu.err" >&2) || status=$?
    wait $! 2>/dev/null # tee
    [[ $status -eq 0 ]] && return 0
    [[ $status -eq 4 ]] && grep -q 'no GPU adapter found' "$2/gpu.err" && return 2
    return 1
}

verify() { # verify SCENE
    local name folder status=0
    name=$(basename "$1" .toml)
    folder=runs/verify/$name
    mkdir -p "$folder"
    if ! hexroll run "$1" --engine cpu --precision f64 --out "$folder/cpu"; then
        count failed "$name" cpu
        return
    fi
    count passed "$name" cpu
    run_gpu "$1" "$folder" || status=$?
    case $status in
    0) count passed "$name" gpu ;;
    2) count skipped "$name" gpu && return ;;
    *) count failed "$name" gpu && return ;;
    esac
    if hexroll compare "$folder/cpu" "$folder/gpu" | tee "$folder/compare.txt"; then
        count passed "$name" compare
    else
        count failed "$name" compare
    fi
}

scenes=("$@")
[[ ${#scenes[@]} -gt 0 ]] || scenes=(scenes/*.toml)
for scene in "${scenes[@]}"; do
    verify "$scene"
done
echo "$passed passed, $failed failed, $skipped skipped"
[[ $failed -eq 0 ]]
