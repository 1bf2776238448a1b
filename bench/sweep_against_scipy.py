#!/usr/bin/env python3
"""sweep_against_scipy.py COMMAND SPEC: designs a second of `tethercalc sweep`, its memory, and how it
compares with SciPy doing the same job.

Both sides do the same job: for each design the set of cross-sections that leave the headroom, the
least power, the optimum, its operating points in hover and forward flight, and a row of CSV. The SciPy
side is the method of Beffert and Zell (2025) as one would script it: a grid of 200 areas over four
decades, brentq at each change of sign of the headroom's margin and for the tilt, bounded minimisation
around the grid's least power. Both sides must agree on every optimum before any time counts.
Rates a processor second hold on a busy machine too; those by the clock on the wall do not.
"""

import csv
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.optimize import brentq, minimize_scalar

command, spec_path = sys.argv[1:3]
GRAVITY = 9.80665
GRAM_FORCE = 1e-3 * GRAVITY


DATA = pathlib.Path(__file__).resolve().parent.parent / "data"


def library(kind, name):
    return json.loads((DATA / kind / f"{name}.json").read_text())


class Scripted:
    """The paper's design calculation for one spec."""

    def __init__(self, spec, motor):
        self.spec = spec
        points = np.array([[p["thrust_g"] * GRAM_FORCE, p["thrust_g"] / p["efficiency_g_per_W"]]
                           for p in motor["points"]])
        self.thrusts = np.concatenate([[0.0], points[:, 0]])
        self.powers = np.concatenate([[0.0], points[:, 1]])
        self.conductor = library("conductors", spec["tether"]["conductor"])
        self.insulation = library("insulation", spec["tether"]["insulation"]["material"])

    def necessary_thrust(self, area, speed):
        drone, tether = self.spec["drone"], self.spec["tether"]
        length, sheath = tether["length_m"], tether["insulation"]["thickness_mm"] * 1e-3
        radius = math.sqrt(area / math.pi)
        sheath_area = math.pi * ((radius + sheath) ** 2 - radius**2)
        mass = 2 * length * (self.conductor["density_g_cm3"] * 1e3 * area
                             + self.insulation["density_g_cm3"] * 1e3 * sheath_area)
        weight = (drone["mass_g"] * 1e-3 + mass) * GRAVITY
        density, drag = self.spec["flight"]["air_density_kg_m3"], drone["drag"]
        tether_drag = (0.5 * density * tether["drag_coefficient"] * tether["projection_factor"]
                       * 4 * length * (radius + sheath) * speed**2)
        pressure = 0.5 * density * (speed**2 + drag["linear_m_s"] * speed)

        def imbalance(angle):
            drone_drag = pressure * (drag["front_area_m2"] * math.cos(angle)
                                     + drag["top_area_m2"] * math.sin(angle))
            return weight * math.tan(angle) - drone_drag - tether_drag

        angle = 0.0 if speed == 0 else brentq(imbalance, 0, math.radians(60), xtol=1e-14)
        return weight / (drone["motor_count"] * math.cos(angle))

    def resistance(self, area):
        return (2 * self.spec["tether"]["length_m"]
                * self.conductor["resistivity_20C_ohm_mm2_per_m"] * 1e-6 / area)

    def hover_margin(self, area):
        """Available less required thrust, for one area or an array of them: no tilt is needed."""
        drone, tether, supply = self.spec["drone"], self.spec["tether"], self.spec["supply"]
        sheath = tether["insulation"]["thickness_mm"] * 1e-3
        radius = np.sqrt(area / math.pi)
        mass = drone["mass_g"] * 1e-3 + 2 * tether["length_m"] * (
            self.conductor["density_g_cm3"] * 1e3 * area
            + self.insulation["density_g_cm3"] * 1e3 * math.pi * ((radius + sheath) ** 2 - radius**2))
        voltage = supply["voltage_V"]
        received = max(supply["converter"]["min_input_voltage_V"], voltage / 2)
        power = ((received * (voltage - received) / self.resistance(area)
                  - drone["auxiliary_power_W"]) * supply["converter"]["efficiency"]
                 / drone["motor_count"])
        return (np.interp(power, self.powers, self.thrusts)
                - self.spec["requirements"]["thrust_headroom"] * mass * GRAVITY / drone["motor_count"])

    def headroom(self, area, speed):
        drone, supply = self.spec["drone"], self.spec["supply"]
        voltage = supply["voltage_V"]
        received = max(supply["converter"]["min_input_voltage_V"], voltage / 2)
        available = received * (voltage - received) / self.resistance(area)
        power = ((available - drone["auxiliary_power_W"]) * supply["converter"]["efficiency"]
                 / drone["motor_count"])
        return np.interp(power, self.powers, self.thrusts) / self.necessary_thrust(area, speed)

    def total_power(self, area, speed=None):
        drone, supply = self.spec["drone"], self.spec["supply"]
        thrust = self.necessary_thrust(
            area, self.spec["flight"]["airspeed_m_s"] if speed is None else speed)
        if thrust > self.thrusts[-1]:
            return math.inf
        load = (drone["motor_count"] * np.interp(thrust, self.thrusts, self.powers)
                / supply["converter"]["efficiency"] + drone["auxiliary_power_W"])
        discriminant = 1 - 4 * self.resistance(area) * load / supply["voltage_V"] ** 2
        return 2 * load / (1 + math.sqrt(discriminant)) if discriminant >= 0 else math.inf

    def feasible_set(self, areas):
        margins = self.hover_margin(areas)
        edges = [brentq(self.hover_margin, areas[i], areas[i + 1], xtol=1e-20, rtol=1e-13)
                 for i in np.nonzero(np.sign(margins[:-1]) != np.sign(margins[1:]))[0]]
        if margins[0] >= 0:
            edges.insert(0, areas[0])
        if margins[-1] >= 0:
            edges.append(areas[-1])
        return list(zip(edges[::2], edges[1::2]))

    def least_power(self, areas):
        best = int(np.argmin([self.total_power(area) for area in areas]))
        return minimize_scalar(self.total_power, method="bounded", options={"xatol": 1e-14},
                               bounds=(areas[max(best - 1, 0)], areas[min(best + 1, len(areas) - 1)])).x

    def optimum(self):
        areas = np.geomspace(1e-8, 1e-4, 200)
        least = self.least_power(areas)
        candidates = [min(max(least, lo), hi) for lo, hi in self.feasible_set(areas)]
        return min(candidates, key=self.total_power)

    def row(self, area):
        values = [area * 1e6]
        for speed in (0, self.spec["flight"]["airspeed_m_s"]):
            thrust = self.necessary_thrust(area, speed)
            resistance, power = self.resistance(area), self.total_power(area, speed)
            current = power / self.spec["supply"]["voltage_V"]
            values += [resistance, thrust / GRAM_FORCE, self.headroom(area, speed), power, current,
                       current**2 * resistance, power / current - current * resistance]
        return values


