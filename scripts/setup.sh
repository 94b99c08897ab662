#!/usr/bin/env bash
# Installs what a fresh Debian (or Ubuntu) machine with Rust lacks to build, run and test hexroll:
# make and a C linker, and a Vulkan loader with a software driver if there is no adapter.
# What is there already is left alone. Nothing here ever asks for a password.
#
#   scripts/setup.sh            what is needed
#   scripts/setup.sh --tools    also cargo-nextest and cargo-deny, built from source (some minutes)
set -euo pipefail

say() { printf 'setup: %s\n' "$*" >&2; }
have() { command -v "$1" >/dev/null 2>&1; }

as_root() {
    if [[ $(id -u) -eq 0 ]]; then
        "$@"
    elif have sudo && sudo -n true 2>/dev/null; then
        sudo -n "$@"
    else
        return 1
    fi
}

# apt_install PACKAGE...: 1 if there is no apt, no right to use it, or it fails.
apt_install() {
    have apt-get || return 1
    local options=(-y --no-install-recommends -o DPkg::Lock::Timeout=300)
    as_root true || return 1
    say "installing $*"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq >&2 || true # old lists may still do
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qq "${options[@]}" "$@" >&2
}

has_vulkan_loader() {
    local library
    for library in /usr/lib/*/libvulkan.so.1 /usr/lib{,64}/libvulkan.so.1 /usr/local/lib/libvulkan.so.1; do
        [[ -e $library ]] && return 0
    done
    # Elsewhere on the linker's path. No pipe into grep -q: it would close the pipe early.
    [[ "$(PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null || true)" == *libvulkan.so.1* ]]
}

# Names of the drivers that the Vulkan loader would find.
vulkan_drivers() {
    local home=${HOME:-/root} directory
    printf '%s\n' "${VK_DRIVER_FILES:-}" "${VK_ICD_FILENAMES:-}" | tr ':' '\n'
    for directory in "${XDG_CONFIG_HOME:-$home/.config}" /etc/xdg /etc /usr/local/etc \
        "${XDG_DATA_HOME:-$home/.local/share}" /usr/local/share /usr/share; do
        find "$directory/vulkan/icd.d" -name '*.json' 2>/dev/null || true
    done
}

# A driver for hardware is of use only where there is hardware; the software one (lavapipe, "lvp") always is.
has_vulkan_driver() {
    local drivers node
    drivers=$(vulkan_drivers)
    [[ $drivers == *lvp_icd* ]] && return 0
    [[ $drivers == *.json* ]] || return 1
    for node in /dev/dri/renderD* /dev/nvidia[0-9]* /dev/dxg; do
        [[ -e $node ]] && return 0
    done
    return 1
}

need_cargo() {
    have cargo && return 0
    say "there is no Rust here; install it from https://rustup.rs and try again"
    exit 1
}

need_build_tools() {
    local packages=()
    have make || packages+=(make)
    have cc || packages+=(gcc libc6-dev)
    [[ ${#packages[@]} -eq 0 ]] && return 0
    apt_install "${packages[@]}" && return 0
    say "cannot install ${packages[*]} here (no apt, or no right to use it): install them by hand"
    exit 1
}

# Without an adapter hexroll still runs, on the CPU engine and without pictures: a warning will do.
want_vulkan() {
    [[ $(uname -s) == Linux ]] || return 0 # Metal and DirectX come with the system
    local packages=()
    has_vulkan_loader || packages+=(libvulkan1)
    has_vulkan_driver || packages+=(mesa-vulkan-drivers)
    [[ ${#packages[@]} -eq 0 ]] && return 0
    apt_install "${packages[@]}" && return 0
    say "no Vulkan adapter, and no way to install ${packages[*]} here: CPU engine only, no pictures"
}

# Name of the crate = name of the subcommand, with "cargo-" in front.
want_cargo_tool() {
    cargo "${1#cargo-}" --version >/dev/null 2>&1 && return 0
    say "building $1 from source"
    cargo install --locked "$1"
}

main() {
    PATH="$PATH:${HOME:-/root}/.cargo/bin"
    need_cargo
    need_build_tools
    want_vulkan
    if [[ ${1:-} == --tools ]]; then
        want_cargo_tool cargo-nextest
        want_cargo_tool cargo-deny
    fi
}

main "$@"
