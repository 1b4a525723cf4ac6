//! Tests sensors on mocked buses: the transfers, the decoded samples, the handling of errors, and
//! samples that come at the wrong time.

mod chip;
mod fifo;
mod filter;
mod pace;
mod record;
mod sheet;
mod start;
mod units;
