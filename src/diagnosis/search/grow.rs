//! Adds one more effect to a hypothesis: a line, a resonance, or noise.

use super::{
    hypothesis::Hypothesis,
    kind::{at, has_frequency, is_added, is_drifting, is_line, is_plain, is_resonance, is_white},
    refine::Solver,
    values::Values,
    variant::Variant,
};
use crate::{
    limits::MAX_PARAMETERS,
    list::{self, numbered},
    numerics::{
        math,
        real::{Real, real},
    },
    theory::{effect::Effect, model::Term},
};
use core::ops::ControlFlow;
use heapless::Vec;

/// A candidate that gains less in a hypothesis, with all else fixed, is not refined.
const LEAST_GAIN: Real = 6.0;
/// What a drift has to gain before it is kept.
const DRIFTED: Real = 4.0;
/// The peaks of a level, and the candidates of lines and resonances, that are looked at.
const PEAKS: usize = 3;
const RESONANCES: usize = 3;
/// A peak stands this many standard errors above the hypothesis.
const PEAK: Real = 3.0;
/// Two resonances are different if the logarithms of their frequencies are this far apart.
const APART: Real = 0.25;
/// The frequencies that are tried for each factor of two, and the values of each other parameter.
const FREQUENCY_STEPS: Real = 5.0;
const QUALITIES: u32 = 3;
/// The same for a line in a record without a spectrum.
const LINE_STEPS: Real = 48.0;
/// The shapes of resonances that are tested in one piece of work.
const TERMS_A_PIECE: usize = 16;
/// The bins of a segment of 64 up to half the rate of its blocks.
const SEEN: Real = 32.0;
/// The square of the half width of Hann's window, in bins.
const WINDOW: Real = 0.5;

