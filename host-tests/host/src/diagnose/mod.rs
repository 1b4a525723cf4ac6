//! The diagnosis of a record, its words, its documents and its pictures.

pub mod conclusion;
pub mod diagnosed;
pub mod drawing;
pub mod found;
pub mod given_filter;
pub mod json;
pub mod lines;
pub mod pictures;
pub mod scope;
pub mod text;
pub mod words;
