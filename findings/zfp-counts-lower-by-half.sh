#!/usr/bin/env bash
# One would guess: zfp with a tolerance of half a count keeps integer counts, or refuses them; and `hdf5plugin.Zfp()` without an
# option, which keeps single-precision rates exactly, keeps counts exactly too.
# What happens: both take integers without a word and change every second one, by up to two counts and half a count downwards
# on average. The mode with a tolerance exists for floating-point numbers only.
# Versions: zfpy 1.0.1.post0, hdf5plugin 7.1.0, h5py 3.16.0, numpy 2.4.6.
# Why it matters: a gyro whose noise is about one count gets a bias of half a count and a fifth more noise, and its quantisation
# is gone from the statistics. Nothing in the file tells that the counts are no longer those of the gyro.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check zfpy==1.0.1.post0 hdf5plugin==7.1.0 h5py==3.16.0 numpy==2.4.6
venv/bin/python - <<'PY'
import h5py, hdf5plugin, numpy as np, zfpy
from importlib.metadata import version

counts = np.round(1000 + np.random.default_rng(1).normal(0, 1, 100_000)).astype('i4')
def through_hdf5(values):
    with h5py.File('gyro.h5', 'w') as f:
        f.create_dataset('gyro_x', data=values, chunks=(10_000,), compression=hdf5plugin.Zfp())
    with h5py.File('gyro.h5') as f:
        return f['gyro_x'][:]

print('zfpy', version('zfpy'), 'hdf5plugin', version('hdf5plugin'))
rates = (counts * 0.01).astype('f4')
assert np.array_equal(through_hdf5(rates), rates)
print('single-precision rates through hdf5plugin.Zfp(): exact')
for name, back in (('zfpy, tolerance 0.5', zfpy.decompress_numpy(zfpy.compress_numpy(counts, tolerance=0.5))),
                   ('hdf5plugin.Zfp()', through_hdf5(counts))):
    error = back - counts
    print(f'counts through {name}: {np.mean(error != 0):.0%} changed, by {error.min()} to {error.max()}, mean {error.mean():.3f};'
          f' standard deviation {counts.std():.3f} before, {back.std():.3f} after')
    assert back.dtype == counts.dtype
    assert abs(error).max() > 1 and error.mean() < -0.4, 'counts are kept or refused now'
print('guess: no count changed')
print(f'SURPRISE: counts err by up to {abs(error).max()} and lie {-error.mean():.2f} lower on average')
PY
