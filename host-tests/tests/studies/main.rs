//! Studies that are small enough for a test, and comparisons with other programs.

mod efficiency;
mod long;
mod paper;
mod peers;
mod speed;
