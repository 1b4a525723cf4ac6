#!/usr/bin/env bash
# One would guess: the mean of a group in xarray is the mean of its samples, whichever packages are installed.
# What happens: if numbagg and flox are installed, xarray gives means of groups to numbagg, which adds f32 in f32: a million
# rates of 0.1 deg/s have the mean 0.10096 as a group and 0.1 at once. Without flox, or with `use_flox=False`, the mean is right.
# Versions: xarray 2026.9.0, flox 0.11.2, numbagg 0.9.6, numpy 2.4.6, pandas 2.3.3.
# Why it matters: rates in netCDF are f32. Their mean at each temperature or orientation errs by a percent, and by nine
# percent for ten million samples, once somebody installs a package that only promises speed.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check xarray==2026.9.0 flox==0.11.2 numbagg==0.9.6 numpy==2.4.6 pandas==2.3.3
venv/bin/python - <<'PY'
import flox, numpy as np, xarray as xr
from importlib.metadata import version

rates = np.full(1_000_000, 0.1, np.float32)
table = xr.DataArray(rates, dims='t', coords={'orientation': ('t', np.zeros(len(rates), int))})
at_once = float(table.mean())
seen = {}
for on in (True, False):
    with xr.set_options(use_flox=on):
        seen[on] = float(table.groupby('orientation').mean()[0])
engines = {engine: float(flox.groupby_reduce(rates, table.orientation.values, func='nanmean', engine=engine)[0][0]) for engine in ('numbagg', 'numpy')}
print(*(f'{name} {version(name)}' for name in ('xarray', 'flox', 'numbagg', 'numpy')))
print(f'mean at once {at_once:.6f}, as a group {seen[True]:.6f}, as a group with use_flox=False {seen[False]:.6f}; guess 0.100000')
print('flox alone by its engines:', *(f'{engine} {mean:.6f}' for engine, mean in engines.items()))
assert engines['numbagg'] == seen[True] and abs(engines['numpy'] - 0.1) < 1e-6
assert abs(at_once - 0.1) < 1e-6 and abs(seen[False] - 0.1) < 1e-6
assert abs(seen[True] - 0.1) > 5e-4
print(f'SURPRISE: as a group, the mean is {1000 * (seen[True] - 0.1):.2f} % too large')
PY
