//! The sum over two octaves of the products of an effect with detail with itself and with the other effects.

use super::{
    detailed::{Detailed, SMOOTH, Tail},
    pair::Pair,
    series::ZERO,
    starts::{NEAR, NEGLIGIBLE, Starts, advance, step_after},
    wave::Wave,
};
use crate::{
    numerics::math::floor_log2,
    theory::lattice::{self, Rounded},
};

/// The phase and decay, in radians, over the lags between the kinks, up to which an oscillation is summed there
/// like a smooth effect. The terms of the closed form would cancel. Chosen by hand, and held to the sum over all
/// pairs by `host-tests/tests/library/covariance`.
const SLOW: f32 = 1.0;

/// What an effect with detail is multiplied with.
enum Partner<'a, 'b> {
    Itself(&'a Detailed),
    Other(&'a Detailed),
    Wave(&'a Wave<'b>),
}

impl Partner<'_, '_> {
    /// The factor of the covariance at a lag of so many starts. The product with another effect counts twice, and
    /// that of a wave holds the two already.
    fn at(&self, lag: u32, middle: u32, stride: u32) -> f32 {
        match self {
            Self::Itself(own) => own.at(lag, middle),
            Self::Other(other) => 2.0 * other.at(lag, middle),
            Self::Wave(wave) => wave.from(lag.saturating_mul(stride)).re,
        }
    }

    fn speed(&self, stride: u32) -> f32 {
        match self {
            Self::Itself(one) | Self::Other(one) => one.speed,
            Self::Wave(wave) => wave.speed(stride),
        }
    }

    fn tail(&self, lag: u32, stride: u32, of: impl Fn(&Detailed) -> Option<Tail>) -> Option<Tail> {
        match self {
            Self::Itself(own) => of(own),
            Self::Other(other) => of(other).map(Tail::doubled),
            Self::Wave(wave) => Some(Tail {
                forward: wave.from(lag.saturating_mul(stride)),
                backward: ZERO,
                rest: wave.rest(stride),
            }),
        }
    }
}

/// Two octaves and the lags at which their differences meet, counted in starts of the shorter one.
pub(super) struct Products<'a> {
    starts: Starts,
    smooth: &'a Rounded,
    /// The number of quarters of the shorter cluster from one start to the next.
    stride: u32,
    /// The distance of the kinks.
    middle: u32,
    /// The distance up to which the kinks reach from 0 and from the middle.
    reach: u32,
    /// The number of samples from one start to the next.
    advance: u32,
}

impl<'a> Products<'a> {
    pub(super) fn new(pair: &Pair<'_>, smooth: &'a Rounded, detailed: &[Detailed]) -> Self {
        let stride = lattice::stride(pair.shorter.m);
        Self {
            starts: Starts::new(pair.shorter, pair.longer),
            smooth,
            stride,
            middle: pair.middle().checked_div(stride).unwrap_or(0),
            reach: detailed.iter().map(|one| one.start).max().unwrap_or(0),
            advance: advance(pair.shorter.m),
        }
    }

