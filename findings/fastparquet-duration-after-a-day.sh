#!/usr/bin/env bash
# One would guess: a column of times since the start, which fastparquet wrote as durations, is a duration or a
# number in other readers of Parquet.
# What happens: fastparquet stores a duration as a TIME OF DAY. Polars reads it so and gives null for each row
# after 24 hours; pandas with pyarrow cannot convert the column any more. fastparquet itself gets its durations
# back from metadata of pandas.
# Versions: fastparquet 2026.9.0, Polars 2.1.0, pyarrow 26.0.1, pandas 3.1.1, numpy 2.4.6.
# Why it matters: a record for bias instability lasts longer than a day. It reads well in all tests of an hour,
# and its later rows have no times.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check fastparquet==2026.9.0 pyarrow==26.0.1 polars==2.1.0 pandas==3.1.1 numpy==2.4.6
venv/bin/python - <<'PY'
import fastparquet, numpy as np, pandas as pd, polars as pl, pyarrow as pa, pyarrow.parquet as pq

hours = np.arange(0, 30)
frame = pd.DataFrame({'time': pd.to_timedelta(hours, unit='h'), 'gx': hours * 0.1})
fastparquet.write('gyro.parquet', frame)
own = fastparquet.ParquetFile('gyro.parquet').to_pandas()['time']
by_polars = pl.read_parquet('gyro.parquet')['time']
kind = pq.read_schema('gyro.parquet').field('time').type
try:
    pd.read_parquet('gyro.parquet', engine='pyarrow')
    refusal = None
except ValueError as error:
    refusal = str(error)

print('fastparquet', fastparquet.__version__, 'Polars', pl.__version__, 'pyarrow', pa.__version__)
print('type in the file      ', kind)
print('fastparquet, last row ', own.iloc[-1])
print('Polars: type          ', by_polars.dtype, 'null in', by_polars.null_count(), 'of', len(by_polars), 'rows')
print('pandas with pyarrow   ', refusal)
assert (own == frame['time']).all()
assert pa.types.is_time(kind) and by_polars.dtype == pl.Time
assert by_polars.null_count() == 6 and by_polars[:24].null_count() == 0
assert refusal
print('SURPRISE: the rows of the hours 24 to 29 have no time in Polars')
PY
