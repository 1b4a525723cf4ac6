#!/usr/bin/env bash
# One would guess: `random_walk` of imusim's gyroscope makes the rate walk by 0.1 deg/s in 100 s for 0.01 deg/s/sqrt(s).
# What happens: the walk is added only if `bias_instability` is not zero. Without it, which is the default, the gyro has no walk
# at all. A bias instability of 1e-12 deg/s brings the whole walk, also without the poles that a bias instability needs.
# Versions: imusim 1.1.2, numpy 2.4.6, scipy 1.17.1, matplotlib 3.11.2.
# Why it matters: a gyro without flicker noise is the usual test of a fit or a filter. Its record has no rate random walk, the
# fit says so, and the fit is blamed.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check imusim==1.1.2 numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2
MPLBACKEND=agg venv/bin/python -W ignore - <<'PY'
from importlib.metadata import version
import imusim
import numpy as np

RATE, SECONDS, WALK = 50, 200, 0.01
with open('rest.csv', 'w') as file:
    print('time,x,y,z,roll,pitch,yaw', file=file)
    for k in range(RATE * SECONDS):
        print(f'{k / RATE},0,0,0,0,0,0', file=file)

def gyroscope(**noise):
    np.random.seed(1)
    simulator = imusim.Simulator('rest.csv')
    three = {name: np.full(3, size) for name, size in noise.items()}
    simulator.set_gyroscope(**three)
    return np.array(simulator.gyroscope)

print('imusim', version('imusim'))
white = gyroscope(noise_density=WALK)
print(f'noise_density {WALK} at {RATE} Hz: standard deviation {white.std():.4f}, expected {WALK * RATE ** 0.5:.4f}')
assert abs(white.std() / (WALK * RATE ** 0.5) - 1) < 0.03
def change(record):
    return (record[10 * RATE:] - record[:-10 * RATE]).std()
alone = change(gyroscope(random_walk=WALK))
beside = change(gyroscope(random_walk=WALK, bias_instability=1e-12))
print(f'change within 10 s: random_walk alone {alone:.5f}, with a bias_instability of 1e-12 {beside:.5f}, of a walk {WALK * 10 ** 0.5:.5f}')
print('guess: the walk is there in both')
assert alone == 0 and 0.5 < beside / (WALK * 10 ** 0.5) < 1.6, 'the walk stands alone now'
print(f'SURPRISE: a random walk of {WALK} deg/s/sqrt(s) alone changes the rate by exactly 0')
PY
