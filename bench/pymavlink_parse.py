#!/usr/bin/env python3
"""Times the EKF columns of a DataFlash log in Python, to set beside bench_dataflash.

    bench/pymavlink_parse.py LOG.bin

With pymavlink installed, its reader is timed: every message parsed, XKF1 of core 0 kept, as its
users do it. A reader written with the standard library's struct module alone is always timed; it
decodes nothing but the wanted messages, so it is the faster of the two and the harder peer.
"""
import struct
import sys
import time

SIZES = dict(a="64s", b="b", B="B", h="h", H="H", i="i", I="I", f="f", d="d", n="4s", N="16s",
             Z="64s", c="h", C="H", e="i", E="I", L="i", M="B", q="q", Q="Q", g="e")
FIELDS = ["TimeUS", "Roll", "Pitch", "Yaw", "VN", "VE", "VD"]
HUNDREDTHS = "cCeE"


def columns_with_struct(data):
    length = {128: 89}
    wanted = {}
    columns = [[] for _ in FIELDS]
    at, end = 0, len(data)
    while at + 3 <= end:
        if data[at] != 0xA3 or data[at + 1] != 0x95 or data[at + 2] not in length:
            at += 1
            continue
        kind = data[at + 2]
        size = length[kind]
        if at + size > end:
            break
        if kind == 128:
            number, its_size, name, form, labels = struct.unpack_from("<BB4s16s64s", data, at + 3)
            length[number] = its_size
            if name.rstrip(b"\0") == b"XKF1":
                form = form.rstrip(b"\0").decode()
                labels = labels.rstrip(b"\0").decode().split(",")
                places = [labels.index(field) for field in FIELDS]
                wanted[number] = (struct.Struct("<" + "".join(SIZES[c] for c in form)),
                                  labels.index("C") if "C" in labels else None,
                                  [(p, 100 if form[p] in HUNDREDTHS else 1) for p in places])
        elif kind in wanted:
            layout, core, places = wanted[kind]
            values = layout.unpack_from(data, at + 3)
            if core is None or values[core] == 0:
                for column, (place, divisor) in zip(columns, places):
                    column.append(values[place] / divisor)
        at += size
    return columns


def columns_with_pymavlink(path):
    from pymavlink import mavutil

    columns = [[] for _ in FIELDS]
    log = mavutil.mavlink_connection(path)
    while (message := log.recv_match(type="XKF1")) is not None:
        if getattr(message, "C", 0) == 0:
            for column, field in zip(columns, FIELDS):
                column.append(getattr(message, field))
    return columns


def report(name, size, read):
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        columns = read()
        best = min(best, time.perf_counter() - start)
    print(f"{name}: {len(columns[0])} samples, {best:.3f} s, {size / best / 1e6:.2f} MB/s")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = sys.argv[1]
    with open(path, "rb") as file:
        data = file.read()
    report("struct", len(data), lambda: columns_with_struct(data))
    try:
        import pymavlink  # noqa: F401
    except ImportError:
        print("pymavlink: not installed, not timed")
        return
    report("pymavlink", len(data), lambda: columns_with_pymavlink(path))


if __name__ == "__main__":
    main()
