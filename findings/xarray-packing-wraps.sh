#!/usr/bin/env bash
# One would guess: xarray refuses a rate that does not fit the packed type of the encoding, or clips it to full
# scale.
# What happens: the value wraps. 330 deg/s at 0.01 deg/s per count of int16 comes back as -325.36 deg/s, without
# an exception and without a warning.
# Versions: xarray 2026.9.0, netCDF4 1.7.5.1.post1, numpy 2.4.6.
# Why it matters: a knock on the bench looks like two jumps of twice the full scale, and a mean over it has the
# wrong sign.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check xarray==2026.9.0 netcdf4==1.7.5.1.post1 numpy==2.4.6
venv/bin/python - <<'PY'
import warnings
import numpy as np, xarray

rates = np.array([0.0, 327.0, 330.0, -330.0, 700.0])
encoding = {'gx': {'dtype': 'int16', 'scale_factor': 0.01, '_FillValue': -32768}}
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter('always')
    xarray.Dataset({'gx': ('row', rates)}).to_netcdf('gyro.nc', encoding=encoding)
    about_values = [str(w.message) for w in caught if issubclass(w.category, (RuntimeWarning, UserWarning))]
with xarray.open_dataset('gyro.nc') as log:
    back = log['gx'].to_numpy()

print('xarray', xarray.__version__)
print('written ', rates)
print('guess: an exception, or +-327.67')
print('read    ', back)
print('warnings', about_values)
assert about_values == []
assert np.allclose(back, [0.0, 327.0, 330.0 - 655.36, -330.0 + 655.36, 700.0 - 655.36])
print('SURPRISE: 330 deg/s is read as -325.36 deg/s, and 700 deg/s as 44.64 deg/s')
PY
