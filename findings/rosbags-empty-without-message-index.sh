#!/usr/bin/env bash
# One would guess: rosbags reads all messages of an MCAP file whose chunks have a chunk index but no message
# index (the specification makes both optional), or refuses it, as it refuses one without any index that is out
# of order.
# What happens: rosbags states the number of messages and then yields none. The reader of the mcap package
# yields all of them.
# Versions: rosbags 0.11.9, mcap 1.6.0.
# Why it matters: a recorder that leaves out message indices to save flash gives an empty record of an IMU, and
# a script that converts bags in a batch writes an empty table without an error.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check rosbags==0.11.9 mcap==1.6.0
venv/bin/python - <<'PY'
import importlib.metadata, struct
from pathlib import Path
from mcap.reader import make_reader
from mcap.writer import IndexType, Writer
from rosbags.highlevel import AnyReader

definition = b'geometry_msgs/Vector3 angular_velocity\n' + b'=' * 80 + b'''
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
'''

def write(name, indices):
    with open(name, 'wb') as file:
        writer = Writer(file, chunk_size=1000, index_types=indices)
        writer.start(profile='ros2', library='test')
        schema = writer.register_schema('board_msgs/msg/Gyro', 'ros2msg', definition)
        channel = writer.register_channel('/gyro', 'cdr', schema)
        for i in range(100):
            writer.add_message(channel, i * 10_000_000, b'\0\1\0\0' + struct.pack('<3d', i, 0, 0), i * 10_000_000, i)
        writer.finish()

print('rosbags', importlib.metadata.version('rosbags'), 'mcap', importlib.metadata.version('mcap'))
found = {}
for name, indices in (('all.mcap', IndexType.ALL), ('chunk.mcap', IndexType.CHUNK)):
    write(name, indices)
    with open(name, 'rb') as file:
        by_mcap = sum(1 for _ in make_reader(file).iter_messages())
    with AnyReader([Path(name)]) as reader:
        stated = reader.message_count
        by_rosbags = sum(1 for _ in reader.messages())
    found[name] = by_mcap, stated, by_rosbags
    print(f'{name:11} mcap reads {by_mcap}; rosbags states {stated} and reads {by_rosbags}')
assert found['all.mcap'] == (100, 100, 100)
assert found['chunk.mcap'][0] == 100 and found['chunk.mcap'][2] == 0
print('SURPRISE: rosbags reads', found['chunk.mcap'][2], 'of', found['chunk.mcap'][0], 'messages, without an error')
PY
