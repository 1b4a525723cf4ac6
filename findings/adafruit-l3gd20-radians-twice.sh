#!/usr/bin/env bash
# One would guess: the L3GD20 driver for CircuitPython gives the same rates over SPI as over I2C, in rad/s.
# What happens: over SPI `gyro_raw` turns counts into radians, and `gyro` does so again after scaling: rates are 57.3 times
# too small. Over I2C they are right.
# Versions: adafruit-circuitpython-l3gd20 2.3.27, Adafruit-Blinka 10.0.0.
# Why it matters: the noise of the gyro is 57 times too small too. It then looks like that of a far better gyro, not like a
# fault, and `gyro_raw` offers no way to check, since it is no count either.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check adafruit-circuitpython-l3gd20==2.3.27 Adafruit-Blinka==10.0.0
venv/bin/python - <<'PY'
import math, struct
from importlib.metadata import version
from adafruit_l3gd20 import L3GD20_I2C, L3GD20_SPI

COUNTS = (1000, -1000, 32767)          # at 250 deg/s: 8.75 mdps a count, by the data sheet

class Chip:
    'The registers of an L3GD20, reached over either bus'
    def __init__(self):
        self.registers = bytearray(64)
        self.registers[0x0F] = 0xD4
        self.registers[0x28:0x2E] = struct.pack('<hhh', *COUNTS)
    def try_lock(self): return True
    def unlock(self): pass

class I2C(Chip):
    def writeto(self, address, buffer, *, start=0, end=None):
        data = bytes(buffer)[start:end]
        if len(data) == 2: self.registers[data[0] & 0x3F] = data[1]
    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        first = out[out_start] & 0x3F
        in_end = len(into) if in_end is None else in_end
        into[in_start:in_end] = self.registers[first:first + in_end - in_start]

class SPI(Chip):
    def configure(self, **_): pass
    def write(self, data):
        self.first = data[0] & 0x3F
        if len(data) == 2 and not data[0] & 0x80: self.registers[self.first] = data[1]
    def readinto(self, buffer):
        buffer[:] = self.registers[self.first:self.first + len(buffer)]

true = [math.radians(0.00875 * count) for count in COUNTS]
i2c = L3GD20_I2C(I2C()).gyro
spi_driver = L3GD20_SPI(SPI(), None)
spi = spi_driver.gyro
print('adafruit-circuitpython-l3gd20', version('adafruit-circuitpython-l3gd20'))
print('counts in the gyro :', COUNTS)
print('rad/s by data sheet:', true)
print('over I2C           :', i2c)
print('over SPI           :', spi)
print('gyro_raw over SPI  :', spi_driver.gyro_raw)
print('guess: the same rates over both')
assert all(math.isclose(a, b) for a, b in zip(i2c, true))
ratio = [a / b for a, b in zip(spi, true)]
assert all(math.isclose(r, math.pi / 180) for r in ratio), 'the conversion over SPI has changed'
print(f'SURPRISE: over SPI each rate is {1 / ratio[0]:.1f} times too small')
PY
