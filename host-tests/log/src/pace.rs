//! The usual step between time stamps, and the units that stamps can have.

use super::names::TimeUnit;

/// A step that is longer than this many usual steps is a gap, provided that it also exceeds
/// [`SCATTER`]. It lies half way between one step and the two steps that a lost sample leaves.
const GAP: f64 = 1.5;

/// The largest ratio between a told step and the regular step of stamps. The clocks of cheap gyros are off by some per
/// cent, which their stamps tell better than their data sheets.
const TOLD: f64 = 1.02;

/// The same for stamps that are not regular.
const IRREGULAR: f64 = 2.0;

/// Stamps are regular if their mean step differs by less than this share from the usual step.
const REGULAR: f64 = 0.02;

/// Rows come in bursts if more rows than this share a stamp. Fewer are rows that were written twice.
const BURSTS: f64 = 1.3;

/// A gap must exceed the usual step by this many times the scatter that this share of the steps keeps. One late stamp in ten
/// makes two odd steps, and is no scatter. Chosen by hand; the tests of the clock hold it to a jitter of half a step.
const SCATTER: (f64, f64) = (10.0, 0.6);

/// The number of stamps in which losses are seldom.
const FEW: usize = 100;

/// The usual distance between stamps, estimated from the first ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    /// The number of ticks in a second. A tick is the unit of the stamps.
    pub(super) per_second: f64,
    /// The usual step, in ticks.
    pub(super) step: f64,
    /// The longest step that is not a gap, in ticks.
    pub(super) longest: f64,
    /// The usual distance of a step from the usual one, in ticks.
    pub(super) scatter: f64,
    /// The number of rows that have the same stamp: 1 unless rows come in bursts.
    pub(super) rows: f64,
}

impl Pace {
    /// The pace of the stamps `first`, in a unit. Returns `None` if the stamps never advance.
    pub(super) fn of(first: &[f64], unit: TimeUnit) -> Option<Self> {
        Self::of_ticks(first, unit.per_second())
    }

    /// The pace of regular stamps that are cut to whole milliseconds or microseconds, which needs many of them where the rate is near
    /// one that is not cut. Returns `None` if `first` are no such stamps.
    pub(super) fn of_cut(first: &[f64], unit: TimeUnit) -> Option<Self> {
        let per_second = unit.per_second();
        // Of few stamps, no sample is lost.
        let few = first.get(..FEW).unwrap_or(first);
        even(few, per_second)
            .or_else(|| even(first, per_second))
            .or_else(|| steady(first, per_second))
    }

    /// The pace of the stamps `first`, of which so many ticks are a second.
    pub(super) fn of_ticks(first: &[f64], per_second: f64) -> Option<Self> {
        let mut steps = steps(first);
        // The last stamp may have more rows than are known.
        let last = (1..first.len())
            .rev()
            .find(|&row| first[row] > first[row - 1]);
        let rows = last.unwrap_or(0) as f64 / steps.len().max(1) as f64;
        let rows = if rows > BURSTS { rows } else { 1.0 };
        if let Some(even) = even(first, per_second) {
            return Some(even);
        }
        let usual = quantile(&mut steps, 0.5)?;
        let mut scatter: Vec<f64> = steps.iter().map(|step| (step - usual).abs()).collect();
        let scatter = quantile(&mut scatter, SCATTER.1)?;
        if let Some((step, longest)) = rounded(&mut steps) {
            return Some(Self {
                per_second,
                step,
                longest,
                scatter,
                rows,
            });
        }
        if let Some(step) = lattice(&mut steps) {
            return Some(Self {
                per_second,
                step,
                longest: GAP * step,
                scatter,
                rows,
            });
        }
        Some(Self {
            per_second,
            step: usual,
            longest: (GAP * usual).max(usual + SCATTER.0 * scatter),
            scatter,
            rows,
        })
    }

