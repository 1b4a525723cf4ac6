#!/usr/bin/env bash
# One would guess: ObsPy keeps the samples that `merge` masked out of every calculation, as `filter`, `detrend`
# and `interpolate` do, which refuse a masked trace.
# What happens: `integrate` takes the value under the mask, -2147483648 of int32, for a rate, and `resample`
# puts it into a Fourier transform. Both return a plain array without a mask.
# Versions: ObsPy 1.5.1, numpy 2.4.6.
# Why it matters: the angle of a rotation sensor drops by millions in a gap of 0.1 s, and a resampled record has
# no sample left that is right.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check obspy==1.5.1 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np, obspy
from obspy import Stream, Trace, UTCDateTime

start = UTCDateTime(2026, 1, 1)
parts = []
for offset in (0.0, 0.6):
    part = Trace(np.full(50, 3, dtype='i4'))
    part.stats.update(dict(network='XX', station='IMU', channel='HJ1', sampling_rate=100.0, starttime=start + offset))
    parts.append(part)
stream = Stream(parts).merge()
trace = stream[0]
assert np.ma.count_masked(trace.data) == 10
refused = []
for name, call in (('detrend', lambda t: t.detrend('demean')), ('filter', lambda t: t.filter('lowpass', freq=10)),
                   ('interpolate', lambda t: t.interpolate(50))):
    try:
        call(trace.copy())
    except NotImplementedError:
        refused.append(name)
angle = trace.copy().integrate().data
half = trace.copy().resample(50.0).data

print('ObsPy', obspy.__version__)
print('refuse a masked trace:', refused)
print('guess: the angle ends near 3 counts x 1.1 s = 3.3, or the call refuses')
print('integrate: ends at', angle[-1], 'masked', np.ma.count_masked(angle))
print('resample : values from', half.min(), 'to', half.max(), 'masked', np.ma.count_masked(half))
assert refused == ['detrend', 'filter', 'interpolate']
assert angle[-1] < -1e7 and np.ma.count_masked(angle) == 0
assert half.min() < -1e8 and np.ma.count_masked(half) == 0
print('SURPRISE: a gap of ten samples of a gyro at 3 counts turns the angle by', round(float(angle[-1])))
PY
