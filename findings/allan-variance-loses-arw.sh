#!/usr/bin/env bash
# One would guess: estimate_parameters of the package allan-variance finds the white noise of an hour at 100 Hz to a
# fraction of a percent, since 360000 samples determine it to 0.12 %.
# What happens: it weighs all averaging times alike, also those with a handful of independent clusters, so chance at the
# long ones turns into quantization noise and takes from white noise: single records err by up to ten percent and more.
# Versions: allan-variance 1.0, numpy 2.4.6, scipy 1.17.1, pandas 3.1.1 on Python 3.11.
# Why it matters: angle random walk scatters tens of times more than the record allows, and a quantization noise appears
# that the gyro lacks, both without any error bar.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install -q allan-variance==1.0 numpy==2.4.6 scipy==1.17.1 pandas==3.1.1
"$dir/venv/bin/python" - <<'PY'
from importlib.metadata import version
import numpy as np
from allan_variance import compute_avar, estimate_parameters

print("allan-variance", version("allan-variance"))
fitted, simple, quantized = [], [], 0
for seed in range(24):
    rate = 0.1 * np.random.default_rng(seed).standard_normal(360_000)
    tau, variance = compute_avar(rate, dt=0.01)
    parameters, _ = estimate_parameters(tau, variance)
    fitted.append(parameters["white"] / 0.01)
    simple.append(np.sqrt(variance[0] * tau[0]) / 0.01)
    quantized += parameters["quantization"] > 0
fitted, simple = np.array(fitted), np.array(simple)
print(f"white noise over its true value, 24 records: mean {fitted.mean():.3f}, scatter {fitted.std():.4f},"
      f" lowest {fitted.min():.3f}; from the first averaging time alone: scatter {simple.std():.4f}")
print(f"records with a quantization noise above zero, where there is none: {quantized}")
print("guess: a scatter near 0.0015")
assert fitted.std() > 10 * simple.std(), "the weights have changed"
assert fitted.min() < 0.95
print(f"seen: the fit scatters {fitted.std() / simple.std():.0f} times as much as the first averaging time alone")
PY
