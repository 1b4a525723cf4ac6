//! The fit: it turns a curve into the coefficients of a model's effects, with intervals, and measures how
//! well the model explains the curve.
//!
//! [`fit()`] works in one go, [`Fitting`] in pieces. Both minimise `r'C⁻¹r`, where `r` are the
//! residuals and `C` is the covariance of the curve at the fitted model. Squared coefficients cannot be
//! negative. The weightings that Lv, Liu, Lai & Huang (2015) compare are there for comparison
//! ([`Method`]).
//!
//! The weights take the octaves and the levels of a spectrum for independent of each other, although they look at the
//! same samples. A model of power laws that explains a record takes its coefficients from the octaves alone. Where an
//! effect has a shape, the coefficients come from octaves and bins, and their intervals are up to a third too short. With
//! the feature `overlap`, which takes 7.4 KB of flash, the intervals count the shared samples. Nothing else changes.

pub(crate) mod coefficient;
mod correlation;
mod estimate;
mod factor;
mod fitting;
mod independent;
mod likelihood_ratio;
mod method;
pub(crate) mod observability;
mod overlap;
mod peak;
mod problem;
pub(crate) mod profile;
mod refinement;
mod result;
mod rows;
mod shape;
mod significance;
mod solver;
mod weights;
mod work;

pub use crate::{
    limits::MAX_SHAPE, numerics::chi_squared::chi_squared_tail,
    theory::covariance::curve_covariance,
};
pub use coefficient::State;
pub use correlation::Correlations;
pub use fitting::{Fitting, fit};
pub use method::{ADEQUATE_P, Method, Options};
pub use peak::Peak;
pub use result::{Fit, ShapeEstimate};

pub(crate) use fitting::Stage;
pub(crate) use problem::{Columns, Problem, check};
pub(crate) use refinement::Refinement;
pub(crate) use rows::Rows;
pub(crate) use shape::ShapeEquations;
pub(crate) use solver::{Solver, Start, Tolerance};
pub(crate) use weights::{Weights, Whitened};
pub(crate) use work::Work;
