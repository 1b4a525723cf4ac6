//! Fuzzes `fuzz::explore`.
#![no_main]

// The first question reads the records, which takes seconds, and no input is to be blamed for them.
libfuzzer_sys::fuzz_target!(
    init: fuzz::explore::check(b"\0{}"),
    |bytes: &[u8]| fuzz::explore::check(bytes)
);
