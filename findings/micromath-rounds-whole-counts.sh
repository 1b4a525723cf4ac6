#!/usr/bin/env bash
# One would guess: round, floor and ceil of a whole number in f32 is that number.
# What happens: round of micromath moves each odd number from 8388609 to 16777215 by one, and from 2147483648 on all three
# give 2147483648 for every number. trunc is right.
# Versions: micromath 2.1.0.
# Why it matters: unsigned readings of 24-bit converters pass 8388609, and time stamps in microseconds pass 2147483648
# after 36 minutes: all of them then fall into one block.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q micromath@=2.1.0
cat >src/main.rs <<'RUST'
use micromath::F32Ext as Fast;
fn main() {
    let mut moved = 0;
    for whole in [1.0f32, 4_194_305.0, 8_388_607.0, 8_388_609.0, 12_345_679.0, 16_777_215.0, 2_147_483_648.0, 3e9, 4e9] {
        let (round, floor, ceil, trunc) = (Fast::round(whole), Fast::floor(whole), Fast::ceil(whole), Fast::trunc(whole));
        println!("{whole}: round {round}, floor {floor}, ceil {ceil}, trunc {trunc}; Rust {} {} {}", whole.round(), whole.floor(), whole.ceil());
        moved += usize::from(round != whole);
        assert_eq!(trunc, whole);
    }
    let odd = (8_388_609..16_777_216).step_by(2);
    let off = odd.clone().filter(|&count| Fast::round(count as f32) != count as f32).count();
    println!("odd whole numbers of 24 bits that round moves: {off} of {}", odd.count());
    assert!(moved >= 4 && off > 1_000_000, "round has changed");
    assert!(Fast::floor(3e9f32) < 2.2e9 && Fast::ceil(3e9f32) < 2.2e9, "floor or ceil has changed");
    println!("SURPRISE: {moved} of 9 whole numbers are not their own round, and floor of 3e9 is {}", Fast::floor(3e9f32));
}
RUST
cargo run -q --release
