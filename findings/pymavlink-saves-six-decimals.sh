#!/usr/bin/env bash
# One would guess: a parameter file that pymavlink saves gives back the parameters when it is loaded.
# What happens: `MAVParmDict.save` writes each value with six decimals. The noise of a gyro's bias, which is far below a
# millionth of a rad/s^2 for a good gyro, is saved as 0.000000 and loaded as 0; larger ones lose digits. `load` says no more
# than the number of parameters.
# Versions: pymavlink 2.4.50. MAVProxy saves its parameters with it.
# Why it matters: a filter of PX4 or ArduPilot whose parameters were saved and restored no longer lets the bias of its gyro
# walk, or by a wrong amount: it comes to trust a bias that has moved on.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pymavlink==2.4.50
venv/bin/python - <<'PY'
from importlib.metadata import version
from pymavlink.mavparm import MAVParmDict

print('pymavlink', version('pymavlink'))
# The parameters of a filter that predicts each 10 ms: N/sqrt(dt) in rad/s and K/sqrt(dt) in rad/s^2.
N, K = 3.5e-5, 1.7e-8
asked = {'EKF2_GYR_NOISE': N / 0.1, 'EKF2_GYR_B_NOISE': K / 0.1, 'EK3_GBIAS_P_NSE': 5.24e-5}
first, second = MAVParmDict(), MAVParmDict()
for name, value in asked.items():
    first[name] = value
first.save('noise.parm')
print(open('noise.parm').read(), end='')
assert second.load('noise.parm')
for name, value in asked.items():
    print(f'{name}: saved {value:.3e}, loaded {second[name]:.3e}')
print('guess: the same numbers')
assert second['EKF2_GYR_B_NOISE'] == 0 and second['EK3_GBIAS_P_NSE'] == 5.2e-5, 'values keep their digits now'
print(f"SURPRISE: a bias noise of {asked['EKF2_GYR_B_NOISE']:.1e} rad/s^2 comes back as 0, and 5.24e-05 as 5.2e-05")
PY
