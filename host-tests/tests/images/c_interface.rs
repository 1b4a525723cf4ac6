//! The interface for C: its header, a product in C on this host and in QEMU, and calls with hostile arguments.

use std::fs;
use xtask::firmware::{
    CORES, CORTEX_M4F,
    agreement::first_difference,
    c_library::{folder, host_program, library, rust_example, target_program},
};

/// Makes the header anew if this variable is set.
const RENEW: &str = "ALLANITE_RENEW_HEADER";

#[test]
fn the_header_is_that_of_the_source() {
    let config =
        cbindgen::Config::from_file(folder().join("cbindgen.toml")).expect("a configuration");
    let bindings = cbindgen::Builder::new()
        .with_crate(folder())
        .with_config(config)
        .generate()
        .expect("a header");
    let mut made = Vec::new();
    bindings.write(&mut made);
    let made = String::from_utf8(made).expect("text");
    let path = folder().join("include/allanite.h");
    if std::env::var_os(RENEW).is_some() {
        fs::write(&path, &made).expect("a folder to write to");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == made,
        "the header is out of date: {RENEW}=1 cargo test -p host-tests --test images c_interface"
    );
}

#[test]
fn a_product_in_c_finds_what_it_finds_in_rust_to_the_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let rust = rust_example().unwrap_or_else(|error| panic!("{error:#}"));
    assert!(
        rust.len() > 20 && rust.iter().any(|line| line.contains("sinusoid")),
        "{rust:?}"
    );
    let here = host_program(&["product.c", "host.c"], folder.path());
    let here = here.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(first_difference(&rust, &here), None);
    let there = target_program(&CORTEX_M4F, folder.path());
    let there = there.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(first_difference(&rust, &there), None);
}

/// Not every core has every atomic instruction, and the library for C is to ask nothing of its program.
#[test]
fn the_library_builds_for_every_core_and_needs_no_symbol_for_atomics() {
    for core in &CORES {
        let path = library(core, 20).unwrap_or_else(|error| panic!("{}: {error:#}", core.name));
        let bytes = fs::read(&path).expect("a library");
        let holds = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
        assert!(holds(b"allanite_diagnosis_advance"), "{}", core.name);
        assert!(!holds(b"_critical_section_1_0_acquire"), "{}", core.name);
    }
}

#[test]
fn hostile_calls_are_refused_and_harm_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = host_program(&["hostile.c", "host.c"], folder.path());
    let said = said.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(said, ["refused as they should be"]);
}
