//! Why a text is refused.

/// What is wrong with a text, and what to write instead.
pub(super) type Refusal = (String, String);
