//! The shapes of effects that are known to be in a model, fitted to a record.

use super::{
    polish::polished,
    search::{Observation, best_shape_of},
};
use crate::{
    error::Error,
    evidence::{observed::Observed, record::Record},
    fit::{Start, Tolerance, Work},
    limits::MAX_PARAMETERS,
    numerics::real::Real,
    pause::unpaused,
    theory::model::{Model, Term},
};

/// How often the shapes are polished at most. One time ends after ten rounds, or when half a step leads too far, and
/// the next one goes on with a new covariance. Chosen by hand: from a line that is a few per cent off, two to four
/// times lead to the minimum.
const POLISHES: u8 = 8;

/// The shapes have settled when none of their logarithms changes by more than this. Chosen by hand, to save time: it is
/// small compared with the interval of any shape that a record of a million samples shows.
const SETTLED: Real = 1e-4;

/// Fits the shapes of those effects of a model whose [`fitted`](field@Term::fitted) is set, all together, and returns the model
/// with them. Whole numbers are kept, and so are the shapes of all other effects.
///
/// The fit begins at the shapes that the model has, and ends in the minimum of `−2 ln L` near them. A shape of zeros
/// is first searched for in the whole range of its effect, given the effects whose shapes are known by then; a
/// whole number above zero in it is kept. `tolerance` is that of
/// [`fit::Options`](crate::fit::Options::tolerance), and [`fit`](crate::fit::fit()) of the returned model gives the
/// coefficients and the intervals of the shapes.
///
/// ```
/// use allanite::{Accumulator, Model, Scale, Term, diagnosis::fit_shapes, effect::Sinusoid, fit::Options};
///
/// // White noise, and a line of 5 Hz, sampled at 100 Hz.
/// let (mut gyro, mut random) = (Accumulator::<12>::new(), 1_u32);
/// for n in 0..1 << 14 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     let line = 300.0 * (0.1 * std::f64::consts::PI * f64::from(n)).sin();
///     gyro.push((random >> 24) as i32 + line as i32);
/// }
/// let curve = gyro.curve(Scale::new(0.01, 100.0)?);
/// let mut model = Model::ieee_952();
/// model.put(Term { fitted: true, ..Term::new(&Sinusoid) })?;
/// let model = fit_shapes(&curve, &model, Options::default().tolerance)?;
/// assert!((model.terms()[5].parameters[0] - 5.0).abs() < 0.05);
/// # Ok::<(), allanite::Error>(())
/// ```
///
/// # Errors
/// The same as those of [`fit`](crate::fit::fit()), and [`Error::Singular`] if no shape in its range can be fitted.
pub fn fit_shapes<'a, const K: usize, const B: usize>(
    record: impl Into<Record<'a, K, B>>,
    model: &Model,
    tolerance: Real,
) -> Result<Model, Error> {
    let observed = record.into().observed();
    let mut shaped = model.clone();
    while let Some((place, term)) = first_unknown(&shaped) {
        let found = best_shape(observed, &with_known_shapes(&shaped)?, &term)?;
        if let Some(term) = shaped.terms_mut().get_mut(place) {
            term.parameters = found;
        }
    }
    if shaped.terms().iter().all(|term| !term.fitted) {
        return Ok(shaped);
    }
    for _ in 0..POLISHES {
        let granted = granted(observed, &shaped, tolerance)?;
        let granted = Tolerance::Fixed(granted);
        let polished = unpaused(|pause| polished(observed, shaped.clone(), granted, pause))?.model;
        let settled = are_settled(&shaped, &polished);
        shaped = polished;
        if settled {
            break;
        }
    }
    Ok(shaped)
}

/// Whether the shape of a term is to be looked for in its whole range.
fn is_unknown(term: &Term) -> bool {
    term.fitted_parameters().any(|j| term.parameter(j) == 0.0)
}

/// Whether the shapes of two models hardly differ.
fn are_settled(before: &Model, after: &Model) -> bool {
    let mut pairs = before.terms().iter().zip(after.terms());
    pairs.all(|(before, after)| {
        let mut fitted = after.fitted_parameters();
        fitted.all(|j| {
            let ratio = after.parameter(j) / before.parameter(j);
            (1.0 - SETTLED..1.0 + SETTLED).contains(&ratio)
        })
    })
}

fn first_unknown(model: &Model) -> Option<(usize, Term)> {
    let place = model.terms().iter().position(is_unknown)?;
    let term = model.terms().get(place)?;
    Some((place, *term))
}

/// The model without the effects whose shapes are not known yet. What they replace comes back.
fn with_known_shapes(model: &Model) -> Result<Model, Error> {
    let mut known = model.clone();
    while let Some((place, term)) = first_unknown(&known) {
        known.take(place);
        if let Some(replaced) = term.effect.replaces() {
            known.restore(replaced)?;
        }
    }
    Ok(known)
}

/// The tolerance that a fit of the model is granted.
fn granted<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: &Model,
    tolerance: Real,
) -> Result<Real, Error> {
    let mut work = Work::NEW;
    let tolerance = Tolerance::IfNeeded(tolerance);
    unpaused(|pause| work.solve(observed, model, Start::Independent, tolerance, pause))?;
    Ok(work.solver.weights.tolerance)
}

/// The best shape of an effect that is added to a model, in the whole range of shapes. A whole number above zero is kept.
fn best_shape<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: &Model,
    term: &Term,
) -> Result<[Real; MAX_PARAMETERS], Error> {
    let observation = Observation::new(observed, None);
    let found = best_shape_of(&observation, model, term);
    found.map(|found| found.parameters).ok_or(Error::Singular)
}
