#!/usr/bin/env bash
# One would guess: the angle between two orientations in f32 is right to a few percent down to a hundredth of a
# milliradian, since their quaternions differ by that much.
# What happens: glam takes an approximate arc cosine of a number next to 1. A milliradian is 20 % too large, a tenth of
# it comes out as seven times as much, and a hundredth as 0. nalgebra gives all three to a percent.
# Versions: glam 0.33.12, nalgebra 0.35.0.
# Why it matters: the drift of an integrated gyro is the angle between two orientations. Below a milliradian it is
# another one or none.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q glam@=0.33.12 nalgebra@=0.35.0
cat >src/main.rs <<'RUST'
fn main() {
    let start = nalgebra::UnitQuaternion::<f32>::from_euler_angles(0.3, -0.2, 1.1);
    let glam = |q: nalgebra::UnitQuaternion<f32>| glam::Quat::from_xyzw(q.i, q.j, q.k, q.w);
    let mut ratios = Vec::new();
    for drift in [1e-1f32, 1e-2, 1e-3, 1e-4, 1e-5] {
        let end = start * nalgebra::UnitQuaternion::from_scaled_axis(nalgebra::Vector3::x() * drift);
        let (by_glam, by_nalgebra) = (glam(start).angle_between(glam(end)), start.angle_to(&end));
        println!("drift of {drift:e} rad: glam {by_glam:e}, nalgebra {by_nalgebra:e}");
        assert!((by_nalgebra / drift - 1.0).abs() < 0.01, "the quaternions do not hold the angle");
        ratios.push(by_glam / drift);
    }
    assert!((ratios[0] - 1.0).abs() < 0.01 && (ratios[1] - 1.0).abs() < 0.01);
    assert!(ratios[2] > 1.1 && ratios[3] > 3.0 && ratios[4] == 0.0, "glam's small angles have changed: {ratios:?}");
    println!("SURPRISE: a drift of 0.1 mrad is {:.2} mrad, and one of 0.01 mrad is 0", 0.1 * ratios[3]);
}
RUST
cargo run -q --release
