//! Plots of an Allan curve beside a model: σ over τ on logarithmic axes, and below it, over the same τ,
//! the residual of each octave in standard errors.
//!
//! A plot is drawn in a [terminal](Plot), in a file by [`svg()`] and `png`, and on the page of `report`
//! by `report/figure.js`. In all three, a [`Figure`] has the data, and a [`Frame`] has the spans and
//! ticks. An [`Overlay`] is a drawing of one curve beside those of several models.

mod canvas;
mod drawing;
mod figure;
mod frame;
mod overlay;
mod panel;
#[cfg(feature = "pictures")]
mod pixels;
mod terminal;
mod ticks;

pub use drawing::{Drawing, effect_styles, svg};
pub use figure::{Figure, Share};
pub use frame::{Frame, Span};
pub use overlay::{Overlay, overlays};
#[cfg(feature = "pictures")]
pub use pixels::png;
pub use terminal::Plot;
