#!/usr/bin/env bash
# One would guess: setting `gyro_range` of the LSM6DSOX driver for MicroPython changes the range of the sensor and the scale.
# What happens: it changes the scale alone; the register keeps 250 deg/s. At 500, 1000 and 2000 deg/s, rates are two, four
# and eight times too large. Reading `gyro_range` back gives what was set, from memory.
# Versions: micropython-lsm6dsox 0.1.0; as a witness of the register adafruit-circuitpython-lsm6ds 4.6.3; Adafruit-Blinka 10.0.0
# for their module `micropython`.
# Why it matters: noise and bias grow with the range that one asks for, and the gyro saturates at 250 deg/s.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check micropython-lsm6dsox==0.1.0 adafruit-circuitpython-lsm6ds==4.6.3 Adafruit-Blinka==10.0.0
venv/bin/python - <<'PY'
import math, struct
from importlib.metadata import version
from adafruit_lsm6ds import GyroRange
from adafruit_lsm6ds.lsm6dsox import LSM6DSOX as Witness
from micropython_lsm6dsox import lsm6dsox

class Chip:
    'An LSM6DSOX that turns at 100 deg/s; its counts follow the bits 3:1 of CTRL2_G, as the data sheet has them'
    MDPS = {0b000: 8.75, 0b001: 4.375, 0b010: 17.5, 0b100: 35, 0b110: 70}
    def __init__(self):
        self.registers = bytearray(128)
        self.registers[0x0F] = 0x6C
    def read(self, first, length):
        counts = round(100e3 / self.MDPS[self.registers[0x11] >> 1 & 7])
        self.registers[0x22:0x28] = struct.pack('<3h', *[min(counts, 32767)] * 3)
        return bytes(self.registers[first:first + length])
    def write(self, first, data):
        self.registers[first:first + len(data)] = data
        self.registers[0x12] &= 0xFE                  # a reset ends at once
    # the bus of MicroPython
    def readfrom_mem(self, address, first, length): return self.read(first, length)
    def writeto_mem(self, address, first, data): self.write(first, data)
    # the bus of CircuitPython
    def try_lock(self): return True
    def unlock(self): pass
    def writeto(self, address, buffer, *, start=0, end=None):
        data = bytes(buffer)[start:end]
        if len(data) > 1: self.write(data[0], data[1:])
    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        in_end = len(into) if in_end is None else in_end
        into[in_start:in_end] = self.read(out[out_start], in_end - in_start)

driver, witness = lsm6dsox.LSM6DSOX(Chip()), Witness(Chip())
print('micropython-lsm6dsox', version('micropython-lsm6dsox'), 'and a gyro that turns at 100 deg/s')
seen = []
for dps in (250, 500, 1000, 2000):
    driver.gyro_range = getattr(lsm6dsox, f'RANGE_{dps}_DPS')
    witness.gyro_range = getattr(GyroRange, f'RANGE_{dps}_DPS')
    rate, other = math.degrees(driver.gyro[0]), math.degrees(witness.gyro[0])
    print(f'range {dps:4}: {driver.gyro_range:14} {rate:6.1f} deg/s, adafruit-circuitpython-lsm6ds {other:5.1f} deg/s')
    assert abs(other - 100) < 0.1
    seen.append(round(rate / 100))
print('guess: 100 deg/s in each row')
assert seen == [1, 2, 4, 8], 'the range is written now'
print('SURPRISE: rates are', ', '.join(map(str, seen)), 'times the true ones at ranges of 250, 500, 1000 and 2000 deg/s')
PY
