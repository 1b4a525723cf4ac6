//! Fuzzes `fuzz::explore`.
#![no_main]

// The session takes seconds, which would count as those of the first input.
libfuzzer_sys::fuzz_target!(
    init: fuzz::explore::begin(),
    |bytes: &[u8]| fuzz::explore::check(bytes)
);
