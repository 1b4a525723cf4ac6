#!/usr/bin/env bash
# One would guess: an overlap of the averages makes an Allan deviation steadier, and leaves its size.
# What happens: with any overlap above zero, allan-variance-analyzer compares averages that lie one sample apart and share all
# samples but one. The deviation falls as the averaging time instead of its root, and the noise density that it writes for
# Kalibr is 19 times too small.
# Versions: allan-variance-analyzer 1.0.4, numpy 2.4.6, scipy 1.17.1.
# Why it matters: a filter that reads the file trusts the gyro hundreds of times too much in variance, and the curve has the slope of
# quantisation noise where the gyro has white noise alone.
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
TRUE = 0.002                                       # rad/s/sqrt(Hz), white
record = np.random.default_rng(1).normal(0, TRUE * 10, (120000, 6))
print('allan-variance-analyzer', version('allan-variance-analyzer'))
seen = {}
for overlap in (0, 0.1, 0.5):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        AllanVarianceAnalyzer('imu-config.yaml', '.', overlap=overlap, period_max=30)(record.copy())
    seen[overlap] = yaml.safe_load(open('imu.yaml'))['gyroscope_noise_density']
    print(f'overlap {overlap}: gyroscope_noise_density {seen[overlap]:.6f}, true {TRUE}')
print('guess: 0.002 in each row, to some percent')
assert abs(seen[0] / TRUE - 1) < 0.15
assert seen[0.1] < 0.1 * TRUE and seen[0.5] < 0.1 * TRUE, 'the stride has changed'
print(f'SURPRISE: with an overlap of a tenth or of a half, the noise is {TRUE / seen[0.5]:.0f} times too small')
PY
