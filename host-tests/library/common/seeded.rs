//! Random test cases that are the same in every run.

use proptest::{prelude::ProptestConfig, test_runner::RngSeed};

/// The configuration for this number of cases.
pub(crate) fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(952),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}
