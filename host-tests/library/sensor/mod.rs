//! Tests sensors on mocked and simulated buses: the transfers, the decoded samples, FIFOs, configurations, the handling
//! of errors, and samples that come at the wrong time.

mod adis16470;
mod bmi270;
mod chip;
mod configuration;
mod driver;
mod fault;
mod fifo;
mod hostile;
mod pace;
mod packets;
mod record;
mod replay;
mod sheet;
mod signal;
mod single;
mod start;
mod units;
mod wire;
