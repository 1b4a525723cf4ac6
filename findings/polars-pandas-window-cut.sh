#!/usr/bin/env bash
# One would guess: a window of 2.5 ms over time stamps in milliseconds has 2.5 ms, or is refused because it is no whole number
# of them.
# What happens: Polars and pandas cut it to 2 ms and say nothing. Blocks of 2.5 ms in Polars last 2 and 3 ms in turn, an
# offset of half a millisecond in pandas is none, and a half-life of 0.5 ms forgets all samples but the last. Over the same
# stamps in microseconds all are right.
# Versions: Polars 2.1.0, pandas 3.1.1, numpy 2.4.6.
# Why it matters: many loggers stamp in milliseconds, and 2.5 ms is the interval of 400 Hz. An average has a third fewer
# samples and other noise than asked for.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check polars==2.1.0 pandas==3.1.1 numpy==2.4.6
venv/bin/python - 2>/dev/null <<'PY'
from datetime import datetime, timedelta
import pandas as pd, polars as pl

times = [datetime(2026, 1, 1) + timedelta(milliseconds=k) for k in range(8)]
print('Polars', pl.__version__, 'pandas', pd.__version__)
seen = {}
for unit in ('ms', 'us'):
    table = pl.DataFrame({'t': pl.Series(times).cast(pl.Datetime(unit)), 'one': [1] * 8})
    series = pd.Series(1.0, index=pd.DatetimeIndex(pd.Series(times).astype(f'datetime64[{unit}]')))
    blocks = table.group_by_dynamic('t', every='2500us').agg(pl.len())['t'].dt.microsecond().to_list()
    ramp = series.cumsum()
    seen[unit] = {
        'Polars, samples in a rolling window of 2.5 ms': table.rolling('t', period='2500us').agg(pl.len())['len'].to_list()[-1],
        'Polars, blocks of 2.5 ms begin at (us)': blocks,
        'pandas, samples in a rolling window of 2.5 ms': int(series.rolling('2500us').sum().iloc[-1]),
        'pandas, blocks with an offset of 0.5 ms begin at (us)': series.resample('2ms', offset='500us').sum().index.microsecond[1],
        'pandas, half-life of 0.5 ms, last of 1 to 8': round(ramp.ewm(halflife=pd.Timedelta('500us'), times=ramp.index).mean().iloc[-1], 3),
    }
for what in seen['ms']:
    print(f"{what}: {seen['ms'][what]} for stamps in ms, {seen['us'][what]} in us")
assert list(seen['us'].values()) == [3, [0, 2500, 5000], 3, 500, 7.667]
assert list(seen['ms'].values()) == [2, [0, 2000, 5000, 7000], 2, 2000, 8.0]
print('SURPRISE: a window of 2.5 ms over stamps in milliseconds is one of 2 ms')
PY
