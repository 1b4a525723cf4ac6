//! What takes minutes: `cargo xtask test --all` runs it.

mod doors;
mod injected;
mod injected_watch;
