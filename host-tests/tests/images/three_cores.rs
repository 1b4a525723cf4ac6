//! Three cores and this host agree to the bit: one without hardware for division and floats, one with floats in hardware, and one of
//! another architecture. The module `thorough` has every core in both precisions.

use crate::check::{
    agree_to_the_bit, finds_what_the_host_finds, has_no_path_to_a_panic, keeps_every_place,
    panic_paths,
};
use rayon::prelude::*;
use xtask::firmware::{CORES, CORTEX_M4F, Image, RISCV, Way, budgets};

#[test]
fn three_cores_and_the_host_agree_to_the_bit() {
    [CORES[0], CORTEX_M4F, RISCV]
        .par_iter()
        .for_each(agree_to_the_bit);
}

#[test]
fn a_whole_product_finds_on_two_cores_what_the_host_finds_to_the_bit() {
    [CORTEX_M4F, RISCV]
        .par_iter()
        .for_each(finds_what_the_host_finds);
}

#[test]
fn a_sample_and_a_fit_cost_on_the_smallest_core_what_the_budgets_say() {
    // The budgets are those of rustup's toolchain.
    if Way::in_use().unwrap_or_else(|error| panic!("{error:#}")) == Way::Rustup {
        budgets::check_core(&CORES[0]).unwrap_or_else(|error| panic!("{error:#}"));
    }
}

#[test]
fn the_five_terms_with_a_screen_fit_into_19_kib_of_the_smallest_core() {
    let of = |name| {
        let image = Image::build_for(name, &CORES[0]);
        image.and_then(|image| image.flash_bytes())
    };
    let [alone, screened] = ["footprint_five_terms", "footprint_screened"]
        .map(|name| of(name).unwrap_or_else(|error| panic!("{error:#}")));
    println!("{alone} bytes of flash, {screened} with a screen");
    assert!(alone < screened);
    // Debian's `core` is compiled for size.
    if Way::in_use().unwrap_or_else(|error| panic!("{error:#}")) == Way::Rustup {
        assert!(screened <= 19 << 10, "{screened}");
    }
}

#[test]
fn images_of_the_whole_library_have_no_path_to_a_panic() {
    for name in [
        "footprint_everything",
        "footprint_five_terms",
        "footprint_self_test",
    ] {
        has_no_path_to_a_panic(name, &CORTEX_M4F, "firmware");
    }
}

#[test]
fn an_image_that_can_panic_is_detected() {
    // The logger of this image panics if it is entered twice.
    let found = panic_paths("characterise", &CORTEX_M4F, "firmware");
    assert!(
        found.iter().any(|name| name.contains("rust_begin_unwind")),
        "{found:?}"
    );
}

#[test]
fn an_interrupt_of_the_receiver_loses_no_sample_without_its_place() {
    [CORTEX_M4F].iter().for_each(keeps_every_place);
}
