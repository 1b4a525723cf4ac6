//! The library on simulated records, in double precision. `host-tests/library` has the tests that run in both precisions.

#[path = "../common/factory.rs"]
mod factory;
#[path = "../../library/common/sealed.rs"]
mod sealed;
#[path = "../../library/common/seeded.rs"]
mod seeded;

mod certificate;
mod chi_squared;
mod course;
mod covariance;
mod covariate;
mod covariate_lag;
mod effect;
mod fit;
mod integrity;
mod own_effect;
mod self_test;
mod sensor_filter;
mod simulated;
mod spectrum;
