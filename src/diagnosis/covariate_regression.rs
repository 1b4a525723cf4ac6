//! Covariate stage: whether the rate follows a covariate, or two that act together. This comes before the search for
//! effects, because a covariate carries its own record.

use super::step::{FollowedCovariate, SecondCovariate};
use crate::{
    curve::Curve,
    evidence::{
        covariate::{Slope, Slopes},
        observed::Observed,
        record::Record,
    },
    fit::{Start, Tolerance, Work},
    numerics::{
        math,
        nnls::Vector,
        real::{Real, real},
    },
    pause::{Pause, Stop, call},
    spectrum::Spectrum,
    theory::model::Model,
};

/// The number of rounds that alternate between the slope and the noise that remains when what follows
/// the covariate is subtracted. Until it is subtracted, the noise seems larger and the slope less sure.
/// `cargo xtask study thermal` runs with this value; it was raised from 3 when the study was made.
const ROUNDS: u8 = 5;

/// The number of first rounds in which no more is added back to an octave than is left of it. What follows a strong
/// covariate looks like noise at first. The error of its slope is then so large that adding back what it takes away
/// would keep the noise large for many rounds. The test of `host-tests/tests/library/covariate.rs` where both slopes act set
/// it.
const CAUTIOUS_ROUNDS: u8 = 2;

/// The search for the covariate with the surest slope, and for a pair of covariates.
struct Search<'s, 'a, const K: usize, const B: usize> {
    observed: Observed<'a, K, B>,
    record: &'s Record<'a, K, B>,
    model: &'s Model,
    /// The squares of the model with which covariates are tried.
    squares: Vector,
    tolerance: Real,
}

/// Tests whether the rate follows a covariate, or two of them, in the noise of a model with these squared coefficients.
/// Returns what has the surest slopes, if that is more than `least_z` standard errors.
///
/// # Errors
/// The same as those of a fit, and the end of the pause.
#[inline(never)]
pub(super) fn followed<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    record: &Record<'_, K, B>,
    (model, squares): (&Model, Vector),
    tolerance: Real,
    least_z: Real,
    pause: &mut Pause<'_>,
) -> Result<Option<FollowedCovariate>, Stop> {
    let search = Search {
        observed,
        record,
        model,
        squares,
        tolerance,
    };
    let mut work = Work::<K, B>::NEW;
    // The curve and the spectrum without what follows the covariate.
    let mut corrected = observed.curve().clone();
    let mut spectrum = Spectrum::EMPTY;
    let tried = record.covariates.len().saturating_add(record.pairs.len());
    let tried_log = math::log(real(u32::try_from(tried).unwrap_or(u32::MAX).max(1)));
    let least_square = least_z * least_z + 2.0 * tried_log;
    let mut best: Option<FollowedCovariate> = None;
    for place in 0..tried {
        call(pause)?;
        let found = search.rounds(place, &mut corrected, &mut spectrum, &mut work, pause)?;
        let Some(found) = found else { continue };
        // A pair needs both of its slopes.
        let is_needed = found.beside.is_none() || found.least_square() > least_square;
        let surest = best.map_or(0.0, |best| best.chi_squared());
        if is_needed && found.chi_squared() > surest {
            best = Some(found);
        }
    }
    Ok(best.filter(|best| best.least_square() > least_square))
}

impl<const K: usize, const B: usize> Search<'_, '_, K, B> {
    /// The slopes of a covariate, or, behind the last covariate, of a pair. They and the noise that remains when what
    /// follows is subtracted are estimated in turn.
    fn rounds(
        &self,
        place: usize,
        corrected: &mut Curve<K>,
        spectrum: &mut Spectrum<B>,
        work: &mut Work<K, B>,
        pause: &mut Pause<'_>,
    ) -> Result<Option<FollowedCovariate>, Stop> {
        let mut squares = self.squares;
        let mut found = self.estimate(place, &squares);
        for round in 1..ROUNDS {
            let Some(followed) = found else { break };
            call(pause)?;
            corrected.clone_from(self.observed.curve());
            match self.observed.spectrum() {
                Some(whole) => spectrum.clone_from(whole),
                None => *spectrum = Spectrum::EMPTY,
            }
            let most = if round > CAUTIOUS_ROUNDS {
                Real::INFINITY
            } else {
                1.0
            };
            followed.correct_up_to(most, self.record, corrected, spectrum);
            let start = Start::From(squares);
            let tolerance = Tolerance::Fixed(self.tolerance);
            work.solve(
                Observed::new(corrected, spectrum),
                self.model,
                start,
                tolerance,
                pause,
            )?;
            squares = work.solver.squares;
            found = self.estimate(place, &squares);
        }
        Ok(found)
    }

    /// The slopes in the noise of the present fit. `None` if a covariate does not change, or if the covariates of
    /// a pair take the same course.
    fn estimate(&self, place: usize, squares: &Vector) -> Option<FollowedCovariate> {
        let (curve, record, model) = (self.observed.curve(), self.record, self.model);
        let octaves = curve.points();
        let noise = |k: usize| {
            let m = octaves.get(k).map_or(1, |point| point.m);
            model.variance(squares.as_slice(), m, curve.interval_s()) * curve.variance_unit()
        };
        if let Some(cross) = record.covariates.get(place) {
            return Some(FollowedCovariate {
                index: place,
                slope: Slope::of(cross, octaves, noise)?,
                beside: None,
            });
        }
        let at = place.checked_sub(record.covariates.len())?;
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
            beside: Some(SecondCovariate {
                index: other,
                slope: beside,
                correlation,
                pair: at,
            }),
        })
    }
}
