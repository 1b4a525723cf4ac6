#!/usr/bin/env bash
# One would guess: NaN is treated alike wherever it comes from: above all numbers, as the NaN of a file is in DataFusion.
# What happens: on x86, 0/0 has its sign bit set, and DataFusion puts it below all numbers. It is the minimum, the maximum
# does not show it, it sorts first, passes a filter `< 100` and not `> 100`, and is another group than the NaN of a file.
# Versions: datafusion 55.0.0 (Python), pyarrow 25.0.1, on x86-64.
# Why it matters: a rate from angles is 0/0 where a gyro at rest repeats a stamp. A filter against spikes of the one sign lets
# it pass, and the same query on ARM, where 0/0 has no sign, drops other rows.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
if [ "$(uname -m)" != x86_64 ]; then echo "the sign of 0/0 is that of x86-64"; exit 1; fi
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check datafusion==55.0.0 pyarrow==25.0.1
venv/bin/python - <<'PY'
import datafusion, math, pyarrow as pa
from datafusion import SessionContext

NAN = float('nan')
context = SessionContext()
table = pa.table({
    'turned': [0.0, 0.1, 0.2], 'passed': [0.0, 0.1, 0.1],  # the first stamp came twice
    'filed': pa.array([NAN, 1.0, 2.0], from_pandas=False),
})
context.register_record_batches('log', [table.to_batches()])
context.sql('CREATE VIEW rates AS SELECT turned / passed AS divided, filed FROM log')
found = {}
for name in ('divided', 'filed'):
    ask = lambda query: context.sql(query.format(name)).to_pydict()['x']
    found[name] = [
        ask('SELECT min({}) AS x FROM rates')[0], ask('SELECT max({}) AS x FROM rates')[0],
        ask('SELECT {0} AS x FROM rates ORDER BY {0}')[0],
        ask('SELECT count(*) AS x FROM rates WHERE {} < 100')[0], ask('SELECT count(*) AS x FROM rates WHERE {} > 100')[0],
    ]
groups = context.sql('SELECT count(DISTINCT x) AS x FROM (SELECT divided AS x FROM rates UNION ALL SELECT filed FROM rates)')
groups = groups.to_pydict()['x'][0]
print('datafusion', datafusion.__version__, 'pyarrow', pa.__version__)
for name, values in found.items():
    print(f'{name:8} min, max, first in order, rows < 100, rows > 100:', *values)
print('different values of 1, 2 and the two NaN:', groups, 'guess 3')
low = found['divided']
assert math.isnan(found['filed'][1]) and found['filed'][0] == 1.0 and found['filed'][3:] == [2, 1]
assert math.isnan(low[0]) and low[1] == 2.0 and math.isnan(low[2]) and low[3:] == [3, 0] and groups == 4
print('SURPRISE: the NaN of a file is the greatest rate, and that of 0/0 the lowest')
PY
