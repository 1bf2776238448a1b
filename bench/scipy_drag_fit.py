#!/usr/bin/env python3
"""Time of SciPy's curve_fit on the flight and samples of bench_drag_fit.cpp.

Prints the parameters, their independent-sample errors and the least of the times, so that the
result can be compared as well as the speed.
"""
import pathlib
import time

import numpy as np
from scipy.optimize import curve_fit

MASS, AIR_DENSITY, GRAVITY, PITCH_OFFSET_DEG = 1.55, 1.225, 9.80665, 0.8


def observations():
    path = pathlib.Path(__file__).parent.parent / "examples" / "simulated-flight.csv"
    log = np.genfromtxt(path, delimiter=",", names=True)
    t = log["time_s"]
    yaw = np.radians(log["yaw_deg"])
    tilt = np.radians(PITCH_OFFSET_DEG - log["pitch_deg"])
    speed = np.cos(yaw) * log["vn_m_s"] + np.sin(yaw) * log["ve_m_s"]
    lift = GRAVITY - np.gradient(log["vd_m_s"], t)
    drag = lift * np.tan(tilt) / np.cos(np.radians(log["roll_deg"])) - np.gradient(speed, t)
    first = np.searchsorted(t, 60)
    used = slice(first, first + 3400)
    return np.cos(tilt[used]), np.abs(np.sin(tilt[used])), speed[used], MASS * drag[used]


def force(x, front, top, linear, wind):
    cosine, sine, speed = x
    u = speed - wind
    return 0.5 * AIR_DENSITY * (front * cosine + top * sine) * (u * np.abs(u) + linear * u)


def main():
    cosine, sine, speed, drag = observations()
    least = float("inf")
    for _ in range(50):
        begin = time.perf_counter()
        values, covariance = curve_fit(force, (cosine, sine, speed), drag, p0=[0.01, 0.01, 10, 0])
        least = min(least, time.perf_counter() - begin)
    print("parameters     ", *(f"{v:.6g}" for v in values))
    print("standard errors", *(f"{e:.6g}" for e in np.sqrt(np.diag(covariance))))
    print(f"curve_fit, 3400 samples: {1e6 * least:.0f} us")


if __name__ == "__main__":
    main()
