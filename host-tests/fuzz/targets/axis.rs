//! Fuzzes `fuzz::axis`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::axis::check(bytes));
