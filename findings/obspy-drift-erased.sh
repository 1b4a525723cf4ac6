#!/usr/bin/env bash
# One would guess: where each record of a MiniSEED file carries its own start time, and each begins 0.4 samples
# later than the nominal rate predicts, the reader shows the true rate or gaps.
# What happens: ObsPy compares each record only with the end of the one before it, joins all within half a
# sample, and gives one trace of exactly the nominal rate. Its last sample is 3.8 s too early after 950 s.
# pymseed, of the same libmseed, keeps the true end beside the same nominal rate.
# Versions: ObsPy 1.5.1, pymseed 1.0.1, numpy 2.4.6.
# Why it matters: the clock of a rotation sensor is wrong by 0.4 %, and the rate and each averaging time with
# it, although the file says so in every record.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check obspy==1.5.1 pymseed==1.0.1 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np, obspy, pymseed
from obspy import Stream, Trace, UTCDateTime

start = UTCDateTime(2026, 1, 1)
records = []
for i in range(950):
    trace = Trace(np.arange(100, dtype='i4') + 100 * i)
    trace.stats.update(dict(network='XX', station='IMU', channel='HJ1', sampling_rate=100.0,
                            starttime=start + i * 1.004))
    records.append(trace)
Stream(records).write('gyro.mseed', format='MSEED', reclen=512)
true_end = 949 * 1.004 + 0.99
read = obspy.read('gyro.mseed')
got = read[-1].stats.endtime - start
(trace_id,) = pymseed.MS3TraceList.from_file('gyro.mseed')
(segment,) = list(trace_id)
other = (segment.endtime - segment.starttime) / 1e9

print('ObsPy', obspy.__version__, 'pymseed', pymseed.__version__)
print('last sample was written at', round(true_end, 3), 's')
print('ObsPy  :', len(read), 'trace,', read[0].stats.npts, 'samples at', read[0].stats.sampling_rate, 'Hz, last at', got, 's')
print('pymseed:', segment.samplecnt, 'samples at', segment.samprate, 'Hz, last at', other, 's')
assert len(read) == 1 and read[0].stats.npts == 95000 and read[0].stats.sampling_rate == 100.0
assert abs(got - 949.99) < 1e-6 and abs(other - true_end) < 1e-3
print(f'SURPRISE: one trace without a gap at 100 Hz, {true_end - got:.2f} s shorter than its own time stamps')
PY
