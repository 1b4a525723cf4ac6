//! Fuzzes `fuzz::accumulator`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::accumulator::check(bytes));
