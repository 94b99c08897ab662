#!/usr/bin/env python3
"""Reads a history back with NumPy and, where there is a universal file, with pyuff, and compares the two.

    pip install numpy pyuff
    scripts/read_history.py runs/x/history_tread.npz
"""
import pathlib
import sys

import numpy as np


def universal(path, arrays):
    """Every function of the universal file beside the array that it is of."""
    import pyuff

    datasets = pyuff.UFF(str(path)).read_sets()
    kinds = [d["type"] for d in datasets]
    assert kinds[0] == 2411, "nodes come first"
    nodes = datasets[0]
    x = np.column_stack([nodes["x"], nodes["y"], nodes["z"]])
    assert np.array_equal(x, arrays["reference_position"]), "positions"
    if 2412 in kinds:
        quads = datasets[kinds.index(2412)][94]
        faces = np.array([q["nodes_nums"] for q in quads]) - 1
        assert np.array_equal(faces, arrays["face"]), "faces"
    functions = [d for d in datasets if d["type"] == 58]
    for function in functions:
        name = function["id1"].split()[-1].replace("-", "_")
        place, component = int(function["rsp_node"]) - 1, int(function["rsp_dir"]) - 1
        values = arrays[name][:, place] if component < 0 else arrays[name][:, place, component]
        start = np.searchsorted(arrays["time"], function["x"][0] * (1 - 1e-5))
        part = values[start : start + len(function["data"])]
        assert np.array_equal(np.float32(function["data"]), part), (name, place, component)
        # Five digits of the first time and of the step.
        assert np.allclose(function["x"], arrays["time"][start : start + len(part)], rtol=2e-5, atol=1e-9)
    print(f"{path}: {len(x)} nodes, {len(functions)} functions: the same values")


def main():
    path = pathlib.Path(sys.argv[1])
    arrays = np.load(path)
    for name in arrays.files:
        print(f"{name:20} {arrays[name].dtype!s:8} {arrays[name].shape}")
    time = arrays["time"]
    if len(time) > 1:
        gaps = np.count_nonzero(np.diff(time) > 1.5 / arrays["rate"])
        print(f"{len(time)} times from {time[0]:.6f} to {time[-1]:.6f} s, {gaps} gaps")
    other = path.with_suffix(".uff")
    if other.exists():
        universal(other, arrays)


if __name__ == "__main__":
    main()
