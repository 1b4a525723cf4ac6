#!/usr/bin/env bash
# One would guess: pyxdf keeps a gap of a second in the time stamps of an LSL recording; its smoothing of times
# removes jitter only.
# What happens: the default `dejitter_times=True` breaks a stream only where a gap is longer than one second AND
# longer than 500 samples. At 100 Hz it spreads a gap of 4 s evenly over the whole recording: all steps are
# equal, and the rate is wrong.
# Versions: pyxdf 1.17.5, numpy 2.4.6.
# Why it matters: the lost samples cannot be seen any more, the rows before and after the gap are joined, and
# the rate is low by 9 % in a record of a minute.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pyxdf==1.17.5 numpy==2.4.6
venv/bin/python - <<'PY'
import importlib.metadata, struct
import numpy as np, pyxdf

def chunk(tag, content):
    body = struct.pack('<H', tag) + content
    return b'\x04' + struct.pack('<I', len(body)) + body

def write(times):
    head = (b'<?xml version="1.0"?><info><name>imu</name><type>gyro</type><channel_count>1</channel_count>'
            b'<nominal_srate>100</nominal_srate><channel_format>int16</channel_format><desc/></info>')
    out = b'XDF:' + chunk(1, b'<?xml version="1.0"?><info><version>1.0</version></info>')
    out += chunk(2, struct.pack('<I', 1) + head)
    for i in range(0, len(times), 100):
        part = times[i:i + 100]
        rows = b''.join(b'\x08' + struct.pack('<dh', t, k) for k, t in enumerate(part))
        out += chunk(3, struct.pack('<I', 1) + b'\x04' + struct.pack('<I', len(part)) + rows)
    out += chunk(6, struct.pack('<I', 1) + b'<?xml version="1.0"?><info/>')
    open('gyro.xdf', 'wb').write(out)

print('pyxdf', importlib.metadata.version('pyxdf'))
largest = {}
for gap in (1.0, 4.0, 6.0):
    times = 100 + np.arange(6000) * 0.01
    times[3000:] += gap
    write(times)
    (stream,), _ = pyxdf.load_xdf('gyro.xdf')
    step = np.diff(stream['time_stamps'])
    largest[gap] = step.max()
    print(f'gap of {gap} s: largest step {step.max():.5f} s, rate {1 / np.median(step):.2f} Hz, '
          f'largest change of a stamp {abs(stream["time_stamps"] - times).max():.2f} s')
print('guess: the largest step is the gap')
assert largest[1.0] < 0.011 and largest[4.0] < 0.0111 and largest[6.0] > 6.0
print('SURPRISE: a gap of 4 s leaves no step longer than', round(largest[4.0], 4), 's')
PY
