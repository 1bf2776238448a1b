"""Memory stays the same however often something is computed."""

import gc
import os
import unittest

import tethercalc
from support import PUBLISHED

CALLS = 1_000_000


def resident() -> int:
    """Bytes of this process in memory now."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Memory(unittest.TestCase):
    def grown(self, calls: int, call) -> int:
        for i in range(calls // 10):
            call(i)
        gc.collect()
        before = resident()
        for i in range(calls):
            call(i)
        gc.collect()
        return resident() - before

    def test_it_is_steady_over_many_optima_and_errors(self):
        design = tethercalc.load(PUBLISHED)

        def optimum(i):
            design["drone.mass_g"] = 1500 + i % 400
            found = tethercalc.optimize(design)
            return found.cross_section_mm2, found.forward.total_power_W

        def error(i):
            try:
                design["drone.mass_g"] = -i - 1
            except tethercalc.InputError:
                pass

        # No allocation is smaller than 16 bytes: one left behind every tenth call would be seen.
        self.assertLess(self.grown(CALLS, optimum), 2**20)
        self.assertLess(self.grown(CALLS // 10, error), 2**20)

    def test_it_is_steady_over_sweeps_and_answers(self):
        def sweep(_):
            return tethercalc.sweep(PUBLISHED, {"drone.mass_g": "1500:1900:1"}).array[-1]

        def answer(_):
            told = tethercalc.optimize(PUBLISHED)
            return told.to_dict(), str(told), told._repr_html_()

        self.assertLess(self.grown(200, sweep), 2**22)  # 200 arrays would be 40 MB
        self.assertLess(self.grown(50, answer), 2**22)  # 50 pages more than 10 MB


if __name__ == "__main__":
    unittest.main()
