//! The options of the search for missing effects.

use crate::numerics::real::Real;

/// The options of the search for missing effects. `cargo xtask study hidden-effect` calibrates the
/// defaults: with them, an effect is claimed in less than 1 % of the records that have none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options {
    /// Tolerance of the model, relative to its variance, as in
    /// [`fit::Options::tolerance`](crate::fit::Options::tolerance). It is granted to a model
    /// that does not explain the record without it, and then to all models that are compared with that one. Default
    /// 0.01.
    pub tolerance: Real,
    /// The smallest improvement for which an effect is accepted. The improvement is the decrease of
    /// `−2 ln L`, less 2 for each of the effect's own parameters. Default 8, set by
    /// `cargo xtask study hidden-effect`.
    pub threshold: Real,
    /// Candidates whose scores lie within this distance of the best one are ambiguous. Default 6: the
    /// data then favour the best one by less than e³ = 20 to 1. The ratio of 20 is chosen by hand.
    pub ambiguity: Real,
    /// The smallest slope of a covariate that is believed, in standard errors. Default 3.5, set by
    /// `cargo xtask study thermal`: noise exceeds it in one of 2000 records. Where `n` covariates and pairs are
    /// tried, it is raised to `√(z² + 2 ln n)`, so that noise exceeds it no more often. Both slopes of a pair have
    /// to exceed it.
    pub covariate_z: Real,
    /// The largest number of effects to add, including a covariate. Default 4. It is chosen by hand; no
    /// study varies it.
    pub max_effects: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            threshold: 8.0,
            ambiguity: 6.0,
            covariate_z: 3.5,
            max_effects: 4,
        }
    }
}
