#!/usr/bin/env bash
# One would guess: standard deviations of numbagg over a moving window and of groups are as accurate as its `nanvar`, and a
# variance is never negative.
# What happens: they subtract squares of sums. At a level of 1000 counts in f32, the variance of a group is negative; at a
# level of a million in f64, deviations of a window err by their whole size. `nanvar` is right.
# Versions: numbagg 0.9.6, numpy 2.4.6, pandas 2.3.3.
# Why it matters: a gyro with a constant offset of many counts seems to have other noise, or none, from block to block.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check numbagg==0.9.6 numpy==2.4.6 pandas==2.3.3
venv/bin/python - <<'PY'
import numbagg, numpy as np, pandas as pd
from importlib.metadata import version

noise = 0.1 * np.random.default_rng(1).normal(size=100_000)
single = (1000 + noise).astype(np.float32)
group = np.zeros(len(single), int)
whole = single.astype(float).var(ddof=1)
of_group = numbagg.group_nanvar(single, group)[0]
print('numbagg', version('numbagg'))
at_once = numbagg.nanvar(single, ddof=1)
print(f'variance at a level of 1000 in f32: true {whole:.5f}, nanvar {at_once:.5f}, group_nanvar {of_group:.5f}')
assert abs(at_once / whole - 1) < 1e-3 and of_group < 0
worst = {}
for kind, level in ((np.float32, 1000), (np.float64, 1_000_000)):
    rates = (level + noise).astype(kind)
    true = pd.Series(rates.astype(float) - level).rolling(100).std().to_numpy()[99:]
    moving = numbagg.move_std(rates, window=100, min_count=100)[99:]
    ratio = moving / true
    worst[kind] = np.nanmax(np.abs(ratio - 1))
    span = f'{np.nanmin(ratio):.2f} to {np.nanmax(ratio):.2f}'
    print(f'move_std over 100 samples at a level of {level} in {kind.__name__}: {span} times the true one')
assert min(worst.values()) > 0.4
print(f'SURPRISE: the variance of a group is {of_group:.1f}, and that of the same samples at once {whole:.2f}')
PY
