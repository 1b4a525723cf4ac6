#!/usr/bin/env bash
# One would guess: the report of a linear regression has the slope that the same package gives without a report.
# What happens: over times in seconds since 1970, `simple_lin_reg` is right to a percent, `lin_reg` gives null, and
# `lin_reg_report` gives another slope, which errs by up to a multiple of itself. Over times that begin at 0 all three agree.
# Versions: polars-ds 0.13.0, Polars 2.1.0, numpy 2.4.6.
# Why it matters: the drift of a bias and its error are read from the report. They come with a p-value that seems to leave no
# doubt.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check polars-ds==0.13.0 polars==2.1.0 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np, polars as pl, polars_ds as pds
from importlib.metadata import version

TRUTH = 1e-3
print('polars-ds', version('polars-ds'), 'Polars', pl.__version__)
wrong, worst = 0, 0
for seed in range(5):
    elapsed = 0.01 * np.arange(10_000)
    rates = 0.5 + TRUTH * elapsed + 1e-3 * np.random.default_rng(seed).normal(size=len(elapsed))
    for origin in (0, 1_700_000_000):
        table = pl.DataFrame({'t': origin + elapsed, 'gx': rates})
        options = {'target': 'gx', 'add_bias': True}
        found = [table.select(fit('t', **options)).to_series() for fit in (pds.simple_lin_reg, pds.lin_reg, pds.lin_reg_report)]
        simple, plain, report = found[0][0][0], found[1][0], found[2][0]
        slope, error, chance = (report[key] for key in ('beta', 'std_err', 'p>|t|'))
        off = abs(slope / TRUTH - 1)
        assert abs(simple / TRUTH - 1) < 0.01
        if origin:
            assert plain is None
            wrong += off > 0.05
            worst = max(worst, off)
        else:
            assert abs(plain[0] / TRUTH - 1) < 0.01 and off < 0.01
        print(f'times from {origin:10}: simple_lin_reg {simple:.6f}, report {slope:.6f} +- {error:.6f}, p {chance:.1g}; truth {TRUTH}')
print(f'reports over times since 1970 that err by more than 5 %: {wrong} of 5')
assert wrong >= 3
print(f'SURPRISE: the report of a regression errs by up to {100 * worst:.0f} % where the regression alone is right')
PY
