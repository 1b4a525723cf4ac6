#!/usr/bin/env bash
# One would guess: `wfdb.rdsamp` gives a gyro of 400 Hz beside a thermometer of 100 Hz at its own rate, or
# repeats the samples of the thermometer.
# What happens: `rdsamp`, and `rdrecord` with default arguments, average the four samples of each frame. The
# gyro has 100 Hz, and its white noise is half as large.
# Versions: wfdb 4.3.1, numpy 2.4.6.
# Why it matters: the average hides the band above 50 Hz and gives quantisation and vibration another size, and
# no name or unit tells that the samples were averaged.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check wfdb==4.3.1 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np, wfdb

gyro = np.random.default_rng(1).normal(0, 1, 40000)
temperature = np.linspace(20, 21, 10000)
wfdb.wrsamp('log', 100, ['deg/s', 'degC'], ['gx', 'temperature'], e_p_signal=[gyro, temperature],
            fmt=['16', '16'], samps_per_frame=[4, 1])
signals, fields = wfdb.rdsamp('log')
full = wfdb.rdrecord('log', smooth_frames=False).e_p_signal[0]

print('wfdb', wfdb.__version__)
print('written    :', len(gyro), 'samples, standard deviation', gyro.std())
print('rdsamp     :', len(signals), 'samples at', fields['fs'], 'Hz, standard deviation', signals[:, 0].std())
print('no smoothing:', len(full), 'samples, standard deviation', full.std())
assert len(signals) == 10000 and fields['fs'] == 100
assert np.allclose(signals[:, 0], gyro.reshape(-1, 4).mean(axis=1), atol=1e-3)
assert len(full) == 40000
print(f'SURPRISE: the default reading has {signals[:, 0].std() / gyro.std():.2f} of the noise, at a quarter of the rate')
PY
