#!/usr/bin/env bash
# One would guess: the mean of time stamps in nanoseconds since 1970, a column of int64, lies between the first and the last.
# What happens: Dask and Daft divide a sum of int64 that has overflowed. From six stamps on, the mean is another time: that
# of six stamps of 2023 is in 1926. pandas is right.
# Versions: dask 2026.8.0, daft 0.7.26, pandas 3.1.1, numpy 2.4.6.
# Why it matters: rates are averaged in blocks together with their stamps, and temperature is joined by the averaged stamp.
# Blocks of six samples and more get another time, without an error.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check 'dask[dataframe]==2026.8.0' daft==0.7.26 pandas==3.1.1 numpy==2.4.6 pyarrow==25.0.1
venv/bin/python - 2>/dev/null <<'PY'
import daft, dask, dask.dataframe as dd, numpy as np, pandas as pd

START = 1_700_000_000_000_000_000
print('dask', dask.__version__, 'daft', daft.__version__, 'pandas', pd.__version__)
means = {}
for samples in (5, 6, 100):
    stamps = START + 10_000_000 * np.arange(samples)
    frame = pd.DataFrame({'block': 0, 'stamp': stamps})
    blocks = dd.from_pandas(frame, npartitions=2)
    table = daft.from_pydict({'block': [0] * samples, 'stamp': stamps.tolist()})
    means[samples] = {
        'pandas': frame.stamp.mean(),
        'Dask, mean': blocks.stamp.mean().compute(),
        'Dask, of a group': blocks.groupby('block').stamp.mean().compute().iloc[0],
        'Daft, mean': table.mean('stamp').to_pydict()['stamp'][0],
        'Daft, of a group': table.groupby('block').mean('stamp').to_pydict()['stamp'][0],
    }
    for name, mean in means[samples].items():
        print(f'{samples:4} stamps of 2023, {name:18} {pd.Timestamp(int(mean))}')
for samples, found in means.items():
    assert abs(found.pop('pandas') - START) < 1e9
    wrong = [abs(mean - START) > 1e17 for mean in found.values()]
    assert all(wrong) if samples > 5 else not any(wrong), found
print('SURPRISE: the mean of six stamps of 2023 is a time before 1970 in Dask and in Daft')
PY
