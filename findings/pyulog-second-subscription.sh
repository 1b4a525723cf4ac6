#!/usr/bin/env bash
# One would guess: a logger may stop a topic of a ULog and subscribe to it again, with a new message id as the
# specification demands, and `ulog2csv` still writes all samples of sensor_gyro:0.
# What happens: pyulog makes two data sets of one name and one instance. `ulog2csv` writes both into ONE file,
# the second over the first, and the samples of the second subscription are gone. `get_dataset` returns the
# second subscription alone.
# Versions: pyulog 1.3.0, numpy 2.4.6.
# Why it matters: a part of the record is lost, and the two entrances of one library lose different parts. The
# file that stays has no gap that would show it.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pyulog==1.3.0 numpy==2.4.6
venv/bin/python - <<'PY'
import importlib.metadata, struct, subprocess
import numpy as np
from pyulog import ULog

def message(kind, body):
    return struct.pack('<HB', len(body), ord(kind)) + body

out = b'ULog\x01\x12\x35\x01' + struct.pack('<Q', 0) + message('B', bytes(40))
out += message('F', b'sensor_gyro:uint64_t timestamp;float x;float y;float z;')
k = 0
for subscription, samples in ((0, 400), (1, 600)):
    out += message('A', struct.pack('<BH', 0, subscription) + b'sensor_gyro')
    for _ in range(samples):
        out += message('D', struct.pack('<HQ3f', subscription, 1000 + 5000 * k, k, 0.0, 0.0))
        k += 1
    out += message('R', struct.pack('<H', subscription))
open('gyro.ulg', 'wb').write(out)

log = ULog('gyro.ulg')
sets = [(d.name, d.multi_id, len(d.data['x'])) for d in log.data_list]
one = log.get_dataset('sensor_gyro').data['x']
said = subprocess.run(['venv/bin/ulog2csv', '-o', '.', 'gyro.ulg'], capture_output=True, text=True, check=True).stdout
csv = np.loadtxt('gyro_sensor_gyro_0.csv', delimiter=',', skiprows=1)

print('pyulog', importlib.metadata.version('pyulog'))
print('samples in the file', k)
print('data sets', sets)
print('ulog2csv says:', said.split('\n')[:2])
print('get_dataset: rows', len(one), 'first', one[0], 'last', one[-1])
print('csv        : rows', len(csv), 'first', csv[0, 1], 'last', csv[-1, 1])
assert sorted(sets) == [('sensor_gyro', 0, 400), ('sensor_gyro', 0, 600)]
assert len(one) == 600 and one[0] == 400
assert len(csv) == 400 and csv[-1, 1] == 399
print('SURPRISE: of 1000 samples ulog2csv keeps the first 400, and get_dataset the last 600')
PY
