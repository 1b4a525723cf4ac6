//! Records of many devices on [DataFusion](datafusion) and on clusters of [Ballista](ballista): SQL functions from batches of
//! samples to coefficients.
//!
//! ```sql
//! SELECT device, axis, allan_fit(allan_state(start, counts, rate, scale), 'deg/s') AS fit
//! FROM logs GROUP BY device, axis
//! ```
//!
//! A state is what [`Pieces`](allanite_log::pieces::Pieces) keep of one axis, as bytes in a column. It does not depend on how the
//! rows are partitioned, and states merge in any order, so that an engine may cut, shuffle and repeat as it likes. The package
//! for Python has the same functions with the same bytes.
//!
//! | function | gives |
//! |---|---|
//! | `allan_state(start, counts, rate, scale)` | aggregate: the state of one axis. `start` is the number of a row's first sample in the record, `counts` a list of whole numbers of 32 bits, `rate` in samples per second, `scale` in rate units per count |
//! | `allan_state_of_samples(number, count, rate, scale)` | aggregate: the same with one sample a row |
//! | `allan_merge(state)` | aggregate: the state of all parts |
//! | `allan_samples(state)` | the number of samples |
//! | `allan_fit(state, unit)` | a struct of the five coefficients with their 95 % intervals, in the unit times the powers of s of IEEE Std 952, `NULL` where the record does not show one; `adequate`, `chi2`, `dof`, `samples`, `stretches`, and `invalid`: why the samples are not those of a gyro at rest, or `NULL` |
//! | `allan_diagnose(state, unit)` | a struct of `verdict`, `missing` (a list of effects) and `conclusion` in words |

mod aggregate;
mod answer;
mod arguments;
mod axis;
pub mod cluster;
mod failure;
mod functions;
mod groups;
mod rows;

pub use functions::register;
