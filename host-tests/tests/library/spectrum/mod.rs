//! Compares the expected densities and their covariance with the scatter of simulated records.

mod covariance;
mod expected;
mod records;
