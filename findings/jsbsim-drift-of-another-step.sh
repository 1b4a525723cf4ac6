#!/usr/bin/env bash
# One would guess: `drift_rate` of a sensor in JSBSim is per second, whatever time step the simulation has.
# What happens: a sensor keeps the time step that was set when the model was loaded, 1/120 s by default. `set_dt` after
# `load_model` changes the time of the simulation, and neither the drift nor the lag of its sensors: at 1000 Hz a gyro drifts 8.3
# times as fast as asked for.
# Versions: jsbsim 1.3.3, numpy 2.4.6.
# Why it matters: the rate ramp of the simulated gyro scales with its output rate, and its low-pass too, without a word. A filter
# that passes on it has met another gyro.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check jsbsim==1.3.3 numpy==2.4.6
venv/bin/python - > out.txt <<'PY'
import shutil
from pathlib import Path
import jsbsim

# a ball of the package, with a gyro of its own
root = Path('root')
for name in ('aircraft/gyro', 'engine', 'systems'):
    (root / name).mkdir(parents=True)
shutil.copy(Path(jsbsim.get_default_root_dir()) / 'aircraft/ball/reset00.xml', root / 'aircraft/gyro')
ball = (Path(jsbsim.get_default_root_dir()) / 'aircraft/ball/ball.xml').read_text()
gyro = '''<system name="imu"><property value="1">imu/rate</property><channel name="gyro">
  <sensor name="drifting"><input>imu/rate</input><drift_rate>0.01</drift_rate><output>imu/drifting</output></sensor>
  <sensor name="slow"><input>imu/rate</input><lag>2</lag><output>imu/slow</output></sensor>
</channel></system>'''
(root / 'aircraft/gyro/gyro.xml').write_text(ball.replace('</fdm_config>', gyro + '</fdm_config>'))

def simulate(step, load_first):
    model = jsbsim.FGFDMExec(str(root))
    model.set_debug_level(0)
    if load_first:
        model.load_model('gyro')
        model.set_dt(step)
    else:
        model.set_dt(step)
        model.load_model('gyro')
    model['ic/h-sl-ft'] = 1000
    model.run_ic()
    begin, drift = model.get_sim_time(), model['imu/drifting']
    model['imu/rate'] = 0
    model.run()
    model['imu/rate'] = 1
    while model['imu/slow'] < 0.632:                     # the time constant of a lag of 2/s is half a second
        model.run()
    constant = model.get_sim_time() - begin
    while model.get_sim_time() - begin < 10:
        model.run()
    return (model['imu/drifting'] - drift) / 10, constant

print('\nRESULT jsbsim', jsbsim.__version__)
for hertz in (100, 200, 1000):
    right, late = simulate(1 / hertz, False), simulate(1 / hertz, True)
    print(f'RESULT {hertz:4} Hz: drift {right[0]:.4f}/s when set_dt comes before load_model, {late[0]:.4f}/s when it comes after;'
          f' time constant of the lag {right[1]:.3f} s and {late[1]:.3f} s')
    assert abs(right[0] - 0.01) < 0.0002
    assert abs(right[1] - 0.5) < 0.02 and abs(late[1] / (0.5 * 120 / hertz) - 1) < 0.05
    assert abs(late[0] / (0.01 * hertz / 120) - 1) < 0.02, 'sensors follow set_dt now'
print('RESULT guess: 0.0100/s and 0.5 s in each place')
print(f'RESULT SURPRISE: at 1000 Hz the gyro drifts {late[0] / right[0]:.1f} times as fast when the step is set after loading')
PY
grep '^RESULT' out.txt | sed 's/^RESULT //'
