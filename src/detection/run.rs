//! The limits of all effects of a list.

use super::{
    excess::{Excess, is_noise},
    limit::{Limit, is_of_shape},
};
use crate::{
    diagnosis::{
        Options, Step,
        search::{Observation, price},
    },
    evidence::{observed::Observed, record::Record},
    fit::profile::Grid,
    limits::MAX_PARAMETERS,
    list,
    numerics::{math, real::Real},
    pause::Pause,
    theory::{
        effect::{Effect, Span},
        model::Term,
    },
};
use core::ops::ControlFlow;

/// The number of values of the first shape parameter for each factor of two. Between them, the limit of a
/// sinusoid changes by up to 10 %, because an octave grid sees some frequencies better than others.
const STEPS_AN_OCTAVE: Real = 4.0;

/// The periods that a record needs for a limit of an oscillation. Chosen by hand.
const PERIODS: Real = 8.0;

/// The correlation times that a record needs for a limit of noise. With fewer, a random walk follows one record's noise as
/// well as the noise itself does: in the study `detection`, noise of a thirtieth of the record shows in half of the records
/// at any size.
const TIMES: Real = 40.0;

/// How often the limit of a coefficient, and that of a shape, is halved at most.
const COEFFICIENT_STEPS: u8 = 24;
const SHAPE_STEPS: u8 = 12;

/// The ratio of neighbouring lengths of a filter that are tried first.
const LONGER: Real = 1.3;

/// The relative difference of two sizes that are the same.
const AGREES: Real = 0.004;

/// The size of each effect that a record would have shown in addition to the final model of a diagnosis.
///
/// Nothing is computed unless it is asked for, and a program that does not name this type holds none of its code.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, Model, Scale};
/// use allanite::detection::{Detection, Ranges};
/// use allanite::diagnosis::{Diagnosis, Options};
/// use allanite::effect::CATALOGUE;
/// use core::ops::ControlFlow;
///
/// let mut gyro = Accumulator::<12>::new();
/// let mut random = 1_u32;
/// for _ in 0..10_000 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     gyro.push((random >> 24) as i32);
/// }
/// let curve = gyro.curve(Scale::new(0.01, 100.0)?);
/// let (model, options) = (Model::ieee_952(), Options::default());
/// let mut pause = || ControlFlow::Continue(()); // feed the watchdog, take the next samples
/// let mut last = None;
/// Diagnosis::new(&curve, &model, &CATALOGUE, options)
///     .run(|step| last = Some(step.clone()), &mut pause)?;
/// let Some(step) = last else { return Ok(()) };
///
/// let mut ranges = Ranges::default();
/// Detection::new(&curve, &step, &CATALOGUE, options)
///     .run(|limit| ranges.push(&limit), &mut pause);
/// let mut ranges = ranges.as_slice().iter();
/// let sinusoid = ranges.find(|range| range.effect.name() == "sinusoid");
/// // The samples have a standard deviation of 0.74 °/s.
/// assert!(sinusoid.is_some_and(|range| range.size < 0.74));
/// # Ok::<(), allanite::Error>(())
/// ```
pub struct Detection<'a, const K: usize, const B: usize = 0> {
    record: Record<'a, K, B>,
    step: &'a Step<K, B>,
    effects: &'a [&'static dyn Effect],
    options: Options,
}

