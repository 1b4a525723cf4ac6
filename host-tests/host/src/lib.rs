//! What a record says: its curve, fits, comparisons, diagnoses and verdicts, and the words for them; lots of devices; and a
//! simulator of gyros.

pub mod comb;
pub mod confidence;
pub mod curve_file;
pub mod dependence;
pub mod diagnosis;
pub mod equivalent;
pub mod lot;
pub mod number;
pub mod overbound;
pub mod quantile;
pub mod simulate;
pub mod stationarity;
pub mod units;
pub mod words;
