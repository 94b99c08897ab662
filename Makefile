# hexroll: `make help` lists the targets. Each installs what is missing first (scripts/setup.sh).

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PATH := $(PATH):$(HOME)/.cargo/bin

# The scene that `make run` rolls, and arguments for it, e.g. ARGS="--engine cpu".
SCENE ?= scenes/lat100_straight.toml
ARGS ?=
OUT ?= runs/$(basename $(notdir $(SCENE)))

.PHONY: help setup tools build run test verify report mutants lint book clean-runs

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 22

setup: ## install what is missing (make, linker, software Vulkan)
	@bash scripts/setup.sh

tools: ## the same, and cargo-nextest and cargo-deny from source
	@bash scripts/setup.sh --tools

build: setup ## build the program: target/release/hexroll
	cargo build --release --locked

run: build ## roll SCENE (scenes/lat100_straight.toml) into OUT (runs/<scene>)
	cargo run --release --locked --quiet -- run $(SCENE) --out $(OUT) $(ARGS)

test: setup ## the test suite
	bash scripts/test.sh $(ARGS)

verify: setup ## long: every scene on the CPU, on the GPU if there is one, compared
	bash scripts/verify.sh $(ARGS)

report: build ## claims, hard cases, speed against error: docs/verification.md, stability.md, accuracy.md
	cargo run --release --locked --quiet -- report verification
	cargo run --release --locked --quiet -- report stability
	cargo run --release --locked --quiet -- report accuracy

mutants: setup ## plant known faults, one by one; every one must be noticed by a test
	bash scripts/mutants.sh $(ARGS)

book: ## the documentation as a book in target/book (needs mdbook: cargo install mdbook)
	mdbook build

lint: setup ## format, clippy, licences
	bash scripts/lint.sh

clean-runs: ## remove runs/
	rm -rf runs
