//! How wide a line may be: the resonances that explain a record as well as a sinusoid does.

use crate::{
    error::Error,
    evidence::record::Record,
    fit::{Start, Tolerance, Work},
    limits::ONE_SIDED_95,
    numerics::{
        math,
        real::{Real, real},
    },
    pause::unpaused,
    theory::{
        effect::Effect,
        model::{Model, Term},
    },
};

/// The narrowest resonance that is tried, in widths of the line that the whole record resolves. Chosen by hand: it is
/// as good as a sinusoid.
const NARROWEST: Real = 0.01;
/// The lowest quality that is tried. Chosen by hand: a resonance of a lower one has no line.
const LOWEST_QUALITY: Real = 1.0;
/// The rise of χ² at a one-sided bound of 95 %.
const RISE: Real = (ONE_SIDED_95 * ONE_SIDED_95) as Real;
/// How often the last step, a factor of two, is halved. Chosen by hand: the width is known to 5 % then.
const HALVINGS: u8 = 4;

/// The largest width in Hz, between the points at half the density, that the line at a place of a model may have: a
/// resonance in its place that is wider is excluded with a probability of 95 %. The general effect, of which the
/// line is the special case, is `resonance`; its parameters are the frequency and the quality.
///
/// The bound is that of the profile likelihood of the quality, from one side: `−2 ln L` is higher by 2.71 than that of
/// the best resonance. The frequency stays that of the line, whose error is smaller than any width that is found.
/// `tolerance` is that of the fit to the model. `None` if the model has no such line, or no width is excluded.
///
/// # Errors
/// The same as those of [`fit`](crate::fit::fit()).
pub fn line_width<'a, const K: usize, const B: usize>(
    record: impl Into<Record<'a, K, B>>,
    model: &Model,
    place: usize,
    resonance: &'static dyn Effect,
    tolerance: Real,
) -> Result<Option<Real>, Error> {
    let observed = record.into().observed();
    let special = resonance.description().special_case;
    let lines = model
        .terms()
        .get(place)
        .filter(|term| special.is_some_and(|special| special.name() == term.effect.name()));
    let Some(frequency_hz) = lines.map(|line| line.parameter(0)) else {
        return Ok(None);
    };
    let mut work = Work::NEW;
    let mut score = |width_hz: Real| {
        let mut model = model.clone();
        if let Some(term) = model.terms_mut().get_mut(place) {
            *term = Term::known(resonance, [frequency_hz, frequency_hz / width_hz]);
        }
        let tolerance = Tolerance::Fixed(tolerance);
        unpaused(|pause| work.solve(observed, &model, Start::Independent, tolerance, pause))?;
        Ok(work.solver.minus_two_log_likelihood())
    };
    let samples = observed.curve().points().first();
    let samples = samples.map_or(0, |octave| octave.differences);
    let mut inside = NARROWEST / (real(samples as u32) * observed.interval_s());
    let mut least = score(inside)?;
    loop {
        let wider = 2.0 * inside;
        if wider * LOWEST_QUALITY > frequency_hz {
            return Ok(None);
        }
        let here = score(wider)?;
        if here > least + RISE {
            break;
        }
        least = least.min(here);
        inside = wider;
    }
    let mut step: Real = 2.0;
    for _ in 0..HALVINGS {
        step = math::sqrt(step);
        let here = score(inside * step)?;
        if here <= least + RISE {
            inside *= step;
        }
    }
    Ok(Some(inside * step))
}