/// A frequency that may be missing, and what a line there gains.
#[derive(Clone, Copy)]
struct Peak {
    frequency_hz: Real,
    gain: Real,
}

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// Hands the hypothesis with one more effect to `each`, which returns the score that others have to beat, for every effect of the list that may be missing. All shapes
    /// are refined together.
    pub(super) fn grow(
        &mut self,
        hypothesis: &Hypothesis,
        effects: &[&'static dyn Effect],
        each: &mut dyn FnMut(&Hypothesis) -> Real,
    ) -> ControlFlow<()> {
        let mut candidates: Vec<Term, 12> = Vec::new();
        self.load(hypothesis)?;
        for effect in effects.iter().copied().filter(|effect| is_added(*effect)) {
            if is_drifting(effect) {
                continue;
            }
            if is_line(effect) && self.observation.has_bins() {
                for peak in &self.peaks(effect)? {
                    let _ = candidates.push(at(effect, &[peak.frequency_hz]));
                }
            } else if is_resonance(effect) && self.observation.has_bins() {
                self.humps(effect, &mut candidates)?;
            } else if has_frequency(effect) {
                self.shapes(effect, &mut candidates)?;
            }
        }
        for effect in effects.iter().copied().filter(|effect| is_plain(*effect)) {
            // White noise that enters behind a filter, such as rounding, has no other name.
            let is_behind = is_white(effect) && hypothesis.filter.is_some();
            let known = self.model.terms().iter().filter(|_| !is_behind);
            let mut known = known.chain(&hypothesis.added);
            if !known.any(|term| term.effect.name() == effect.name()) {
                let _ = candidates.push(Term::fitted(effect));
            }
        }
        for term in candidates.iter().copied() {
            if let Some(with) = hypothesis.with(term, self.limits.effects) {
                let grown = self.refine(with, 10)?;
                let bar = each(&grown);
                self.raise(&grown, bar);
            }
        }
        for effect in effects.iter().copied().filter(|effect| is_added(*effect)) {
            let mut added = hypothesis.added.iter();
            if has_frequency(effect)
                || is_drifting(effect)
                || added.any(|term| term.effect.name() == effect.name())
            {
                continue;
            }
            if let Some(with) = self.scan_noise(effect, hypothesis)? {
                let grown = self.refine(with, 10)?;
                let bar = each(&grown);
                self.raise(&grown, bar);
            }
        }
        ControlFlow::Continue(())
    }

    /// Hands the hypothesis with a drifting oscillation in the place of one that stays at its frequency to `each`, as
    /// [`grow`](Self::grow) does.
    pub(super) fn drift(
        &mut self,
        hypothesis: &Hypothesis,
        effects: &[&'static dyn Effect],
        each: &mut dyn FnMut(&Hypothesis) -> Real,
    ) -> ControlFlow<()> {
        for effect in effects
            .iter()
            .copied()
            .filter(|effect| is_drifting(*effect))
        {
            for (i, term) in numbered(hypothesis.added.iter()) {
                if let Some(general) = self.drifting(effect, term) {
                    let mut begun = hypothesis.clone();
                    if let Some(place) = begun.added.get_mut(i) {
                        *place = general;
                    }
                    if begun.has_room(self.limits.effects) {
                        let grown = self.refine(begun, 12)?;
                        // One that the data do not ask for would take the place of another story.
                        if grown.score < hypothesis.score - DRIFTED {
                            let bar = each(&grown);
                            self.raise(&grown, bar);
                        }
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// A drifting oscillation in the place of one that stays at its frequency: its range is as wide as the hump, or two bins
    /// of the level that shows a line best. `None` if there is none.
    fn drifting(&self, effect: &'static dyn Effect, term: &Term) -> Option<Term> {
        if !has_frequency(term.effect) || is_drifting(term.effect) {
            return None;
        }
        let frequency_hz = term.parameter(0);
        let range_hz = if is_resonance(term.effect) {
            frequency_hz / term.parameter(1)
        } else {
            let widths = self.observation.levels().filter_map(|(_, bins)| {
                let bin = bins.first()?;
                Some(bin.frequency_hz / real(bin.index))
            });
            let seen = |width_hz: &Real| frequency_hz < SEEN * width_hz;
            2.0 * widths.filter(seen).last()?
        };
        let last = effect.parameters().len().checked_sub(1)?;
        let mut general = at(effect, &[frequency_hz]);
        if last > 1 {
            // As wide as the hump was, or as a line that hardly decays.
            let quality = if is_resonance(term.effect) {
                1.5 * term.parameter(1)
            } else {
                2.0 * frequency_hz / range_hz
            };
            general.set_parameter(1, quality);
        }
        let range = effect.search_range(last, &self.observation.span)?;
        general.set_parameter(last, range_hz.max(range.low).min(range.high));
        Some(general)
    }

    /// The shapes of an effect with a frequency that gain most.
    #[inline(never)]
    fn shapes(
        &mut self,
        effect: &'static dyn Effect,
        found: &mut Vec<Term, 12>,
    ) -> ControlFlow<()> {
        let mut best: Vec<(Term, Real), RESONANCES> = Vec::new();
        let mut column = Values::<B>::NONE;
        // Octaves show a line at many frequencies, each of them sharply.
        let steps = if is_line(effect) {
            LINE_STEPS
        } else {
            FREQUENCY_STEPS
        };
        for variant in Variant::of(effect, &self.observation.span) {
            for term in variant.grid(self.observation, steps, QUALITIES).terms() {
                (self.pause)()?;
                if self.observation.column(&term, None, &mut column) == 0.0 {
                    continue;
                }
                let gain = self.work.gain(&column);
                if gain < LEAST_GAIN {
                    continue;
                }
                enter(&mut best, term, gain);
            }
        }
        for (term, _) in &best {
            let _ = found.push(*term);
        }
        ControlFlow::Continue(())
    }

    /// The humps above the present model that a resonance explains best, by the score test of its density: with the density
    /// `c` of a Lorentzian, `(Σ ν c (1 − m)/m²)²/Σ ν c²/m²` is about what the resonance gains. Each level sees it as wide as
    /// its bins at least, and no level sees it below half its rate.
    #[inline(never)]
    fn humps(&mut self, effect: &'static dyn Effect, found: &mut Vec<Term, 12>) -> ControlFlow<()> {
        let mut best: Vec<(Term, Real), RESONANCES> = Vec::new();
        for variant in Variant::of(effect, &self.observation.span) {
            for (i, term) in numbered(
                variant
                    .grid(self.observation, FREQUENCY_STEPS, QUALITIES)
                    .terms(),
            ) {
                if i % TERMS_A_PIECE == 0 {
                    (self.pause)()?;
                }
                let gain = self.score_of_hump(&term);
                if gain >= LEAST_GAIN {
                    enter(&mut best, term, gain);
                }
            }
        }
        for (term, _) in &best {
            let _ = found.push(*term);
        }
        ControlFlow::Continue(())
    }

    fn score_of_hump(&self, term: &Term) -> Real {
        let (middle_hz, quality) = (term.parameter(0), term.parameter(1));
        let half_hz = 0.5 * middle_hz / quality;
        let (mut along, mut own) = (0.0, 0.0);
        for row in self.observation.rows() {
            let Some((frequency_hz, width_hz)) = self.observation.place(row) else {
                continue;
            };
            // Bins of a level reach to half the rate of its blocks, 32 bins of a segment of 64.
            if middle_hz > SEEN * width_hz {
                continue;
            }
            let half_seen = math::sqrt(half_hz * half_hz + WINDOW * width_hz * width_hz);
            let distance = (frequency_hz - middle_hz) / half_seen;
            let density = half_hz / (half_seen * (1.0 + distance * distance));
            let c = real(self.observation.relative(row, density));
            let (m, shape) = (real(self.work.model[row]), real(self.work.shape[row]));
            let weight = shape * c / (m * m);
            along += weight * (1.0 - m);
            own += weight * c;
        }
        if along > 0.0 && own > 0.0 {
            along * along / own
        } else {
            0.0
        }
    }

    /// The peaks above the present model that a line explains best. The frequency is that between two bins (for Hann's
    /// window, δ = (2r − 1)/(r + 1) bins from the larger of two neighbours of amplitude ratio r), made sharper on the two
    /// finer levels, which see the line's alias.
    #[inline(never)]
    fn peaks(&mut self, effect: &'static dyn Effect) -> ControlFlow<(), Vec<Peak, PEAKS>> {
        let mut strongest: Vec<(usize, usize, Real), { 2 * PEAKS }> = Vec::new();
        for (i, (first, bins)) in numbered(self.observation.levels()) {
            let z = |b: usize| {
                let row = first.saturating_add(b);
                let shape = real(self.work.shape[row]);
                (1.0 / real(self.work.model[row]) - 1.0) * math::sqrt(shape)
            };
            for b in 0..bins.len() {
                let own = z(b);
                let is_higher = |other: Option<usize>| {
                    other.is_none_or(|other| other >= bins.len() || z(other) <= own)
                };
                if own > PEAK && is_higher(b.checked_sub(1)) && is_higher(b.checked_add(1)) {
                    list::rank(&mut strongest, (i, b, own), |other| other.2 < own);
                }
            }
        }
        let mut found: Vec<Peak, PEAKS> = Vec::new();
        for &(level, b, _) in &strongest {
            let Some(mut frequency_hz) = self.between_bins(level, b) else {
                continue;
            };
            let mut gain = 0.0;
            for finer in 0..3_usize {
                let Some((_, bins)) = self.observation.levels().nth(level.saturating_add(finer))
                else {
                    break;
                };
                let Some(bin) = bins.first() else { break };
                let width_hz = bin.frequency_hz / real(bin.index);
                // No bin lies above the last one, so that it sees a line anywhere up to half the rate of its blocks.
                let is_last = b.saturating_add(1) >= bins.len();
                let (reach, steps) = match finer {
                    0 if is_last => (0.7, 11),
                    0 => (0.36, 6),
                    _ => (0.6, 8),
                };
                if finer == 0 && is_last {
                    frequency_hz += 0.35 * width_hz;
                }
                (frequency_hz, gain) =
                    self.sharpened(effect, frequency_hz, reach * width_hz, steps)?;
            }
            let is_known = |other: &Peak| {
                let distance = other.frequency_hz - frequency_hz;
                distance * distance
                    < 1e-4 / (self.observation.duration_s * self.observation.duration_s)
            };
            if gain > LEAST_GAIN && !found.iter().any(is_known) {
                let peak = Peak { frequency_hz, gain };
                list::rank(&mut found, peak, |other| other.gain < gain);
            }
        }
        ControlFlow::Continue(found)
    }

    /// The frequency of a peak between bins.
    fn between_bins(&self, level: usize, b: usize) -> Option<Real> {
        let (first, bins) = self.observation.levels().nth(level)?;
        let bin = bins.get(b)?;
        let amplitude = |b: usize| {
            let row = first.saturating_add(b);
            let density = bins.get(b).map_or(0.0, |bin| bin.density);
            let above = density * (1.0 - real(self.work.model[row]));
            math::sqrt(above.max(0.0))
        };
        let below = b.checked_sub(1).map_or(0.0, amplitude);
        let above = amplitude(b.saturating_add(1));
        let own = amplitude(b);
        let ratio = below.max(above) / own;
        let distance = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.6);
        let width_hz = bin.frequency_hz / real(bin.index);
        let signed = if above > below { distance } else { -distance };
        Some(bin.frequency_hz + signed * width_hz)
    }

    /// The frequency near a given one at which a line gains most, and that gain.
    fn sharpened(
        &mut self,
        effect: &'static dyn Effect,
        frequency_hz: Real,
        reach_hz: Real,
        steps: i16,
    ) -> ControlFlow<(), (Real, Real)> {
        let mut best = (frequency_hz, 0.0);
        let mut column = Values::<B>::NONE;
        let range = effect.search_range(0, &self.observation.span);
        for step in steps.saturating_neg()..=steps {
            (self.pause)()?;
            let share = Real::from(step) / Real::from(steps);
            let mut frequency = frequency_hz + reach_hz * share;
            if let Some(range) = range {
                frequency = frequency.max(range.low).min(range.high);
            }
            let mut parameters = [0.0; MAX_PARAMETERS];
            if let Some(first) = parameters.first_mut() {
                *first = frequency;
            }
            let term = at(effect, &parameters);
            if self.observation.column(&term, None, &mut column) == 0.0 {
                continue;
            }
            let gain = self.work.gain(&column);
            if gain > best.1 {
                best = (frequency, gain);
            }
        }
        ControlFlow::Continue(best)
    }
}

/// Keeps a shape if it is one of the best, and the best one near its frequency.
fn enter(best: &mut Vec<(Term, Real), RESONANCES>, term: Term, gain: Real) {
    let near = |other: &(Term, Real)| {
        let ratio = math::log(other.0.parameter(0) / term.parameter(0));
        ratio < APART && ratio > -APART
    };
    match best.iter().position(near) {
        Some(place) if best.get(place).is_some_and(|other| other.1 < gain) => {
            list::remove(best, place);
        }
        Some(_) => return,
        None => {}
    }
    list::rank(best, (term, gain), |other| other.1 < gain);
}
