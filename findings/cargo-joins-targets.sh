#!/usr/bin/env bash
# One would guess: a dependency's feature asked for under `[target.'cfg(target_arch = "arm")'.dependencies]` is on for
# Arm alone, also when one `cargo build` has several `--target`, as resolver 2 promises and `cargo tree` shows.
# What happens: with two `--target` flags, cargo compiles the dependency for RISC-V with Arm's feature too, although
# `cargo tree --target` of RISC-V lacks it. With one flag each, both builds are as written.
# Versions: cargo 1.95.0.
# Why it matters: images of a firmware for two architectures change by being built together: single precision,
# say, slips from one into the other, and the coefficients of the other differ.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cargo=(cargo)
if command -v rustup >/dev/null && rustup toolchain list | grep -q '^1\.95\.0'; then cargo=(cargo +1.95.0); fi
"${cargo[@]}" --version
for target in thumbv7em-none-eabi riscv32imc-unknown-none-elf; do
  if command -v rustup >/dev/null; then rustup -q target add "$target" 2>/dev/null; fi
done
mkdir -p "$dir/maths/src" "$dir/image/src"
printf '[workspace]\nmembers = ["maths", "image"]\nresolver = "2"\n' >"$dir/Cargo.toml"
printf '[package]\nname = "maths"\nversion = "0.1.0"\nedition = "2021"\n[features]\nsingle = []\n' >"$dir/maths/Cargo.toml"
printf '#![no_std]\n#[cfg(feature = "single")]\npub type Real = f32;\n#[cfg(not(feature = "single"))]\npub type Real = f64;\n' >"$dir/maths/src/lib.rs"
printf '#![no_std]\npub static VALUE: maths::Real = 0.5;\n' >"$dir/image/src/lib.rs"
cat >"$dir/image/Cargo.toml" <<'TOML'
[package]
name = "image"
version = "0.1.0"
edition = "2021"
[dependencies]
maths = { path = "../maths" }
[target.'cfg(target_arch = "arm")'.dependencies]
maths = { path = "../maths", features = ["single"] }
TOML
cd "$dir"
# Prints yes or no: whether the compiler was called for RISC-V's copy of maths with the feature.
single() {
  rm -rf target
  "${cargo[@]}" build -v -p image "$@" 2>&1 | grep -E -- 'crate-name maths .*--target riscv32imc-unknown-none-elf' >calls
  if grep -q 'feature="single"' calls; then echo yes; else echo no; fi
}
alone=$(single --target riscv32imc-unknown-none-elf)
both=$(single --target riscv32imc-unknown-none-elf --target thumbv7em-none-eabi)
if "${cargo[@]}" tree -q -p image -e features --target riscv32imc-unknown-none-elf | grep -q single; then tree=yes; else tree=no; fi
echo "feature of Arm in the RISC-V copy: built alone $alone, built with Arm $both, in cargo tree $tree"
echo "guess: no, no, no"
[ "$alone $both $tree" = "no yes no" ]
echo "seen: no, yes, no: cargo joins the features of all targets of one build"
