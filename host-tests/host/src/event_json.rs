//! What happened during a record, in JSON documents.

use crate::schema::EventName;
use allanite::course::{Event as Told, What};
use allanite_log::Disturbance;
use schemars::JsonSchema;
use serde::Serialize;

/// Something that happened during the record.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "event")]
pub struct Event {
    /// The kind of the event.
    #[schemars(with = "EventName")]
    what: &'static str,
    /// When it happened, in seconds from the first sample.
    at_s: f64,
    /// A ratio of standard deviations for noise and bursts, in rate units for a step and a warm-up.
    #[schemars(with = "Option<f64>")]
    size: f64,
    #[schemars(with = "Option<f64>")]
    lower: f64,
    #[schemars(with = "Option<f64>")]
    upper: f64,
    /// Standard errors from no event.
    #[schemars(with = "Option<f64>")]
    z: f64,
    /// The time constant of a warm-up, in seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    time_constant_s: Option<f64>,
}

/// Motion has a time but no size: its squares are not noise, and their share is in the notes.
pub fn motion(motion: &Disturbance) -> Event {
    Event {
        what: "motion",
        at_s: motion.at_s,
        size: f64::NAN,
        lower: f64::NAN,
        upper: f64::NAN,
        z: f64::NAN,
        time_constant_s: None,
    }
}

/// An event of the course.
pub fn event(event: &Told) -> Event {
    let (what, time_constant_s) = match event.what {
        What::NoiseChange => ("noise_change", None),
        What::Bursts { .. } => ("burst", None),
        What::Step => ("step", None),
        What::WarmUp { time_constant_s } => ("warm_up", Some(time_constant_s)),
        _ => ("other", None),
    };
    Event {
        what,
        at_s: event.at_s,
        size: event.size,
        lower: event.lower,
        upper: event.upper,
        z: event.z,
        time_constant_s,
    }
}
