#!/usr/bin/env bash
# One would guess: netCDF4-python and xarray agree on which rows of a NetCDF-4 file hold a sample.
# What happens: in rows that were never written, netCDF4 masks the default fill value, and xarray gives it as a
# rate, for lack of an attribute _FillValue. A count of -32767 that a saturated gyro WROTE is masked by netCDF4
# all the same, while -32768 next to it is valid.
# Versions: netCDF4 1.7.5.1.post1, xarray 2026.9.0, numpy 2.4.6.
# Why it matters: a logger that allocates its rows ahead and stops early leaves a stretch at minus full scale in
# one reader, and one saturated count vanishes in the other.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check netcdf4==1.7.5.1.post1 xarray==2026.9.0 numpy==2.4.6
venv/bin/python - <<'PY'
import netCDF4, numpy as np, xarray

with netCDF4.Dataset('gyro.nc', 'w') as log:
    log.createDimension('row', 8)
    gx = log.createVariable('gx', 'i2', ('row',))
    gx.set_auto_maskandscale(False)
    gx.scale_factor = 0.01
    gx[:5] = np.array([3, -32768, -32767, -32766, 5], 'i2')
with netCDF4.Dataset('gyro.nc') as log:
    by_netcdf = log['gx'][:]
with xarray.open_dataset('gyro.nc') as log:
    by_xarray = log['gx'].to_numpy()

print('netCDF4', netCDF4.__version__, 'xarray', xarray.__version__)
print('written: 0.03 -327.68 -327.67 -327.66 0.05, then three rows without a sample')
print('netCDF4', by_netcdf)
print('xarray ', by_xarray)
assert np.ma.getmaskarray(by_netcdf).tolist() == [False, False, True, False, False, True, True, True]
assert np.allclose(by_xarray[5:], -327.67) and not np.isnan(by_xarray).any()
print('SURPRISE: xarray gives -327.67 deg/s for three rows never written; netCDF4 masks a sample that was written')
PY
