//! `explore`: a page in the browser on which effects are tried by hand.

#[cfg(feature = "explore")]
mod answer;
mod arguments;
#[cfg(feature = "explore")]
mod catalogue;
#[cfg(feature = "explore")]
mod diagnosis;
#[cfg(feature = "explore")]
mod download;
#[cfg(feature = "explore")]
mod figure;
#[cfg(feature = "explore")]
mod fitted;
#[cfg(feature = "explore")]
mod page;
#[cfg(feature = "explore")]
mod question;
#[cfg(feature = "explore")]
mod questions;
#[cfg(feature = "explore")]
mod record;
#[cfg(feature = "explore")]
mod server;
#[cfg(feature = "explore")]
mod session;
#[cfg(feature = "explore")]
mod shell;

pub(super) use arguments::Arguments;
#[cfg(feature = "explore")]
pub use questions::{Answered, Questions};
#[cfg(feature = "explore")]
pub(super) use server::run;

/// Refuses the command with a message that tells how to get it.
#[cfg(not(feature = "explore"))]
pub(super) fn run(
    _: &Arguments,
    _: &mut impl std::io::Write,
) -> Result<(), crate::failure::Failure> {
    Err(crate::failure::Failure::not_built_in("`explore`"))
}
