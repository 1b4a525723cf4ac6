//! Covariate stage: whether the rate follows a covariate. This comes before the search for effects,
//! because a covariate carries its own evidence.

use super::{judged::Judged, step::FollowedCovariate};
use crate::{
    covariate::{CrossCurve, Slope},
    curve::Curve,
    error::Error,
    fit::{Problem, Start, Tolerance, Work},
    model::Model,
    nnls::Vector,
    observed::Observed,
    real::Real,
};

/// The number of rounds that alternate between the slope and the noise that remains when what follows
/// the covariate is subtracted. Until it is subtracted, the noise seems larger and the slope less sure.
/// `cargo xtask study thermal` runs with this value; it was raised from 3 when the study was made.
const ROUNDS: u8 = 5;

/// The search in progress for the covariate with the surest slope.
pub(super) struct Following<const K: usize> {
    /// The curve without what follows the covariate.
    corrected: Curve<K>,
    /// The squares of the step's model, and those of the fit to the corrected curve.
    first: Vector,
    squares: Vector,
    slope: Option<Slope>,
    covariate: usize,
    round: u8,
    solving: bool,
    best: Option<FollowedCovariate>,
}

impl<const K: usize> Following<K> {
    /// Begins with a model that was fitted to the curve.
    pub(super) fn new(curve: &Curve<K>, squares: Vector) -> Self {
        Self {
            corrected: curve.clone(),
            first: squares,
            squares,
            slope: None,
            covariate: 0,
            round: 0,
            solving: false,
            best: None,
        }
    }

    /// Does one piece of work. When all covariates have been tried, returns the one with the surest
    /// slope, if that is more than `least_z` standard errors.
    ///
    /// # Errors
    /// The same as those of a fit.
    #[inline(never)]
    pub(super) fn advance<const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        covariates: &[CrossCurve<K>],
        model: &Model,
        judged: &Judged,
        least_z: Real,
        work: &mut Work<K, B>,
    ) -> Result<Option<Option<FollowedCovariate>>, Error> {
        let Some(cross) = covariates.get(self.covariate) else {
            let sure = |followed: &FollowedCovariate| square(followed.slope.z()) > square(least_z);
            return Ok(Some(self.best.filter(sure)));
        };
        if self.solving {
            let corrected = observed.with_curve(&self.corrected);
            let problem = Problem::new(corrected, model, &work.columns);
            if !work.solver.advance(&problem)? {
                return Ok(None);
            }
            self.squares = work.solver.squares;
            self.solving = false;
        }
        let curve = observed.curve();
        let octaves = curve.points();
        let noise = |k: usize| {
            let m = octaves.get(k).map_or(1, |point| point.m);
            let squares = self.squares.as_slice();
            model.variance(squares, m, curve.interval_s()) * curve.variance_unit()
        };
        self.slope = Slope::of(cross, curve.points(), noise);
        self.round = self.round.saturating_add(1);
        match self.slope.filter(|_| self.round < ROUNDS) {
            Some(slope) => {
                self.corrected.clone_from(curve);
                cross.correct(&mut self.corrected, &slope);
                let start = Start::From(self.squares);
                let tolerance = Tolerance::Fixed(judged.tolerance);
                let corrected = observed.with_curve(&self.corrected);
                work.begin_at(corrected, model, start, tolerance)?;
                self.solving = true;
            }
            None => self.next_covariate(),
        }
        Ok(None)
    }

    fn next_covariate(&mut self) {
        if let Some(slope) = self.slope.take() {
            let surest = self.best.map_or(0.0, |best| square(best.slope.z()));
            if square(slope.z()) > surest {
                self.best = Some(FollowedCovariate {
                    index: self.covariate,
                    slope,
                });
            }
        }
        self.covariate = self.covariate.saturating_add(1);
        self.round = 0;
        self.squares = self.first;
    }
}

fn square(x: Real) -> Real {
    x * x
}
