"""What a loop in Python over 10 000 designs costs beside the optimum itself, in µs a design.

PYTHONPATH=build/release/python /usr/bin/python3 bench/python_loop.py SPEC

The optimum itself is measured by a sweep on one thread over the same designs, which has no Python in it
but writes a record a design and makes the design's change."""

import statistics
import sys
import time

import tethercalc

DESIGNS = 10_000


def loop(design):
    total = 0.0
    for i in range(DESIGNS):
        design["drone.mass_g"] = 1500 + 0.04 * i
        found = tethercalc.optimize(design)
        if found.feasible:
            total += found.cross_section_mm2 + found.forward.total_power_W
    return total


def bare(design):
    axis = {"drone.mass_g": f"1500:{1500 + 0.04 * (DESIGNS - 1)}:0.04"}
    array = tethercalc.sweep(design, axis, jobs=1).array
    assert len(array) == DESIGNS
    return array["cross_section_mm2"].sum() + array["forward.total_power_W"].sum()


def seconds(work, design):
    began = time.perf_counter()
    result = work(design)
    return time.perf_counter() - began, result


design = tethercalc.load(sys.argv[1])
assert abs(loop(design) - bare(design)) < 1e-6 * bare(design)
loops = [seconds(loop, design)[0] for _ in range(15)]
bares = [seconds(bare, design)[0] for _ in range(15)]
looped, alone = (1e6 * min(times) / DESIGNS for times in (loops, bares))
print(f"loop {looped:.2f} µs a design (median {1e6 * statistics.median(loops) / DESIGNS:.2f}), "
      f"sweep {alone:.2f} µs, beside the optimum {looped - alone:.2f} µs")
sys.exit(looped - alone > 5)
