#!/usr/bin/env bash
# One would guess: resample_poly and the filter `fir` of decimate continue the record at its ends, as the default of
# decimate does, so a gyro's bias stays.
# What happens: both take rates beyond the ends as zero. A constant of 100 deg/s swings between 55 and 109 at its ends.
# Two or three such samples raise the Allan deviation at the shortest averaging time three times.
# Versions: scipy 1.17.1, allantools 2024.6, numpy 2.4.6 on Python 3.11.
# Why it matters: a resampled record looks right in a plot of the whole, yet its angle random walk is wrong.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install -q scipy==1.17.1 numpy==2.4.6 allantools==2024.6
"$dir/venv/bin/python" - <<'PY'
import allantools
import numpy as np
import scipy
import scipy.signal as signal

print("scipy", scipy.__version__, "allantools", allantools.__version__)
flat = signal.resample_poly(np.full(1000, 100.0), 1, 10)
print("a constant of 100 deg/s after resample_poly:", np.round(flat[:3], 2), "...", np.round(flat[-3:], 2))

rate = 100 + 0.5 * np.random.default_rng(2).standard_normal(100_000)
def deviation(values):
    return allantools.oadev(values, rate=10, data_type="freq", taus=[0.1])[1][0]
results = {
    "resample_poly": deviation(signal.resample_poly(rate, 1, 10)),
    "resample_poly padtype=mean": deviation(signal.resample_poly(rate, 1, 10, padtype="mean")),
    "decimate fir": deviation(signal.decimate(rate, 10, ftype="fir")),
    "decimate iir": deviation(signal.decimate(rate, 10)),
}
for name, value in results.items():
    print(f"Allan deviation at 0.1 s, {name}: {value:.4f} deg/s")
print("guess: all four about the same")
assert 40 < flat[0] < 60 and flat[1:3].max() > 101, "the ends have changed"
reference = results["resample_poly padtype=mean"]
assert results["resample_poly"] > 2 * reference and results["decimate fir"] > 2 * reference, "the ends have changed"
assert abs(results["decimate iir"] / reference - 1) < 0.2
print(f"seen: zeros beyond the ends raise the Allan deviation {results['resample_poly'] / reference:.1f} times")
PY
