"""Runs CalculiX, Akantu and hexroll on the same ring on one core, and prints rates and ratios. Started by run.sh."""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import time

import mesh

# OpenRadioss, one thread, reproducible mode (Parith/ON), million element updates a second, and its time step [s]
# (scale 0.9): another day's run on the same kind of machine (2 cores of a server processor with AVX-512, idle).
OPENRADIOSS = {
    "Isolid 17, 8 points, constant pressure": ("q1p0", {880: (0.317, 8.9e-6), 56320: (0.265, 2.11e-6)}),
    "Isolid 24, one point, physical hourglass": ("uniform-gradient", {880: (1.81, 9.6e-6), 56320: (1.39, 2.16e-6)}),
}
# Least ratios asked for on a machine with AVX-512.
ASKED = {"CalculiX": 100, "Akantu": 50}


def main():
    parser = argparse.ArgumentParser(prog="run.sh", description=__doc__)
    parser.add_argument("--cache", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--root", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--sizes", default="880,56320", help="elements, 880 n^3 each")
    parser.add_argument("--core", type=int, default=0, help="processor core that everything runs on")
    parser.add_argument("--only", default="calculix,akantu,hexroll")
    parser.add_argument("--out", type=pathlib.Path, help="folder of the record (default: target/peers)")
    parser.add_argument("--hexroll", type=pathlib.Path, help="program (default: target/release/hexroll)")
    args = parser.parse_args()
    args.out = args.out or args.root / "target/peers"
    args.hexroll = args.hexroll or args.root / "target/release/hexroll"
    args.out.mkdir(parents=True, exist_ok=True)
    sizes = [int(s) for s in args.sizes.split(",")]
    only = args.only.split(",")
    rows = []
    for size in sizes:
        refinement = round((size / 880) ** (1 / 3))
        if 880 * refinement**3 != size:
            parser.error(f"--sizes: {size} is not 880 n^3")
        if "calculix" in only:
            rows += calculix(args, size, refinement)
        if "akantu" in only:
            rows += akantu(args, size, refinement)
    if "hexroll" in only:
        rows += hexroll(args, sizes)
    page = report(rows) + (straight(args) if "hexroll" in only else "")
    (args.out / "peers.json").write_text(json.dumps(rows, indent=1) + "\n")
    (args.out / "peers.md").write_text(page)
    print(page)


def on_core(args, command, **more):
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "CCX_NPROC_RESULTS": "1", **more.pop("env", {})}
    pin = ["taskset", "-c", str(args.core)] if shutil.which("taskset") else []
    return subprocess.run([*pin, *map(str, command)], check=True, text=True, env=environment, **more)


