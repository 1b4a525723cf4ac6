#!/usr/bin/env bash
# One would guess: ln of micromath gives minus infinity for zero and NaN for a negative number, as that of
# Rust does.
# What happens: it reads exponent and fraction from the bits and gives plain numbers: -88.03 for zero, and 6.54 for -1.
# Near one, where ln itself is near zero, its error is large: ln(1.001) is 0.00106, and ln(0.999) twice what it should be.
# Versions: micromath 2.1.0.
# Why it matters: slopes of Allan deviations are fitted to logarithms. An empty octave, whose deviation is zero, and a
# mark below zero both enter the fit as finite points.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q micromath@=2.1.0
cat >src/main.rs <<'RUST'
use micromath::F32Ext as Fast;
fn main() {
    for x in [0.0f32, -1.0, -1e-3, f32::NAN, f32::INFINITY, 1.001, 0.999] {
        println!("ln({x}): micromath {}, Rust {}", Fast::ln(x), x.ln());
    }
    println!("guess: the same in each row to 0.1 %");
    assert!(Fast::ln(0.0f32).is_finite() && Fast::ln(-1.0f32).is_finite(), "micromath keeps the marks now");
    let relative = Fast::ln(1.001f32) / 1.001f32.ln() - 1.0;
    assert!(relative > 0.03, "ln near one has changed");
    println!("seen: ln of zero and of -1 is finite, and ln(1.001) is {:.1} % too large", 100.0 * relative);
}
RUST
cargo run -q --release
