#!/usr/bin/env bash
# Format, clippy, licences and sources of dependencies, shell syntax. A tool that is not installed is named and
# left out.
set -euo pipefail
cd "$(dirname "$0")/.."

has_cargo() { cargo "$1" --version >/dev/null 2>&1 || { echo "lint: cargo $1 is not installed, left out" >&2; false; }; }

for script in scripts/*.sh benches/*.sh benches/peers/*.sh .ci/run; do
    bash -n "$script"
done
if has_cargo fmt; then cargo fmt --all --check; fi
if has_cargo clippy; then cargo clippy --workspace --locked --all-targets -- -D warnings; fi
# Advisories need a database from the network: `cargo deny check advisories`.
if has_cargo deny; then cargo deny --locked check bans licenses sources; fi
