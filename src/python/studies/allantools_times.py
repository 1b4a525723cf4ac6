"""CPU time of octave deviations from one array, here and by allantools, in one process.

    python src/python/studies/allantools_times.py [SAMPLES]

allantools' ``oadev`` overlaps fully, and allanite by a quarter of a cluster. So there are two comparisons: the deviations at all
octaves as each program defines them, and those of one definition. A fully overlapping deviation at 4 of means over blocks of m/4
samples is the quarter-overlapping one at m.
"""

import json
import sys
import time

import allantools
import numpy as np

import allanite


def cpu(work):
    """What work returns, and the CPU time of this process that it took, all threads together: the least of three."""
    times = []
    for _ in range(3):
        begun = time.process_time()
        result = work()
        times.append(time.process_time() - begun)
    return result, min(times)


def octaves(n):
    """The averaging factors at which allanite has at least six differences."""
    return [1 << k for k in range(30) if (n // max(1, (1 << k) // 4)) - (1 if k == 0 else 3 if k == 1 else 7) >= 6]


def quarter_overlapping(x, rate):
    """allantools' deviations by the definition of allanite."""
    found = {}
    for m in octaves(len(x)):
        h = max(1, m // 4)
        means = x[: len(x) // h * h].reshape(-1, h).mean(axis=1)
        taus, deviations, _, _ = allantools.oadev(means, rate=rate / h, data_type="freq", taus=[m / rate])
        found[m] = deviations[0]
    return found


def compared(x, rate):
    """The largest relative difference of the deviations by one definition, and the CPU times in s."""
    ours, own_s = cpu(lambda: allanite.deviations(x, rate=rate))
    (ours,) = ours.values()
    _, octave_s = cpu(lambda: allantools.oadev(x, rate=rate, data_type="freq", taus="octave"))
    theirs, quarter_s = cpu(lambda: quarter_overlapping(x, rate))
    assert [one.m for one in ours] == list(theirs)
    difference = max(abs(one.deviation / theirs[one.m] - 1) for one in ours)
    return {
        "type": str(x.dtype),
        "samples": len(x),
        "octaves": len(ours),
        "difference": difference,
        "allanite_s": own_s,
        "allantools_octaves_s": octave_s,
        "allantools_quarter_s": quarter_s,
        "ratio_octaves": octave_s / own_s,
        "ratio_quarter": quarter_s / own_s,
        "allanite_ns_a_sample": own_s / len(x) * 1e9,
    }


def main():
    n = int(float(sys.argv[1])) if len(sys.argv) > 1 else 10_000_000
    rng = np.random.default_rng(1)
    counts = (rng.normal(0, 100, n) + np.cumsum(rng.normal(0, 0.1, n))).round().astype("i4")
    for x in (counts, counts * 0.01):
        print(json.dumps(compared(x, 100.0)))


if __name__ == "__main__":
    main()
