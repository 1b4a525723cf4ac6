#!/usr/bin/env bash
# One would guess: analysing an array of rates twice, say with two settings, gives the same noise twice.
# What happens: allan-variance-analyzer turns the rates into degrees within the array of its caller. The second run takes them
# for radians and writes a noise density 57.3 times as large; whatever the caller does next with the rates is wrong too.
# Versions: allan-variance-analyzer 1.0.4, numpy 2.4.6, scipy 1.17.1.
# Why it matters: the file is for Kalibr and for filters, which take its number without a question; the rates of the
# accelerometer beside it stay right, so the pair looks consistent.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check allan-variance-analyzer==1.0.4 numpy==2.4.6 scipy==1.17.1
printf 'imu_rate: 100\nmeasure_rate: 100\n' > imu-config.yaml
venv/bin/python - <<'PY'
import contextlib, io
from importlib.metadata import version
import numpy as np, yaml
from allan_variance_analyzer import AllanVarianceAnalyzer, logger

logger.remove()
record = np.random.default_rng(1).normal(0, 0.02, (120000, 6))     # white, 0.002 rad/s/sqrt(Hz)
before = record[:, 3].std()
print('allan-variance-analyzer', version('allan-variance-analyzer'))
seen = []
for run in range(2):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        AllanVarianceAnalyzer('imu-config.yaml', '.', period_max=30)(record)
    result = yaml.safe_load(open('imu.yaml'))
    seen.append(result['gyroscope_noise_density'])
    print(f"run {run + 1}: gyroscope_noise_density {seen[-1]:.5f}, accelerometer_noise_density {result['accelerometer_noise_density']:.5f}")
print(f"standard deviation of the caller's rates: {before:.4f} before, {record[:, 3].std():.2f} after")
print('guess: 0.002 twice')
assert abs(seen[0] / 0.002 - 1) < 0.15
assert abs(seen[1] / seen[0] / np.rad2deg(1) - 1) < 1e-6, 'the array is left alone now'
print(f'SURPRISE: the second run finds {seen[1] / seen[0]:.1f} times the noise')
PY
