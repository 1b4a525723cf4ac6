//! The search for the best shape of an effect over the whole range of shapes.

use super::{
    evaluations_a_call,
    grid::Grid,
    likelihood::{Evaluation, Found},
    line::Peak,
    refinement::Refinement,
};
use crate::{
    effect::{Effect, Span},
    limits::MAX_PARAMETERS,
    list,
    model::Term,
    real::Real,
};
use heapless::Vec;

/// The number of the grid's shapes that are refined. A curve has several minima where an effect
/// oscillates, and the lowest one of the grid need not be the lowest one between its steps.
const MINIMA: usize = 4;
/// The fewest steps of the first parameter between two shapes that are refined.
const APART: u32 = 2;

/// The factor by which the frequency of a line may differ from that of its peak: a line between the lowest two bins
/// of a level, 4 and 5, is nearer than that.
const AROUND: Real = 1.4;

/// The same for an effect that is wider than a line, and whose highest bin is a matter of chance. Chosen by hand, and
/// more than enough: a resonance of quality 1 has fallen to a half there.
const AROUND_WIDE: Real = 2.0;

/// The step of shapes with the frequency of a peak, which lie apart from all others.
const AT_PEAK: u32 = u32::MAX;

/// A search over the grid of an effect's shapes. The best shapes of the grid are then refined.
pub(crate) struct GridSearch {
    term: Term,
    grids: [Grid; MAX_PARAMETERS],
    /// A peak, at which the search begins.
    peak: Option<Peak>,
    /// The number of steps of the first parameter that are searched, and the steps among them that are skipped: the
    /// first of them, and the one behind them.
    steps: u32,
    skipped: (u32, u32),
    /// The steps of the two parameters that come next.
    at: [u32; MAX_PARAMETERS],
    /// The best shapes of the grid that lie apart, best first, and their step of the first parameter.
    minima: Vec<(Found, u32), MINIMA>,
    /// The best shape after the refinement of some of the minima.
    best: Found,
    refinement: Option<Refinement>,
}

impl GridSearch {
    /// Begins to search for an effect's shape on a curve of this span.
    pub(crate) fn new(effect: &'static dyn Effect, span: &Span) -> Self {
        let term = Term::fitted(effect);
        let grids: [Grid; MAX_PARAMETERS] = core::array::from_fn(|i| Grid::of(effect, i, span));
        Self {
            term,
            steps: grids.first().map_or(0, |first| first.steps),
            skipped: (0, 0),
            grids,
            peak: None,
            at: [0; MAX_PARAMETERS],
            minima: Vec::new(),
            best: Found::none(term),
            refinement: None,
        }
    }

    /// Begins at a peak. It has no effect on a search that is not for the frequency of an effect that adds power. Such
    /// an effect in the range of the bins is at the peak, so that the grid is searched only around the peak and below
    /// that range.
    pub(crate) fn at_peak(mut self, peak: Option<Peak>) -> Self {
        let parameters = self.term.effect.parameters();
        let is_frequency = parameters.first().is_some_and(|first| first.unit == "Hz");
        let adds_power = self.term.effect.replaces().is_none();
        let Some(peak) = peak.filter(|_| is_frequency && adds_power) else {
            return self;
        };
        self.peak = Some(peak);
        let [first, ..] = self.grids;
        let is_line = parameters.len() == 1;
        let factor = if is_line { AROUND } else { AROUND_WIDE };
        let [below, around, above] = [
            peak.lowest_hz,
            peak.frequency_hz / factor,
            peak.frequency_hz * factor,
        ]
        .map(|frequency_hz| first.steps_to(frequency_hz));
        self.skipped = (below, around.max(below));
        self.steps = above.max(below);
        self
    }

    /// Begins to search among the shapes with this value of a parameter.
    pub(crate) fn with(effect: &'static dyn Effect, j: usize, value: Real, span: &Span) -> Self {
        let mut search = Self::new(effect, span);
        if let Some(grid) = search.grids.get_mut(j) {
            *grid = Grid::only(value);
        }
        search.steps = search.grids.first().map_or(0, |first| first.steps);
        search
    }

    /// Does some evaluations; returns the best shape when no more are to do.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        evaluation: &mut Evaluation<'_, K, B>,
    ) -> Option<Found> {
        if let Some(refinement) = &mut self.refinement {
            let refined = refinement.advance(evaluation)?;
            self.best.improve(refined);
            self.refinement = None;
            if self.minima.is_empty() {
                return Some(self.best);
            }
        }
        let [first, second] = self.grids;
        if let Some(peak) = self.peak.take() {
            for frequency_hz in [peak.frequency_hz, peak.uncorrected_hz] {
                for step in 0..second.steps {
                    self.term.parameters = [first.clamp(frequency_hz), second.at(step)];
                    let found = evaluation.found(self.term);
                    self.keep(found, AT_PEAK);
                }
            }
            return None;
        }
        for _ in 0..evaluations_a_call(B) {
            if self.at[0] >= self.steps {
                let Some((best, _)) = self.minima.pop() else {
                    return Some(self.best);
                };
                self.refinement = Some(Refinement::new(best, self.grids));
                break;
            }
            self.term.parameters = [first.at(self.at[0]), second.at(self.at[1])];
            let found = evaluation.found(self.term);
            self.keep(found, self.at[0]);
            self.at[1] = self.at[1].saturating_add(1);
            if self.at[1] >= second.steps {
                self.at = [self.at[0].saturating_add(1), 0];
            }
            let (skipped, behind) = self.skipped;
            if self.at[0] == skipped && skipped < behind {
                self.at[0] = behind;
            }
        }
        None
    }

    /// Keeps a shape at a step of the first parameter, if it is one of the best and the best one near it.
    fn keep(&mut self, found: Found, at: u32) {
        let parameters = found.term.parameters;
        let effect = found.term.effect;
        // Shapes with different whole numbers have minima of their own.
        let is_alike = |other: &Found| {
            let pairs = parameters.iter().zip(&other.term.parameters);
            list::numbered(pairs).all(|(j, (one, other))| !effect.is_whole(j) || one == other)
        };
        let is_near = |(other, step): &(Found, u32)| step.abs_diff(at) < APART && is_alike(other);
        let is_worse = |other: &Found| other.chi_squared > found.chi_squared;
        let mut near = self.minima.iter().filter(|known| is_near(known));
        if near.any(|(other, _)| !is_worse(other)) {
            return;
        }
        while let Some(place) = self.minima.iter().position(is_near) {
            list::remove(&mut self.minima, place);
        }
        list::rank(&mut self.minima, (found, at), |(other, _)| is_worse(other));
    }
}
