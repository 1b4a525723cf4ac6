#!/usr/bin/env bash
# One would guess: pyule and pburg of the package spectrum, two estimates of one autoregressive density, agree on white
# noise of a long record with their default arguments.
# What happens: pyule multiplies its density by 2 pi over the spacing of its frequencies by default, pburg does not. They
# differ by a factor that depends on the length of the record and on the rate of sampling.
# Versions: spectrum 0.10.0, numpy 2.4.6, scipy 1.17.1 on Python 3.11.
# Why it matters: the rate noise density from pyule is wrong by a factor of 26 to 1029 here, and changes with the rate and the length
# of the log, so two logs of one gyro seem to differ.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install -q spectrum==0.10.0 numpy==2.4.6 scipy==1.17.1
MPLBACKEND=Agg "$dir/venv/bin/python" - <<'PY'
from importlib.metadata import version
import math
import numpy as np
import spectrum

print("spectrum", version("spectrum"))
factors = []
for count, rate in ((4096, 100.0), (16384, 100.0), (4096, 1000.0)):
    white = np.random.default_rng(4).standard_normal(count)
    mean = {}
    for name in ("pburg", "pyule"):
        estimate = getattr(spectrum, name)(white, 4, sampling=rate)
        mean[name] = float(np.mean(estimate.psd))
    spacing = rate / count
    factor = mean["pyule"] / mean["pburg"]
    factors.append(factor * spacing / (2 * math.pi))
    print(f"{count} samples at {rate} Hz: pburg {mean['pburg']:.5f}, pyule {mean['pyule']:.5f}, ratio {factor:.1f},"
          f" 2 pi / spacing {2 * math.pi / spacing:.1f}")
print("guess: the ratio is 1 in all three rows")
assert all(abs(f - 1) < 0.02 for f in factors), "the units of pyule or pburg have changed"
print("seen: with default arguments, pyule exceeds pburg by 2 pi over the spacing of frequencies")
PY
