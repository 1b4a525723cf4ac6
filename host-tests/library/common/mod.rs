//! What several tests need.

pub(crate) mod precision;
#[cfg(feature = "flash")]
pub(crate) mod ram_flash;
#[cfg(feature = "storage")]
pub(crate) mod sealed;
pub(crate) mod seeded;
