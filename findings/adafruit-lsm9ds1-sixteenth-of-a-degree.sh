#!/usr/bin/env bash
# One would guess: the LSM9DS1 driver for CircuitPython gives the temperature of the gyro in degrees Celsius, off by a few
# degrees at most.
# What happens: it drops the four low bits of the right-justified word and divides by 16 as well. The data sheet has 16 counts
# a degree from 25 degC on: ten degrees of warming become 0.6 degrees, in steps of 1/16 degree for each whole one.
# Versions: adafruit-circuitpython-lsm9ds1 2.1.29, Adafruit-Blinka 10.0.0.
# Why it matters: the reading stays near 27 degC in every room, so it looks alive and right. A slope of bias over
# temperature comes out sixteen times too steep, and a warm-up looks like a gyro whose temperature is constant.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check adafruit-circuitpython-lsm9ds1==2.1.29 Adafruit-Blinka==10.0.0
venv/bin/python - <<'PY'
import struct
from importlib.metadata import version
from adafruit_lsm9ds1 import LSM9DS1_I2C

class Chip:
    'An LSM9DS1 whose temperature word is right-justified, 0 at 25 degC and 16 counts a degree; 12 bits with sign extension'
    def __init__(self):
        self.registers = {0x6B: bytearray(128), 0x1E: bytearray(128)}
        self.registers[0x6B][0x0F], self.registers[0x1E][0x0F] = 0x68, 0x3D
    def warm(self, celsius):
        self.registers[0x6B][0x15:0x17] = struct.pack('<h', round(16 * (celsius - 25)))
    def try_lock(self): return True
    def unlock(self): pass
    def writeto(self, address, buffer, *, start=0, end=None):
        data = bytes(buffer)[start:end]
        if len(data) == 2: self.registers[address][data[0] & 0x7F] = data[1]
    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        in_end = len(into) if in_end is None else in_end
        first = out[out_start] & 0x7F
        into[in_start:in_end] = self.registers[address][first:first + in_end - in_start]

chip = Chip()
sensor = LSM9DS1_I2C(chip)
print('adafruit-circuitpython-lsm9ds1', version('adafruit-circuitpython-lsm9ds1'))
celsius = (-10, 10, 25, 40, 70)
seen = []
for true in celsius:
    chip.warm(true)
    seen.append(sensor.temperature)
    print(f'{true:4} degC in the gyro: the driver reads {seen[-1]:.4f}')
slope = (seen[-1] - seen[0]) / (celsius[-1] - celsius[0])
print('guess: 1 degree for each degree')
assert abs(slope - 1 / 16) < 0.002, 'the conversion has changed'
print(f'SURPRISE: {slope:.4f} degrees for each degree; from {celsius[0]} to {celsius[-1]} degC the driver shows {seen[0]:.1f} to {seen[-1]:.1f}')
PY
