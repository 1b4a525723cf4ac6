//! The search for what is missing: several hypotheses side by side, each a story of the whole record.
//!
//! A [`Hypothesis`] says what the white noise went through, and what adds to it. The search goes the way of an engineer,
//! who looks at the continuum first and at the peaks next, and keeps two or three stories in mind until the end:
//!
//! 1. *Start*: every filter at its best shape, narrow peaks left out, without and with slow noise.
//! 2. *Grow*: each hypothesis of the beam gets one more line, resonance or other noise, and all shapes are refined together.
//! 3. *Cross*: the best sets of additions are tried behind every other filter too.
//! 4. *Prune*: what is not worth its parameters goes.
//!
//! Hypotheses are judged by `−2 ln L` of the [gamma likelihood](likelihood), which sees deficits as well as excesses, plus
//! two for each parameter and a [price](price::price) for each effect, which is what clean records reach by chance.

mod beam;
mod cross;
mod grow;
mod hypothesis;
mod kind;
mod likelihood;
mod limits;
mod order;
mod pool;
mod price;
mod prune;
mod refine;
mod rows;
mod run;
mod start;
mod values;
mod variant;
mod white;

pub(crate) use hypothesis::Hypothesis;
pub(crate) use kind::{is_filter, is_white};
pub(crate) use likelihood::Workspace;
pub(crate) use limits::Limits;
pub(crate) use order::ordered;
pub(crate) use price::price;
pub(crate) use rows::Observation;
pub(crate) use run::{Found, MAX_ALTERNATIVES, Search, best_shape_of};
pub(crate) use values::Values;
pub(crate) use white::WhiteRange;
