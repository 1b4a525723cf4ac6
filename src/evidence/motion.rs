//! Motion that goes on, judged from the Allan curves of a sensor.
//!
//! [`Integrity`](crate::integrity::Integrity) sees how motion begins and ends. A gyro that is held, carried, driven or swung for the
//! whole record gives it no such place. What remains is the shape of the curve between 0.03 s and 4 s: motion is slow, so that τσ²(τ),
//! which white noise keeps constant, rises there by decades, and falls again, because hands and vehicles come back while drift does
//! not; it is large; and it turns the sensor about one axis more than about the others. Each of these is found in gyros at rest, too:
//! a resonance rises and falls, bias instability rises, and axes differ. A network of one hidden layer weighs them. Noise that is
//! larger than that of any gyro is motion without being weighed.
//!
//! Nothing is kept for this, and a sample costs nothing, so that every door that has a curve can ask.

mod network;
mod weights;

use crate::{
    curve::Curve,
    numerics::{
        math::log,
        real::{Real, real},
    },
    record::integrity::Reason,
};
use network::{FEATURES, JOINT};
use weights::{ONE_AXIS, THREE_AXES};

/// The averaging times in seconds at which a curve is read, an octave apart: at the octave next to each.
const TIMES_S: [Real; 8] = [0.03125, 0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0];
/// The place from which on they are slow. A curve that ends before says nothing.
const SLOW: usize = 3;
/// The longest averaging time that is read.
const LONGEST_S: Real = 6.0;
/// The least number of differences of an octave that is read: four clusters.
const LEAST_DIFFERENCES: u64 = 9;
/// The steepest rise of τσ² in an octave that says more than a smaller one, in powers of ten. Smooth motion rises by 1.2.
const STEEPEST: Real = 0.95;

/// log₁₀ of the least τσ² in (°/s)²/Hz at a quarter, half and whole second that is motion whatever the shape of the curve is: no gyro at
/// rest has an angle random walk of 0.5 °/s/√Hz.
const LOUD: Real = -0.602;

/// log₁₀ of the τσ² in (°/s)²/Hz at a quarter, half or whole second that is motion if it lies [`RISEN`] above the least one at shorter
/// times: a gyro at rest with such slow noise would have an Allan deviation of 1000 °/h at a second.
const LOUD_WHERE_RISEN: Real = -1.046;
const RISEN: Real = 1.0;

/// The place of the feature of an axis that has a unit, and of the other one of three axes.
const LEVEL: usize = 5;
const LEAST_LEVEL: usize = FEATURES + 2;

/// What the curve of an axis says about motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slowness {
    /// log₁₀ of τσ² at each time; the last one that is known stands for those behind it.
    levels: [Real; TIMES_S.len()],
    /// log₁₀ of the least τσ² up to each time.
    least: [Real; TIMES_S.len()],
    /// The number of times that are known.
    known: usize,
    /// The averaging factor of the octave that rises most, and log₁₀ of its rise.
    highest: (u32, Real),
}

impl Slowness {
    /// Reads a curve. `None` if it ends before a quarter of a second, or does not vary.
    #[inline(never)]
    pub(crate) fn of<const K: usize>(curve: &Curve<K>) -> Option<Self> {
        let points = curve.points().iter();
        let mut points = points
            .take_while(|point| point.tau_s <= LONGEST_S && point.differences >= LEAST_DIFFERENCES)
            .peekable();
        let mut read = Self {
            levels: [0.0; TIMES_S.len()],
            least: [0.0; TIMES_S.len()],
            known: 0,
            highest: (0, 0.0),
        };
        let (mut m, mut level, mut least) = (0, 0.0, Real::INFINITY);
        let times = TIMES_S.iter().zip(&mut read.levels).zip(&mut read.least);
        for (place, ((&time, to), least_to)) in (0_usize..).zip(times) {
            // The next octave is nearer as long as it is less than half an octave above.
            let near = time * core::f64::consts::SQRT_2 as Real;
            while let Some(point) = points.next_if(|point| m == 0 || point.tau_s <= near) {
                m = point.m;
                level = log10(point.variance * point.tau_s)?;
                least = if level < least { level } else { least };
            }
            let is_known = real(m) * curve.interval_s() * near >= time * time;
            if is_known {
                read.known = place.saturating_add(1);
            }
            if place >= SLOW && level - least >= read.highest.1 {
                read.highest = (m, level - least);
            }
            (*to, *least_to) = (level, least);
        }
        (read.known > SLOW).then_some(read)
    }

