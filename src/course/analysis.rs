//! All tests of a course, and their turns with the fit of the noise.

use super::{
    BLOCKS, Course,
    baseline::median,
    contrasts::BlockMeans,
    correction,
    event::{Event, Events, Largest, What},
    form::{Form, MAX_SHIFTS},
    noise,
    shifts::{LargestShift, Shift, shifts},
};
use crate::{
    curve::{Curve, Scale},
    error::Error,
    evidence::course::Level,
    fit::{Fit, Options, fit},
    limits::TWO_SIDED_95,
    list,
    numerics::real::{Real, real},
    theory::model::Model,
};
use heapless::Vec;

/// The number of times that the noise is fitted without the shifts. Chosen by hand; no study varies it.
const ROUNDS: usize = 4;

/// The sizes have settled if none changes by more than this share of its standard error. Chosen by hand.
const SETTLED: Real = 0.1;

/// The result of a course and a curve together.
#[derive(Clone, Debug)]
pub struct Analysis<const K: usize> {
    /// The events, the earliest first.
    pub events: Events,
    /// The largest standardised deviations of each kind, against the first fit.
    pub largest: Largest,
    /// The curve without what the steps and the warm-up add to it.
    pub curve: Curve<K>,
    /// The fit of the model to that curve.
    pub fit: Fit,
}

/// The events of a course, given a model and its squared coefficients in rate units and seconds.
///
/// The tests are against the model's own covariance. If the model was fitted to a curve with a step in it, the model
/// takes a part of the step for noise, and its size is underestimated: [`analyse`] corrects this. A course of less
/// than 9 blocks has no noise changes and no bursts, and one of less than 8 complete blocks has no steps.
///
/// The limits are such that less than 0.5 % of clean records have any event (`cargo xtask study course`).
pub fn events<const COVARIATES: usize>(
    course: &Course<COVARIATES>,
    scale: Scale,
    model: &Model,
    squares: &[Real],
) -> Events {
    let levels = course.levels(scale);
    let interval_s = 1.0 / scale.rate_hz();
    let means = BlockMeans {
        levels: &levels,
        model,
        length: course.block_length(),
        interval_s,
    };
    let shifts = shifts(&means, squares, &mut LargestShift::default());
    let shifts = shifts.map(|shifts| shifts.shifts).unwrap_or_default();
    told(
        course.block_length(),
        levels,
        &shifts,
        interval_s,
        model,
        squares,
        &mut Largest::default(),
    )
}

/// Fits a model to a curve, looks for events in the course of the same record, and fits the model again to the curve
/// without the steps and the warm-up that were found, until their sizes settle.
///
/// `K` is the number of octaves of the curve.
///
/// # Errors
/// The same as those of [`fit()`].
pub fn analyse<const K: usize, const COVARIATES: usize>(
    curve: &Curve<K>,
    model: &Model,
    course: &Course<COVARIATES>,
    scale: Scale,
    options: Options,
) -> Result<Analysis<K>, Error> {
    analyse_without(curve, model, course, scale, &[], options)
}

/// As [`analyse`], for a record whose rate follows a recorded covariate, such as a temperature. What
/// follows it is no event. `followed` is its mean in every block of the course, in rate units; blocks that it does not
/// reach keep their mean. The curve is the one without it, as that of
/// [`FollowedCovariate::correct`](crate::diagnosis::FollowedCovariate::correct).
///
/// # Errors
/// The same as those of [`fit()`].
pub fn analyse_without<const K: usize, const COVARIATES: usize>(
    curve: &Curve<K>,
    model: &Model,
    course: &Course<COVARIATES>,
    scale: Scale,
    followed: &[Real],
    options: Options,
) -> Result<Analysis<K>, Error> {
    let mut levels = course.levels(scale);
    for level in &mut levels {
        level.mean -= followed.get(level.place as usize).copied().unwrap_or(0.0);
    }
    let interval_s = 1.0 / scale.rate_hz();
    let length = course.block_length();
    let mut analysis = Analysis {
        events: Events::new(),
        largest: Largest::default(),
        curve: curve.clone(),
        fit: fit(curve, model, options)?,
    };
    let mut known: Vec<Shift, MAX_SHIFTS> = Vec::new();
    for round in 0..ROUNDS {
        let mut largest = LargestShift::default();
        let means = BlockMeans {
            levels: &levels,
            model,
            length,
            interval_s,
        };
        let found = shifts(&means, &analysis.fit.squares(), &mut largest);
        if round == 0 {
            analysis.largest.step = largest.step;
            analysis.largest.warm_up = largest.warm_up;
        }
        let Some(found) = found else {
            break;
        };
        analysis.curve = curve.clone();
        correction::subtract(&mut analysis.curve, &levels, &found, length, course.time());
        analysis.fit = fit(&analysis.curve, model, options)?;
        let is_settled = has_settled(&known, &found.shifts);
        known = found.shifts;
        if is_settled {
            break;
        }
    }
    analysis.events = told(
        length,
        levels,
        &known,
        interval_s,
        model,
        &analysis.fit.squares(),
        &mut analysis.largest,
    );
    Ok(analysis)
}

/// Whether a round found the same shifts as the one before.
fn has_settled(known: &[Shift], found: &[Shift]) -> bool {
    let mut pairs = known.iter().zip(found);
    known.len() == found.len()
        && pairs.all(|(known, found)| {
            let change = (known.size - found.size) / found.error;
            change * change < SETTLED * SETTLED
        })
}

/// The events: the given shifts, and those of the noise.
#[inline(never)]
fn told(
    block_length: u32,
    mut levels: Vec<Level, BLOCKS>,
    shifts: &[Shift],
    interval_s: Real,
    model: &Model,
    squares: &[Real],
    largest: &mut Largest,
) -> Events {
    let mut events = Events::new();
    let block_s = real(block_length) * interval_s;
    let mut add = |event: Event| {
        list::rank(&mut events, event, |other| other.at_s > event.at_s);
    };
    for shift in shifts {
        add(event(shift, block_s));
        take_step(&mut levels, shift);
    }
    let freedom = noise::freedom_per_difference(model, squares, interval_s);
    noise::find(&levels, freedom, block_s, largest, &mut add);
    events
}

/// The event of a shift.
fn event(shift: &Shift, block_s: Real) -> Event {
    let half = real(TWO_SIDED_95) * shift.error;
    let (what, at_s) = match shift.form {
        Form::Step { place, fraction } => (What::Step, (real(place) + fraction) * block_s),
        Form::WarmUp { time_constant } => {
            let time_constant_s = time_constant * block_s;
            (What::WarmUp { time_constant_s }, 0.0)
        }
    };
    Event {
        what,
        at_s,
        size: shift.size,
        lower: shift.size - half,
        upper: shift.size + half,
        z: shift.size / shift.error,
    }
}

/// Takes the one large difference of a step from the noise of its block, so that it is not reported as a burst as well.
/// The block is the noisiest one near the step. It keeps at least the median noise.
fn take_step(levels: &mut [Level], shift: &Shift) {
    let Form::Step { place, .. } = shift.form else {
        return;
    };
    let steady = median(levels.iter().map(|level| level.square));
    let near = levels
        .iter_mut()
        .filter(|level| level.place.abs_diff(place) <= 1);
    if let Some(level) = near.max_by(|a, b| a.square.total_cmp(&b.square)) {
        let rest = level.square - shift.size * shift.size / level.differences.max(1.0);
        level.square = level.square.min(rest.max(steady));
    }
}
