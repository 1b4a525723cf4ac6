"""Memory that a record of a large array takes: the peak of resident memory before and after.

    python src/python/studies/memory.py [BYTES] [FILE]

The array has BYTES (2e9 unless given) of floats. With FILE it is a ``numpy.memmap`` of that file, of which only pages that the
system keeps are resident; its private memory (``RssAnon``) tells what is the program's own.
"""

import json
import sys

import numpy as np

import allanite


def resident():
    """Resident memory in MB: private, and the peak of all."""
    with open("/proc/self/status", encoding="ascii") as file:
        lines = dict(line.split(":", 1) for line in file)
    return {name: int(lines[name].split()[0]) / 1024 for name in ("RssAnon", "VmHWM")}


def main():
    size = int(float(sys.argv[1])) if len(sys.argv) > 1 else 2_000_000_000
    rows = size // 8
    rng = np.random.default_rng(1)
    if len(sys.argv) > 2:
        array = np.memmap(sys.argv[2], dtype="f8", mode="w+", shape=(rows,))
    else:
        array = np.empty(rows)
    for first in range(0, rows, 1 << 20):
        part = array[first : first + (1 << 20)]
        part[:] = rng.normal(0, 1, len(part))
    # What the package itself takes is loaded before.
    allanite.Record.from_numpy(rng.normal(0, 1, 10_000), rate=100, unit="deg/s")
    before = resident()
    record = allanite.Record.from_numpy(array, rate=100, unit="deg/s")
    after = resident()
    print(
        json.dumps(
            {
                "bytes": array.nbytes,
                "samples": record.samples,
                "private_mb": round(after["RssAnon"] - before["RssAnon"], 1),
                "peak_mb": round(after["VmHWM"] - before["VmHWM"], 1),
            }
        )
    )


if __name__ == "__main__":
    main()