    /// Whether the stamps `first`, which have this pace, can be those of a record of a given rate. The
    /// usual step and the mean step are tried, because stamps may be written in bursts.
    pub(super) fn agrees(&self, first: &[f64], rate_hz: f64) -> bool {
        let told = self.per_second / rate_hz;
        let whole = first
            .last()
            .zip(first.first())
            .map_or(0.0, |(last, first)| last - first);
        let mean = whole / first.len().saturating_sub(1).max(1) as f64;
        let irregular = (mean / self.step - 1.0).abs() > REGULAR;
        let factor = if irregular { IRREGULAR } else { TOLD };
        let (shortest, longest) = (mean.min(self.step), mean.max(self.step));
        (shortest / factor..=longest * factor).contains(&told)
    }

    /// The rate at the usual step, in Hz.
    pub(super) fn usual_hz(&self) -> f64 {
        self.rows * self.per_second / self.step
    }

    /// The mean rate of the stamps `first`, or that at the usual step if rows are missing among them, in Hz.
    pub(super) fn mean_hz(&self, first: &[f64]) -> f64 {
        let rows = first.len().saturating_sub(1) as f64;
        let whole = first
            .last()
            .zip(first.first())
            .map_or(0.0, |(last, first)| last - first);
        let mean_hz = rows * self.per_second / whole;
        let usual_hz = self.usual_hz();
        if (mean_hz / usual_hz - 1.0).abs() < 0.05 {
            mean_hz
        } else {
            usual_hz
        }
    }

    /// The same pace for rows that were written twice, and are not those of bursts.
    pub(super) fn without_bursts(self) -> Self {
        Self { rows: 1.0, ..self }
    }

    /// The number of ticks in a second.
    pub(super) fn per_second(&self) -> f64 {
        self.per_second
    }

    /// The seconds in a number of ticks.
    pub(super) fn seconds(&self, ticks: f64) -> f64 {
        ticks / self.per_second
    }
}

/// The units that stamps without a told unit can have. If the first stamp is a time since 1970 in some
/// unit that fits, it is that unit alone. A unit fits if it makes the rate plausible: at least 0.1 Hz in
/// seconds and 1 Hz in the other units, which nobody needs for slower records, and at most 33 kHz, beyond
/// the fastest gyros. Returns `None` if the stamps never advance.
pub(super) fn possible_units(first: &[f64]) -> Option<Vec<TimeUnit>> {
    const FASTEST_HZ: f64 = 33e3;
    let step = lattice(&mut steps(first)).or_else(|| quantile(&mut steps(first), 0.5))?;
    let fits = |unit: &TimeUnit| {
        let slowest_hz = if *unit == TimeUnit::S { 0.1 } else { 1.0 };
        // A step of exactly 10 s may be rounded upwards.
        (0.99 * slowest_hz..FASTEST_HZ).contains(&(unit.per_second() / step))
    };
    // This range covers the years 2001 to 2037, in seconds since 1970. Counters of 31 and 32 bits are beyond it shortly before
    // they begin anew.
    let since_1970 = |unit: &TimeUnit| (1e9..2.14e9).contains(&(first[0] / unit.per_second()));
    let fitting = TimeUnit::ALL.into_iter().filter(fits);
    let fitting: Vec<TimeUnit> = fitting.collect();
    match fitting.iter().find(|unit| since_1970(unit)) {
        Some(&unit) => Some(vec![unit]),
        None => Some(fitting),
    }
}

/// The steps forwards between stamps.
fn steps(stamps: &[f64]) -> Vec<f64> {
    let steps = stamps.windows(2).map(|pair| pair[1] - pair[0]);
    steps.filter(|&step| step > 0.0).collect()
}

