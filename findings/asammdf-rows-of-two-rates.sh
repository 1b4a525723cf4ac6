#!/usr/bin/env bash
# One would guess: where an MDF file has a gyro at 100 Hz and a thermometer at 25 Hz, a common table has empty
# cells where one of them has no sample.
# What happens: asammdf's `to_dataframe` and `export('csv', single_time_base=True)` give the gyro a row at each
# time of the thermometer too. Counts are repeated there, floating-point rates are interpolated, and the last
# value is held after the end.
# Versions: asammdf 8.8.28, numpy 2.4.6, pandas 3.1.1.
# Why it matters: the gyro has more rows than it measured, at an uneven step. A repeated or interpolated row
# lowers the angle random walk, and no mark says which rows are real.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1
venv/bin/python - <<'PY'
import glob
import asammdf, numpy as np
from asammdf import MDF, Signal

t = np.arange(12) * 0.01
slow = np.arange(3) * 0.04 + 0.002
mdf = MDF(version='4.10')
mdf.append([
    Signal(np.arange(12, dtype='i2') * 10, t, name='counts', unit=''),
    Signal(np.arange(12) * 1.0, t, name='gx', unit='deg/s'),
])
mdf.append([Signal(np.array([20.0, 21.0, 22.0]), slow, name='temperature', unit='degC')])
mdf.export('csv', filename='log', single_time_base=True)
text = open(glob.glob('log*.csv')[0]).read()
head, *rows = [line.split(',') for line in text.split()]
column = {name: np.array([float(row[i]) for row in rows]) for i, name in enumerate(head)}

print('asammdf', asammdf.__version__)
print(text)
print('guess: empty cells of counts and gx at 0.002, 0.042 and 0.082 s')
assert len(rows) == 15
extra = np.isin(np.round(column['timestamps'], 6), np.round(slow, 6))
assert list(column['counts'][extra]) == [0, 40, 80]
assert np.allclose(column['gx'][extra], [0.2, 4.2, 8.2])
assert list(column['temperature'][-3:]) == [22, 22, 22]
print(f'SURPRISE: {len(rows)} rows of a gyro that gave 12 samples; the rest is repeated (counts) or interpolated (gx)')
PY
