//! Whether the rate follows a covariate.

use super::{Addition, Diagnosis, Evidence, Follows, standing::Standing};
use crate::{
    covariate::{CrossCurve, Slope},
    curve::Curve,
    error::Error,
    fit::{
        Problem,
        generalized::{Rounds, Solution},
    },
    list::numbered,
    model::Model,
    nnls::Vector,
};

/// Rounds of a slope and the noise that is left of the curve without what follows the covariate: as
/// long as that is in the curve, the noise seems larger, and the slope less sure.
const ROUNDS: usize = 5;

impl Diagnosis {
    /// The covariate of the surest slope, if that is sure enough.
    pub(super) fn follow<const K: usize>(
        &self,
        curve: &Curve<K>,
        evidence: &Evidence<'_, K>,
        standing: &Standing<K>,
    ) -> Result<Option<Addition>, Error> {
        let model = &standing.step.model;
        let mut best: Option<Follows> = None;
        for (covariate, cross) in numbered(evidence.covariates.iter()) {
            let Some(slope) = self.slope(curve, cross, model, &standing.squares)? else {
                continue;
            };
            let z = |slope: Slope| slope.z() * slope.z();
            if best.is_none_or(|best| z(slope) > z(best.slope)) {
                best = Some(Follows { covariate, slope });
            }
        }
        let sure = |follows: &Follows| {
            let z = follows.slope.z();
            z * z > self.covariate_z * self.covariate_z
        };
        Ok(best.filter(sure).map(Addition::Covariate))
    }

    #[inline(never)]
    fn slope<const K: usize>(
        &self,
        curve: &Curve<K>,
        cross: &CrossCurve<K>,
        model: &Model,
        squares: &Vector,
    ) -> Result<Option<Slope>, Error> {
        let mut squares = *squares;
        let mut slope: Option<Slope> = None;
        for _ in 0..ROUNDS {
            let corrected = slope.map(|slope| {
                let mut corrected = curve.clone();
                cross.correct(&mut corrected, &slope);
                corrected
            });
            let problem = Problem::new(corrected.as_ref().unwrap_or(curve), model);
            if corrected.is_some() {
                let mut solution = Solution::new(&problem);
                solution.converge(squares, self.tolerance, Rounds::All)?;
                squares = solution.squares;
            }
            slope = Slope::of(cross, curve.points(), |k| {
                problem.variance(k, &squares) * problem.variance_unit
            });
        }
        Ok(slope)
    }
}