/// The pace of stamps that are cut to whole milliseconds where the step is about one, and scatter besides: steps of none, one and two
/// follow each other in no order. The stamps stay near a straight line, from which samples that are lost at random would lead away by
/// more and more.
fn steady(first: &[f64], per_second: f64) -> Option<Pace> {
    const RESOLUTION_S: f64 = 1e-3;
    /// The steps that differ from the usual one, from which on losses would lead far away.
    const ODD: usize = 12;
    /// The range of the distances from the line, in units of the resolution: one is that of cutting.
    const NEAR: f64 = 1.75;
    let resolution = RESOLUTION_S * per_second;
    let (start, end) = (first.first()?, first.last()?);
    let mean = (end - start) / (first.len() - 1) as f64;
    let places = first.iter().zip(0..);
    let distances = places.map(|(stamp, row)| stamp - start - mean * f64::from(row));
    let (least, most) = distances.fold((0.0, 0.0), |(least, most): (f64, f64), distance| {
        (least.min(distance), most.max(distance))
    });
    let units: Vec<f64> = first
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) / resolution)
        .collect();
    let are_units = units.iter().all(|one| (one - one.round()).abs() < 0.01);
    let odd = units.iter().filter(|one| (*one - 1.0).abs() > 0.5).count();
    let longest = units.iter().copied().fold(0.0, f64::max);
    let is_steady = are_units && odd >= ODD && 2 * odd < units.len();
    if !is_steady || most - least > NEAR * resolution || longest > 2.5 {
        return None;
    }
    let advancing = units.iter().filter(|one| **one > 0.5).count();
    let rows = units.len() as f64 / advancing as f64;
    Some(Pace {
        per_second,
        step: mean * rows,
        longest: (longest + 0.5) * resolution,
        scatter: 0.5 * resolution,
        rows,
    })
}

/// The pace of regular stamps that are cut to whole milliseconds or microseconds. Their steps take two values that differ by the
/// resolution, and the rarer one comes as evenly as it can, so that the steps between two of them are equally many but for one.
/// Samples that are lost leave no such order.
fn even(first: &[f64], per_second: f64) -> Option<Pace> {
    /// The resolutions of clocks, in seconds.
    const RESOLUTIONS: [f64; 2] = [1e-3, 1e-6];
    /// The rarer step is there so often at least.
    const SEEN: usize = 3;
    let steps: Vec<f64> = first.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let short = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let long = steps.iter().copied().fold(0.0, f64::max);
    let resolution = long - short;
    let is_near = |one: f64, other: f64| (one - other).abs() < 0.01 * resolution;
    let is_known = RESOLUTIONS
        .iter()
        .any(|known| is_near(resolution, known * per_second));
    let whole = (short / resolution).round();
    let is_cut = short >= 0.0 && is_near(short, whole * resolution);
    let is_either = |step: &f64| is_near(*step, short) || is_near(*step, long);
    if !is_known || !is_cut || !steps.iter().all(is_either) {
        return None;
    }
    let longs = steps.iter().filter(|step| is_near(**step, long)).count();
    let rarer = if 2 * longs <= steps.len() {
        long
    } else {
        short
    };
    let places = steps.iter().enumerate();
    let places = places.filter(|(_, step)| is_near(**step, rarer));
    let places: Vec<usize> = places.map(|(place, _)| place).collect();
    let between: Vec<usize> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (fewest, most) = (between.iter().min()?, between.iter().max()?);
    if places.len() < SEEN || most - fewest > 1 || *fewest < 2 {
        return None;
    }
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    // Several rows share a stamp where the samples follow each other faster than the clock counts.
    let rows = if whole == 0.0 { long / mean } else { 1.0 };
    Some(Pace {
        per_second,
        step: mean * rows,
        longest: long + 0.5 * resolution,
        scatter: 0.5 * resolution,
        rows,
    })
}

