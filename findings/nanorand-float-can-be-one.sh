#!/usr/bin/env bash
# One would guess: a random f32 of nanorand is less than 1, as that of oorandom is.
# What happens: it is a u32 over the greatest u32, in f32: about three of a hundred million are exactly 1. The logarithm
# of one minus such a number is minus infinity.
# Versions: nanorand 0.8.0, oorandom 11.1.5.
# Why it matters: simulated noise by the method of Box and Muller then has an infinite rate, once in some hours of three
# axes at a kilohertz, and all sums after it are lost.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q nanorand@=0.8.0 --no-default-features --features wyrand
cargo add -q oorandom@=11.1.5
cat >src/main.rs <<'RUST'
use nanorand::{Rng, WyRand};
fn main() {
    const NUMBERS: u32 = 300_000_000;
    let mut generator = WyRand::new_seed(1);
    let ones = (0..NUMBERS).filter(|_| generator.generate::<f32>() >= 1.0).count();
    let mut other = oorandom::Rand32::new(1);
    let greatest = (0..NUMBERS).map(|_| other.rand_float()).fold(0.0f32, f32::max);
    let mut generator = WyRand::new_seed(1);
    let infinite = (0..NUMBERS / 2)
        .map(|_| (-2.0 * (1.0 - generator.generate::<f32>()).ln()).sqrt() * (core::f32::consts::TAU * generator.generate::<f32>()).cos())
        .filter(|rate| rate.is_infinite())
        .count();
    println!("numbers of {NUMBERS} that are 1: nanorand {ones}, guess 0; greatest of oorandom {greatest}");
    println!("infinite rates of {} by Box and Muller: {infinite}", NUMBERS / 2);
    assert!(greatest < 1.0);
    assert!(ones > 0 && infinite > 0, "nanorand's floats have changed");
    println!("SURPRISE: {ones} of {NUMBERS} numbers below 1 are 1, and {infinite} rates are infinite");
}
RUST
cargo run -q --release
