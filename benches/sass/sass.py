#!/usr/bin/env python3
"""Counts what NVIDIA's compiler makes of hexroll's kernels, without an NVIDIA GPU.

    cargo build --release
    target/release/hexroll check scenes/lat100_straight.toml --programs wgsl
    python3 benches/sass/sass.py wgsl/element_force.wgsl wgsl/node.wgsl

WGSL goes through naga to Metal's C++, which a header makes CUDA's, and NVRTC with ptxas makes machine code of it for an
H100 (sm_90). A table row a kernel: registers a thread, bytes of stack, shared memory, instructions in all, in its largest loop (that over the elements of
a chain, or over the steps of a small mesh), and of those by kind.

Needs cargo, and from PyPI, in a virtual environment under ${XDG_CACHE_HOME:-~/.cache}/hexroll-sass that it makes itself,
nvidia-cuda-nvrtc-cu12 (the compiler) and triton (for its disassembler). No GPU and no driver.
What a Vulkan driver makes of the SPIR-V may differ: same backend, another front end."""

import argparse
import collections
import ctypes
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "hexroll-sass"
PACKAGES = ["nvidia-cuda-nvrtc-cu12==12.9.86", "triton==3.1.0"]
# Of the mesh with 450,560 elements, and of the wheel's material; values change no instruction but divisions by them.
LARGE = dict(lattice_row=352, lattice_rows=33, lattice_columns=352, lattice_groups=176, lattice_length=6, lattice_layers=7, lattice_last=4,
             face_slots=132)
# Of the wheel with 880 elements in one work group.
SMALL = dict(lattice_row=44, lattice_rows=5, lattice_columns=44, lattice_groups=3, lattice_length=3, lattice_layers=2, lattice_last=2, face_slots=134,
             rounds=1, faces=4, words=3960)
REALS = dict(g0=65.1e6, g1=2.64e6, g2=0.5e6, eta=20.0, mu=1.0, normal_x=0.0, normal_y=0.0, normal_z=1.0, road_offset=0.0,
             road_velocity_x=0.0, road_velocity_y=0.0, road_velocity_z=0.0)


def python():
    """An interpreter that has the packages."""
    found = CACHE / "bin" / "python"
    if not found.exists():
        subprocess.run([sys.executable, "-m", "venv", CACHE], check=True)
        subprocess.run([found, "-m", "pip", "install", "--quiet", "--no-deps", *PACKAGES], check=True)
    return found


def tool(pattern):
    found = sorted(CACHE.glob(f"lib/python*/site-packages/{pattern}"))
    if not found:
        sys.exit(f"sass.py: {pattern} is not in {CACHE}: remove that folder and try again")
    return found[0]


def with_values(wgsl, threads):
    """Overrides as constants, since Metal's C++ needs the sizes of arrays."""
    values = {**REALS, **(SMALL if "override words" in wgsl else LARGE), "threads": threads}

    def constant(match):
        name, kind = match.groups()
        if name not in values:
            sys.exit(f"sass.py: no value for the constant {name}: add one to the tables at the top of this file")
        value = f"{float(values[name])!r}" if kind == "real" else f"{values[name]}u"
        return f"const {name}: {kind} = {value};"

    return re.sub(r"override (\w+): (\w+);", constant, wgsl)


def cuda(metal, threads):
    """Metal's C++ as CUDA's: address spaces and attributes go, parameters become pointers, constants and shared memory."""
    metal = metal[metal.index("struct _mslBufferSizes") if "_mslBufferSizes" in metal else metal.index("using metal::uint;") + 18:]
    metal = re.sub(r"\[\[.*?\]\]", "", metal)
    metal = re.sub(r"\.(xyz|xy)\b(?!\()", r".\1()", metal)
    metal = re.sub(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d+)?)(?!\w)", r"\1f", metal)
    metal = re.sub(r"\b(device|thread) ", "", metal)
    head, rest = metal.split("kernel void main_(")
    parameters, body = rest.split(") {", 1)
    head = re.sub(r"(?m)^((?:metal::)?\w+ \w+\($)", r"D \1", head)
    head = re.sub(r"(?m)^((?:metal::)?\w+ \w+\()", r"D \1", head)
    head = re.sub(r"(?m)^constant (real|float|uint|int|bool) (\w+ = .*;)$", r"static constexpr \1 \2", head)
    # Constants with constructors, as expressions.
    head = re.sub(r"(?m)^constant \w+ (\w+) = (.*);$", r"#define \1 (\2)", head)
    head = re.sub(r"\b(constant|threadgroup) ", "", head)
    builtin = {
        "group": "metal::uint3(blockIdx.x, blockIdx.y, blockIdx.z)",
        "groups": "metal::uint3(gridDim.x, gridDim.y, gridDim.z)",
        "lane": "threadIdx.x",
    }
    inner, outer, shared, given, constants = [], [], [], [], []
    for parameter in re.split(r"\n, ", parameters):
        parameter = " ".join(parameter.split())
        name = parameter.split()[-1].lstrip("&")
        kind = re.sub(r"\b(constant|threadgroup|const)\b|&", "", parameter[: parameter.rindex(name)]).strip()
        inner.append(f"{kind}{'&' if '&' in parameter else ''} {name}")
        if name in builtin:
            given.append(builtin[name])
        elif parameter.startswith("threadgroup"):
            shared.append(f"__shared__ char {name}_s[sizeof({kind})];")
            given.append(f"*({kind}*){name}_s")
        elif parameter.startswith("constant"):
            constants.append(f"__constant__ char {name}_c[16384];")
            given.append(f"*({kind}*){name}_c")
        else:
            outer.append(f"{kind}* __restrict__ {name}")
            given.append(f"*{name}")
    return "\n".join([
        '#include "metal.h"', head, f"D void inner({', '.join(inner)}) {{{re.sub(r'(threadgroup|constant) ', '', body)}", *constants,
        f'extern "C" __global__ void __launch_bounds__({threads}) main_({", ".join(outer)}) {{',
        *shared, f"inner({', '.join(given)});", "}",
    ])


