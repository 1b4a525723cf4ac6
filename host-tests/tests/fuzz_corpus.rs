//! The fuzz targets accept their committed corpora, and what bytes changed at random make of them.

// The targets are public in the fuzzer's library.
#![allow(unreachable_pub)]

#[path = "../fuzz/src/accumulator.rs"]
mod accumulator;
#[path = "../fuzz/src/axis.rs"]
mod axis;
#[path = "../fuzz/src/comparison.rs"]
mod comparison;
#[path = "../fuzz/src/diagnosis.rs"]
mod diagnosis;
#[path = "../fuzz/src/explore.rs"]
mod explore;
#[path = "../fuzz/src/file.rs"]
mod file;
#[path = "../fuzz/src/formula.rs"]
mod formula;
#[path = "../fuzz/src/sensor.rs"]
mod sensor;
#[path = "../fuzz/src/spectrum.rs"]
mod spectrum;
#[path = "../fuzz/src/stored.rs"]
mod stored;

use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fs, path::Path};
use xtask::firmware::c_library::replay as replay_in_c;

/// Checks every file of a corpus, and so many changed copies of each.
fn replay(name: &str, changed: u64, check: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../fuzz/corpus")
        .join(name);
    let mut checked = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let bytes = fs::read(entry.unwrap().path()).unwrap();
        check(&bytes);
        for seed in 0..changed {
            check(&change(bytes.clone(), seed));
        }
        checked += 1;
    }
    assert!(checked >= 2, "{checked} files of {name}");
}

/// A copy with a few other bytes, and now and then a shorter one.
fn change(mut bytes: Vec<u8>, seed: u64) -> Vec<u8> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    for _ in 0..random.random_range(1..6) {
        let place = random.random_range(0..bytes.len());
        bytes[place] = random.next_u32() as u8;
    }
    if random.random_range(0..8) == 0 {
        bytes.truncate(random.random_range(1..=bytes.len()));
    }
    bytes
}

#[test]
fn accumulators_follow_the_definition() {
    replay("accumulator", 300, accumulator::check);
}

#[test]
fn axes_follow_the_description_of_the_gate() {
    replay("axis", 5, axis::check);
}

#[test]
fn formulas_are_refused_or_written_back() {
    replay("formula", 200, formula::check);
}

/// The library for C is compiled in single precision, unlike this test.
#[test]
fn calls_from_c_in_any_order_are_answered() {
    let said = replay_in_c(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../fuzz/corpus/c")
            .as_path(),
    );
    let said = said.unwrap_or_else(|error| panic!("{error:#}"));
    let files: usize = said
        .last()
        .and_then(|line| line.parse().ok())
        .expect("a number");
    assert!(files >= 5, "{files} files");
}

#[test]
fn comparisons_of_any_model_and_curve_have_finite_numbers() {
    replay("comparison", 20, comparison::check);
}

#[test]
fn diagnoses_of_any_curve_end_with_finite_numbers() {
    replay("diagnosis", 10, diagnosis::check);
}

#[test]
fn questions_of_any_contents_are_answered_or_refused_in_a_line() {
    replay("explore", 20, explore::check);
}

#[test]
fn files_of_any_contents_are_read_or_refused_by_name() {
    replay("file", 100, file::check);
}

#[test]
fn sensors_on_a_bus_that_answers_anything_are_read() {
    replay("sensor", 300, sensor::check);
}

#[test]
fn spectra_follow_the_definition() {
    replay("spectrum", 20, spectrum::check);
}

#[test]
fn stored_data_of_any_contents_are_restored_or_refused() {
    replay("stored", 2000, stored::check);
}
