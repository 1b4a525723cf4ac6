#!/usr/bin/env bash
# One would guess: `gyr_noise` of ahrs' simulated sensors has the unit of the gyroscopes, which are in rad/s by default.
# What happens: the noise is added in deg/s, and the sum is turned into rad/s. A noise of 0.01 rad/s becomes 0.00017 rad/s.
# Versions: ahrs 0.4.0, numpy 2.4.6.
# Why it matters: a record that was asked to have the noise of a given gyro has 57.3 times less, and both its Allan deviation
# and a filter tuned on it are those of a far better one. The default noise, of 0.1 rad/s, is right.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check ahrs==0.4.0 numpy==2.4.6
venv/bin/python -W ignore - <<'PY'
from importlib.metadata import version
import ahrs
import numpy as np

NOISE = 0.01
rest = np.tile([1.0, 0.0, 0.0, 0.0], (20000, 1))

def noise(**options):
    sensors = ahrs.Sensors(rest, freq=100.0, rng=np.random.default_rng(1), **options)
    return (sensors.gyroscopes - sensors.gyroscopes.mean(axis=0)).std()

print('ahrs', version('ahrs'))
acceleration = ahrs.Sensors(rest, freq=100.0, acc_noise=NOISE, rng=np.random.default_rng(1)).accelerometers
print(f'acc_noise {NOISE}: standard deviation {acceleration[:, 0].std():.5f} m/s^2')
assert abs(acceleration[:, 0].std() / NOISE - 1) < 0.03
radians, degrees = noise(gyr_noise=NOISE), noise(gyr_noise=NOISE, in_degrees=True)
print(f'gyr_noise {NOISE}: standard deviation {radians:.6f} rad/s, with in_degrees {degrees:.6f} deg/s')
print(f'guess: {NOISE} rad/s')
assert abs(degrees / NOISE - 1) < 0.03 and abs(np.degrees(radians) / NOISE - 1) < 0.03, 'the noise is in rad/s now'
print(f'SURPRISE: the gyro in rad/s has {NOISE / radians:.1f} times less noise than it was asked to have')
PY
