//! The five terms fitted to the axes of a record: results, their documents and their tables.

pub mod fitted;
pub mod json;
pub mod judged;
pub mod table;
