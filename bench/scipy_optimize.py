#!/usr/bin/python3
"""The optimum of one design after another with SciPy: what the C++ library is compared with.

Does the whole job of `optimize` for the published drone: the feasible set for the headroom by
bracketing every change of sign on a grid, the least power by bounded search around the best of the
same grid (200 areas over four decades, 5 % apart, finer than the motor curve's points, at each of
which the power has a kink), the optimum, and the operating points in hover and forward flight.
Written the way one would with NumPy and SciPy at hand: what needs no tilt is an array operation, the
rest are SciPy's solvers.

Prints one line: mean microseconds a design, and the last design's area in mm² and powers in W.
"""

import argparse
import math
import time

import numpy as np
from scipy.optimize import brentq, minimize_scalar

G0 = 9.80665
# Holybro AIR2216 920KV with a 10" propeller: thrust in gram-force, efficiency in gram-force/W.
THRUST_G = np.array([0, 210, 259, 309, 373, 447, 536, 628, 729, 814, 906, 993, 1087, 1191, 1289, 1332.0])
EFFICIENCY = np.array([1, 9.12, 8.67, 8.45, 8.15, 7.76, 7.39, 7.01, 6.73, 6.44, 6.18, 5.88, 5.65, 5.43,
                       5.18, 5.13])
THRUST = THRUST_G * 1e-3 * G0
POWER = THRUST_G / EFFICIENCY

VOLTAGE, CUT_OFF, EFFICIENCY_CONVERTER, AUXILIARY = 75.0, 20.0, 0.9, 15.0
LENGTH, RESISTIVITY, DENSITY = 30.0, 0.0278e-6, 2700.0
WALL, DENSITY_INSULATION = 0.75e-3, 1360.0
FRONT, TOP, LINEAR = 0.01451, 0.01361, 19.27
AIR, AIRSPEED, MOTORS, HEADROOM = 1.293, 30 / 3.6, 4, 2.0


def tether(area):
    radius = np.sqrt(area / math.pi)
    mass = 2 * LENGTH * (DENSITY * area
                         + DENSITY_INSULATION * math.pi * ((radius + WALL) ** 2 - radius**2))
    return 2 * LENGTH * RESISTIVITY / area, mass, radius


def pitch(mass, radius, speed):
    if speed == 0:
        return 0.0
    tether_drag = 0.5 * AIR * 0.75 * 4 * LENGTH * (radius + WALL) * speed**2

    def unbalanced(theta):
        drag = 0.5 * AIR * (FRONT * math.cos(theta) + TOP * math.sin(theta))
        drag *= speed**2 + LINEAR * speed
        return mass * G0 * math.tan(theta) - drag - tether_drag

    return brentq(unbalanced, 0, 1.5, xtol=1e-13)


def necessary_thrust(drone_mass, area, speed):
    _, tether_mass, radius = tether(area)
    mass = drone_mass + tether_mass
    return mass * G0 / (MOTORS * math.cos(pitch(mass, radius, speed)))


def available_thrust(area):
    resistance, _, _ = tether(area)
    lowest = max(CUT_OFF, VOLTAGE / 2)
    motors_input = (lowest * (VOLTAGE - lowest) / resistance - AUXILIARY) * EFFICIENCY_CONVERTER
    return np.interp(motors_input / MOTORS, POWER, THRUST)


def total_power(drone_mass, area, speed):
    thrust = necessary_thrust(drone_mass, area, speed)
    if thrust > THRUST[-1]:
        return math.inf
    load = MOTORS * np.interp(thrust, THRUST, POWER) / EFFICIENCY_CONVERTER + AUXILIARY
    resistance, _, _ = tether(area)
    discriminant = VOLTAGE**2 - 4 * resistance * load
    if discriminant < 0:
        return math.inf
    return VOLTAGE * (VOLTAGE - math.sqrt(discriminant)) / (2 * resistance)


def headroom_margin(drone_mass, area):
    """In hover, where no tilt is needed, so that it takes whole arrays."""
    _, tether_mass, _ = tether(area)
    return available_thrust(area) - HEADROOM * (drone_mass + tether_mass) * G0 / MOTORS


def feasible_set(drone_mass, grid):
    margins = headroom_margin(drone_mass, grid)
    edges = [brentq(lambda a: headroom_margin(drone_mass, a), grid[i], grid[i + 1], xtol=1e-20,
                    rtol=1e-13)
             for i in np.nonzero(np.sign(margins[:-1]) != np.sign(margins[1:]))[0]]
    if margins[0] >= 0:
        edges.insert(0, grid[0])
    if margins[-1] >= 0:
        edges.append(grid[-1])
    return list(zip(edges[::2], edges[1::2]))


def minimum_power(drone_mass, grid, speed):
    powers = [total_power(drone_mass, area, speed) for area in grid]
    best = int(np.argmin(powers))
    lo, hi = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    found = minimize_scalar(lambda a: total_power(drone_mass, a, speed), bounds=(lo, hi),
                            method="bounded", options={"xatol": 1e-14})
    return found.x


def operating_point(drone_mass, area, speed):
    thrust = necessary_thrust(drone_mass, area, speed)
    return thrust, available_thrust(area) / thrust, total_power(drone_mass, area, speed)


def optimize(drone_mass):
    areas = np.geomspace(1e-8, 1e-4, 200)
    feasible = feasible_set(drone_mass, areas)
    least = minimum_power(drone_mass, areas, AIRSPEED)
    if not feasible:
        return math.nan, None, None
    candidates = [min(max(least, lo), hi) for lo, hi in feasible]
    area = min(candidates, key=lambda a: total_power(drone_mass, a, AIRSPEED))
    return area, operating_point(drone_mass, area, 0), operating_point(drone_mass, area, AIRSPEED)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--designs", type=int, default=50)
    count = parser.parse_args().designs
    optimize(1.710)
    start = time.process_time()
    for i in range(count):
        area, _, _ = optimize(1.5 + 0.4 * i / count)
    mean = (time.process_time() - start) / count * 1e6
    area, hover, forward = optimize(1.710)
    print(f"{mean:.1f} us/design  {area * 1e6:.4f} mm2  {hover[2]:.1f} W hover  "
          f"{forward[2]:.1f} W forward")


if __name__ == "__main__":
    main()
