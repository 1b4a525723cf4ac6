//! What takes minutes: `cargo xtask test --all` runs it.

mod injected;
mod injected_watch;
