#!/usr/bin/env bash
# One would guess: `FXAS21002(bw=25)` of nxp-imu runs the gyro at 25 Hz, and bw=800 at 800 Hz.
# What happens: the table of its register is written in the reverse order: 25 Hz becomes 800 Hz, 800 Hz becomes 25 Hz, and the
# default of 100 Hz becomes 200 Hz. The comment in the same file has the right order.
# Versions: nxp-imu 0.6.2; as a witness of the register adafruit-circuitpython-fxas21002c 3.0.10; smbus2 0.6.1, Adafruit-Blinka 10.0.0.
# Why it matters: the averaging times of each coefficient follow from the rate, and the low-pass follows the rate too. Where it is 200 Hz
# instead of 100 Hz, angle random walk comes out 1.41 times too large and rate random walk 1.41 times too small.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check nxp-imu==0.6.2 smbus2==0.6.1 adafruit-circuitpython-fxas21002c==3.0.10 Adafruit-Blinka==10.0.0
venv/bin/python - <<'PY'
from importlib import import_module
from importlib.metadata import version
from adafruit_fxas21002c import FXAS21002C as Witness
i2c_module, nxp = import_module('nxp_imu.I2C'), import_module('nxp_imu.FXAS21002')

HERTZ = {0: 800, 1: 400, 2: 200, 3: 100, 4: 50, 5: 25, 6: 12.5, 7: 12.5}   # DR, bits 4:2 of CTRL_REG1, by the data sheet

class Chip:
    'The registers of an FXAS21002C on a bus of smbus2 and on one of CircuitPython'
    def __init__(self, bus=None):
        self.registers = bytearray(32)
        self.registers[0x0C] = 0xD7
        Chip.last = self
    def rate(self): return HERTZ[self.registers[0x13] >> 2 & 7]
    def read_byte_data(self, address, register): return self.registers[register]
    def write_byte_data(self, address, register, value): self.registers[register] = value
    def close(self): pass
    def try_lock(self): return True
    def unlock(self): pass
    def writeto(self, address, buffer, *, start=0, end=None):
        data = bytes(buffer)[start:end]
        if len(data) == 2: self.registers[data[0]] = data[1]
    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        in_end = len(into) if in_end is None else in_end
        into[in_start:in_end] = self.registers[out[out_start]:out[out_start] + in_end - in_start]

i2c_module.SMBus = Chip                  # the wires end in a simulated gyro
print('nxp-imu', version('nxp-imu'))
seen = {}
for asked in (25, 50, 100, 200, 400, 800):
    driver = nxp.FXAS21002(dps=250, bw=asked)
    seen[asked] = Chip.last.rate()
    print(f'asked for {asked:3} Hz: the gyro runs at {seen[asked]} Hz')
witness = Chip()
Witness(witness)
print(f'adafruit-circuitpython-fxas21002c, which says 100 Hz: {witness.rate()} Hz')
print('guess: each rate as asked for')
assert witness.rate() == 100
assert seen == {25: 800, 50: 400, 100: 200, 200: 100, 400: 50, 800: 25}, 'the table has changed'
print('SURPRISE: asked for', ', '.join(map(str, seen)), 'Hz the gyro runs at', ', '.join(map(str, seen.values())), 'Hz')
PY
