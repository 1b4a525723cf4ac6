//! A model: the effects that make up a curve.

use crate::{
    error::Error,
    limits::MAX_PARAMETERS,
    list,
    numerics::real::{Real, real},
    theory::effect::{
        AngleRandomWalk, Behind, Distribution, Effect, IEEE_952, SampledShape, padded,
    },
};
use heapless::Vec;

pub use crate::limits::MAX_EFFECTS;

/// One effect of a model, with its shape.
#[derive(Clone, Copy)]
pub struct Term {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// The effect's shape parameters, in the order in which the effect names them.
    pub parameters: [Real; MAX_PARAMETERS],
    /// Whether the shape was found on the curve that the model is fitted to. Such a shape costs degrees
    /// of freedom, and widens the intervals of the coefficients.
    pub fitted: bool,
    /// Whether the coefficient is held at zero, because a fitted shape could take its place and the
    /// curve does not distinguish the two.
    pub pinned: bool,
}

impl Term {
    /// An effect without shape parameters.
    pub fn new(effect: &'static dyn Effect) -> Self {
        Self {
            effect,
            parameters: [0.0; MAX_PARAMETERS],
            fitted: false,
            pinned: false,
        }
    }

    /// An effect whose shape is known, such as the filter of a sensor's data sheet. The parameters come in the order
    /// in which the effect names them. There may be up to [`MAX_PARAMETERS`] of them.
    pub fn known<const N: usize>(effect: &'static dyn Effect, parameters: [Real; N]) -> Self {
        Self {
            parameters: padded(parameters),
            ..Self::new(effect)
        }
    }

    /// An effect whose shape, if it has one, is to be fitted.
    pub(crate) fn fitted(effect: &'static dyn Effect) -> Self {
        Self {
            fitted: !effect.parameters().is_empty(),
            ..Self::new(effect)
        }
    }

    /// Indices of the shape parameters that were fitted.
    pub(crate) fn fitted_parameters(&self) -> impl Iterator<Item = usize> + use<> {
        let (effect, fitted) = (self.effect, self.fitted);
        let all = 0..effect.parameters().len().min(MAX_PARAMETERS);
        all.filter(move |&i| fitted && !effect.is_whole(i))
    }

    /// A shape parameter, or 0 for a place beyond [`MAX_PARAMETERS`].
    pub(crate) fn parameter(&self, j: usize) -> Real {
        self.parameters.get(j).copied().unwrap_or(0.0)
    }

    pub(crate) fn set_parameter(&mut self, j: usize, value: Real) {
        if let Some(parameter) = self.parameters.get_mut(j) {
            *parameter = value;
        }
    }

    pub(crate) fn scale_parameter(&mut self, j: usize, factor: Real) {
        self.set_parameter(j, self.parameter(j) * factor);
    }

    /// Goes from a shape at which the effect no longer changes with a parameter to the nearest one at which it does.
    pub(crate) fn make_distinct(&mut self, interval_s: Real) {
        self.parameters = self.effect.canonical(&self.sampled_shape(interval_s));
    }

    pub(crate) fn parameter_name(&self, j: usize) -> &'static str {
        let parameters = self.effect.parameters();
        parameters.get(j).map_or("", |parameter| parameter.name)
    }

    /// The effect's shape for samples that lie `interval_s` seconds apart.
    pub fn sampled_shape(&self, interval_s: Real) -> SampledShape {
        SampledShape {
            interval_s,
            parameters: self.parameters,
        }
    }
}

impl core::fmt::Debug for Term {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}{:?}", self.effect.name(), self.parameters)
    }
}

/// A list of effects, each with a coefficient that a fit determines.
#[derive(Clone, Debug, Default)]
pub struct Model {
    terms: Vec<Term, MAX_EFFECTS>,
}

impl Model {
    /// The five terms of IEEE Std 952: quantization, angle random walk, bias instability, rate random
    /// walk and rate ramp.
    pub fn ieee_952() -> Self {
        Self {
            // The five terms fit into eight places.
            terms: list::fill(IEEE_952.into_iter().map(Term::new)),
        }
    }

    /// A model of these effects. None of their shape parameters is set or fitted.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] for more than [`MAX_EFFECTS`].
    pub fn new(effects: &[&'static dyn Effect]) -> Result<Self, Error> {
        let mut model = Self::default();
        for effect in effects {
            model.add(Term::new(*effect))?;
        }
        Ok(model)
    }

    /// Adds an effect.
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] if the model already has [`MAX_EFFECTS`].
    pub fn add(&mut self, term: Term) -> Result<(), Error> {
        self.terms.push(term).map_err(|_| Error::TooManyEffects {
            capacity: MAX_EFFECTS,
        })
    }

