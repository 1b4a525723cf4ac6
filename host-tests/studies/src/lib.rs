//! Statistics over thousands of simulated records. They take too long for tests, and the figures in
//! the README rest on them.

pub mod calibration;
pub mod chains;
pub mod clean;
pub mod coefficients;
pub mod confusion;
pub mod course;
pub mod detection;
pub mod efficiency;
pub mod export;
pub mod faults;
pub mod five_terms;
pub mod hidden_effect;
pub mod lag;
pub mod limits;
pub mod lines;
pub mod long;
pub mod losses;
pub mod lot;
pub mod measured;
pub mod mixtures;
pub mod motion;
mod noise;
pub mod pairs;
pub mod paper;
pub mod peers;
mod periodogram;
pub mod precision;
pub mod processes;
pub mod resources;
pub mod rounding;
pub mod said;
pub mod self_test;
pub mod slow;
pub mod smallest;
pub mod speed;
pub mod stamps;
pub mod strange;
pub mod theory;
pub mod thermal;
pub mod whittle;

pub use allanite_host::simulate::record::{
    OCTAVES, RATE_HZ, curve, expected_curve, quantum, record, record_at, spectrum,
};
