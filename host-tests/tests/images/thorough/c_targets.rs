//! The library for C on every core, and products in C in QEMU.

use std::fs;
use xtask::firmware::{
    CORES, CORTEX_M4F, RISCV,
    agreement::first_difference,
    c_library::{Contents, build_for_target, host_program, library, rust_example, target_program},
    image::flash_of,
};

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
    let there = target_program(&CORTEX_M4F, "product.c", folder.path());
    let there = there.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(first_difference(&rust, &there), None);
}

#[test]
fn one_axis_in_c_finds_the_same_on_every_core_and_is_small() {
    /// The flash that one axis and the five terms may take of a Cortex-M0+, in bytes.
    const FLASH: u64 = 24 * 1024;
    let folder = tempfile::tempdir().expect("a folder");
    let here = host_program(&["axis.c", "host.c"], folder.path());
    let here = here.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(here.last().map(String::as_str), Some("pass"), "{here:?}");
    assert!(here[2].starts_with("measured "), "{here:?}");
    let there = target_program(&CORTEX_M4F, "axis.c", folder.path());
    let there = there.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(first_difference(&here, &there), None);
    let contents = Contents {
        octaves: 14,
        one_axis: true,
    };
    let small = CORES.iter().find(|core| core.small).expect("a small core");
    let program = build_for_target(small, contents, "axis.c", folder.path());
    let program = program.unwrap_or_else(|error| panic!("{error:#}"));
    let flash = flash_of(&program).unwrap_or_else(|error| panic!("{error:#}"));
    assert!((4096..=FLASH).contains(&flash), "{flash} bytes of flash");
}

/// Not every core has every atomic instruction, and the library for C is to ask nothing of its program. The others have what a
/// Cortex-M4F has, and take a minute each.
#[test]
fn the_library_builds_for_cores_without_atomics_and_needs_no_symbol_for_them() {
    let without = CORES.iter().filter(|core| core.small);
    for core in without.chain([&RISCV, &CORTEX_M4F]) {
        let path =
            library(core, Contents::ALL).unwrap_or_else(|error| panic!("{}: {error:#}", core.name));
        let bytes = fs::read(&path).expect("a library");
        let holds = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
        assert!(holds(b"allanite_diagnosis_advance"), "{}", core.name);
        assert!(!holds(b"_critical_section_1_0_acquire"), "{}", core.name);
    }
}
