//! The events that a course (block history) can show.

use crate::numerics::real::Real;
use heapless::Vec;

/// The largest number of events that are reported.
pub const MAX_EVENTS: usize = 8;

/// The events of a record, the earliest first.
pub type Events = Vec<Event, MAX_EVENTS>;

/// The kind of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum What {
    /// The noise is larger or smaller from this time on. The size is the ratio of the standard deviations after
    /// and before.
    NoiseChange,
    /// The noise of some blocks exceeds that of their neighbourhood. The time is the middle of the strongest block,
    /// and the size is the ratio of its standard deviation to that of its neighbourhood.
    Bursts {
        /// The number of such blocks.
        blocks: u8,
    },
    /// The mean rate is another one from this time on. The size is the change, in rate units.
    Step,
    /// The rate approaches its final value exponentially from the start of the record on. The size is the rate at
    /// the start less the final rate, in rate units. The time is that of the start.
    WarmUp {
        /// The time constant, in seconds.
        time_constant_s: Real,
    },
}

/// Something that happened at a time of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Event {
    /// The kind of the event, which says what the size means.
    pub what: What,
    /// When it happened, in seconds since the first sample of the course. It is known to one block.
    pub at_s: Real,
    /// How large it is.
    pub size: Real,
    /// Lower end of the 95 % interval of the size.
    pub lower: Real,
    /// Upper end of the 95 % interval of the size.
    pub upper: Real,
    /// The size's distance from that of no event, in standard errors, with its sign.
    pub z: Real,
}

/// The largest standardised deviation of each kind over all places, whether it makes an event or not. They are 0
/// where the course is too short for a test.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Largest {
    /// Of a noise change, with the sign of the change.
    pub noise_change: Real,
    /// Of the strongest burst.
    pub burst: Real,
    /// Of a step, with its sign.
    pub step: Real,
    /// Of a warm-up, with its sign.
    pub warm_up: Real,
}
