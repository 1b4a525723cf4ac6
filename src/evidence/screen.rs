//! The verdict on a record of one axis of which little is kept.

use crate::{
    curve::{Curve, Scale, carries_rounding},
    numerics::real::{Real, real},
    record::{
        integrity::{Limits, Reason},
        screen::Screen,
    },
};

/// The differences of neighbours from which they are judged.
const JUDGED: u32 = 1000;
/// A run is stuck if it is longer than so many mean runs, and has a thousandth of the samples.
const RUN_FACTOR: u32 = Limits::DEFAULT.run_factor as u32;
/// The density of a normal distribution at its centre, in standard deviations: so many neighbours are equal by chance for each count of
/// their difference's standard deviation.
const AT_CENTRE: Real = 0.4;
/// The standard deviation of the difference, in counts, from which repeats are judged, and by how much they exceed chance then. The centre
/// of a difference of Student's distributions of five degrees of freedom is 1.15 times as dense.
const FINE: Real = 2.0;
const BEYOND_CHANCE: Real = 1.6;
/// Repeats that are never too many, because their number scatters.
const FEW_REPEATS: u32 = 12;
/// The averaging times of a quarter, half and whole second, to half an octave.
const SLOW_S: core::ops::Range<Real> = 0.177..1.414;
/// The τσ² in (°/s)²/Hz of motion at all of them, that at one of them if it lies so many times above the least one at shorter times, and how
/// many. `motion` has the first two as logarithms.
const LOUD: Real = 0.25;
const LOUD_WHERE_RISEN: Real = 0.09;
const RISEN: Real = 10.0;
/// A spike is longer than so many standard deviations of the difference without it.
const SPIKE: Real = 16.0;

impl Screen {
    /// Why the curve of these samples is not valid; `None` if nothing speaks against it, or if there are fewer than 1000 differences.
    /// `scale` is that of the curve.
    #[inline(never)]
    pub fn verdict<const K: usize>(&self, curve: &Curve<K>, scale: Scale) -> Option<Reason> {
        let (repeats, changes, longest, largest) = self.seen();
        let pairs = repeats.saturating_add(changes);
        let first = curve.points().first().filter(|point| point.m == 1)?;
        if pairs < JUDGED {
            return None;
        }
        let samples = u64::from(pairs) + 1;
        let run = (pairs / changes.saturating_add(1)).saturating_add(1);
        if longest > RUN_FACTOR.saturating_mul(run) && longest > pairs / 1000 {
            return Some(Reason::Stuck {
                longest_run: longest,
                changes: changes.into(),
                samples,
            });
        }
        // The mean square of a difference of neighbours, in counts.
        let square = 2.0 * first.variance / (scale.rate_per_count() * scale.rate_per_count());
        let number = real(pairs);
        let least = real(u32::from(Limits::DEFAULT.difference_per_mille));
        let octaves = curve.points().iter();
        let octaves = octaves.map(|point| (point.m, point.differences, point.variance));
        if 1000.0 * square < least && !carries_rounding(octaves) {
            return Some(Reason::Coarse {
                per_mille: (1000.0 * square) as u16,
            });
        }
        // A spike goes there and back.
        let of_spike = 2.0 * real(largest) * real(largest);
        let all = square * number;
        let rest = (all - of_spike) / number;
        let share = of_spike / all;
        let is_spike = 0.5 * of_spike > SPIKE * SPIKE * rest;
        let is_spiked =
            is_spike && share > 0.001 * real(u32::from(Limits::DEFAULT.spike_per_mille));
        let spiked = || {
            is_spiked.then_some(Reason::Spiked {
                spikes: 1,
                percent: (100.0 * share) as u8,
            })
        };
        let disturbed = moved(curve, scale).or_else(spiked);
        if disturbed.is_some() {
            return disturbed;
        }
        let more = real(repeats.saturating_sub(FEW_REPEATS));
        let most = BEYOND_CHANCE * AT_CENTRE * number;
        let is_repeated = square >= FINE * FINE && more * more * square > most * most;
        is_repeated.then_some(Reason::Repeated {
            times: 0,
            changes: changes.into(),
            samples,
        })
    }
}

/// Motion that goes on, by its size alone: the part of [`motion`](crate::motion) that needs no logarithm.
fn moved<const K: usize>(curve: &Curve<K>, scale: Scale) -> Option<Reason> {
    let degree = scale.per_degree()?;
    let unit = degree * degree;
    let (loud, loud_where_risen) = (LOUD * unit, LOUD_WHERE_RISEN * unit);
    let (mut least, mut is_quiet, mut slow) = (Real::INFINITY, false, 0_u8);
    for point in curve.points() {
        let level = point.variance * point.tau_s;
        if SLOW_S.contains(&point.tau_s) {
            if level > loud_where_risen && level > RISEN * least {
                return Some(still_moving(point.m));
            }
            is_quiet |= level <= loud;
            slow = slow.saturating_add(1);
        }
        least = if level < least { level } else { least };
    }
    (slow >= 3 && !is_quiet).then_some(still_moving(0))
}

/// Motion that never stopped; nine tenths of the variance at least are its.
fn still_moving(m: u32) -> Reason {
    Reason::Moved {
        motions: 0,
        cluster: m.min(u16::MAX.into()) as u16,
        percent: 90,
    }
}
