#!/usr/bin/env bash
# One would guess: a driver reads the six bytes of a gyro in one transfer, as the chip's shadow registers want it, so that the
# two bytes of a count are of one sample.
# What happens: the driver icm42670 reads each byte in a transfer of its own. A sample that comes between the two bytes of an
# axis gives a count of neither: 0 after -1 reads as -256. At rest, where counts change their sign all the time, polling at
# 200 Hz over a bus of 400 kHz makes the noise six times as large; nothing is returned that says so.
# Versions: icm42670 0.2.0, embedded-hal 1.0.0, rand 0.8.5, rand_distr 0.4.3.
# Why it matters: the noise density of a healthy gyro is then that of its driver: it depends on the speed of the bus, and on how
# near to zero the gyro's offset is.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q icm42670@=0.2.0 embedded-hal@=1.0.0 rand@=0.8.5 rand_distr@=0.4.3
cat >src/main.rs <<'RUST'
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use icm42670::{Address, Icm42670};
use rand::{rngs::StdRng, SeedableRng};
use rand_distr::{Distribution, Normal};
use std::{cell::RefCell, convert::Infallible, rc::Rc};

/// A chip at rest: registers, and white noise of 8 counts at 806 Hz, whose clock is 0.75 % fast, in 0x11 to 0x16. The bytes of one transfer are of one sample.
struct Chip { registers: [u8; 128], seconds: f64, samples: u64, noise: StdRng }
impl Chip {
    fn pass(&mut self, seconds: f64) {
        self.seconds += seconds;
        while (self.samples as f64) < self.seconds * 806.0 {
            self.samples += 1;
            let normal = Normal::new(0.0, 8.0).unwrap();
            for axis in 0..3 {
                let count = (normal.sample(&mut self.noise) as f64).round() as i16;
                self.registers[0x11 + 2 * axis..][..2].copy_from_slice(&count.to_be_bytes());
            }
        }
    }
}
/// A bus of 400 kHz: nine clocks a byte.
#[derive(Clone)]
struct Bus(Rc<RefCell<Chip>>);
impl ErrorType for Bus { type Error = Infallible; }
impl I2c for Bus {
    fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), Infallible> {
        let mut chip = self.0.borrow_mut();
        let (mut first, mut bytes) = (0, 0);
        for operation in operations {
            match operation {
                Operation::Write(sent) => {
                    first = usize::from(sent[0]);
                    chip.registers[first..][..sent.len() - 1].copy_from_slice(&sent[1..]);
                    bytes += 1 + sent.len();
                }
                Operation::Read(to) => {
                    to.copy_from_slice(&chip.registers[first..][..to.len()]);
                    bytes += 1 + to.len();
                }
            }
        }
        chip.pass(bytes as f64 * 9.0 / 400e3);
        Ok(())
    }
}

fn deviation(counts: &[f64]) -> f64 {
    let mean = counts.iter().sum::<f64>() / counts.len() as f64;
    (counts.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / counts.len() as f64).sqrt()
}

fn main() {
    let mut registers = [0; 128];
    registers[0x75] = 0x67;
    let chip = Chip { registers, seconds: 0.0, samples: 0, noise: StdRng::seed_from_u64(1) };
    let bus = Bus(Rc::new(RefCell::new(chip)));
    let mut driver = Icm42670::new(bus.clone(), Address::Primary).ok().expect("the chip answers");
    let (mut theirs, mut whole) = (Vec::new(), Vec::new());
    for poll in 0..20_000_u32 {
        let due = f64::from(poll) / 200.0 - bus.0.borrow().seconds;
        bus.0.borrow_mut().pass(due.max(0.0));
        theirs.push(f64::from(driver.gyro_raw().ok().unwrap().x));
        let mut six = [0; 6];
        bus.clone().write_read(0x68, &[0x11], &mut six).unwrap();
        whole.push(f64::from(i16::from_be_bytes([six[0], six[1]])));
    }
    let far = |counts: &[f64]| counts.iter().filter(|x| x.abs() > 100.0).count();
    let (theirs_rms, whole_rms) = (deviation(&theirs), deviation(&whole));
    println!("20000 reads of a gyro with a noise of 8 counts, beyond 100 counts: driver {}, one transfer {}", far(&theirs), far(&whole));
    println!("guess: noise of 8.0 counts; one transfer {whole_rms:.1}, driver {theirs_rms:.1}");
    assert!(far(&whole) == 0 && (whole_rms - 8.0).abs() < 0.2);
    assert!(far(&theirs) > 200 && theirs_rms > 2.0 * whole_rms, "both bytes are of one sample now");
    println!("SURPRISE: icm42670 gives {theirs_rms:.0} counts of noise where the gyro has {whole_rms:.0}: {} of 20000 counts are of two samples",
        far(&theirs));
}
RUST
cargo run -q --release
