//! Tests every effect of the catalogue: its closed forms against its kernel, and its kernel against
//! sums over single samples. A new effect is tested as soon as it is in the catalogue.

mod covariance;
mod description;
mod shapes;
mod standard;
mod variance;
