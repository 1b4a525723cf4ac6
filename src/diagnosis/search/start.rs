//! The first hypotheses: every filter at its best shape, with the narrow peaks left out.

use super::{
    hypothesis::{Added, Hypothesis},
    likelihood::kept,
    refine::{Bars, Solver},
    rows::Observation,
    variant::Variant,
};
use crate::{
    list::numbered,
    numerics::{
        math,
        real::{Real, real, single},
    },
    spectrum::Bin,
    theory::{effect::Effect, model::Term},
};
use core::ops::ControlFlow;

/// The shapes of a filter that are tried for each factor of two of its first parameter, and of each other one.
pub(super) const FILTER_STEPS: Real = 1.0;
pub(super) const FILTER_OTHERS: u32 = 3;

/// The frequency at which a mean passes half of the white noise, times its length.
const HALF_OF_MEAN: Real = 0.443;

/// The correlation times that are tried for each factor of two.
const NOISE_STEPS: Real = 1.0;
const NOISE_OTHERS: u32 = 3;

/// What a filter gains in the continuum before it is taken further.
const ASKED_FOR: Real = 2.0;

/// How far a peak stands above the neighbourhood before it is left out: by this much, and by this many standard errors.
const ABOVE: Real = 0.12;
const STANDARD_ERRORS: Real = 4.5;
/// The logarithm by which a bin with too few neighbours has to exceed them.
const WITHOUT_NEIGHBOURS: Real = 0.15;

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// Tries every filter, without and with noise of each of these effects. `each` gets the hypothesis as the whole record
    /// sees it, and its score in the continuum.
    pub(super) fn start(
        &mut self,
        variants: &mut dyn Iterator<Item = Variant>,
        noises: &[&'static dyn Effect],
        effects: &[&'static dyn Effect],
        each: &mut dyn FnMut(&Hypothesis, Real) -> Real,
    ) -> ControlFlow<()> {
        self.shapes.clear();
        // Scores in the continuum compare with no others.
        let mut bars = self.bars;
        let mut plain: Option<Real> = None;
        let mut best: Option<(Term, Real)> = None;
        let mut next = Some(None);
        while let Some(variant) = next {
            leave_out_peaks(self.observation, &mut self.work.shape);
            let found = match variant {
                None => self.refine(Hypothesis::new(None, Added::new()), 8)?,
                Some(variant) => {
                    let found = self.best_filter(variant, &Hypothesis::new(None, Added::new()))?;
                    let found = self.refine(found, 8)?;
                    if let Some(filter) = found.filter {
                        let _ = self.shapes.push(filter);
                    }
                    found
                }
            };
            // A filter that the continuum does not ask for tells no other story. Additions may ask for it later.
            let plain = *plain.get_or_insert(found.score);
            let is_asked_for = found.filter.is_none() || found.score < plain - ASKED_FOR;
            next = variants.next().map(Some);
            if !is_asked_for {
                continue;
            }
            if let Some(filter) = &found.filter
                && best.as_ref().is_none_or(|(_, least)| found.score < *least)
            {
                best = Some((*filter, found.score));
            }
            self.whole(found.clone(), &mut bars, each)?;
            leave_out_peaks(self.observation, &mut self.work.shape);
            if let Some(of_all) = self.passing(effects, &found)? {
                self.whole(of_all, &mut bars, each)?;
            }
            for noise in noises {
                leave_out_peaks(self.observation, &mut self.work.shape);
                if let Some(with) = self.scan_noise(*noise, &found)? {
                    let with = self.refine(with, 10)?;
                    self.whole(with, &mut bars, each)?;
                }
            }
        }
        if let Some((filter, _)) = best.filter(|_| B > 0 && self.observation.has_bins())
            && let Some(mean) = self.mean_like(effects, &filter)?
        {
            self.whole(mean, &mut bars, each)?;
        }
        self.bars = bars;
        self.work.shape = self.observation.shape;
        ControlFlow::Continue(())
    }

    /// The hypothesis in which all noise passes the filter; `None` if the list has no such filter.
    pub(super) fn passing(
        &mut self,
        effects: &[&'static dyn Effect],
        hypothesis: &Hypothesis,
    ) -> ControlFlow<(), Option<Hypothesis>> {
        // Octaves hardly show the other noise behind a filter. Without room for bins, none of this is compiled.
        if B == 0 || !self.observation.has_bins() {
            return ControlFlow::Continue(None);
        }
        let Some(filter) = &hypothesis.filter else {
            return ControlFlow::Continue(None);
        };
        let filters = Variant::passing(effects, filter, self.observation.interval_s);
        // Means alone are looked for once, on the whole record.
        let is_alone = hypothesis.added.is_empty();
        let mut filters = filters.filter(|filter| !(is_alone && filter.effect.is_whole(0)));
        self.best_of(&mut filters, &hypothesis.added)
    }

    /// The means over samples that pass about what a filter passes, the best one of them; `None` if the list has none.
    fn mean_like(
        &mut self,
        effects: &[&'static dyn Effect],
        filter: &Term,
    ) -> ControlFlow<(), Option<Hypothesis>> {
        let Some(cutoff_hz) = self.cutoff_hz(filter) else {
            return ControlFlow::Continue(None);
        };
        let samples = HALF_OF_MEAN / (cutoff_hz * self.observation.interval_s);
        // What lies between the zeros of a mean looks like peaks, and tells how many samples there are.
        self.work.shape = self.observation.shape;
        let mut filters = Variant::means(effects, samples);
        self.best_of(&mut filters, &Added::new())
    }

    /// The best of these filters, given what is added.
    fn best_of(
        &mut self,
        filters: &mut dyn Iterator<Item = Term>,
        added: &Added,
    ) -> ControlFlow<(), Option<Hypothesis>> {
        let mut best: Option<(Hypothesis, Real)> = None;
        for filter in filters {
            let tried = Hypothesis::new(Some(filter), added.clone());
            let deviance = self.deviance(&tried)?;
            if best.as_ref().is_none_or(|(_, least)| deviance < *least) {
                best = Some((tried, deviance));
            }
        }
        match best {
            Some((begun, _)) => ControlFlow::Continue(Some(self.refine(begun, 8)?)),
            None => ControlFlow::Continue(None),
        }
    }

    /// Refines a hypothesis of the continuum on the whole record.
    fn whole(
        &mut self,
        hypothesis: Hypothesis,
        bars: &mut Bars,
        each: &mut dyn FnMut(&Hypothesis, Real) -> Real,
    ) -> ControlFlow<()> {
        let masked = hypothesis.score;
        core::mem::swap(&mut self.bars, bars);
        self.work.shape = self.observation.shape;
        let whole = self.refine(hypothesis, 3)?;
        let bar = each(&whole, masked);
        self.raise(&whole, bar);
        core::mem::swap(&mut self.bars, bars);
        ControlFlow::Continue(())
    }

    /// A hypothesis behind another filter, at the best shape of the filter's grid.
    #[inline(never)]
    pub(super) fn best_filter(
        &mut self,
        variant: Variant,
        hypothesis: &Hypothesis,
    ) -> ControlFlow<(), Hypothesis> {
        let mut best = hypothesis.clone();
        best.filter = None;
        self.load(&best)?;
        let mut least = Real::INFINITY;
        for term in variant
            .grid(self.observation, FILTER_STEPS, FILTER_OTHERS)
            .terms()
        {
            (self.pause)()?;
            self.work.change_own(self.observation, 0, &term);
            self.work.pass(self.observation, Some(&term));
            let deviance = self.work.solve(2);
            if deviance < least {
                least = deviance;
                best.filter = Some(term);
                best.squares = kept(&self.work.squares);
            }
        }
        ControlFlow::Continue(best)
    }

    /// A hypothesis with noise of one more effect, at the best shape of its grid. All coefficients are fitted anew for each
    /// shape, because slow noise shows by what flicker and random walks lose. `None` if there is no room.
    #[inline(never)]
    pub(super) fn scan_noise(
        &mut self,
        effect: &'static dyn Effect,
        hypothesis: &Hypothesis,
    ) -> ControlFlow<(), Option<Hypothesis>> {
        self.load(hypothesis)?;
        let mut best: Option<Hypothesis> = None;
        let mut least = Real::INFINITY;
        let own = self.work.own();
        for variant in Variant::of(effect, &self.observation.span) {
            for term in variant
                .grid(self.observation, NOISE_STEPS, NOISE_OTHERS)
                .terms()
            {
                (self.pause)()?;
                let Some(with) = hypothesis.with(term, self.limits.effects) else {
                    return ControlFlow::Continue(None);
                };
                self.work.keep_own(own);
                self.work.add_own(self.observation, &term);
                let deviance = self.work.solve(3);
                if deviance < least {
                    least = deviance;
                    let squares = kept(&self.work.squares);
                    best = Some(Hypothesis { squares, ..with });
                }
            }
        }
        ControlFlow::Continue(best)
    }
}

/// Sets the rows' shapes, those of narrow peaks and their neighbours to zero. A peak stands above the median of the bins
/// three to five places away, on both sides.
#[inline(never)]
fn leave_out_peaks<const B: usize>(
    observation: &Observation<'_, B>,
    shape: &mut super::values::Values<B>,
) {
    *shape = observation.shape;
    for (first, bins) in observation.levels() {
        let log = |b: usize| {
            bins.get(b)
                .map(|bin: &Bin| math::log(bin.density.max(Real::MIN_POSITIVE)))
        };
        for (b, bin) in numbered(bins) {
            let Some(own) = log(b) else { continue };
            let below = median([5, 4, 3].map(|distance| b.checked_sub(distance).and_then(&log)));
            let above = median([3, 4, 5].map(|distance| log(b.saturating_add(distance))));
            let base = match (below, above) {
                (Some(below), Some(above)) => 0.5 * (below + above),
                (Some(one), None) | (None, Some(one)) => one + WITHOUT_NEIGHBOURS,
                (None, None) => continue,
            };
            let error = 1.0 / math::sqrt(real(bin.segments));
            if own - base > ABOVE + STANDARD_ERRORS * error {
                let rows = b.saturating_sub(2)..b.saturating_add(3).min(bins.len());
                for near in rows {
                    shape.put(first.saturating_add(near), single(0.0));
                }
            }
        }
    }
}

/// The median of up to three numbers; the mean of two.
fn median(numbers: [Option<Real>; 3]) -> Option<Real> {
    let (mut sum, mut low, mut high, mut count) = (0.0, Real::INFINITY, -Real::INFINITY, 0.0);
    for number in numbers.into_iter().flatten() {
        sum += number;
        low = low.min(number);
        high = high.max(number);
        count += 1.0;
    }
    match count {
        0.0 => None,
        3.0 => Some(sum - low - high),
        _ => Some(sum / count),
    }
}