    /// The features, in powers of ten: the rise of τσ² above its least value at shorter times, among the slow times and among those
    /// before; its fall from the largest value to the last one; a rise with a fall behind it; the steepest octave; the largest slow
    /// value; the least rise of a slow octave; the rise at the last times; a rise of up to a power of ten; the steepest two octaves; and the
    /// rise from the slow times on alone, and from the one before, which a filter of the sensor does not make.
    fn features(&self) -> [Real; FEATURES] {
        let rises = |from: usize, to: usize| {
            let pairs = self.levels.iter().zip(&self.least);
            most(
                pairs
                    .take(to)
                    .skip(from)
                    .map(|(level, least)| level - least),
            )
        };
        // Behind the last known time, levels stay the same.
        let octaves = |from: usize| {
            let octaves = self.levels.windows(2).skip(from);
            octaves.map(|octave| match octave {
                [before, after] => after - before,
                _ => 0.0,
            })
        };
        let rise = self.rise();
        let last = self.levels.get(self.known.saturating_sub(1)).copied();
        let fall = most(self.levels) - last.unwrap_or(0.0);
        let pairs = octaves(1).zip(octaves(2)).map(|(one, next)| one + next);
        [
            rise,
            rises(1, SLOW.saturating_add(1)),
            fall,
            lesser(rise, 3.0 * fall),
            lesser(most(octaves(1)), STEEPEST),
            most(self.levels.iter().skip(SLOW).copied()),
            -most(octaves(2).map(|octave| -octave)),
            rises(5, TIMES_S.len()),
            lesser(rises(1, TIMES_S.len()), 1.0),
            most(pairs),
            self.rise_from(SLOW),
            self.rise_from(SLOW - 1),
        ]
    }

    /// The largest rise above the least value since a place.
    fn rise_from(&self, place: usize) -> Real {
        let mut least = Real::INFINITY;
        let rises = self.levels.iter().skip(place).map(|&level| {
            least = if level < least { level } else { least };
            level - least
        });
        most(rises)
    }

    /// Whether the noise is larger than that of any gyro, with a unit whose square has this log₁₀.
    fn is_loud(&self, unit: Real) -> bool {
        let mut slow = self.levels.iter().skip(SLOW).take(3);
        let is_loud = self.known >= SLOW.saturating_add(3) && slow.all(|level| level - unit > LOUD);
        let pairs = self.levels.iter().zip(&self.least).skip(SLOW).take(3);
        let mut risen = pairs.filter(|(level, least)| *level - *least > RISEN);
        is_loud || risen.any(|(level, _)| level - unit > LOUD_WHERE_RISEN)
    }

    /// The rise among the slow times.
    fn rise(&self) -> Real {
        let pairs = self.levels.iter().zip(&self.least).skip(SLOW);
        most(pairs.map(|(level, least)| level - least))
    }
}

/// The features of three axes.
fn joint(axes: [&Slowness; 3]) -> [Real; JOINT] {
    let mut features = [0.0; JOINT];
    let own = axes.map(Slowness::features);
    for (place, feature) in (0_usize..FEATURES).zip(&mut features) {
        *feature = most(own.iter().filter_map(|own| own.get(place).copied()));
    }
    let known = axes.iter().map(|axis| axis.known).min().unwrap_or(0);
    let at = |place: usize| axes.map(|axis| axis.levels.get(place).copied().unwrap_or(0.0));
    // By how much the axis that varies most exceeds the one that varies least.
    let imbalance = |from: usize, to: usize| {
        let known = (from..to).filter(|place| *place < known);
        most(known.map(|place| most(at(place)) - least(at(place))))
    };
    let [x, y, z] = axes.map(Slowness::rise);
    let (high, low) = (most([x, y, z]), least([x, y, z]));
    let together = [
        imbalance(1, SLOW + 1),
        imbalance(SLOW, 6),
        most((SLOW..TIMES_S.len()).map(|place| least(at(place)))),
        x + y + z - high - low,
        low,
        high - low,
    ];
    for (feature, value) in features.iter_mut().skip(FEATURES).zip(together) {
        *feature = value;
    }
    features
}

