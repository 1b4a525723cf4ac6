#!/usr/bin/env bash
# One would guess: the exports of wfdb keep a lost sample, which wfdb itself writes and reads as NaN,
# recognisable, or refuse it.
# What happens: `wfdb_to_mat` writes a lost sample as 0, the value of a gyro at rest. `wfdb_to_edf` writes it as
# the smallest value of the record. Only the first one gives a warning, of a cast in numpy.
# Versions: wfdb 4.3.1, pyEDFlib 0.1.42 and scipy 1.17.1 as readers, numpy 2.4.6.
# Why it matters: one export makes the record quieter than the gyro, the other one noisier, and both hide that a
# tenth of the samples is lost.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check wfdb==4.3.1 pyedflib==0.1.42 scipy==1.17.1 numpy==2.4.6
venv/bin/python - <<'PY'
import contextlib, io, warnings
import numpy as np, pyedflib, scipy.io, wfdb
from wfdb.io.convert.edf import wfdb_to_edf
from wfdb.io.convert.matlab import wfdb_to_mat

rates = np.random.default_rng(1).normal(0, 1, 2000)
rates[500:700] = np.nan
wfdb.wrsamp('gyro', 100, ['deg/s'], ['gx'], p_signal=rates[:, None], fmt=['16'])
record = wfdb.rdrecord('gyro')
with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter('always', RuntimeWarning)
    wfdb_to_mat('gyro')
    wfdb_to_edf('gyro')
mat = scipy.io.loadmat('gyrom.mat')['val'].ravel()
reader = pyedflib.EdfReader('gyro.edf')
edf = reader.readSignal(0)[:2000]
reader.close()

print('wfdb', wfdb.__version__)
print('warnings                 :', [str(w.message) for w in caught if w.category is RuntimeWarning])
print('wfdb reads its own file  : NaN in', int(np.isnan(record.p_signal).sum()), 'rows')
print('MATLAB, distinct values  :', np.unique(mat[500:700]), 'of', mat.dtype)
print('EDF, distinct values     :', np.unique(edf[500:700]), 'deg/s; smallest rate measured', np.nanmin(rates))
print('standard deviation       : gyro', np.nanstd(rates), 'EDF', edf.std())
assert np.isnan(record.p_signal).sum() == 200
assert (mat[500:700] == 0).all()
assert np.allclose(edf[500:700], np.nanmin(rates), atol=1e-3)
print('SURPRISE: 200 lost samples are 0 in MATLAB and the lowest rate of the record in EDF')
PY