    /// The sum over all pairs of starts, in both orders, of what the detailed add to `c (c + 2g)`.
    pub(super) fn sum(&self, detailed: &[Detailed], waves: &[Wave<'_>]) -> f32 {
        let mut sum = 0.0;
        let mut left = detailed;
        while let [one, others @ ..] = left {
            left = others;
            let partners = || {
                let itself = core::iter::once(Partner::Itself(one));
                let others = others.iter().map(Partner::Other);
                itself.chain(others).chain(waves.iter().map(Partner::Wave))
            };
            let beyond: f32 = partners().map(|other| self.beyond_kinks(one, &other)).sum();
            sum += beyond;
            sum += self.along_lattice(one, sum.abs(), &|lag, inner| {
                let counted = partners().filter(|other| !inner || !self.is_closed(one, other));
                counted
                    .map(|other| other.at(lag, self.middle, self.stride))
                    .sum()
            });
        }
        sum
    }

    /// Whether the product is summed in closed form between the kinks.
    fn is_closed(&self, one: &Detailed, other: &Partner<'_, '_>) -> bool {
        one.speed.max(other.speed(self.stride)) * self.middle as f32 > SLOW
    }

    /// The closed form of the lags beyond the kinks.
    fn beyond_kinks(&self, one: &Detailed, other: &Partner<'_, '_>) -> f32 {
        let Self {
            middle,
            reach,
            stride,
            ..
        } = *self;
        let product = |lag: u32| one.at(lag, middle) * other.at(lag, middle, stride);
        let mut sum = 0.0;
        let far = middle.saturating_sub(reach);
        if far > reach && self.is_closed(one, other) {
            let own = one.inner(middle, reach);
            let its = other.tail(reach, stride, |one| one.inner(middle, reach));
            if let Some((own, its)) = own.zip(its) {
                let pairs = self.starts.mean_pairs(reach, self.advance)
                    + self.starts.mean_pairs(far, self.advance);
                let all = own.product(&its, far.saturating_sub(reach));
                sum += 0.5 * pairs * (all - 0.5 * (product(reach) + product(far)));
            }
        }
        let outer = middle.saturating_add(reach);
        let pairs = self.starts.mean_pairs(outer, self.advance);
        if pairs > 0.0 {
            let own = one.outer(middle, reach);
            let its = other.tail(outer, stride, |one| one.outer(middle, reach));
            if let Some((own, its)) = own.zip(its) {
                let slope = self.starts.slope(self.advance);
                sum += own.outer_product(&its, pairs, slope) - 0.5 * pairs * product(outer);
            }
        }
        sum
    }

    /// The part that a step from this lag on lies in, and its end.
    fn part(&self, from: u32) -> (Part, u32) {
        let Self { middle, reach, .. } = *self;
        let (far, outer) = (middle.saturating_sub(reach), middle.saturating_add(reach));
        if from < reach && from < far {
            (Part::Kink, reach.min(far.max(1)))
        } else if from < far {
            (Part::Inner, far)
        } else if from < outer {
            (Part::Kink, outer)
        } else {
            (Part::Outer, u32::MAX)
        }
    }

    /// The products with the smooth effects at all lags, and with the partners at those lags that have no closed
    /// form. `partners(lag, inner)` is their sum at the kinks, or between them.
    fn along_lattice(
        &self,
        one: &Detailed,
        mut size: f32,
        partners: &dyn Fn(u32, bool) -> f32,
    ) -> f32 {
        let Self {
            middle,
            reach,
            stride,
            ..
        } = *self;
        let quarters = middle.saturating_mul(stride);
        let outer = middle.saturating_add(reach.max(NEAR));
        let at = |quarters_here: u32, part: Part| {
            let pairs = self.starts.pairs(quarters_here) as f32;
            let here = self.smooth.at(quarters_here);
            let smooth = self.smooth.at(quarters_here.abs_diff(quarters)) - (here + here)
                + self.smooth.at(quarters_here.saturating_add(quarters));
            let lag = quarters_here.checked_div(stride).unwrap_or(0);
            let own = one.at(lag, middle);
            let partners = match part {
                Part::Kink => partners(lag, false),
                Part::Inner => partners(lag, true),
                Part::Outer => 0.0,
            };
            Here {
                smooth: 2.0 * pairs * smooth,
                own,
                partners: pairs * own * partners,
            }
        };
        let (inner_tail, outer_tail) = (one.inner(middle, reach), one.outer(middle, reach));
        let (mut sum, mut lag, mut quiet) = (0.0_f32, 0_u32, 0_u32);
        let mut before: Option<(Part, Here)> = None;
        while quiet < 2 && lag < lattice::END / 2 && self.starts.pairs(lag) > 0 {
            let from = lag.checked_div(stride).unwrap_or(0);
            let (part, end) = self.part(from);
            // No step leads across the end of a part.
            let most = 1_u32.wrapping_shl(floor_log2(end.saturating_sub(from)));
            let step = step_after(lag, quarters, stride).checked_div(stride);
            let starts = match part {
                Part::Kink => 1,
                _ => step.unwrap_or(1).min(most),
            };
            let to = from.saturating_add(starts);
            let next = to.saturating_mul(stride);
            // A step begins with the numbers with which the step before it ended.
            let first = before.take().filter(|(ended, _)| *ended == part);
            let first = first.map_or_else(|| at(lag, part), |(_, here)| here);
            let last = at(next, part);
            let half = 0.5 * starts as f32;
            let mut here = half * (first.partners + last.partners);
            here += if starts <= 1 || one.speed * (starts as f32) < SMOOTH {
                half * (first.smooth * first.own + last.smooth * last.own)
            } else {
                let smooth = [first.smooth, last.smooth];
                let level = floor_log2(starts);
                let (tail, begin) = match part {
                    Part::Outer => (&outer_tail, middle.saturating_add(reach)),
                    _ => (&inner_tail, reach),
                };
                let apart = [from.saturating_sub(begin), end.saturating_sub(to)];
                tail.as_ref()
                    .map_or(0.0, |tail| one.step(tail, level, apart, smooth))
            };
            sum += here;
            size = size.max(sum.abs());
            let counts = to <= outer || here.abs() > NEGLIGIBLE * size;
            quiet = if counts { 0 } else { quiet.saturating_add(1) };
            lag = next;
            before = Some((part, last));
        }
        sum
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Kink,
    Inner,
    Outer,
}

/// The factors at one lag, each but the oscillation's own times the number of pairs.
struct Here {
    smooth: f32,
    own: f32,
    partners: f32,
}
