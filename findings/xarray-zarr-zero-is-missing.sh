#!/usr/bin/env bash
# One would guess: a Zarr array of counts that zarr-python wrote with its default fill value 0 has the count 0
# in xarray too.
# What happens: of a store in Zarr format 2, xarray takes the fill value as the mark of missing samples, so that
# each measured zero becomes NaN. The same array in format 3 keeps its zeros, and then a chunk that was never
# written looks like a gyro that reads 0.
# Versions: xarray 2026.9.0, zarr 3.1.6, numpy 2.4.6.
# Why it matters: near rest a gyro of coarse resolution gives the count 0 most of the time. Without the zeros
# the noise of the record is far too large, or its rows are taken as lost.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check xarray==2026.9.0 zarr==3.1.6 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np, xarray, zarr

counts = np.round(np.random.default_rng(1).normal(0, 0.7, 4000)).astype('i2')
got = {}
for version in (2, 3):
    group = zarr.open_group(f'gyro{version}', mode='w', zarr_format=version)
    names = {'dimension_names': ['row']} if version == 3 else {}
    gx = group.create_array('gx', shape=(6000,), chunks=(1000,), dtype='i2', **names)
    gx[:4000] = counts
    if version == 2:
        gx.attrs['_ARRAY_DIMENSIONS'] = ['row']
    got[version] = xarray.open_zarr(f'gyro{version}', consolidated=False)['gx'].to_numpy()
    assert gx.fill_value == 0

print('xarray', xarray.__version__, 'zarr', zarr.__version__)
missing = np.isnan(got[2][:4000].astype(float)).sum()
zeros = (counts == 0).sum()
print('zeros measured in 4000 samples          ', zeros)
print('format 2: missing among these samples   ', missing)
print('format 2: standard deviation            ', np.nanstd(got[2]), 'instead of', counts.std())
print('format 3: rows never written that are 0 ', (got[3][4000:] == 0).sum(), 'of 2000')
assert missing == zeros > 1000
assert np.array_equal(got[3][:4000], counts) and (got[3][4000:] == 0).all()
print('SURPRISE: the same counts have', missing, 'lost samples in format 2 and none in format 3')
PY
