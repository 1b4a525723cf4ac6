//! An Allan curve beside a model: σ over τ on logarithmic axes, and below it, over the same τ, how far
//! each octave lies off, in standard errors.
//!
//! It is drawn in three places: in a [terminal](Plot), in a file by [`svg()`] and `png`, and on the
//! page of `report`, by `report/figure.js`. What they show is a [`Figure`], where they show it a
//! [`Frame`], with the same ticks.

mod canvas;
mod drawing;
mod figure;
mod frame;
mod panel;
#[cfg(feature = "pictures")]
mod pixels;
mod terminal;
mod ticks;

pub use drawing::{Drawing, effect_styles, svg};
pub use figure::{Figure, Share};
pub use frame::{Frame, Span};
#[cfg(feature = "pictures")]
pub use pixels::png;
pub use terminal::Plot;
