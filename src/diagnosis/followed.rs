//! Covariate stage: whether the rate follows a covariate, or two that act together. This comes before the search for
//! effects, because a covariate carries its own record.

use super::step::{Beside, FollowedCovariate};
use crate::{
    covariate::{Slope, Slopes},
    curve::Curve,
    error::Error,
    fit::{Problem, Start, Tolerance, Work},
    math,
    model::Model,
    nnls::Vector,
    observed::Observed,
    real::{Real, real},
    record::Record,
    spectrum::Spectrum,
};

/// The number of rounds that alternate between the slope and the noise that remains when what follows
/// the covariate is subtracted. Until it is subtracted, the noise seems larger and the slope less sure.
/// `cargo xtask study thermal` runs with this value; it was raised from 3 when the study was made.
const ROUNDS: u8 = 5;

/// The number of first rounds in which no more is added back to an octave than is left of it. What follows a strong
/// covariate looks like noise at first. The error of its slope is then so large that adding back what it takes away
/// would keep the noise large for many rounds. The test of `host-tests/tests/covariate.rs` where both slopes act set
/// it.
const CAUTIOUS_ROUNDS: u8 = 2;

/// The search in progress for the covariate with the surest slope, and for a pair of covariates.
pub(super) struct Following<const K: usize, const B: usize> {
    /// The curve and the spectrum without what follows the covariate.
    corrected: Curve<K>,
    spectrum: Spectrum<B>,
    /// The squares of the step's model, and those of the fit to the corrected curve.
    first: Vector,
    squares: Vector,
    found: Option<FollowedCovariate>,
    /// The covariate that is tried; behind the last covariate, the pair.
    place: usize,
    round: u8,
    solving: bool,
    best: Option<FollowedCovariate>,
}

impl<const K: usize, const B: usize> Following<K, B> {
    /// Begins with a model that was fitted to the curve.
    pub(super) fn new(curve: &Curve<K>, squares: Vector) -> Self {
        Self {
            corrected: curve.clone(),
            spectrum: Spectrum::EMPTY,
            first: squares,
            squares,
            found: None,
            place: 0,
            round: 0,
            solving: false,
            best: None,
        }
    }

    /// Does one piece of work. When all covariates and pairs have been tried, returns what has the surest slopes, if
    /// that is more than `least_z` standard errors.
    ///
    /// # Errors
    /// The same as those of a fit.
    #[inline(never)]
    pub(super) fn advance(
        &mut self,
        observed: Observed<'_, K, B>,
        record: &Record<'_, K, B>,
        model: &Model,
        tolerance: Real,
        least_z: Real,
        work: &mut Work<K, B>,
    ) -> Result<Option<Option<FollowedCovariate>>, Error> {
        let tried = record.covariates.len().saturating_add(record.pairs.len());
        let tried_log = math::log(real(u32::try_from(tried).unwrap_or(u32::MAX).max(1)));
        let least_square = least_z * least_z + 2.0 * tried_log;
        if self.place >= tried {
            let sure = |followed: &FollowedCovariate| followed.least_square() > least_square;
            return Ok(Some(self.best.filter(sure)));
        }
        if self.solving {
            let corrected = Observed::new(&self.corrected, &self.spectrum);
            let problem = Problem::new(corrected, model, &work.columns);
            if !work.solver.advance(&problem)? {
                return Ok(None);
            }
            self.squares = work.solver.squares;
            self.solving = false;
        }
        self.found = self.estimate(observed.curve(), record, model);
        self.round = self.round.saturating_add(1);
        match self.found.filter(|_| self.round < ROUNDS) {
            Some(found) => {
                self.corrected.clone_from(observed.curve());
                match observed.spectrum() {
                    Some(spectrum) => self.spectrum.clone_from(spectrum),
                    None => self.spectrum = Spectrum::EMPTY,
                }
                let most = if self.round > CAUTIOUS_ROUNDS {
                    Real::INFINITY
                } else {
                    1.0
                };
                found.correct_up_to(most, record, &mut self.corrected, &mut self.spectrum);
                let start = Start::From(self.squares);
                let tolerance = Tolerance::Fixed(tolerance);
                let corrected = Observed::new(&self.corrected, &self.spectrum);
                work.begin_at(corrected, model, start, tolerance)?;
                self.solving = true;
            }
            None => self.next(least_square),
        }
        Ok(None)
    }

    /// The slopes beside the noise of the present fit. `None` if a covariate does not change, or if the covariates of
    /// a pair take the same course.
    fn estimate(
        &self,
        curve: &Curve<K>,
        record: &Record<'_, K, B>,
        model: &Model,
    ) -> Option<FollowedCovariate> {
        let octaves = curve.points();
        let noise = |k: usize| {
            let m = octaves.get(k).map_or(1, |point| point.m);
            let squares = self.squares.as_slice();
            model.variance(squares, m, curve.interval_s()) * curve.variance_unit()
        };
        if let Some(cross) = record.covariates.get(self.place) {
            return Some(FollowedCovariate {
                index: self.place,
                slope: Slope::of(cross, octaves, noise)?,
                beside: None,
            });
        }
        let at = self.place.checked_sub(record.covariates.len())?;
        let pair = record.pairs.get(at)?;
        let [index, other] = pair.covariates;
        let crosses = [record.covariates.get(index)?, record.covariates.get(other)?];
        let Slopes {
            slopes: [slope, beside],
            correlation,
        } = Slopes::of(pair, crosses, octaves, noise)?;
        Some(FollowedCovariate {
            index,
            slope,
            beside: Some(Beside {
                index: other,
                slope: beside,
                correlation,
                pair: at,
            }),
        })
    }

    /// Keeps what was found if it is surer than what was found before. A pair needs both of its slopes.
    fn next(&mut self, least_square: Real) {
        if let Some(found) = self.found.take() {
            let surest = self.best.map_or(0.0, |best| best.chi_squared());
            let is_needed = found.beside.is_none() || found.least_square() > least_square;
            if is_needed && found.chi_squared() > surest {
                self.best = Some(found);
            }
        }
        self.place = self.place.saturating_add(1);
        self.round = 0;
        self.squares = self.first;
    }
}
