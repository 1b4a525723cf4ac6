//! `watch`: shows a gyro's curve and coefficients while it is being recorded.

mod arguments;
#[cfg(feature = "watch")]
mod diagnosis;
#[cfg(feature = "watch")]
mod recorder;
#[cfg(feature = "watch")]
mod recording;
#[cfg(feature = "watch")]
mod saving;
#[cfg(feature = "watch")]
mod screen;
#[cfg(feature = "watch")]
mod session;
#[cfg(feature = "watch")]
mod signals;
#[cfg(feature = "watch")]
mod source;
#[cfg(feature = "watch")]
mod status;

pub(super) use arguments::Arguments;
#[cfg(feature = "watch")]
pub(super) use session::run;

/// Refuses the command with a message that tells how to get it.
#[cfg(not(feature = "watch"))]
pub(super) fn run(
    _: &Arguments,
    _: &mut impl std::io::Write,
) -> Result<(), allanite_log::failure::Failure> {
    Err(allanite_log::failure::Failure::not_built_in("`watch`"))
}
