//! Studies that are small enough for a test, and comparisons with other programs.

mod course;
mod detection;
mod efficiency;
mod faults;
mod lines;
mod long;
mod paper;
mod peers;
mod precision;
mod self_test;
mod speed;
mod stories;
mod thermal;
