//! Tests sensors on mocked buses: the transfers, the decoded samples, the handling of errors, and
//! samples that come at the wrong time.

mod chip;
mod configuration;
mod driver;
mod fault;
mod fifo;
mod filter;
mod hostile;
mod pace;
mod record;
mod replay;
mod sheet;
mod signal;
mod start;
mod units;
