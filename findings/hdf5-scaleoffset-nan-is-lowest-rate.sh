#!/usr/bin/env bash
# One would guess: a lost sample that is NaN stays NaN in an HDF5 data set that is packed by the filter scale-offset, or the
# writing fails. The filter belongs to HDF5 itself, and h5py offers it as `scaleoffset`.
# What happens: NaN becomes the lowest rate of its chunk, also where the fill value of the data set is NaN. If the first sample
# of a chunk is NaN, writing succeeds, and the whole chunk cannot be read any more.
# Versions: h5py 3.16.0 with HDF5 2.0.0, numpy 2.4.6.
# Why it matters: each lost sample turns into the largest excursion of its chunk, which counts as noise and looks possible; no
# mark is left. A gap at the border of a chunk costs the rest of the chunk.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check h5py==3.16.0 numpy==2.4.6
venv/bin/python - <<'PY'
import h5py, numpy as np

rate = np.random.default_rng(1).normal(0, 1, 8000).astype('f4')
lost = np.zeros(8000, bool)
lost[1200:1400] = True
def store(values, **options):
    with h5py.File('gyro.h5', 'w') as f:
        f.create_dataset('gyro_x', data=values, chunks=(1000,), scaleoffset=3, **options)   # three decimals
    with h5py.File('gyro.h5') as f:
        return f['gyro_x'][:]

print('h5py', h5py.__version__, 'HDF5', h5py.version.hdf5_version)
for name, options in (('no fill value', {}), ('fill value NaN', {'fillvalue': np.nan})):
    back = store(np.where(lost, np.nan, rate), **options)
    lowest = rate[1000:2000][~lost[1000:2000]].min()
    print(f'{name}: {lost.sum()} written as NaN, {np.isnan(back).sum()} read as NaN; the first is {back[1200]:.3f},'
          f' the lowest rate of the chunk {lowest:.3f}; standard deviation {rate[~lost].std():.3f} before, {back.std():.3f} after')
    assert not np.isnan(back).any(), 'the mark survives now'
    assert np.allclose(back[lost], lowest, atol=1e-6)
    assert np.abs(back - rate)[~lost].max() < 0.001

first = rate.copy()
first[2000] = np.nan
try:
    store(first)
    outcome = 'read'
except OSError as error:
    outcome = f'not readable: {error}'
with h5py.File('gyro.h5') as f:
    print('a NaN as the first of a chunk: written;', outcome, '; the chunk before it:', f['gyro_x'][1000:2000].shape, 'samples')
print('guess: NaN, or an error on writing')
assert outcome.startswith('not readable')
print(f'SURPRISE: {lost.sum()} lost samples are the lowest rate of their chunk, and one at the start of a chunk takes 1000 with it')
PY