/// Judges the curves of axes that were recorded together: all of them at once if they are three, or else each by itself.
/// `per_degree` is that of 1 °/s in rate units; `None` if the unit is not known, and then half of the moving records are seen.
/// [`Reason::Moved`] says in which clusters the motion is largest. `None` if the gyro was at rest, or if no octave of a quarter of a
/// second has nine differences.
pub fn judge<const K: usize, const AXES: usize>(
    curves: [&Curve<K>; AXES],
    per_degree: Option<Real>,
) -> Option<Reason> {
    judge_axes(&curves.map(Slowness::of), per_degree)
}

/// The same of axes that have been read.
#[inline(never)]
pub(crate) fn judge_axes(axes: &[Option<Slowness>], per_degree: Option<Real>) -> Option<Reason> {
    let found = |is_moved: bool, axes: &[&Slowness]| {
        let highest = axes.iter().map(|axis| axis.highest);
        let (cluster, rise) = highest.fold(
            (0, 0.0),
            |one, other| {
                if other.1 > one.1 { other } else { one }
            },
        );
        is_moved.then(|| Reason::Moved {
            motions: 0,
            cluster: cluster.min(u16::MAX.into()) as u16,
            percent: percent(rise),
        })
    };
    // log₁₀ of (°/s)² in squared rate units.
    let unit = per_degree.and_then(|unit| log10(unit * unit));
    let is_loud = |axis: &&Slowness| unit.is_some_and(|unit| axis.is_loud(unit));
    if let Some(axis) = axes.iter().flatten().find(is_loud) {
        return found(true, &[axis]);
    }
    if let [Some(x), Some(y), Some(z)] = axes {
        let mut features = joint([x, y, z]);
        scale(&mut features, [LEVEL, LEAST_LEVEL], unit);
        return found(THREE_AXES.is_positive(&features, unit), &[x, y, z]);
    }
    let mut axes = axes.iter().flatten();
    axes.find_map(|axis| {
        let mut features = axis.features();
        scale(&mut features, [LEVEL, LEVEL], unit);
        found(ONE_AXIS.is_positive(&features, unit), &[axis])
    })
}

/// Brings the features at these places to (°/s)²/Hz, or to 0 if the unit is not known.
fn scale(features: &mut [Real], places: [usize; 2], unit: Option<Real>) {
    let [one, other] = places;
    for (place, feature) in (0_usize..).zip(features) {
        if place == one || place == other {
            *feature = unit.map_or(0.0, |unit| *feature - unit);
        }
    }
}

/// The largest value; 0 if there is none.
fn most(values: impl IntoIterator<Item = Real>) -> Real {
    let mut values = values.into_iter();
    let first = values.next().unwrap_or(0.0);
    values.fold(first, |one, other| if other > one { other } else { one })
}

fn least(values: [Real; 3]) -> Real {
    -most(values.map(|value| -value))
}

fn lesser(one: Real, other: Real) -> Real {
    if other < one { other } else { one }
}

/// The share of the variance that lies above its least value, in percent.
fn percent(rise: Real) -> u8 {
    let below = crate::numerics::math::exp(-rise * core::f64::consts::LN_10 as Real);
    (100.0 * (1.0 - below)).clamp(0.0, 99.0) as u8
}

/// `None` where there is no logarithm.
fn log10(x: Real) -> Option<Real> {
    (x > 0.0 && x.is_finite()).then(|| log(x) * core::f64::consts::LOG10_E as Real)
}
