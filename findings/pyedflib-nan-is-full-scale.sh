#!/usr/bin/env bash
# One would guess: pyEDFlib refuses a NaN, which EDF cannot hold, or warns; and it warns where it clips.
# What happens: a NaN is written as the smallest digital value, and is read back as minus full scale. It has the
# same number as a rate that was clipped there. There is neither an exception nor a warning.
# Versions: pyEDFlib 0.1.42, numpy 2.4.6.
# Why it matters: each lost sample of a gyro becomes -500 deg/s. Three of 2000 make a noise of 1 deg/s look like
# 19 deg/s.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pyedflib==0.1.42 numpy==2.4.6
venv/bin/python - <<'PY'
import importlib.metadata, warnings
import numpy as np, pyedflib

rates = np.random.default_rng(1).normal(0, 1, 2000)
rates[[100, 900, 1500]] = np.nan
rates[200] = 620.0
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter('always')
    writer = pyedflib.EdfWriter('gyro.edf', 1, file_type=pyedflib.FILETYPE_EDF)
    writer.setSignalHeader(0, dict(label='gx', dimension='deg/s', sample_frequency=100, physical_max=500,
                                   physical_min=-500, digital_max=32767, digital_min=-32768,
                                   transducer='', prefilter=''))
    writer.writeSamples([rates])
    writer.close()
reader = pyedflib.EdfReader('gyro.edf')
back = reader.readSignal(0)
reader.close()

print('pyEDFlib', importlib.metadata.version('pyedflib'))
print('guess: an exception or a warning')
print('warnings', [str(w.message) for w in caught])
print('written', rates[[100, 200, 900, 1500]])
print('read   ', back[[100, 200, 900, 1500]])
print('standard deviation written', np.nanstd(np.delete(rates, 200)), 'read', np.delete(back, 200).std())
assert caught == []
assert np.allclose(back[[100, 900, 1500]], -500) and np.isclose(back[200], 500)
print('SURPRISE: three lost samples are read as -500 deg/s, as if the gyro had been saturated')
PY
