#!/usr/bin/env bash
# One would guess: ufmt_float, which prints f32 on microcontrollers, prints -0.5 as -0.500, and NaN as a word.
# What happens: it passes the number through unsigned integers. Below zero
# the fraction is lost: -0.5 prints as 0.000 and -1.5 as -1.000. NaN prints as a number near 2^31.
# Versions: ufmt_float 0.2.0 with ufmt 0.2.0.
# Why it matters: in a log over a serial line each small negative rate of a gyro at rest reads 0.000. The record has a
# bias that the gyro lacks and less noise, and the mark of a missing sample is a rate of two thousand million.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q ufmt_float@=0.2.0 ufmt@=0.2.0
cat >src/main.rs <<'RUST'
use ufmt_float::uFmt_f32;
struct Text(String);
impl ufmt::uWrite for Text {
    type Error = core::convert::Infallible;
    fn write_str(&mut self, part: &str) -> Result<(), Self::Error> { self.0.push_str(part); Ok(()) }
}
fn print(value: f32) -> String {
    let mut text = Text(String::new());
    ufmt::uwrite!(&mut text, "{}", uFmt_f32::Three(value)).unwrap();
    text.0
}
fn main() {
    for value in [1.5f32, 0.25, -0.25, -0.5, -1.5, -250.0, f32::NAN] {
        println!("{value}: ufmt_float {}, Rust {value:.3}", print(value));
    }
    println!("guess: the same text in each row");
    assert_eq!(print(1.5), "1.500");
    let lost = [-0.25f32, -0.5].iter().all(|&v| print(v).parse() == Ok(0.0f32));
    assert!(lost, "a rate below zero keeps its sign now");
    assert!(print(f32::NAN).parse::<f64>().is_ok_and(f64::is_finite), "NaN is no longer a number");
    println!("seen: -0.5 becomes {}, and NaN becomes {}", print(-0.5), print(f32::NAN));
}
RUST
cargo run -q --release
