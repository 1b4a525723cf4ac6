#!/usr/bin/env bash
# One would guess: `cdf_to_xarray(..., fillval_to_nan=True)` turns samples that equal FILLVAL into NaN, as its
# documentation says.
# What happens: it does so for floating-point variables. In a variable of int16 the fill value stays, as a
# number, in an array of int16, without a warning.
# Versions: cdflib 1.3.16, xarray 2026.9.0, numpy 2.4.6.
# Why it matters: raw counts are integers. Each lost sample is read as minus full scale, although the
# caller asked for NaN.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check cdflib==1.3.16 xarray==2026.9.0 numpy==2.4.6
venv/bin/python - <<'PY'
import cdflib, numpy as np
from cdflib.cdfwrite import CDF
from cdflib.xarray import cdf_to_xarray

log = CDF('gyro.cdf', cdf_spec={'Compressed': 0})
epoch = cdflib.cdfepoch.compute_tt2000([[2026, 1, 1, 0, 0, 0, 10 * i, 0, 0] for i in range(6)])
log.write_var({'Variable': 'Epoch', 'Data_Type': 33, 'Num_Elements': 1, 'Rec_Vary': True, 'Dim_Sizes': []},
              var_attrs={'VAR_TYPE': 'support_data'}, var_data=epoch)
values = np.array([1, 2, -32768, 4, 5, 6])
for name, kind, code, of in (('counts', 2, 'CDF_INT2', np.int16), ('rates', 45, 'CDF_DOUBLE', np.float64)):
    log.write_var({'Variable': name, 'Data_Type': kind, 'Num_Elements': 1, 'Rec_Vary': True, 'Dim_Sizes': []},
                  var_attrs={'DEPEND_0': 'Epoch', 'VAR_TYPE': 'data', 'FILLVAL': [of(-32768), code]},
                  var_data=values.astype(of))
log.close()
data = cdf_to_xarray('gyro.cdf', fillval_to_nan=True)
counts, rates = data['counts'].to_numpy(), data['rates'].to_numpy()

print('cdflib', cdflib.__version__)
print('double:', rates)
print('int16 :', counts, counts.dtype, '(FILLVAL', data['counts'].attrs['FILLVAL'], ')')
assert np.isnan(rates[2]) and counts[2] == -32768
print('SURPRISE: fillval_to_nan=True leaves -32768 in the counts and replaces it in the rates')
PY