def compiled(source, name, architecture):
    nvrtc = ctypes.CDLL(str(tool("nvidia/cuda_nvrtc/lib/libnvrtc.so.12")))
    program, size = ctypes.c_void_p(), ctypes.c_size_t()
    header = (HERE / "metal.h").read_text().encode()
    one = lambda text: (ctypes.c_char_p * 1)(text)
    nvrtc.nvrtcCreateProgram(ctypes.byref(program), source.encode(), name.encode(), 1, one(header), one(b"metal.h"))
    # Vulkan's precision: division and square root within a few units in the last place.
    options = [f"--gpu-architecture={architecture}".encode(), b"-default-device", b"--prec-div=false", b"--prec-sqrt=false", b"-w"]
    failed = nvrtc.nvrtcCompileProgram(program, len(options), (ctypes.c_char_p * len(options))(*options))
    if failed:
        nvrtc.nvrtcGetProgramLogSize(program, ctypes.byref(size))
        log = ctypes.create_string_buffer(size.value)
        nvrtc.nvrtcGetProgramLog(program, log)
        sys.exit(f"sass.py: {name}: {log.value.decode()[:2000]}")
    nvrtc.nvrtcGetCUBINSize(program, ctypes.byref(size))
    cubin = ctypes.create_string_buffer(size.value)
    nvrtc.nvrtcGetCUBIN(program, cubin)
    return cubin.raw


KINDS = {
    "arithmetic": {"FFMA", "FADD", "FMUL", "FMNMX", "FSETP", "FSEL"},
    "integer": {"IADD3", "IMAD", "LOP3", "SHF", "ISETP", "LEA", "SEL", "IMNMX", "VIADD", "PLOP3", "PRMT", "VIMNMX"},
    "global": {"LDG", "STG", "ATOMG", "RED"},
    "shared": {"LDS", "STS"},
    "spills": {"LDL", "STL"},
    "barriers": {"BAR"},
}


def counted(cubin, file):
    file.write_bytes(cubin)
    bin_ = "triton/backends/nvidia/bin"
    for name in ("cuobjdump", "nvdisasm"):
        tool(f"{bin_}/{name}").chmod(0o755)
    run = lambda *command: subprocess.run(command, check=True, capture_output=True, text=True).stdout
    usage = run(tool(f"{bin_}/cuobjdump"), "-res-usage", file)
    listing = run(tool(f"{bin_}/nvdisasm"), "-c", file)
    file.with_suffix(".sass").write_text(listing)
    instructions, labels = [], {}
    for line in listing.splitlines():
        if label := re.match(r"\s*(\.L_x_\d+):", line):
            labels[label[1]] = len(instructions)
        elif found := re.search(r"/\*[0-9a-f]{4,5}\*/\s+(.*?);", line):
            instructions.append(found[1])
    loop = range(0)
    for i, text in enumerate(instructions):
        target = re.search(r"BRA.*`\((\.L_x_\d+)\)", text)
        if target and labels.get(target[1], i) < i and i - labels[target[1]] > len(loop):
            loop = range(labels[target[1]], i + 1)
    kinds = collections.Counter()
    for i in loop:
        name = re.sub(r"^@!?U?P\w+ ", "", instructions[i]).split()[0].split(".")[0]
        kinds[next((kind for kind, names in KINDS.items() if name in names), "other")] += 1
    number = lambda name: int(re.search(rf"{name}:(\d+)", usage)[1])
    # The padding behind the last branch is no code.
    real = sum(not text.startswith("NOP") for text in instructions)
    return dict(registers=number("REG"), stack=number("STACK"), shared_memory=number("SHARED"), instructions=real, loop=len(loop), **{k: kinds[k] for k in [*KINDS, "other"]})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kernels", nargs="+", type=pathlib.Path, metavar="WGSL")
    parser.add_argument("--threads", type=int, default=384, help="of the work group that has a small mesh (default: %(default)s)")
    parser.add_argument("--architecture", default="sm_90", help="default: %(default)s, the H100 and H200")
    arguments = parser.parse_args()
    python()
    subprocess.run(["cargo", "build", "--release", "--quiet", "--manifest-path", HERE / "Cargo.toml", "--target-dir", CACHE / "target"], check=True)
    rows = []
    for file in arguments.kernels:
        wgsl = file.read_text()
        threads = arguments.threads if "@workgroup_size(threads)" in wgsl else 64
        metal = subprocess.run([CACHE / "target/release/wgsl-to-msl"], input=with_values(wgsl, threads), capture_output=True, text=True)
        if metal.returncode:
            sys.exit(f"sass.py: {file}: {metal.stderr}")
        out = CACHE / f"{file.parent.name}-{file.stem}.cubin"
        source = cuda(metal.stdout, threads)
        out.with_suffix(".cu").write_text(source)
        rows.append((f"{file.parent.name}/{file.stem}", counted(compiled(source, file.stem, arguments.architecture), out)))
    columns = list(rows[0][1])
    print("| kernel | " + " | ".join(c.replace("_", " ") for c in columns) + " |")
    print("|---|" + "---|" * len(columns))
    for name, row in rows:
        print(f"| {name} | " + " | ".join(str(row[c]) for c in columns) + " |")


if __name__ == "__main__":
    main()
