//! Fuzzes `fuzz::sensor`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::sensor::check(bytes));
