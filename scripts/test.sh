#!/usr/bin/env bash
# The test suite: with cargo-nextest where it is installed, else with cargo test. Arguments go to the runner.
set -euo pipefail
cd "$(dirname "$0")/.."

if cargo nextest --version >/dev/null 2>&1; then
    profile=default
    [[ -n ${CI:-} ]] && profile=ci
    exec cargo nextest run --workspace --locked --no-fail-fast --profile "$profile" "$@"
fi
echo "cargo-nextest is not installed (make tools builds it): running cargo test" >&2
exec cargo test --workspace --locked --no-fail-fast --lib --bins --tests "$@"
