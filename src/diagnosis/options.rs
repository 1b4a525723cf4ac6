//! How to look for missing effects.

use crate::real::Real;

/// How to look for missing effects. The defaults are calibrated by `cargo xtask study hidden-effect`: with
/// them, an effect is claimed in less than 1 % of records that have none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// Tolerance of the model, as of [`fit::Options::tolerance`](crate::fit::Options::tolerance). Whether
    /// it is granted is decided once, for the model that is asked about, and holds for all models that are
    /// compared with it. Default 0.01.
    pub tolerance: Real,
    /// The least improvement of `−2 ln L`, less 2 for each of an effect's own parameters, that an effect is
    /// accepted for. Default 8, set by `cargo xtask study hidden-effect`.
    pub threshold: Real,
    /// Candidates whose scores lie within this of the best are ambiguous. Default 6: the data then favour
    /// the best by less than e³ = 20 to 1.
    pub ambiguity: Real,
    /// The least slope of a covariate that is believed, in standard errors. Default 3.5, set by
    /// `cargo xtask study thermal`: noise exceeds it in one of 2000 records.
    pub covariate_z: Real,
    /// The most effects to add, a covariate among them. Default 3.
    pub max_effects: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            threshold: 8.0,
            ambiguity: 6.0,
            covariate_z: 3.5,
            max_effects: 3,
        }
    }
}