def calculix(args, size, refinement):
    """Two runs of different length: their difference leaves out reading, setting up and writing."""
    own = args.cache / "calculix/usr"
    program = own / "bin/ccx" if (own / "bin/ccx").exists() else shutil.which("ccx")
    if not program:
        print("CalculiX is not there: run.sh --install; left out")
        return []
    libraries = own / "lib/x86_64-linux-gnu"
    env = {"LD_LIBRARY_PATH": ":".join(str(libraries / d) for d in ("", "blas", "lapack"))} if libraries.exists() else {}
    folder = args.out / f"calculix-{size}"
    folder.mkdir(exist_ok=True)
    # About 8.6e-6 s at 880 elements, and inversely to their edge.
    guess = 8.6e-6 / refinement
    counts, seconds = [], []
    for increments in (5, 25) if size > 10_000 else (100, 600):
        mesh.write_calculix(folder / "ring.inp", refinement, increments * guess, guess)
        begun = time.perf_counter()
        done = on_core(args, [program, "ring"], cwd=folder, env=env, capture_output=True)
        seconds.append(time.perf_counter() - begun)
        found = re.search(r"SELECTED time increment:\s*([0-9.eE+-]+)", done.stdout)
        if not found:
            raise SystemExit(f"CalculiX said nothing of its time increment:\n{done.stdout[-2000:]}")
        dt = float(found.group(1))
        # Equal increments to the end; the last is what is left.
        counts.append(-(-increments * guess // dt))
    steps = counts[1] - counts[0]
    rate = size * steps / (seconds[1] - seconds[0])
    element = "C3D8, 8 points"
    return [row("CalculiX", element, "neo-Hooke (*HYPERELASTIC)", size, dt, steps, rate)]


def akantu(args, size, refinement):
    python = args.cache / "akantu/bin/python"
    if not python.exists():
        print("Akantu is not there: run.sh --install; left out")
        return []
    folder = args.out / f"akantu-{size}"
    folder.mkdir(exist_ok=True)
    mesh.write_gmsh(folder / "ring.msh", refinement)
    steps = 25 if size > 10_000 else 400
    script = pathlib.Path(__file__).with_name("akantu_ring.py")
    done = on_core(args, [python, script, folder / "ring.msh", steps, steps, steps], capture_output=True)
    found = json.loads(done.stdout.strip().splitlines()[-1])
    rate = size * steps / min(found["seconds"])
    law = "St. Venant-Kirchhoff (elastic, finite deformation)"
    return [row("Akantu", "_hexahedron_8, 8 points", law, size, found["dt"], steps, rate)]


def hexroll(args, sizes):
    """One thread, no road, as the others; the step is 0.95 of the critical one."""
    if not args.hexroll.exists():
        raise SystemExit(f"{args.hexroll} is not there: cargo build --release")
    record = args.out / "hexroll.json"
    base = ["--elements", "q1p0,uniform-gradient", "--sizes", ",".join(map(str, sizes)), "--json", record]
    table = ["bench", "--parts", "table,steps", "--engines", "cpu-f64,cpu-f32", "--threads", "1"]
    lanes = ["--contact", "off", "--lanes", "portable,best"]
    on_core(args, [args.hexroll, *table, *lanes, *base], stdout=subprocess.DEVNULL)
    report = json.loads(record.read_text())
    steps = {(s["element"], s["elements"]): 0.95 * s["assembled"] for s in report["critical"]["steps"]}
    rows = []
    for r in report["rows"]:
        element = {"q1p0": "q1p0, 8 points", "uniform-gradient": "uniform-gradient, one point"}[r["element"]]
        name = f"hexroll {r['engine']} {r['lanes']}"
        dt = steps[(r["element"], r["elements"])]
        found = row(name, element, "neo-Hooke", r["elements"], dt, r["steps"], r["updates_per_s"])
        rows.append({**found, "formulation": r["element"]})
    return rows


def straight(args):
    """0.1 s of the paper's straight run on one thread against OpenRadioss's about 33 s (Isolid 17)."""
    record = args.out / "straight.json"
    what = ["--parts", "straight", "--engines", "cpu-f64,cpu-f32", "--threads", "1", "--elements", "q1p0,uniform-gradient"]
    on_core(args, [args.hexroll, "bench", *what, "--json", record], stdout=subprocess.DEVNULL)
    text = ["\nThe paper's straight run, 0.1 s of rolling with friction, 880 elements, one thread:\n"]
    text.append("| hexroll | element | seconds | OpenRadioss's 33 s over it |\n|---|---|---|---|")
    for r in json.loads(record.read_text())["straight"]:
        text.append(f"| {r['engine']} | {r['element']} | {r['roll_s']:.3f} | {33 / r['roll_s']:.0f} |")
    return "\n".join(text) + "\n"


def row(code, element, law, elements, dt, steps, rate):
    return {
        "code": code, "element": element, "law": law, "elements": elements,
        "dt_s": dt, "cycles": int(steps), "updates_per_s": rate,
    }


def report(rows):
    text = ["# The ring on one core, one code after the other\n"]
    text.append("Whole steps without a road, rim held (others) or rolling (hexroll), double precision unless f32 is said.\n")
    text.append("| code | element | law | elements | dt [us] | cycles | element updates/s | ms for 1 ms of simulation |")
    text.append("|---|---|---|---|---|---|---|---|")
    for r in rows:
        cost = 1e3 * (1e-3 / r["dt_s"]) * r["elements"] / r["updates_per_s"]
        text.append(
            f"| {r['code']} | {r['element']} | {r['law']} | {r['elements']} | {1e6 * r['dt_s']:.2f} | {r['cycles']} "
            f"| {r['updates_per_s']:.3g} | {cost:.3g} |"
        )
    own = [r for r in rows if r["code"].startswith("hexroll")]
    text.append("\nRatios of element updates a second, and of the time for the same simulated time (longer steps included):\n")
    text.append("| hexroll | against | elements | updates | time to solution | asked for |")
    text.append("|---|---|---|---|---|---|")
    for r in own:
        for other in peers(rows, r):
            updates = r["updates_per_s"] / other["updates_per_s"]
            solution = updates * r["dt_s"] / other["dt_s"]
            asked = ASKED.get(other["code"], "") if r["formulation"] == "q1p0" and "f64" in r["code"] else ""
            text.append(
                f"| {r['code']}, {r['formulation']} | {other['code']} | {r['elements']} | {updates:.0f} | {solution:.0f} | {asked} |"
            )
    text.append("\nOpenRadioss's figures are of another day's run on the same kind of machine (2 cores of a server processor")
    text.append("with AVX-512); against the portable row of this run, which uses two f64 lanes of the baseline")
    text.append("instructions, the ratios travel to other machines.")
    return "\n".join(text) + "\n"


def peers(rows, own):
    """Codes to compare a row with: those run here, and OpenRadioss's element of the same kind."""
    found = [r for r in rows if not r["code"].startswith("hexroll") and r["elements"] == own["elements"]]
    for name, (formulation, figures) in OPENRADIOSS.items():
        if formulation == own["formulation"] and own["elements"] in figures:
            rate, dt = figures[own["elements"]]
            found.append({"code": f"OpenRadioss {name} (recorded)", "updates_per_s": 1e6 * rate, "dt_s": dt})
    return found


main()
