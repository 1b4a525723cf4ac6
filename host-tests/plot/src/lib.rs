//! Plots of a record beside a model: the Allan deviation over the averaging time and the density over the
//! frequency on logarithmic axes, below each of them the residual in standard errors, and the rate over time.
//!
//! A plot is drawn in a [terminal](Plot), in a file by [`svg()`] and `png`, and on the page of `report`
//! by `report/figure.js`. In all three, a [`Figure`] has the data, and a [`Frame`] has the spans and
//! ticks; a [`CourseFigure`] has both for the rate over time. An [`Overlay`] is a drawing of one curve beside
//! those of several models.

mod canvas;
mod comparison;
mod course;
mod drawing;
mod figure;
mod frame;
mod lines;
mod overlay;
mod panel;
#[cfg(feature = "pictures")]
mod pixels;
mod quantity;
mod sheet;
mod strips;
mod terminal;
mod ticks;
mod timeline;

pub use course::{CourseFigure, Mark};
pub use drawing::{Drawing, svg};
pub use figure::{Figure, Measured, Share, View, relative_error};
pub use frame::{Frame, Span};
pub use lines::Line;
pub use overlay::{Overlay, overlays};
#[cfg(feature = "pictures")]
pub use pixels::png;
pub use quantity::Quantity;
pub use sheet::effect_styles;
pub use terminal::Plot;
pub use timeline::Timeline;
