#!/usr/bin/env bash
# One would guess: RocketPy's gyroscope with a `temperature_bias` has no bias at its default temperature, which is 298.15 K,
# 25 degC, by its documentation.
# What happens: the default is 25, and it is taken in kelvin. The bias is that of a gyro 273 K too cold: -0.27 rad/s for
# 0.001 rad/s/K. With `temperature_scale_factor` the rates shrink in the same way.
# Versions: rocketpy 1.13.0, numpy 2.4.6.
# Why it matters: 0.27 rad/s, 16 deg/s, passes for a poor gyro, and a filter tuned on such flights learns a bias that the
# settings do not have.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check rocketpy==1.13.0 numpy==2.4.6
venv/bin/python -W ignore - <<'PY'
import inspect
from importlib.metadata import version
import numpy as np
from rocketpy import Gyroscope

def measured(rate=0.0, **options):
    gyro, state = Gyroscope(sampling_rate=100, seed=1, **options), np.zeros(13)
    state[10] = rate
    gyro.measure(0.0, u=state, u_dot=np.zeros(13), relative_position=None, environment=None)
    return float(gyro.measurement[0])

print('rocketpy', version('rocketpy'))
line = next(l.strip() for l in inspect.getdoc(Gyroscope.__init__).split('\n') if '298.15' in l and 'Default' in l)
print('documentation:', line)
print('default      :', inspect.signature(Gyroscope.__init__).parameters['operating_temperature'].default)
bias = measured(temperature_bias=0.001)
reference = measured(temperature_bias=0.001, operating_temperature=298.15)
scaled = measured(1.0, temperature_scale_factor=0.1)
print(f'temperature_bias 0.001 rad/s/K: {bias:.5f} rad/s by default, {reference:.5f} at 298.15 K')
print(f'temperature_scale_factor 0.1 %/K: 1 rad/s becomes {scaled:.5f} by default')
print('guess: 0 and 1')
assert reference == 0
assert abs(bias + 0.27315) < 1e-9 and abs(scaled - 0.72685) < 1e-9, 'the default is in kelvin now'
print(f'SURPRISE: by default the gyro has a bias of {bias:.3f} rad/s, and {scaled:.0%} of the rate')
PY
