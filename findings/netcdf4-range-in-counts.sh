#!/usr/bin/env bash
# One would guess: a valid_range of the type of scale_factor (float64) is in deg/s. The NetCDF Users Guide says
# so for packed data.
# What happens: netCDF4-python compares valid_range with the packed counts. Of a gyro with 0.1 deg/s per count
# and a range of 250 deg/s it masks all that exceeds 25 deg/s. xarray ignores valid_range.
# Versions: netCDF4 1.7.5.1.post1, xarray 2026.9.0, numpy 2.4.6.
# Why it matters: one reader drops good samples and keeps the small ones, so that the noise looks smaller; the
# other keeps those that the writer declared invalid.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check netcdf4==1.7.5.1.post1 xarray==2026.9.0 numpy==2.4.6
venv/bin/python - <<'PY'
import netCDF4, numpy as np, xarray

counts = np.array([-2600, -2400, -300, -100, 0, 100, 300, 2400, 2600], 'i2')
with netCDF4.Dataset('gyro.nc', 'w') as log:
    log.createDimension('row', len(counts))
    gx = log.createVariable('gx', 'i2', ('row',))
    gx.set_auto_maskandscale(False)
    gx.units = 'deg s-1'
    gx.scale_factor = np.float64(0.1)
    gx.valid_range = np.array([-250.0, 250.0])
    gx[:] = counts
with netCDF4.Dataset('gyro.nc') as log:
    by_netcdf = log['gx'][:]
with xarray.open_dataset('gyro.nc') as log:
    by_xarray = log['gx'].to_numpy()

print('netCDF4', netCDF4.__version__, 'xarray', xarray.__version__)
print('rates written            ', counts * 0.1)
print('guess: all but +-260 are valid')
print('netCDF4: valid           ', by_netcdf.compressed())
print('xarray: valid            ', by_xarray[~np.isnan(by_xarray)])
assert np.allclose(by_netcdf.compressed(), [-10, 0, 10])
assert len(by_xarray) == 9 and not np.isnan(by_xarray).any()
print('SURPRISE: netCDF4 masks 30 and 240 deg/s of a range of 250 deg/s; xarray masks nothing')
PY
