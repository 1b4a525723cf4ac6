#!/usr/bin/env bash
# One would guess: a channel that npTDMS read and hands to its own TdmsWriter keeps its values.
# What happens: the writer stores the scaled values and also the properties of the scale. A reader scales them a
# second time. (TdmsWriter.defragment keeps the values.)
# Versions: npTDMS 1.13.0, numpy 2.4.6.
# Why it matters: the copy of a gyro's log, for example a part of it or one with a further property, has all
# noise coefficients multiplied by the scale once more, and nothing fails.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check nptdms==1.13.0 numpy==2.4.6
venv/bin/python - <<'PY'
import nptdms, numpy as np
from nptdms import ChannelObject, TdmsFile, TdmsWriter
from nptdms.types import Uint32

volts = np.random.default_rng(1).normal(2.5, 0.001, 1000)
scale = {
    'NI_Number_Of_Scales': 1,
    'NI_Scaling_Status': 'unscaled',
    'NI_Scale[0]_Scale_Type': 'Linear',
    'NI_Scale[0]_Linear_Slope': 200.0,
    'NI_Scale[0]_Linear_Y_Intercept': -500.0,
    'NI_Scale[0]_Linear_Input_Source': Uint32(0xFFFFFFFF),
    'wf_increment': 0.01,
    'wf_start_offset': 0.0,
}
with TdmsWriter('gyro.tdms') as writer:
    writer.write_segment([ChannelObject('imu', 'gx', volts, properties=scale)])
first = TdmsFile.read('gyro.tdms')['imu']['gx']
with TdmsWriter('copy.tdms') as writer:
    writer.write_segment([first])
copy = TdmsFile.read('copy.tdms')['imu']['gx']
TdmsWriter.defragment('gyro.tdms', 'defragmented.tdms')
other = TdmsFile.read('defragmented.tdms')['imu']['gx']

print('npTDMS', nptdms.__version__)
for name, channel in (('original', first), ('copy', copy), ('defragmented', other)):
    print(f'{name:13} mean {channel[:].mean():12.3f}  standard deviation {channel[:].std():9.4f} deg/s')
print('guess: three equal lines')
assert np.allclose(first[:], 200 * volts - 500) and np.allclose(other[:], first[:])
assert np.allclose(copy[:], 200 * first[:] - 500)
print(f'SURPRISE: the copy is {copy[:].std() / first[:].std():.0f} times as noisy as the log it was made from')
PY
