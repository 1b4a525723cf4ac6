//! A model beside a record: the comparison, its document and its text.

pub mod compared;
pub mod json;
pub mod model;
pub mod text;
pub mod visible;
