"""Runs one Python package on records for the study `peers`: peer.py PEER TASK RATE SCALE FILE...

A line of JSON is printed for each file, and one for the process at the end. The records are arrays of 32-bit counts.
Tasks:
  octaves  deviations at octaves, by the package's own definition
  same     deviations at octaves by the definition of the library. A fully overlapping deviation at m = 4 of means over
           blocks of m/4 samples is the quarter-overlapping one at m; m = 1, 2 and 4 need no blocks.
  fit      the coefficients N, B and K, and what the package says
"""

import contextlib
import io
import json
import os
import sys
import time
import warnings

import numpy as np


def octaves(n):
    """The averaging factors with a difference."""
    return [1 << k for k in range(64) if 2 << k <= n]


def blocks(counts, m):
    """Means over a quarter of a cluster, and the averaging factor that remains."""
    h = max(1, m // 4)
    whole = len(counts) // h * h
    return counts[:whole].reshape(-1, h).mean(axis=1), m // h


def rows(ms, deviations):
    # Without a difference, some packages return NaN.
    return [[int(m), float(d)] for m, d in zip(ms, deviations) if np.isfinite(d)]


class Allantools:
    """allantools: deviations, and the exponent of the noise."""

    overlap = True

    def octaves(self, counts):
        import allantools

        function = allantools.oadev if self.overlap else allantools.adev
        taus, deviations, _, _ = function(counts, rate=1.0, data_type="freq", taus="octave")
        return rows(taus, deviations)

    def same(self, counts):
        import allantools

        found = []
        for m in octaves(len(counts)):
            if self.overlap:
                means, left = blocks(counts, m)
                deviation = allantools.oadev(means, rate=1.0, data_type="freq", taus=[left])[1]
            else:
                deviation = allantools.adev(counts, rate=1.0, data_type="freq", taus=[m])[1]
            if len(deviation):
                found.append([m, float(deviation[0])])
        return found

    def fit(self, rates, _rate):
        import allantools

        # The exponent of the density of frequency at one sample: 0 is white noise, -1 flicker, -2 a random walk.
        alpha = allantools.autocorr_noise_id(rates, af=1, data_type="freq")[0]
        return {"notes": [f"noise of the exponent {alpha}"]}


class AllantoolsAdev(Allantools):
    overlap = False


class AllanVariance:
    """allan-variance: deviations and a weighted fit of the five terms."""

    def octaves(self, counts):
        import allan_variance

        k = len(octaves(len(counts))) - 1
        taus, variances = allan_variance.compute_avar(counts, 1.0, 1.0, float(1 << k), k + 1)
        return rows(taus, np.sqrt(variances))

    def same(self, counts):
        import allan_variance

        found = []
        for m in octaves(len(counts)):
            means, left = blocks(counts, m)
            # The sums are handed over, because means lose their first difference.
            sums = np.concatenate([[0.0], np.cumsum(means)])
            _, variances = allan_variance.compute_avar(
                sums, 1.0, float(left), float(left), 1, input_type="integral"
            )
            found.append([m, float(np.sqrt(variances[0]))])
        return found

    def fit(self, rates, rate):
        import allan_variance

        taus, variances = allan_variance.compute_avar(rates, 1.0 / rate)
        found, _ = allan_variance.estimate_parameters(taus, variances)
        names = {"Q": "quantization", "N": "white", "B": "flicker", "K": "walk", "R": "ramp"}
        return {symbol: float(found[name]) for symbol, name in names.items()}


class Avar:
    """avar: deviations. Its fit is drawn by hand on a figure."""

    def octaves(self, counts):
        import avar

        ms = np.array(octaves(len(counts)))
        return rows(ms, np.sqrt(avar.variance(counts, ms)))

    def same(self, counts):
        import avar

        found = []
        for m in octaves(len(counts)):
            means, left = blocks(counts, m)
            found.append([m, float(np.sqrt(avar.variance(means, np.array([left]))[0]))])
        return found


class AllanVarianceAnalyzer:
    """allan-variance-analyzer, a port of allan_variance_ros: deviations without overlap, and lines through them.

    It takes six columns, whose like the record is.
    """

    def octaves(self, counts):
        from allan_variance_analyzer.statistics import compute_allan_variances

        ms = octaves(len(counts))
        six = np.repeat(counts[:, None], 6, axis=1)
        variances = compute_allan_variances(six, np.array(ms), measure_rate=1.0, overlap=0)
        return rows(ms, np.sqrt(variances[:, 3]))

    same = octaves

    def fit(self, rates, rate):
        from allan_variance_analyzer import analysis
        from allan_variance_analyzer.statistics import compute_allan_variances

        # The defaults of its class AllanVarianceAnalyzer, and the ends of the line of white noise as in `analyze`.
        periods = np.arange(0.1, 1000, step=0.1)
        six = np.repeat(rates[:, None], 6, axis=1)
        deviations = np.sqrt(compute_allan_variances(six, periods, rate, overlap=0))[:, 3:6]
        white, _ = analysis.compute_white_noise_params(
            periods, deviations, np.where(periods == 10)[0][0]
        )
        to_one_second, _ = analysis.compute_white_noise_params(periods, deviations, 10)
        walk, _ = analysis.compute_rate_random_walk(periods, deviations)
        least, _ = analysis.compute_bias_instability(deviations)
        return {
            "N": float(white[0]),
            "N to 1 s": float(to_one_second[0]),
            "B": float(least[0]),
            "B / 0.664": float(least[0]) / np.sqrt(2 * np.log(2) / np.pi),
            "K": float(walk[0]),
        }


PEERS = {
    "allantools": Allantools,
    "allantools adev": AllantoolsAdev,
    "allan-variance": AllanVariance,
    "avar": Avar,
    "allan-variance-analyzer": AllanVarianceAnalyzer,
}


def peak_bytes():
    with open("/proc/self/status") as status:
        for line in status:
            if line.startswith("VmHWM:"):
                return 1024.0 * int(line.split()[1])
    raise RuntimeError("Linux tells the peak of the memory")


def main():
    peer, task, rate, scale, *files = sys.argv[1:]
    package = PEERS[peer]()
    for file in files:
        counts = np.load(file).astype(float)
        with (
            warnings.catch_warnings(record=True) as heard,
            contextlib.redirect_stdout(io.StringIO()),
            contextlib.redirect_stderr(io.StringIO()),
        ):
            warnings.simplefilter("always")
            if task == "fit":
                found = package.fit(counts * float(scale), float(rate))
                found.setdefault("notes", []).extend(str(one.message) for one in heard)
            else:
                found = getattr(package, task)(counts)
        print(json.dumps(found), flush=True)
    print(json.dumps({"cpu_s": time.process_time(), "peak_bytes": peak_bytes()}))


if __name__ == "__main__":
    os.environ.setdefault("MPLBACKEND", "Agg")
    main()
