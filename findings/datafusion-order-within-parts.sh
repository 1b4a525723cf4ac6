#!/usr/bin/env bash
# One would guess: an aggregate of one's own that is called with ORDER BY sees the rows in that order, or DataFusion refuses.
# What happens: each partition sorts its own rows, and their states are merged in whatever order they come,
# one after the other. `array_agg` with the same ORDER BY is right. Over one part, the aggregate is right too.
# Versions: datafusion 55.0.0 (Python), pyarrow 25.0.1.
# Why it matters: an aggregate over differences of neighbours, such as an Allan deviation, joins ends of blocks that were not
# neighbours. A test on one file passes.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check datafusion==55.0.0 pyarrow==25.0.1
venv/bin/python - <<'PY'
import datafusion, pyarrow as pa
from datafusion import Accumulator, SessionConfig, SessionContext, udaf

class Differences(Accumulator):
    """The mean size of the difference between a rate and the next one."""
    def __init__(self):
        self.rates = []
    def update(self, rates, *_order):
        self.rates += rates.to_pylist()
    def state(self):
        return [pa.scalar(self.rates, type=pa.list_(pa.float64()))]
    def merge(self, states):
        column = states[0] if isinstance(states, list) else states
        for rates in column.to_pylist():
            self.rates += rates
    def evaluate(self):
        pairs = zip(self.rates, self.rates[1:])
        return pa.scalar(sum(abs(b - a) for a, b in pairs) / (len(self.rates) - 1))

number = list(range(100_000))
table = pa.table({'t': number, 'gx': [0.5 * t for t in number]})
# The same samples as two interleaved parts, such as two files of which each has every second sample.
parts = [table.take(number[first::2]).to_batches() for first in (0, 1)]
own = udaf(Differences, pa.float64(), pa.float64(), [pa.list_(pa.float64())], 'immutable', name='differences')
seen = {}
for partitions, batches in ((1, [table.to_batches()]), (2, parts)):
    context = SessionContext(SessionConfig().with_target_partitions(partitions))
    context.register_udaf(own)
    context.register_record_batches('log', [*batches])
    row = context.sql('SELECT differences(gx ORDER BY t) AS own, array_agg(gx ORDER BY t) AS list FROM log').to_pylist()[0]
    pairs = list(zip(row['list'], row['list'][1:]))
    seen[len(batches)] = row['own'], sum(abs(b - a) for a, b in pairs) / len(pairs)

print('datafusion', datafusion.__version__, 'pyarrow', pa.__version__)
for parts, (mine, listed) in seen.items():
    print(f'{parts} part(s): mean difference of neighbours {mine:.4f}, from array_agg {listed:.4f}, guess 0.5 in both')
assert abs(seen[1][0] - 0.5) < 1e-9 and all(abs(listed - 0.5) < 1e-9 for _, listed in seen.values())
assert seen[2][0] > 1.2
print(f'SURPRISE: with two parts, ORDER BY gives {seen[2][0] / 0.5:.1f} times the difference of neighbours')
PY
