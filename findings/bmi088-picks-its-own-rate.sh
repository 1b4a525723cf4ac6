#!/usr/bin/env bash
# One would guess: the driver bmi088, whose `set_bandwidth` takes the data rate in Hz and whose `set_range` takes deg/s, sets what it
# is asked for, or returns an error.
# What happens: it knows two rates and has them the wrong way round: 2000 Hz for anything below 2000, and 1000 Hz for 2000. `setup` asks
# for 1000 Hz and gets 2000. Each range below 2000 deg/s becomes 1000. It always returns Ok.
# Versions: bmi088 0.2.1, embedded-hal 1.0.0.
# Why it matters: samples come at twice the rate that the record is analysed with, so angle random walk is wrong by the root of
# two; counts of a range of 125 deg/s, scaled by its data sheet, are rates eight times too small. The driver returns counts, so
# nothing else tells the range.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q bmi088@=0.2.1 embedded-hal@=1.0.0
cat >src/main.rs <<'RUST'
use bmi088::Builder;
use embedded_hal::{delay::DelayNs, spi::{ErrorType, Operation, SpiDevice}};
use std::{cell::RefCell, convert::Infallible, rc::Rc};

/// The registers of a BMI088's gyro; its data sheet decodes GYRO_RANGE (0x0F) and GYRO_BANDWIDTH (0x10).
#[derive(Clone)]
struct Chip(Rc<RefCell<[u8; 128]>>);
impl Chip {
    fn range(&self) -> u32 { [2000, 1000, 500, 250, 125][usize::from(self.0.borrow()[0x0F])] }
    fn rate(&self) -> u32 { [2000, 2000, 1000, 400, 200, 100, 200, 100][usize::from(self.0.borrow()[0x10] & 7)] }
}
impl ErrorType for Chip { type Error = Infallible; }
impl SpiDevice for Chip {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for operation in operations {
            let Operation::TransferInPlace(bytes) = operation else { unreachable!() };
            let first = usize::from(bytes[0] & 0x7F);
            if bytes[0] & 0x80 == 0 {
                self.0.borrow_mut()[first] = bytes[1];
            } else {
                let length = bytes.len() - 1;
                bytes[1..].copy_from_slice(&self.0.borrow()[first..first + length]);
            }
        }
        Ok(())
    }
}
struct Delay;
impl DelayNs for Delay { fn delay_ns(&mut self, _: u32) {} }

fn main() {
    let chip = Chip(Rc::new(RefCell::new([0; 128])));
    chip.0.borrow_mut()[0x00] = 0x0F;
    let mut gyro = Builder::new_gyro_spi::<_, Infallible>(chip.clone());
    gyro.setup(&mut Delay).unwrap();
    println!("after setup, which asks for 1000 Hz: {} Hz, range {} deg/s", chip.rate(), chip.range());
    assert_eq!(chip.rate(), 2000);
    let rates: Vec<_> = [100, 400, 1000, 2000].map(|hertz| {
        gyro.set_bandwidth(hertz).unwrap();
        println!("asked for {hertz:4} Hz: Ok, and the gyro runs at {} Hz", chip.rate());
        chip.rate()
    }).into();
    let ranges: Vec<_> = [125, 250, 500, 1000, 2000].map(|dps| {
        gyro.set_range(dps).unwrap();
        println!("asked for {dps:4} deg/s: Ok, and the range is {} deg/s", chip.range());
        chip.range()
    }).into();
    println!("guess: as asked for, or an error");
    assert_eq!(rates, [2000, 2000, 2000, 1000], "the rates have changed");
    assert_eq!(ranges, [1000, 1000, 1000, 1000, 2000], "the ranges have changed");
    println!("SURPRISE: 1000 Hz runs at 2000 Hz and 2000 Hz at 1000 Hz; a range of 125 deg/s is 1000 deg/s");
}
RUST
cargo run -q --release 2>build.log || { cat build.log; exit 1; }