/// The mean step of regular stamps that are rounded to a unit of a fifth to two thirds of it, and the longest step that is not
/// a gap. Such steps take two or three values, which differ by the unit.
fn rounded(steps: &mut [f64]) -> Option<(f64, f64)> {
    /// The share of steps within a unit of the usual one.
    const NEARLY_ALL: f64 = 0.8;
    let median = quantile(steps, 0.5)?;
    let unit = {
        let others = steps.iter().map(|step| (step - median).abs());
        others
            .filter(|apart| *apart > 1e-6 * median)
            .fold(f64::INFINITY, f64::min)
    };
    if !(0.2 * median..0.67 * median).contains(&unit) {
        return None;
    }
    let units = |step: f64| (step - median) / unit;
    let is_whole = |step: &&f64| (units(**step) - units(**step).round()).abs() < 0.01;
    let near: Vec<f64> = steps
        .iter()
        .copied()
        .filter(|step| units(*step).abs() < 1.5)
        .collect();
    let most = NEARLY_ALL * steps.len() as f64;
    if (near.len() as f64) < most || (steps.iter().filter(is_whole).count() as f64) < most {
        return None;
    }
    let mean = near.iter().sum::<f64>() / near.len() as f64;
    // Rounding moves a step by less than a unit. Two steps are longer by more than the same, unless the unit is above half
    // of a step.
    Some((
        mean,
        (mean + 1.01 * unit)
            .min(2.0 * mean - 0.01 * unit)
            .max(1.1 * mean),
    ))
}

/// The step of which nearly all steps are whole multiples, if there is one. Longer steps are then rows
/// that are missing, however many they are.
///
/// Stamps with a jitter of half a step have no such step: three quarters of their steps lie within a
/// quarter of a multiple, and four fifths are needed. Nor is it the time that a reader takes for a row that waits, which
/// fits any step if it is short enough: a quarter of the steps are single ones.
fn lattice(steps: &mut [f64]) -> Option<f64> {
    const NEAR: f64 = 0.25;
    const NEARLY_ALL: f64 = 0.8;
    const SINGLE: f64 = 0.25;
    let multiple = |long: f64, step: f64| (long / step).round().max(1.0);
    let mut step = quantile(steps, 0.2)?;
    for _ in 0..2 {
        let mut single: Vec<f64> = steps
            .iter()
            .map(|&long| long / multiple(long, step))
            .collect();
        step = quantile(&mut single, 0.5)?;
    }
    let is_near = |long: &&f64| (**long / step - multiple(**long, step)).abs() <= NEAR;
    let near = steps.iter().filter(is_near);
    let (mut count, mut single, mut samples, mut sum) = (0, 0, 0.0, 0.0);
    for &long in near {
        count += 1;
        single += usize::from(multiple(long, step) == 1.0);
        samples += multiple(long, step);
        sum += long;
    }
    // The mean, because the usual one of rounded stamps may be off by some per cent.
    let number = steps.len() as f64;
    (f64::from(count) >= NEARLY_ALL * number && single as f64 >= SINGLE * number)
        .then(|| sum / samples)
}

fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let at = (values.len() as f64 * share) as usize;
    (at < values.len()).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_that_is_possible_is_found() {
        use TimeUnit::{Ms, Ns, S, Us};
        for (first, step, units) in [
            (0.0, 0.005, &[S][..]),
            (0.0, 0.02, &[S]),
            (1.7e9, 0.01, &[S]),
            (1.7e9, 1.0, &[S]),
            (1.7e9, 5000.0, &[Us]),
            (0.0, 0.05, &[S, Ms]),
            (0.0, 1.0, &[S, Ms]),
            (0.0, 5.0, &[S, Ms]),
            (0.0, 10.0, &[S, Ms]),
            (0.0, 20.0, &[Ms]),
            (0.0, 40.0, &[Ms, Us]),
            (1.2e8, 4000.0, &[Us]),
            (4.294e9, 2.0, &[S, Ms]),
            (4.294e9, 4000.0, &[Us]),
            (0.0, 40_000.0, &[Us, Ns]),
            (1.403e18, 5e6, &[Ns]),
            (0.0, 5e6, &[Ns]),
            (0.0, 1e-9, &[]),
        ] {
            let stamps: Vec<f64> = (0..20).map(|i| first + f64::from(i) * step).collect();
            assert_eq!(possible_units(&stamps).unwrap(), units, "{first} {step}");
        }
    }
}
