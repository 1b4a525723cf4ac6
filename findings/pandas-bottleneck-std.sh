#!/usr/bin/env bash
# One would guess: pandas gives the standard deviation of a column whatever else is installed.
# What happens: once the package bottleneck is installed, pandas hands `std` to it by default, which sums single-precision columns in
# single precision. A million counts with bias 1000 and noise 1 have a standard deviation of 9 then, and without bottleneck of
# 1.0. The mean stays right.
# Versions: pandas 3.1.1, bottleneck 1.6.0, numpy 2.4.6.
# Why it matters: bottleneck comes along with other packages. The same lines on the same log then give another noise on another
# computer, and nothing but the size of the number tells.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cat > measure.py <<'PY'
import importlib.util
import numpy as np, pandas as pd
counts = np.round(1000 + np.random.default_rng(1).normal(0, 1, 1_000_000))
column = pd.Series(counts.astype('f4'))
there = importlib.util.find_spec('bottleneck') is not None
print(f'pandas {pd.__version__}, bottleneck {"installed" if there else "absent":9}: std {column.std():.4f}, describe {column.describe()["std"]:.4f},'
      f' mean {column.mean():.4f}; in double precision {counts.std(ddof=1):.4f} and {counts.mean():.4f}')
open(f'std-{int(there)}', 'w').write(str(float(column.std())))
PY
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pandas==3.1.1 numpy==2.4.6
venv/bin/python measure.py
venv/bin/pip install -q --disable-pip-version-check bottleneck==1.6.0
venv/bin/python measure.py
venv/bin/python - <<'PY'
without, with_it = (float(open(f'std-{n}').read()) for n in (0, 1))
print('guess: the same standard deviation twice')
assert abs(without - 1.04) < 0.01
assert with_it > 3 * without, 'pandas or bottleneck sums in double precision now'
print(f'SURPRISE: the standard deviation is {with_it / without:.1f} times as large once bottleneck is installed')
PY
