"""Sweeps as arrays: the command's rows, the same memory, and Ctrl-C."""

import csv
import io
import math
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np
import tethercalc
from support import PUBLISHED, command

VARY = {
    "supply.voltage_V": "30:100:5",
    "tether.conductor": ["aluminium", "copper"],
    "tether.length_m": [10, 30, 100],
}
OPTIONS = [
    "--vary", "supply.voltage_V=30:100:5",
    "--vary", "tether.conductor=aluminium,copper",
    "--vary", "tether.length_m=10,30,100",
]


class Sweeps(unittest.TestCase):
    def test_the_rows_are_the_commands_byte_for_byte(self):
        sweep = tethercalc.sweep(PUBLISHED, VARY)
        expected = command("sweep", PUBLISHED, *OPTIONS)
        self.assertEqual(sweep.to_csv(), expected)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "rows.csv"
            sweep.to_csv(file)
            self.assertEqual(file.read_bytes(), expected.encode())

    def test_the_array_holds_what_the_rows_say(self):
        sweep = tethercalc.sweep(PUBLISHED, VARY)
        rows = list(csv.DictReader(io.StringIO(command("sweep", PUBLISHED, *OPTIONS))))
        self.assertEqual(len(sweep), len(rows))
        names = sweep.array.dtype.names
        self.assertEqual([*names, "reason"], list(rows[0]))
        self.assertEqual({row["status"] for row in rows}, {"optimal", "infeasible"})
        for record, row in zip(sweep.array, rows):
            for name in names:
                if sweep.array.dtype[name].kind == "U":
                    self.assertEqual(str(record[name]), row[name], name)
                elif row[name] == "":
                    self.assertTrue(math.isnan(record[name]), name)
                else:
                    self.assertEqual(float(record[name]), float(row[name]), name)

    def test_the_array_shows_the_memory_it_was_computed_into(self):
        sweep = tethercalc.sweep(PUBLISHED, VARY)
        array = sweep.array
        self.assertFalse(array.flags.owndata)
        self.assertTrue(np.shares_memory(array, np.asarray(sweep)))
        self.assertTrue(np.shares_memory(array, sweep["forward.total_power_W"]))
        kept = array["forward.total_power_W"]
        expected = kept.copy()
        del sweep, array
        np.testing.assert_array_equal(kept, expected)

    def test_a_sample_is_the_commands_and_has_a_summary(self):
        sweep = tethercalc.sweep(
            PUBLISHED, {"supply.voltage_V": "75~1.5"}, sample=200, method="lhs", seed=3
        )
        words = ["--vary", "supply.voltage_V=75~1.5", "--sample", 200, "--method", "lhs", "--seed", 3]
        self.assertEqual(sweep.to_csv(), command("sweep", PUBLISHED, *words))
        self.assertEqual(sweep.summary["draws"], 200)
        self.assertIsNone(tethercalc.sweep(PUBLISHED, "supply.voltage_V=75").summary)

    def test_a_bad_axis_is_refused_with_every_problem(self):
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.sweep(PUBLISHED, ["supply.voltge_V=40,50", "drone.mass_g=-1"])
        self.assertEqual(len(caught.exception.problems), 2)
        self.assertIn("supply.voltage_V", str(caught.exception))

    def test_other_threads_run_while_it_computes(self):
        ticks = []
        done = threading.Event()

        def count():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        began = time.monotonic()
        tethercalc.sweep(PUBLISHED, {"drone.mass_g": "1000:2000:0.02"}, jobs=1)
        ended = time.monotonic()
        done.set()
        counter.join()
        within = sum(began < tick < ended for tick in ticks)
        self.assertGreater(within, 3)

    def test_ctrl_c_ends_a_sweep_and_a_search(self):
        def sweep():
            tethercalc.sweep(PUBLISHED, {"drone.mass_g": "1000:2000:0.0001"})

        def search():
            tethercalc.design(
                PUBLISHED,
                {"supply.voltage_V": "40..400", "drone.motor": "all", "tether.conductor": "all",
                 "tether.insulation.thickness_mm": "0.2..2"},
                pareto=["total_power_W", "tether_mass_g"],
            )

        # A job in the background of a shell begins with the signal ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        for work in (sweep, search):
            with self.subTest(work.__name__):
                timer = threading.Timer(0.15, os.kill, (os.getpid(), signal.SIGINT))
                timer.start()
                began = time.monotonic()
                with self.assertRaises(KeyboardInterrupt):
                    work()
                self.assertLess(time.monotonic() - began, 2)
                timer.join()


if __name__ == "__main__":
    unittest.main()
