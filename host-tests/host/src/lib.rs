//! What a record says: its curve, fits, comparisons, diagnoses and verdicts, and the words for them; lots of devices; and a
//! simulator of gyros.

pub mod comb;
pub mod compare;
pub mod confidence;
pub mod curve_file;
pub mod dependence;
pub mod diagnose;
pub mod diagnosis;
pub mod disturbance;
pub mod effect_argument;
pub mod equivalent;
pub mod event_json;
pub mod fit;
pub mod freeform;
pub mod interface;
pub mod judgement;
pub mod known_filter;
pub mod limit;
pub mod live;
pub mod lot;
pub mod model_json;
pub mod number;
pub mod overbound;
pub mod own;
pub mod quantile;
pub mod record;
pub mod rounding;
pub mod schema;
pub mod simulate;
pub mod stationarity;
pub mod tried;
pub mod units;
pub mod verdict;
pub mod words;
