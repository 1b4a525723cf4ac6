#!/usr/bin/env bash
# One would guess: mdfreader masks the samples that an MDF4 file marks as invalid, at the latest after
# `apply_all_invalid_bit`.
# What happens: after reading nothing is masked. After `apply_all_invalid_bit` the first axis still has no mask,
# and the second axis is masked where the FIRST axis is invalid: the number of the bit serves as the mask of
# bits.
# Versions: mdfreader 4.3, asammdf 8.8.28 as the writer, numpy 2.4.6.
# Why it matters: a saturated or lost sample goes into the noise of one axis, and good samples of another axis
# are thrown away.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check mdfreader==4.3 asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1
venv/bin/python - <<'PY'
import importlib.metadata
import mdfreader, numpy as np
from asammdf import MDF, Signal

t = np.arange(8) * 0.01
lost = {'gx': [1], 'gy': [3], 'gz': [5]}
signals = []
for name, rows in lost.items():
    bits = np.zeros(8, bool)
    bits[rows] = True
    counts = np.arange(8, dtype='i2')
    counts[rows] = 32767
    signals.append(Signal(counts, t, name=name, unit='deg/s', invalidation_bits=bits))
mdf = MDF(version='4.10')
mdf.append(signals)
mdf.save('gyro.mf4')

log = mdfreader.Mdf('gyro.mf4')
before = {name: np.ma.getmaskarray(log.get_channel_data(name)).nonzero()[0].tolist() for name in lost}
log.apply_all_invalid_bit()
after = {name: np.ma.getmaskarray(log.get_channel_data(name)).nonzero()[0].tolist() for name in lost}

print('mdfreader', importlib.metadata.version('mdfreader'))
asammdf_says = {name: signal.invalidation_bits.nonzero()[0].tolist()
                for name, signal in ((n, MDF('gyro.mf4').get(n, ignore_invalidation_bits=True)) for n in lost)}
print('invalid rows as written, read by asammdf', asammdf_says)
print('masked by mdfreader after reading       ', before)
print('masked after apply_all_invalid_bit      ', after)
assert asammdf_says == lost
assert before == {'gx': [], 'gy': [], 'gz': []}
assert after['gx'] == [] and after['gy'] == lost['gx']
print('SURPRISE: gx keeps its invalid sample, and gy is masked at the row where gx is invalid')
PY
