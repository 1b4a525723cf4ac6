//! Sensors on mocked buses: what is said to them, what is made of their answers, what becomes of
//! errors, and samples that come at the wrong time.

mod pace;
mod record;
mod sheet;
mod start;
mod units;
