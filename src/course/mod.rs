//! The course of a record over time: when the noise rose, when a burst or a step came, and whether the gyro
//! warmed up.
//!
//! An Allan curve forgets the order of the samples. A [`Course`] keeps it, in 64 blocks of equal duration that
//! double their length when they are full. [`events()`] tests the blocks against the covariance of a fitted model,
//! and [`analyse`] also subtracts from the curve what steps and a warm-up add to it, and fits the model again.
//!
//! | event | test |
//! |---|---|
//! | [noise change](What::NoiseChange) | the largest standardised ratio of the noise after and before, over all block boundaries |
//! | [bursts](What::Bursts) | the blocks whose noise exceeds that of their neighbourhood |
//! | [step](What::Step), [warm-up](What::WarmUp) | generalised least squares on differences of block means, with the model's covariance |
//!
//! The noise of a block is the mean square of the differences of neighbouring samples, which a slow drift does not
//! reach.

mod analysis;
mod baseline;
mod contrasts;
mod correction;
mod event;
mod form;
mod noise;
mod response;
mod shifts;
mod slow_noise;

pub use crate::{
    evidence::course::{Block, CosineTransform},
    record::course::{BLOCKS, Course},
};
pub use analysis::{Analysis, analyse, analyse_without, events};
pub use event::{Event, Events, Largest, MAX_EVENTS, What};
pub use response::{allan_variance_of_step, allan_variance_of_warm_up};

#[cfg(test)]
mod tests;
