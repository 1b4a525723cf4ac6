//! Fuzzes `fuzz::explore`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::explore::check(bytes));
