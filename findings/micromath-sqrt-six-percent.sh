#!/usr/bin/env bash
# One would guess: sqrt and hypot of micromath, which is meant for microcontrollers without a fast FPU, are right to a
# fraction of a percent, as its exp and atan2 nearly are.
# What happens: sqrt halves the exponent in the bits of the number and does no more. It is up to 6 % too large;
# hypot(3, 4) is 5.125. Its own inverse square root errs otherwise.
# Versions: micromath 2.1.0.
# Why it matters: a standard deviation, an Allan deviation or an angle random walk taken from a variance by it is up to 6 % too large,
# by an amount that depends on the unit: the same gyro in deg/s and in rad/s does not differ by pi / 180.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q micromath@=2.1.0
cat >src/main.rs <<'RUST'
use micromath::F32Ext as Fast;
fn main() {
    let mut worst = (0.0f64, 0.0f32);
    for step in 0..200_000 {
        let variance = 1e-6 * 1.0001f32.powi(step);
        let error = f64::from(Fast::sqrt(variance)) / f64::from(variance).sqrt() - 1.0;
        if error.abs() > worst.0.abs() && variance.is_finite() { worst = (error, variance); }
    }
    println!("worst relative error of sqrt: {:+.4} at {:e}", worst.0, worst.1);
    println!("hypot(3, 4) = {}", Fast::hypot(3.0f32, 4.0));
    let variance = 4e-4f32; // of a gyro, in (deg/s)^2
    let degrees = Fast::sqrt(variance);
    let radians = Fast::sqrt(variance * core::f32::consts::PI.powi(2) / 32400.0);
    println!("one gyro: {degrees} deg/s, and {} deg/s by way of rad/s; std: {}", radians * 180.0 / core::f32::consts::PI, variance.sqrt());
    println!("guess: errors below 0.01");
    assert!(worst.0 > 0.05 && worst.0 < 0.07, "sqrt has changed");
    assert!((Fast::hypot(3.0f32, 4.0) - 5.125).abs() < 1e-6, "hypot has changed");
    println!("seen: sqrt of micromath is up to {:.1} % too large", 100.0 * worst.0);
}
RUST
cargo run -q --release
