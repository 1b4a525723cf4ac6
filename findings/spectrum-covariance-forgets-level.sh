#!/usr/bin/env bash
# One would guess: the autoregressive densities of the package spectrum integrate to the variance of the record with each
# of its methods, so the density of a gyro's white noise can be read from any of them.
# What happens: pburg does so; pcovar and pmodcovar return the density of a record of variance one, whatever its level.
# Versions: spectrum 0.10.0, numpy 2.4.6, scipy 1.17.1 on Python 3.11.
# Why it matters: a gyro ten times as noisy has the same density, so rate noise density and angle random walk from these
# two methods tell nothing of the gyro, without a warning.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install -q spectrum==0.10.0 numpy==2.4.6 scipy==1.17.1
MPLBACKEND=Agg "$dir/venv/bin/python" - <<'PY'
from importlib.metadata import version
import numpy as np
import spectrum

print("spectrum", version("spectrum"))
white = np.random.default_rng(3).standard_normal(4096)
power = {}
for name in ("pburg", "pcovar", "pmodcovar"):
    for level in (0.1, 1.0, 10.0):
        estimate = getattr(spectrum, name)(level * white, 4, scale_by_freq=False)
        density, frequency = np.array(estimate.psd), np.array(estimate.frequencies())
        power[name, level] = density.sum() * (frequency[1] - frequency[0])
        print(f"{name}: variance {np.var(level * white):9.4f}, integral of the density {power[name, level]:9.4f}")
print("guess: the integral is the variance in all nine rows")
for level in (0.1, 1.0, 10.0):
    assert abs(power["pburg", level] / np.var(level * white) - 1) < 0.1
    for name in ("pcovar", "pmodcovar"):
        assert abs(power[name, level] - 1) < 0.05, f"{name} knows the level now"
print("seen: pcovar and pmodcovar give 1 at each level")
PY
