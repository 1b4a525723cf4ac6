//! x
use crate::failure::Failure;
/// x
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {}
pub(super) fn run(_: &Arguments) -> Result<(), Failure> { Ok(()) }
