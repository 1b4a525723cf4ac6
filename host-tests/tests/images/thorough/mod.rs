//! What takes long: `cargo xtask test --all` runs it.

mod boards;
mod c_targets;
mod every_core;
mod product;
