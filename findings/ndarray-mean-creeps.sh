#!/usr/bin/env bash
# One would guess: mean of a one-dimensional ndarray of f32 keeps its rounding errors small, so ten million rates of 0.1 deg/s
# have the mean 0.1 to six digits, and mean_axis does so for three columns.
# What happens: the mean is 0.1011, and mean_axis of three columns near 1000 is 1009: sums of f32 grow until what is added
# is rounded away.
# Versions: ndarray 0.17.2.
# Why it matters: the bias of a long record in f32 is wrong by one percent, and nothing says so.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q ndarray@=0.17.2
cat >src/main.rs <<'RUST'
use ndarray::{Array1, Array2, Axis};
fn main() {
    let single = Array1::<f32>::from_elem(10_000_000, 0.1).mean().unwrap();
    // Three axes, a million rows, alternately 999.9 and 1000.1 counts.
    let rows = Array2::<f32>::from_shape_fn((1_000_000, 3), |(row, _)| if row % 2 == 0 { 1000.1 } else { 999.9 });
    let axes = rows.mean_axis(Axis(0)).unwrap();
    let wide = rows.mapv(f64::from).mean_axis(Axis(0)).unwrap();
    println!("mean of 10000000 times 0.1 in f32: {single}");
    println!("mean_axis of a million rows near 1000: f32 {axes}, f64 {wide}");
    println!("guess: 0.1 and 1000 to six digits");
    assert!((single - 0.1).abs() > 5e-4, "mean has become more accurate");
    assert!((axes[0] - 1000.0).abs() > 1.0, "mean_axis has become more accurate");
    println!("seen: errors of {:.2} % and {:.2} %", 1e3 * (single - 0.1), 0.1 * (axes[0] - 1000.0));
}
RUST
cargo run -q --release
