#!/usr/bin/env bash
# One would guess: `set_gyro_range` of the driver icm20689 selects the range that it is given, and rates are in its scale.
# What happens: it writes the range into the bits 3:2 of GYRO_CONFIG, where FS_SEL has the bits 4:3. The gyro measures at
# 250 or 500 deg/s, and the driver scales for the range asked for: rates are two or four times too large. Its default,
# 2000 deg/s, runs at 500.
# Versions: icm20689 0.1.1; as a witness of the register mpu9250 0.25.0; embedded-hal 0.2.7.
# Why it matters: noise and bias of a gyro at rest look plausible at four times their size, and full scale is a quarter.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q icm20689@=0.1.1 mpu9250@=0.25.0 embedded-hal@=0.2.7
cat >src/main.rs <<'RUST'
use embedded_hal::{blocking::{delay::DelayMs, spi::{Transfer, Write}}, digital::v2::OutputPin};
use icm20689::{Builder, GyroRange};
use mpu9250::{GyroScale, Mpu9250, MpuConfig};
use std::convert::Infallible;

/// A gyro that turns at 100 deg/s: registers, and counts by the bits 4:3 of GYRO_CONFIG, as both data sheets have them.
struct Chip { registers: [u8; 128] }
impl Chip {
    fn new(who_am_i: u8) -> Self {
        let mut registers = [0; 128];
        registers[0x75] = who_am_i;
        Chip { registers }
    }
}
impl Write<u8> for Chip {
    type Error = Infallible;
    fn write(&mut self, words: &[u8]) -> Result<(), Infallible> {
        let value = if words[0] == 0x6B { words[1] & !0x80 } else { words[1] };
        self.registers[usize::from(words[0])] = value;
        Ok(())
    }
}
impl Transfer<u8> for Chip {
    type Error = Infallible;
    fn transfer<'w>(&mut self, words: &'w mut [u8]) -> Result<&'w [u8], Infallible> {
        let full_scale = f64::from(250u32 << (self.registers[0x1B] >> 3 & 3));
        let counts = ((100.0 / full_scale * 32768.0).round() as i16).to_be_bytes();
        for axis in 0..3 {
            self.registers[0x43 + 2 * axis..][..2].copy_from_slice(&counts);
        }
        let first = usize::from(words[0] & 0x7F);
        let length = words.len() - 1;
        words[1..].copy_from_slice(&self.registers[first..first + length]);
        Ok(words)
    }
}
struct Pin;
impl OutputPin for Pin {
    type Error = Infallible;
    fn set_low(&mut self) -> Result<(), Infallible> { Ok(()) }
    fn set_high(&mut self) -> Result<(), Infallible> { Ok(()) }
}
struct Delay;
impl DelayMs<u8> for Delay { fn delay_ms(&mut self, _: u8) {} }

fn main() {
    let mut driver = Builder::new_spi::<_, _, Infallible, Infallible>(Chip::new(0x98), Pin);
    driver.setup(&mut Delay).expect("setup");
    let mut witness = Mpu9250::imu(Chip::new(0x71), Pin, &mut Delay, &mut MpuConfig::imu()).ok().expect("setup");
    let default = f64::from(driver.get_scaled_gyro().unwrap()[0]).to_degrees();
    println!("a gyro that turns at 100 deg/s; icm20689 after setup: {default:.1} deg/s");
    let ranges = [
        (250, GyroRange::Range_250dps, GyroScale::_250DPS), (500, GyroRange::Range_500dps, GyroScale::_500DPS),
        (1000, GyroRange::Range_1000dps, GyroScale::_1000DPS), (2000, GyroRange::Range_2000dps, GyroScale::_2000DPS),
    ];
    let mut seen = Vec::new();
    for (range, ours, theirs) in ranges {
        driver.set_gyro_range(ours).unwrap();
        let rate = f64::from(driver.get_scaled_gyro().unwrap()[0]).to_degrees();
        witness.gyro_scale(theirs).ok().unwrap();
        let other = f64::from(witness.gyro::<[f32; 3]>().ok().unwrap()[0]).to_degrees();
        println!("range {range:4} deg/s: icm20689 {rate:5.1} deg/s, mpu9250 {other:5.1} deg/s");
        assert!((other - 100.0).abs() < 0.1);
        seen.push((rate / 100.0).round());
    }
    println!("guess: 100 deg/s in each row");
    assert_eq!(seen, [1.0, 2.0, 2.0, 4.0], "the range is written elsewhere now");
    println!("SURPRISE: icm20689 gives {} times the rate at ranges of 250, 500, 1000 and 2000 deg/s",
        seen.iter().map(|x| x.to_string()).collect::<Vec<_>>().join(", "));
}
RUST
cargo run -q --release
