#!/usr/bin/env bash
# One would guess: `random_walk_density` of RocketPy's gyroscope lets the bias walk: by 0.1 rad/s in 100 s for 0.01 rad/s/sqrt(s).
# What happens: the sum of the old bias and the new step is multiplied by the size of a step, since `+` binds before `&`. The
# bias forgets its past at once, and the gyro has a trace of white noise instead of a walk.
# Versions: rocketpy 1.13.0, numpy 2.4.6.
# Why it matters: a filter tuned on such flights meets no bias that moves, and a record shows a trace of angle random walk where
# rate random walk was asked for.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check rocketpy==1.13.0 numpy==2.4.6
venv/bin/python -W ignore - <<'PY'
from importlib.metadata import version
import numpy as np
from rocketpy import Gyroscope

RATE, WALK = 100, 0.01
def record(seconds, **noise):
    gyro, rest = Gyroscope(sampling_rate=RATE, seed=1, **noise), np.zeros(13)
    for k in range(seconds * RATE):
        gyro.measure(k / RATE, u=rest, u_dot=rest, relative_position=None, environment=None)
        yield gyro.measurement

print('rocketpy', version('rocketpy'))
white = np.array(list(record(100, noise_density=0.01)))
print(f'noise_density 0.01 at {RATE} Hz: standard deviation {white.std():.4f}, expected 0.1')
assert abs(white.std() - 0.1) < 0.002
walk = np.array(list(record(400, random_walk_density=WALK)))
seen = {}
for seconds in (1, 10, 100):
    seen[seconds] = (walk[seconds * RATE:] - walk[:-seconds * RATE]).std()
    print(f'random_walk_density {WALK}: change within {seconds:3} s {seen[seconds]:.5f} rad/s, of a walk {WALK * seconds ** 0.5:.5f}')
neighbours = np.corrcoef(walk[1:, 0], walk[:-1, 0])[0, 1]
print(f'correlation of neighbours: {neighbours:.3f}, of a walk near 1')
print('guess: 0.1 rad/s within 100 s')
assert seen[100] < 0.03 * WALK * 10 and abs(neighbours) < 0.05, 'the bias walks now'
print(f'SURPRISE: within 100 s the bias moves {WALK * 10 / seen[100]:.0f} times too little, and no further than within 1 s')
PY