class Run:
    """A sweep's wall-clock time, processor time and peak memory."""

    def __init__(self, vary, jobs, output=os.devnull):
        arguments = [command, "sweep", spec_path, "--jobs", str(jobs), "--output", output]
        for axis in vary:
            arguments += ["--vary", axis]
        began = time.perf_counter()
        process = subprocess.Popen(arguments)
        self.memory_MiB = 0.0
        while process.poll() is None:
            # Not ru_maxrss: a child's begins with the memory of Python, from which it is forked.
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            if f"Name:\t{os.path.basename(command)}" in status and "VmHWM:" in status:
                self.memory_MiB = int(status.split("VmHWM:")[1].split()[0]) / 1024
            time.sleep(0.001)
        self.seconds = time.perf_counter() - began
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.processor_seconds = usage.ru_utime + usage.ru_stime - Run.earlier
        Run.earlier += self.processor_seconds
        assert process.returncode == 0

    earlier = 0.0

    def told(self, what, designs):
        print(f"{what:38} {designs / self.seconds:9.0f} designs/s,"
              f" {designs / self.processor_seconds:9.0f} a processor second,"
              f" {self.memory_MiB:5.1f} MiB")
        return designs / self.seconds, designs / self.processor_seconds


def main():
    spec = json.load(open(spec_path))
    voltages, lengths = (70, 85, 1), (15, 30, 1)
    vary = ["supply.voltage_V=%d:%d:%d" % voltages, "tether.length_m=%d:%d:%d" % lengths]
    designs = (voltages[1] - voltages[0] + 1) * (lengths[1] - lengths[0] + 1)

    scripted = Scripted(spec, library("motors", spec["drone"]["motor"]))
    began, processor_began = time.perf_counter(), time.process_time()
    optima = []
    written = csv.writer(open(os.devnull, "w"))
    for voltage in range(voltages[0], voltages[1] + 1):
        for length in range(lengths[0], lengths[1] + 1):
            spec["supply"]["voltage_V"], spec["tether"]["length_m"] = voltage, length
            area = scripted.optimum()
            written.writerow([voltage, length, *scripted.row(area)])
            optima.append(area * 1e6)
    scipy_rate = designs / (time.perf_counter() - began)
    scipy_processor_rate = designs / (time.process_time() - processor_began)

    with tempfile.TemporaryDirectory() as folder:
        rows = os.path.join(folder, "rows.csv")
        Run(vary, 1, rows)
        areas = [float(row["cross_section_mm2"]) for row in csv.DictReader(open(rows))]
    worst = max(abs(a / b - 1) for a, b in zip(areas, optima, strict=True))
    print(f"{designs} designs: largest difference of an optimum {worst:.1e}")
    assert worst < 1e-4, "the two sides do not solve the same problem"
    print(f"{'SciPy':38} {scipy_rate:9.0f} designs/s, {scipy_processor_rate:9.0f} a processor second")

    few = ["supply.voltage_V=70:99.9:0.3", "tether.length_m=15:29.85:0.15"]  # 100 × 100
    many = ["supply.voltage_V=70:99.97:0.03", "tether.length_m=15:29.985:0.015"]  # 1000 × 1000
    most = ["supply.voltage_V=70:99.99:0.01", "tether.length_m=15:29.9955:0.0045"]  # 3000 × 3333
    Run(few, 2).told("CSV of 1e4 designs, 2 threads", 1e4)
    one = Run(many, 1).told("CSV of 1e6 designs, 1 thread", 1e6)
    two = Run(many, 2).told("CSV of 1e6 designs, 2 threads", 1e6)
    Run(most, 2).told("CSV of 1e7 designs, 2 threads", 3000 * 3333)
    print(f"scaling from 1 to 2 threads: {two[0] / one[0]:.2f}; times SciPy: {two[0] / scipy_rate:.0f},"
          f" a processor second {two[1] / scipy_processor_rate:.0f}")


main()
