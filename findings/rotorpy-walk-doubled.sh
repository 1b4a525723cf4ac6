#!/usr/bin/env bash
# One would guess: RotorPy's IMU takes `noise_density` and `random_walk` in one convention, so a gyro simulated with N and K has
# N and K, or both smaller by the root of two if densities are one-sided.
# What happens: it multiplies white noise by the root of half the rate and divides the steps of the bias by the same root. White
# noise is smaller by the root of two, and the walk larger by it: beside the white noise, the walk is twice too large.
# Versions: rotorpy 3.0.0, numpy 2.4.6.
# Why it matters: no convention makes both numbers right, so a filter that was tuned by simulation trusts the bias too little
# and the rates too much on the real gyro.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check rotorpy==3.0.0 numpy==2.4.6
venv/bin/python - <<'PY'
from importlib.metadata import version
import numpy as np
from rotorpy.sensors.imu import Imu

def record(rate, density, walk, samples=10_000):
    np.random.seed(1)
    none = {name: np.zeros(3) for name in ('initial_bias', 'noise_density', 'random_walk')}
    gyro = none | {'noise_density': np.full(3, density), 'random_walk': np.full(3, walk)}
    imu = Imu(none, gyro, sampling_rate=rate)
    rest = {'q': np.array([0, 0, 0, 1.0]), 'w': np.zeros(3)}, {'vdot': np.zeros(3), 'wdot': np.zeros(3)}
    return np.array([imu.measurement(*rest)['gyro'] for _ in range(samples)])

print('rotorpy', version('rotorpy'))
for rate in (100, 500):
    n = record(rate, 0.01, 0.0).std() / rate ** 0.5 / 0.01          # angle random walk over what was asked for
    k = np.diff(record(rate, 0.0, 0.01), axis=0).std() * rate ** 0.5 / 0.01   # rate random walk over what was asked for
    print(f'{rate} Hz: N is {n:.3f} of noise_density, K is {k:.3f} of random_walk, K/N {k / n:.3f} of the ratio asked for')
    assert abs(n - 0.5 ** 0.5) < 0.02 and abs(k - 2 ** 0.5) < 0.03, 'the scales have changed'
print('guess: 1 and 1, or 0.707 and 0.707')
print(f'SURPRISE: N is {n:.2f} and K is {k:.2f} of what was asked for, which no convention explains')
PY
