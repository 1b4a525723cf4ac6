//! Second stage: the search for the best shape of every effect beside a model that is not adequate.

use super::step::MAX_CANDIDATES;
use crate::{
    effect::{Effect, Span},
    error::Error,
    fit::{Problem, Solver, Start, Tolerance, Work},
    limits::MAX_PARAMETERS,
    list,
    model::{Model, Term},
    observed::Observed,
    profile::{Evaluation, Found, GridSearch, Peak, Profile, strongest_peak},
    real::Real,
};
use heapless::Vec;

/// The best shapes that a scan found, best first.
pub(super) type Shapes = Vec<Found, MAX_CANDIDATES>;

/// A scan of the effects of a list, in progress. It takes octaves for independent.
pub(super) struct Scanning<const K: usize, const B: usize> {
    profile: Profile<K, B>,
    /// The effect that comes next, and the search for the shape of the present effect, with the
    /// effect's place.
    next: usize,
    search: Option<(GridSearch, usize)>,
    /// The strongest peak of the spectrum that the model lacks.
    peak: Option<Peak>,
    shapes: Shapes,
}

impl<const K: usize, const B: usize> Scanning<K, B> {
    /// A scan that has not begun.
    // Inlined, so that it is set where it stays and not moved there.
    #[inline(always)]
    pub(super) const fn new() -> Self {
        Self {
            profile: Profile::EMPTY,
            next: 0,
            search: None,
            peak: None,
            shapes: Shapes::new(),
        }
    }

    /// Begins to scan beside a solved model. The weights of its solution are replaced.
    pub(super) fn begin(&mut self, problem: &Problem<'_, K, B>, solver: &mut Solver<K, B>) {
        self.peak = strongest_peak(problem, &solver.squares);
        solver.weights.set_independent(problem);
        self.profile.begin(problem, &solver.weights);
    }

    /// The best shapes so far, best first.
    pub(super) const fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// Does some evaluations, and returns whether all effects have been scanned.
    #[inline(never)]
    pub(super) fn advance(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        effects: &[&'static dyn Effect],
        span: &Span,
    ) -> bool {
        if let Some((search, place)) = &mut self.search {
            let mut evaluation = Evaluation::new(&mut self.profile, problem, &solver.weights);
            if let Some(found) = search.advance(&mut evaluation) {
                if found.squares[*place] > 0.0 {
                    list::rank(&mut self.shapes, found, |other| {
                        other.chi_squared > found.chi_squared
                    });
                }
                self.search = None;
            }
            return false;
        }
        let Some(&effect) = effects.get(self.next) else {
            return true;
        };
        self.next = self.next.saturating_add(1);
        // An effect for which the model has no place is left out.
        if let Some(place) = place(problem, effect)
            && self.profile.choose(problem, place, &solver.squares).is_ok()
        {
            let search = GridSearch::new(effect, span).at_peak(self.peak);
            self.search = Some((search, place));
        }
        false
    }
}

/// The best shape of an effect beside a model, in the whole range of shapes. Whole numbers of `term` above zero are
/// kept.
///
/// # Errors
/// As of [`fit`](crate::fit::fit()), and [`Error::Singular`] if no shape can be fitted.
pub(super) fn scan_for<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: &Model,
    term: &Term,
    tolerance: Real,
) -> Result<[Real; MAX_PARAMETERS], Error> {
    let mut work = Work::NEW;
    let tolerance = Tolerance::IfNeeded(tolerance);
    work.begin_at(observed, model, Start::Independent, tolerance)?;
    let problem = Problem::new(observed, model, &work.columns);
    while !work.solver.advance(&problem)? {}
    let squares = work.solver.squares;
    let peak = strongest_peak(&problem, &squares);
    work.solver.weights.set_independent(&problem);
    let mut profile = Profile::EMPTY;
    profile.begin(&problem, &work.solver.weights);
    let effect = term.effect;
    let replaced = effect.replaces();
    let place = replaced.and_then(|replaced| model.position(replaced.name()));
    profile.choose(&problem, place.unwrap_or(problem.count()), &squares)?;
    let span = observed.span();
    let mut whole = (0..MAX_PARAMETERS).filter(|&j| effect.is_whole(j));
    let mut search = match whole.find(|&j| term.parameter(j) > 0.0) {
        Some(j) => GridSearch::with(effect, j, term.parameter(j), &span),
        None => GridSearch::new(effect, &span),
    }
    .at_peak(peak);
    let mut evaluation = Evaluation::new(&mut profile, &problem, &work.solver.weights);
    loop {
        match search.advance(&mut evaluation) {
            None => {}
            Some(found) if found.chi_squared.is_finite() => return Ok(found.term.parameters),
            Some(_) => return Err(Error::Singular),
        }
    }
}

/// The place that an effect would have in a model: that of the effect that it replaces, or the first
/// one behind the others. `None` for an effect that would add nothing. Such an effect has a fixed shape
/// and is in the model already, or replaces an effect that the model lacks or of which a known effect has
/// the place, or shares its Allan variance with another effect of the catalogue, or needs a spectrum that there is
/// not.
pub(crate) fn place<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    effect: &'static dyn Effect,
) -> Option<usize> {
    let model = problem.model;
    let present = model.position(effect.name()).is_some();
    if effect.needs_spectrum() && problem.observed.spectrum().is_none() {
        return None;
    }
    if effect.mirror().is_some() || (present && effect.parameters().is_empty()) {
        return None;
    }
    let has_known = |replaced: &dyn Effect| {
        let mut known = model.terms().iter().filter(|term| !term.fitted);
        known.any(|term| {
            let other = term.effect.replaces();
            other.is_some_and(|other| other.name() == replaced.name())
        })
    };
    match effect.replaces() {
        Some(replaced) if has_known(replaced) => None,
        Some(replaced) => model.position(replaced.name()),
        None => Some(problem.count()),
    }
}