impl<'a, const K: usize, const B: usize> Detection<'a, K, B> {
    /// The limits of detection given the model of a step, which is the last one of a diagnosis. The curve and the spectrum of the record
    /// are those on which the step was judged, without what follows a covariate. `effects` and `options` are those of the
    /// diagnosis.
    ///
    /// There are no limits if the model is not adequate.
    pub fn new(
        record: impl Into<Record<'a, K, B>>,
        step: &'a Step<K, B>,
        effects: &'a [&'static dyn Effect],
        options: Options,
    ) -> Self {
        Self {
            record: record.into(),
            step,
            effects,
            options,
        }
    }

    /// Calls `each` for every limit, and `pause` between two pieces of work. Returns `None` if the pause ended it.
    pub fn run(
        &self,
        mut each: impl FnMut(Limit),
        pause: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Option<()> {
        let done = self.with_excess(|excess| {
            for effect in self.effects.iter().copied() {
                let is_missing = self.step.model.position(effect.name()).is_none();
                if is_missing && self.has_limit(effect) {
                    self.of_effect(effect, excess, &mut each, pause)?;
                }
            }
            ControlFlow::Continue(())
        });
        match done {
            Some(ControlFlow::Break(())) => None,
            _ => Some(()),
        }
    }

    /// The limit of one shape. The first parameter of a filter is replaced by its limit. `None` if the
    /// effect hides in the model, if it has no shape, or if the model is not adequate.
    pub fn limit_of(&self, term: Term) -> Option<Limit> {
        if term.effect.parameters().is_empty() {
            return None;
        }
        let mut go_on = || ControlFlow::Continue(());
        let found = self.with_excess(|excess| self.of_shape(term, excess, &mut go_on))?;
        match found {
            ControlFlow::Continue(limit) => limit,
            ControlFlow::Break(()) => None,
        }
    }

    /// Works with the record as the model explains it; `None` if it does not.
    #[inline(never)]
    fn with_excess<T>(&self, work: impl FnOnce(&mut Excess<'_, '_, B>) -> T) -> Option<T> {
        if self.step.fit.is_adequate() != Some(true) {
            return None;
        }
        let observed: Observed<'a, K, B> = self.record.observed();
        let course = self.record.course.filter(|_| self.step.covariate.is_none());
        let observation = Observation::new(observed, course);
        let squares = self.step.fit.squares();
        let mut excess = Excess::new(&observation, &self.step.model, &squares)?;
        Some(work(&mut excess))
    }

    fn span(&self) -> Span {
        self.record.curve.span()
    }

    /// Whether there is a size from which on an effect shows in addition to the model. That of a filter is its length, which a
    /// filter around a frequency does not have.
    fn has_limit(&self, effect: &'static dyn Effect) -> bool {
        let Some(first) = effect.parameters().first() else {
            return false;
        };
        let sees = self.record.observed().spectrum().is_some() || !effect.needs_spectrum();
        let model = &self.step.model;
        let has_place = effect
            .replaces()
            .is_none_or(|replaced| model.position(replaced.name()).is_some());
        let is_around = is_of_shape(effect) && first.unit == "Hz";
        // The limit of a more general form is that of its special case, or a little more.
        let is_general = effect.replaces().is_some() && effect.description().special_case.is_some();
        let is_drifting = effect
            .parameters()
            .last()
            .is_some_and(|last| last.name == "drift_hz");
        // The five terms follow a power law, and white noise that rises, of any size in too many records: of those at what
        // would be its limit, 31 to 41 % and 25 to 28 % showed it (`cargo xtask study detection`).
        let is_followed = ["exponent", "rise_hz"].contains(&first.name);
        let is_odd = is_around || is_general || is_drifting || is_followed;
        sees && has_place && !is_odd && effect.mirror().is_none()
    }

    /// The limits of all shapes of an effect: for each value of its first parameter the largest one of the others.
    #[inline(never)]
    fn of_effect(
        &self,
        effect: &'static dyn Effect,
        excess: &mut Excess<'_, '_, B>,
        each: &mut dyn FnMut(Limit),
        pause: &mut Pause<'_>,
    ) -> ControlFlow<()> {
        let span = self.span();
        let grids: [Grid; MAX_PARAMETERS] =
            core::array::from_fn(|j| Grid::coarse(effect, j, &span, STEPS_AN_OCTAVE));
        let [first, others @ ..] = grids;
        let firsts = if is_of_shape(effect) { 1 } else { first.steps };
        let shapes = others
            .iter()
            .fold(1_u32, |n, grid| n.saturating_mul(grid.steps));
        for at in 0..firsts {
            let mut worst: Option<Limit> = None;
            let mut hides = false;
            for shape in 0..shapes {
                let mut rest = shape;
                let mut term = Term::fitted(effect);
                term.set_parameter(0, first.at(at));
                for (j, grid) in list::numbered(others.iter()) {
                    term.set_parameter(j.saturating_add(1), grid.at(rest % grid.steps.max(1)));
                    rest /= grid.steps.max(1);
                }
                match self.of_shape(term, excess, pause)? {
                    None => hides = true,
                    Some(limit) if worst.is_none_or(|worst| worst.size() < limit.size()) => {
                        worst = Some(limit);
                    }
                    Some(_) => {}
                }
            }
            if let Some(worst) = worst.filter(|_| !hides) {
                each(worst);
            }
        }
        ControlFlow::Continue(())
    }

    /// The limit of one shape.
    fn of_shape(
        &self,
        term: Term,
        excess: &mut Excess<'_, '_, B>,
        pause: &mut Pause<'_>,
    ) -> ControlFlow<(), Option<Limit>> {
        let needed = price(
            &term,
            self.record.curve.interval_s(),
            self.options.threshold,
            excess.has_bins(),
        ) + excess.surcharge();
        // What a record shows of few periods depends on their phase.
        let first = term.effect.parameters().first();
        let has_frequency = first.is_some_and(|first| first.unit == "Hz");
        if has_frequency && excess.periods(term.parameter(0)) < PERIODS {
            return ControlFlow::Continue(None);
        }
        if is_noise(&term) && excess.times(term.parameter(0)) < TIMES {
            return ControlFlow::Continue(None);
        }
        if is_of_shape(term.effect) {
            self.of_filter(term, needed, excess, pause)
        } else {
            of_coefficient(term, needed, excess, pause)
        }
    }

    /// The least first parameter of a filter that shows.
    fn of_filter(
        &self,
        term: Term,
        needed: Real,
        excess: &mut Excess<'_, '_, B>,
        pause: &mut Pause<'_>,
    ) -> ControlFlow<(), Option<Limit>> {
        let Some(range) = term.effect.search_range(0, &self.span()) else {
            return ControlFlow::Continue(None);
        };
        // The shortest filter does nothing, and a far longer one is taken for another coefficient.
        let (mut low, mut high) = (range.low, range.low);
        let mut found: Option<Limit> = None;
        while found.is_none() {
            pause()?;
            low = high;
            high *= LONGER;
            if high > range.high {
                return ControlFlow::Continue(None);
            }
            found = with_length(term, high, needed, excess);
        }
        for _ in 0..SHAPE_STEPS {
            pause()?;
            let size = math::sqrt(low * high);
            match with_length(term, size, needed, excess) {
                Some(limit) => {
                    found = Some(limit);
                    high = size;
                }
                None => low = size,
            }
            if high < low * (1.0 + AGREES) {
                break;
            }
        }
        ControlFlow::Continue(found)
    }
}

/// The limit of a filter of this length, if it shows.
fn with_length<const B: usize>(
    term: Term,
    length: Real,
    needed: Real,
    excess: &mut Excess<'_, '_, B>,
) -> Option<Limit> {
    let mut tried = term;
    tried.set_parameter(0, length);
    excess.set(&tried);
    excess.of_filter(needed)
}

/// The least coefficient of an effect that shows.
fn of_coefficient<const B: usize>(
    term: Term,
    needed: Real,
    excess: &mut Excess<'_, '_, B>,
    pause: &mut Pause<'_>,
) -> ControlFlow<(), Option<Limit>> {
    excess.set(&term);
    // A size in units of the largest share of the model in any row.
    let (mut low, mut high) = (1e-4, excess.most());
    if excess.of_size(high, needed).is_none() {
        return ControlFlow::Continue(None);
    }
    for _ in 0..COEFFICIENT_STEPS {
        pause()?;
        let size = math::sqrt(low * high);
        if excess.of_size(size, needed).is_some() {
            high = size;
        } else {
            low = size;
        }
        if high < low * (1.0 + AGREES) {
            break;
        }
    }
    ControlFlow::Continue(excess.of_size(high, needed))
}