    /// Adds an effect in the place of the effect that it replaces, such as a filter on white noise in the place of
    /// the angle random walk; at the end if the model has no such effect.
    ///
    /// A [diagnosis](crate::diagnosis) keeps what its first model has: it never removes an effect of
    /// [known](Term::known) shape, and never looks for another filter on the same noise.
    ///
    /// ```
    /// use allanite::{Model, Term, effect::LowPass};
    ///
    /// // A sensor whose data sheet gives a cut-off of 42 Hz and two poles.
    /// let time_constant_s = 1.0 / (2.0 * core::f32::consts::PI * 42.0);
    /// let mut model = Model::ieee_952();
    /// model.put(Term::known(&LowPass, [time_constant_s.into(), 2.0]))?;
    /// assert_eq!(model.position("low_pass"), Some(1));
    /// assert_eq!(model.position("angle_random_walk"), None);
    /// # Ok::<(), allanite::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::TooManyEffects`] if the model already has [`MAX_EFFECTS`] and the effect replaces none of them.
    pub fn put(&mut self, term: Term) -> Result<(), Error> {
        let replaced = term.effect.replaces();
        let place = replaced.and_then(|replaced| self.position(replaced.name()));
        match place.and_then(|place| self.terms.get_mut(place)) {
            Some(replaced) => {
                *replaced = term;
                Ok(())
            }
            None => self.add(term),
        }
    }

    /// Puts an effect without a shape back. One of the five terms returns to its usual place, another
    /// one to the end. Returns its place.
    pub(crate) fn restore(&mut self, effect: &'static dyn Effect) -> Result<usize, Error> {
        let usual = IEEE_952.iter().position(|e| e.name() == effect.name());
        let place = usual.unwrap_or(MAX_EFFECTS).min(self.terms.len());
        if self.terms.is_full() {
            return Err(Error::TooManyEffects {
                capacity: MAX_EFFECTS,
            });
        }
        list::insert(&mut self.terms, place, Term::new(effect));
        Ok(place)
    }

    /// The model without the effect of that name, if it has one.
    #[must_use]
    pub fn without(&self, name: &str) -> Self {
        let rest = self.terms.iter().filter(|term| term.effect.name() != name);
        Self {
            terms: list::fill(rest.copied()),
        }
    }

    /// Removes the effect of that name, or the later one if there are two. Returns its place.
    pub(crate) fn remove(&mut self, name: &str) -> Option<usize> {
        let mut terms = self.terms.iter();
        let place = terms.rposition(|term| term.effect.name() == name)?;
        list::remove(&mut self.terms, place);
        Some(place)
    }

    /// Removes the effect at a place, if there is one.
    pub(crate) fn take(&mut self, place: usize) {
        list::remove(&mut self.terms, place);
    }

    /// The place of the effect of that name.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.terms
            .iter()
            .position(|term| term.effect.name() == name)
    }

    pub(crate) fn terms_mut(&mut self) -> &mut [Term] {
        &mut self.terms
    }

    /// The filter that all noise without a shape passes, with its place; `None` if there is none.
    pub(crate) fn passing(&self) -> Option<(usize, &Term)> {
        let mut terms = self.terms.iter().enumerate();
        terms.find(|(_, term)| term.effect.passes_all())
    }

    /// The filter of all noise that effect `i` [passes](Effect::passes_all), if the model has one: the effect is noise, and
    /// has no shape.
    pub fn filter_of(&self, i: usize) -> Option<&Term> {
        let (_, filter) = self.passing()?;
        self.terms.get(i).is_some_and(is_passed).then_some(filter)
    }

    /// What effect `i` contributes to the model's Allan variance at the averaging factor `m`, for a coefficient of one: that
    /// behind the filter, if all noise [passes](Effect::passes_all) one. `interval_s` is the sample interval in seconds. It is
    /// 0 for an effect beyond the model.
    pub fn unit_variance(&self, i: usize, m: Real, interval_s: Real) -> Real {
        let Some(term) = self.terms.get(i) else {
            return 0.0;
        };
        match self.filter_of(i) {
            Some(filter) => {
                let shape = filter.sampled_shape(interval_s);
                match Behind::new(term.effect, filter.effect, &shape) {
                    Some(behind) => behind.variance(m, &shape),
                    None => {
                        let white = 1.0 / (m * interval_s);
                        let passed = filter.effect.variance(m, &shape) / white;
                        term.effect.variance(m, &shape) * passed
                    }
                }
            }
            None => term.effect.variance(m, &term.sampled_shape(interval_s)),
        }
    }

    /// The effects, in the order in which they were added.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The model's Allan variance at the averaging factor `m`, in rate units squared. `squares` holds
    /// the squared coefficients in the order of the effects, and `interval_s` is the sample interval in
    /// seconds.
    pub fn variance(&self, squares: &[Real], m: u32, interval_s: Real) -> Real {
        let shares = list::numbered(squares).take(self.terms.len());
        shares
            .map(|(i, square)| square * self.unit_variance(i, real(m), interval_s))
            .sum()
    }
}

/// Whether a term passes a filter that all noise passes: it is noise, and has no shape. The white noise in front of the filter
/// is that of the filter itself, so that other white noise comes from behind it, such as the rounding of its output.
pub(crate) fn is_passed(term: &Term) -> bool {
    let description = term.effect.description();
    description.parameters.is_empty()
        && description.distribution == Distribution::Gaussian
        && !is_white(term.effect)
}

/// The white noise that filters work on.
const WHITE: &dyn Effect = &AngleRandomWalk;

/// Whether an effect is that white noise.
pub(crate) fn is_white(effect: &dyn Effect) -> bool {
    effect.name() == WHITE.name()
}

#[cfg(test)]
mod tests;
