#!/usr/bin/env bash
# One would guess: a sample whose invalidation bit is set in MDF4 becomes NaN or an empty cell when asammdf
# exports the record.
# What happens: `get` leaves the sample out. `to_dataframe` and `export('csv')` put numbers between its
# neighbours there. `export('mat')` writes the raw value of the invalid sample. No export has a mark.
# Versions: asammdf 8.8.28, numpy 2.4.6, pandas 3.1.1.
# Why it matters: an interpolated stretch has no noise, and a raw one has a saturated value. Both change the
# Allan deviation, and the reader of the export cannot see which rows were lost.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1 scipy==1.17.1 h5py==3.16.0
venv/bin/python - <<'PY'
import glob
import asammdf, numpy as np, scipy.io
from asammdf import MDF, Signal

t = np.arange(12) * 0.01
counts = np.arange(12, dtype='i2') ** 2
lost = np.zeros(12, bool)
lost[4:7] = True
counts[lost] = 32767
conversion = {'a': 0.1, 'b': 0.0}
mdf = MDF(version='4.10')
mdf.append([
    Signal(counts, t, name='gx', unit='deg/s', conversion=conversion, invalidation_bits=lost),
    Signal(np.arange(12, dtype='i2'), t, name='gy', unit='deg/s', conversion=conversion),
])
mdf.save('gyro.mf4')

mdf = MDF('gyro.mf4')
kept = len(mdf.get('gx'))
frame = mdf.to_dataframe()['gx'].to_numpy()
mdf.export('csv', filename='gyro')
rows = [line.split(',') for line in open(glob.glob('gyro*.csv')[0]).read().split()]
csv = np.array([float(row[rows[0].index('gx')]) for row in rows[1:]])
mdf.export('mat', filename='gyro')
mat = scipy.io.loadmat('gyro.mat')['DG0_gx'].ravel()

print('asammdf', asammdf.__version__)
print('valid samples from get   ', kept, 'of', len(t))
print('guess: NaN at rows 4 to 6')
print('data frame, rows 3 to 7  ', frame[3:8])
print('csv, rows 3 to 7         ', csv[3:8])
print('mat, rows 3 to 7         ', mat[3:8])
line = np.interp(t[lost], t[~lost], 0.1 * counts[~lost])
assert kept == 9
assert np.allclose(frame[lost], line) and np.allclose(csv[lost], line)
assert np.allclose(mat[lost], 3276.7)
print('SURPRISE: three invalid samples are a straight line in csv and 3276.7 deg/s in mat, without a mark')
PY
