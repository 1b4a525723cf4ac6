#!/usr/bin/env bash
# One would guess: the low-pass filters of the crate biquad in f32 have a gain of one at zero frequency to four digits, and its two
# forms agree.
# What happens: the lower the cutoff, the worse. At a thousandth of the rate of sampling, the direct form 1 settles 0.2 %
# too high; at a ten-thousandth, the transposed direct form 2 settles 17 % too low and stays there.
# Versions: biquad 0.6.0.
# Why it matters: a slow low-pass before a bias estimate scales bias and bias instability. The error looks like a scale
# factor of the gyro and hides in f64 on a workstation.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q biquad@=0.6.0
cat >src/main.rs <<'RUST'
use biquad::*;
fn main() {
    let mut worst = [0.0f32; 2];
    for cutoff in [10.0f32, 1.0, 0.1] {
        let single = Coefficients::<f32>::from_params(Type::LowPass, 1000f32.hz(), cutoff.hz(), Q_BUTTERWORTH_F32).unwrap();
        let double = Coefficients::<f64>::from_params(Type::LowPass, 1000f64.hz(), f64::from(cutoff).hz(), Q_BUTTERWORTH_F64).unwrap();
        let (mut one, mut two, mut wide) = (DirectForm1::new(single), DirectForm2Transposed::new(single), DirectForm1::new(double));
        let mut out = (0.0, 0.0, 0.0);
        for _ in 0..400_000 { out = (one.run(1.0), two.run(1.0), wide.run(1.0)); }
        println!("cutoff {cutoff} Hz at 1000 Hz: after 400 s of 1, form 1 {}, form 2 {}, form 1 in f64 {}", out.0, out.1, out.2);
        assert!((out.2 - 1.0).abs() < 1e-6);
        worst = [worst[0].max((out.0 - 1.0).abs()), worst[1].max((out.1 - 1.0).abs())];
    }
    println!("guess: 1.0000 in each column");
    assert!(worst[0] > 1e-3 && worst[1] > 0.1, "the filters have become more accurate");
    println!("seen: errors up to {:.2} % in form 1 and {:.1} % in form 2", 100.0 * worst[0], 100.0 * worst[1]);
}
RUST
cargo run -q --release
