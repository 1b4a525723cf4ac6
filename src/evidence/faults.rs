//! What a logger did to samples: repeated, held, clipped and cut-out ones, judged from their counts.

pub use crate::record::{
    faults::{JointRepeats, SampleFaults},
    reads::{
        Reads,
        stale::{AtDistance, StaleRuns},
    },
};

use crate::{
    list::numbered,
    numerics::{
        math::{erfc, exp, log, sqrt},
        real::{Real, consts::FRAC_1_SQRT_2, real},
    },
    record::{
        faults::{Hole, ends::End, steps::Steps, zero_runs::ZeroRuns},
        integrity::Reason,
    },
};

/// The significance from which repeats are told, in standard errors. `cargo xtask study faults` sets this and all
/// other numbers of this file.
const TOLD: Real = 4.5;
/// The same for repeats of three axes at once, whose chance depends on more.
const TOLD_OF_ALL: Real = 5.5;
/// The number of samples from which a record is judged.
const JUDGED: u64 = 1000;
/// The smallest share of repeats that is told.
const LEAST: Real = 0.005;
/// The largest chance of a sample to equal the one before at which every repeat counts as one of the logger.
const CHANCE: Real = 0.002;
/// A run longer than so many mean runs holds a value, as [`Integrity`](crate::integrity::Integrity) has it.
const LONGEST_RUN: Real = 128.0;
/// The variance in squared steps below which values have a few levels, and the correlation of neighbours below which they are pulses.
const FEW_LEVELS: Real = 2.0;
const OPPOSED: Real = -0.04;
/// The share of equal neighbours from which neither long runs nor full ends of the range mean anything.
const MOSTLY_EQUAL: Real = 0.45;

/// The repeats of a record beyond those by chance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Repeats {
    /// Whether samples are repeated by the logger.
    pub told: bool,
    /// The share of samples that the logger repeated, 0 … 1. The sensor's rate is that of the record times one less
    /// this share.
    pub share: Real,
    /// The probability that a sample of the sensor equals the one before by chance.
    pub chance: Real,
    /// Repeats below this share cannot be detected.
    pub least: Real,
}

impl Repeats {
    /// Whether all samples that equal the one before can be left out: hardly any of them is one of the sensor.
    pub fn are_certain(&self) -> bool {
        self.told && self.chance <= CHANCE
    }

    /// Repeats below the share of equal neighbours cannot be detected.
    const fn unknown(equal: Real) -> Self {
        Self {
            told: false,
            share: 0.0,
            chance: equal,
            least: equal,
        }
    }

    /// `z` is the significance of a share that has this standard error.
    fn new(z: Real, share: Real, error: Real, chance: Real) -> Self {
        Self {
            told: z > TOLD && share >= LEAST,
            share: share.clamp(0.0, 1.0),
            chance,
            least: (TOLD * error).max(LEAST),
        }
    }
}

impl SampleFaults {
    /// What is wrong with an axis; `None` if nothing is. `joint` is that of the sensor's three axes.
    ///
    /// A dead band comes before clipped samples, and these before stuck values and repeats, because each of them looks
    /// like those after it as well.
    pub fn verdict(&self, joint: Option<&JointRepeats>) -> Option<Reason> {
        if self.samples < JUDGED {
            return None;
        }
        let repeats = self.repeats(joint);
        let first = self.dead_band().or_else(|| self.clipped());
        let first = first.or_else(|| self.stuck(joint));
        first.or_else(|| repeats.told.then(|| self.repeated(joint, &repeats)))
    }

    /// The repeats of the axis: those of all axes at once where there are any.
    pub fn repeats(&self, joint: Option<&JointRepeats>) -> Repeats {
        let own = self.own_repeats();
        match joint.map(JointRepeats::repeats) {
            // All axes tell that samples repeat, and the surer one of both how many.
            Some(all) if all.told && own.told && own.least < all.least => Repeats {
                chance: all.chance,
                ..own
            },
            Some(all) if all.told || all.least <= own.least && !own.told => all,
            _ => own,
        }
    }

    /// Whether the values are held, so that what repeats are not the samples of a slow sensor.
    pub fn is_stuck(&self, joint: Option<&JointRepeats>) -> bool {
        self.stuck(joint).is_some()
    }

    /// The differences of noise have a smooth distribution, so that the numbers of one and two steps give that of zero.
    fn own_repeats(&self) -> Repeats {
        let steps = &self.steps;
        let [zero, one, two, three] = steps.near.map(|number| number as Real);
        let pairs = steps.pairs.max(1) as Real;
        if one + two < 60.0 {
            return fine_repeats(steps);
        }
        if self.is_pulsed() {
            return Repeats::unknown(zero / pairs);
        }
        if two < 60.0 || two < 0.02 * one {
            return Repeats::unknown(zero / pairs);
        }
        if two < 0.3 * one {
            // Narrower values do not lie anywhere within a step.
            let (_, variance) = self.mean_and_variance();
            let step = real(steps.step());
            return match variance >= 0.42 * step * step {
                true => coarse_repeats(steps.near, pairs),
                false => Repeats::unknown(zero / pairs),
            };
        }
        let [h1, h2, h3] = [one, two, three + 0.5].map(|number| log(0.5 * number));
        // The logarithm of the distribution is a polynomial of the squared difference: of first order for Gaussian
        // noise, and of second order for noise whose size changes.
        let gauss = smooth([one, two]);
        let mixed = (
            exp(1.5 * h1 - 0.6 * h2 + 0.1 * h3),
            2.25 / one + 0.36 / two + 0.01 / (three + 0.5),
        );
        let excess = |(chance, variance): (Real, Real)| {
            let error = sqrt(zero + chance * chance * variance);
            (zero - chance, error.max(1.0))
        };
        let (number, error) = excess(gauss);
        let (other, other_error) = excess(mixed);
        let z = (number / error).min(other / other_error);
        let share = number / pairs;
        let chance = (zero - number) / (pairs - number).max(1.0);
        Repeats::new(z, share, error / pairs, chance)
    }

    /// Whether values of a few levels lie on the other side of their mean more often than not after each other, as counts of pulses of an
    /// angle do: what one sample has too much, the next one lacks. Their differences have no smooth distribution.
    fn is_pulsed(&self) -> bool {
        let (near, pairs) = (self.steps.near, self.steps.pairs);
        let [_, one, two, three] = near.map(|number| number as Real);
        let counted: u64 = near
            .iter()
            .fold(0, |sum: u64, number| sum.saturating_add(*number));
        let far = pairs.saturating_sub(counted) as Real;
        let squares = one + 4.0 * two + 9.0 * three + 16.0 * far;
        let step = real(self.steps.step());
        let (_, variance) = self.mean_and_variance();
        let variance = variance / (step * step).max(1.0);
        let both = 2.0 * pairs as Real * variance;
        variance < FEW_LEVELS && squares > both * (1.0 - OPPOSED)
    }

    /// Values that stay for longer than chance, or a slow sensor, allows.
    fn stuck(&self, joint: Option<&JointRepeats>) -> Option<Reason> {
        let own = (&self.runs, self.pairs(), self.own_repeats());
        let all = joint.map(|joint| (&joint.runs, joint.pairs(), joint.repeats()));
        let mut all = [Some(own), all].into_iter().flatten();
        // A run of noise is geometric: none is that long.
        let changes = self.pairs().saturating_sub(self.runs.zeros).max(1);
        let held = real(self.runs.longest) * changes as Real > LONGEST_RUN * self.pairs() as Real;
        let is_held = held
            || all.any(|(runs, pairs, repeats)| {
                let fine = repeats.chance <= CHANCE;
                is_stuck(&runs.reached, (runs.zeros, runs.long), pairs, fine)
            });
        is_held.then(|| Reason::Stuck {
            longest_run: self.runs.longest.saturating_add(1),
            changes: self.pairs().saturating_sub(self.runs.zeros),
            samples: self.samples,
        })
    }

    /// The pairs of neighbours.
    const fn pairs(&self) -> u64 {
        self.steps.later.saturating_add(256)
    }

    /// The mean of the counts, and their variance.
    fn mean_and_variance(&self) -> (Real, Real) {
        let (first, sum, squares) = self.spread.sums();
        let number = self.samples.max(1) as Real;
        let mean = sum as Real / number;
        let variance = squares as Real / number - mean * mean;
        (first as Real + mean, variance.max(0.0))
    }

    fn share_of_equal(&self) -> Real {
        self.runs.zeros as Real / self.pairs() as Real
    }

    /// More samples at an end of the range than the values next to it let expect. The distribution of noise is
    /// log-concave there, so that a level has at most the square of the next one over the one behind that. A sinusoid
    /// that is larger than the noise has up to 1.9 times as many, at both ends.
    fn clipped(&self) -> Option<Reason> {
        let excess = |end: &End| {
            let [here, next, behind] = end.near.map(|number| number as Real);
            let expected = next * next / behind.max(1.0);
            // Neighbours are alike where noise is slow, so that the numbers scatter more.
            let alike = here / (end.entries as Real).max(1.0);
            let relative = 4.0 / next.max(1.0) + 1.0 / behind.max(1.0);
            let error = sqrt(alike * (here + expected * expected * relative) + 1.0);
            let few = next + behind < 8.0 && here > 10.0 * (next + behind);
            let many = next >= 4.0 && behind >= 4.0 && here - expected > TOLD * error;
            let is_full = here >= 16.0 && end.entries >= 8 && (few || many);
            let ratio = if few { Real::MAX } else { here / expected };
            if is_full { ratio } else { 0.0 }
        };
        let [high, low] = &self.ends;
        let (mean, variance) = self.mean_and_variance();
        let (deviation, step) = (sqrt(variance), real(self.steps.step()));
        let [up, down] = [high.value() as Real - mean, low.value() as Real + mean];
        // The noise is cut off on one side of its mean, and goes on on the other one.
        let is_cut = |end: &End, near: Real, far: Real| {
            let [here, next, _] = end.near.map(|number| number as Real);
            let is_full = here >= 16.0 && end.entries >= 8 && here >= 0.3 * next;
            is_full && deviation > step && near < 3.2 * deviation && far > 1.3 * near + 1.5 * step
        };
        let is_above = |own: Real, other: Real| own > 2.2 || (own > 1.2 && other == 0.0);
        let [above, below] = [excess(high), excess(low)];
        let clipped = [
            is_above(above, below) || is_cut(high, up, down),
            is_above(below, above) || is_cut(low, down, up),
        ];
        let hits = self.ends.iter().zip(clipped).filter(|(_, is)| *is);
        let hits = hits.filter_map(|(end, _)| end.near.first()).sum();
        (hits > 0 && self.share_of_equal() < MOSTLY_EQUAL).then_some(Reason::Railed {
            hits,
            samples: self.samples,
        })
    }

    /// Zeros in the middle of a hole, about as many as the values next to it let expect in it. Or more zeros than the
    /// levels next to them let expect, where all larger values are moved towards zero.
    fn dead_band(&self) -> Option<Reason> {
        let Hole {
            zeros,
            edge,
            beside,
            levels,
            around,
        } = self.hole;
        let step = self.steps.step().max(1);
        let width = real(Hole::width(edge, step));
        // Zero and the levels on either side of it up to the edge.
        let inside = 2.0 * real(edge) - real(step);
        let expected = 0.5 * beside as Real / width * inside;
        let found = zeros as Real;
        let is_hole = edge >= step.saturating_mul(2).saturating_sub(step / 4)
            && beside >= 8
            && (0.5 * expected..40.0 * expected).contains(&found);
        let [none, one, two] = levels.map(|number| number as Real);
        let is_peak = if one + two < 60.0 {
            self.steps.window() > 0 && none > 2.0 * around as Real + 16.0
        } else {
            let (chance, relative) = smooth([one, two]);
            let error = sqrt(none + chance * chance * relative);
            let is_more = none > 1.5 * chance && none - chance > 5.0 * error;
            two >= 60.0 && two >= 0.3 * one && is_more && !self.is_pulsed()
        };
        // Zeros at an end of the range are clipped.
        let [high, low] = self.ends.each_ref().map(End::value);
        let zero = i64::from(self.zero);
        let is_inside = high > zero && -low < zero;
        let enough = is_inside && zeros >= 16 && found >= 0.005 * self.samples as Real;
        (enough && (is_hole || is_peak)).then_some(Reason::DeadBand {
            zeros,
            samples: self.samples,
        })
    }

    fn repeated(&self, joint: Option<&JointRepeats>, repeats: &Repeats) -> Reason {
        match joint {
            Some(joint) if joint.repeats().told => joint.reason(repeats, self.samples),
            _ => repeated(&self.runs, repeats, self.samples),
        }
    }
}

/// The reason why a record with these repeats is invalid.
fn repeated(runs: &ZeroRuns, repeats: &Repeats, samples: u64) -> Reason {
    let repeated = real(repeats.share * samples as Real) as u64;
    let changes = samples.saturating_sub(repeated);
    // A sensor that is slower by the same factor all the time leaves runs of nearly the same length.
    let [first, ..] = runs.reached;
    let regular = repeats.share >= 0.1
        && first.saturating_mul(100) >= runs.zeros.min(changes).saturating_mul(97);
    let whole = (2..=4_u8).find(|&times| {
        let all = changes.saturating_mul(times.into());
        regular && all.abs_diff(samples).saturating_mul(200) < samples
    });
    Reason::Repeated {
        times: whole.unwrap_or(u8::from(regular)),
        changes,
        samples,
    }
}

/// The repeats of values whose differences are hardly longer than a step. The sensor's value before rounding lies anywhere
/// within a step, so that the differences of white or slow Gaussian noise have the distribution of Gaussian ones plus
/// a triangle of two steps. The numbers of one and two steps give its width, and with it that of zero.
fn coarse_repeats(near: [u64; 4], pairs: Real) -> Repeats {
    let [zero, one, two, three] = near.map(|number| number as Real);
    let ratio = two / one;
    let (mut low, mut high): (Real, Real) = (0.1, 3.0);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        let [_, first, second, _] = rounded(middle);
        if second < ratio * first {
            low = middle;
        } else {
            high = middle;
        }
    }
    let of_one = |width: Real| {
        let [none, first, _, third] = rounded(width);
        (0.5 * none / first, third / first)
    };
    let ((chance, third), (other, _)) = (of_one(low), of_one(low * 1.01));
    let [_, first, second, _] = rounded(low);
    let [_, other_first, other_second, _] = rounded(low * 1.01);
    // How the logarithm of the chance follows that of the ratio.
    let slope = log(other / chance) / log(other_second / other_first / (second / first));
    let chance = chance * one;
    let relative = (1.0 - slope) * (1.0 - slope) / one + slope * slope / two;
    let error = sqrt(zero + chance * chance * relative).max(1.0);
    // Noise of another distribution has longer differences.
    let expected = third * one;
    if three
        > expected + TOLD * sqrt(expected * (1.0 + expected * 9.0 * (1.0 / one + 1.0 / two)) + 1.0)
    {
        return Repeats::unknown(zero / pairs);
    }
    let number = zero - chance;
    let own = chance / (pairs - number).max(1.0);
    Repeats::new(number / error, number / pairs, error / pairs, own)
}

/// The probabilities that the difference of two rounded values is 0, 1, 2 and 3 steps, up to a factor. `width` is the
/// standard deviation of the difference before rounding, in steps.
fn rounded(width: Real) -> [Real; 4] {
    // The second integral of the normal density.
    let integral = |steps: Real| {
        let u = steps / width;
        let below = 0.5 * erfc(-u * FRAC_1_SQRT_2);
        u * below + 0.398_942_3 * exp(-0.5 * u * u)
    };
    [0.0, 1.0, 2.0, 3.0].map(|steps: Real| {
        (integral(steps + 1.0) - 2.0 * integral(steps) + integral(steps - 1.0)).max(1e-12)
    })
}

/// The number of zeros of a smooth symmetric distribution, of which so many are one and two steps long on both sides,
/// and its relative variance. The logarithm of a Gaussian density is a parabola.
fn smooth([one, two]: [Real; 2]) -> (Real, Real) {
    let zero = exp((4.0 * log(0.5 * one) - log(0.5 * two)) / 3.0);
    (zero, 16.0 / 9.0 / one + 1.0 / 9.0 / two)
}

/// The repeats of values so fine that none is there by chance. Their grid may be finer for smaller values, but hardly
/// coarser than a 64th of the usual difference. Then at most half as many differences are zero as are below that.
fn fine_repeats(steps: &Steps) -> Repeats {
    let pairs = steps.later.max(1) as Real;
    if steps.window() == 0 || steps.later < JUDGED {
        return Repeats::unknown(steps.zero as Real / pairs);
    }
    let (zero, small) = (steps.zero as Real, steps.small as Real);
    let most = 0.5 * small;
    let error = sqrt(most + 0.25 * small + 1.0);
    let [_, one, ..] = steps.near.map(|number| number as Real);
    let by_chance = 0.5 * one;
    let share = (zero - by_chance) / pairs;
    let z = (zero - most) / error;
    Repeats::new(z, share, error / pairs, by_chance / pairs)
}

/// Whether runs of repeats are too long. `fine` means that none is there by chance. Then a sensor slower by a factor
/// `1/(1 − r)` has no runs beyond this factor, and repeats at random go on with the probability `r`. Else the short
/// runs show how likely a run goes on.
fn is_stuck(reached: &[u64; 6], (zeros, long): (u64, u64), pairs: u64, fine: bool) -> bool {
    let [one, two, four, ..] = reached.map(|number| number as Real);
    let share = zeros as Real / pairs.max(1) as Real;
    if long.saturating_mul(1000) < pairs || (!fine && share >= MOSTLY_EQUAL) {
        return false;
    }
    // Slow noise makes a run go on more often than short ones tell: the exponent allows for it.
    let (chance, from, begun) = match fine {
        true => (share.max(0.001), 1.0, one),
        false => {
            let later = if two > 20.0 { sqrt(four / two) } else { 0.0 };
            ((two / one.max(1.0)).max(later).max(0.001), 4.0, four + 1.0)
        }
    };
    let slow = 1.0 / (1.0 - share).max(0.001);
    numbered(reached.iter()).skip(3).any(|(place, &runs)| {
        let length = real(1_u32 << place);
        let expected = begun * exp(0.6 * (length - from) * log(chance)) + 0.01;
        let runs = runs as Real;
        // Chernoff's bound of the probability of so many runs.
        length > slow && runs > expected && runs * (log(runs / expected) - 1.0) + expected > 9.2
    })
}

impl JointRepeats {
    const fn pairs(&self) -> u64 {
        let mut sum = 0_u64;
        let mut left: &[u64] = &self.cells;
        while let [cell, rest @ ..] = left {
            sum = sum.saturating_add(*cell);
            left = rest;
        }
        sum
    }

    /// The reason why a record of so many samples with these repeats of all axes is invalid.
    pub(crate) fn reason(&self, repeats: &Repeats, samples: u64) -> Reason {
        repeated(&self.runs, repeats, samples)
    }

    /// The share of samples in which all axes repeat.
    pub(crate) fn share_of_all(&self) -> Real {
        let [.., all] = self.cells;
        all as Real / self.pairs().max(1) as Real
    }

    /// The share of samples in which each axis repeats.
    pub(crate) fn shares_of_axes(&self) -> [Real; 3] {
        let [_, x, y, xy, z, xz, yz, all] = self.cells.map(|number| number as Real);
        let pairs = self.pairs().max(1) as Real;
        [x + xy + xz, y + xy + yz, z + xz + yz].map(|some| (some + all) / pairs)
    }

    /// Whether axes are as they were two samples before more often than as they were one sample before. So are counts of pulses of an
    /// angle, whose neighbours are not independent, so that their steps say nothing of repeats.
    pub fn is_alternating(&self) -> bool {
        let [repeated, returned] = self.returned.map(real);
        returned - repeated > 4.0 * sqrt(returned + repeated)
    }

    /// The share of samples in which all axes repeat, beyond chance.
    ///
    /// A sample in which an axis moves is one of the sensor, and such samples show how often each of the other axes
    /// repeats by chance. If the axes are independent, all of them do so as often as the product. If a common
    /// disturbance moves them, two axes repeat together more often than that, and only what three axes do beyond any two,
    /// or beyond their third one's own smooth distribution, counts.
    pub fn repeats(&self) -> Repeats {
        let cells = self.cells.map(|cell| cell as Real + 0.5);
        let pairs = cells.iter().sum::<Real>();
        let [none, x, y, xy, z, xz, yz, all] = cells;
        if self.pairs() < JUDGED {
            return Repeats::unknown(all / pairs);
        }
        let chances = [
            (x + xy + xz) / (none + x + y + z + xy + xz),
            (y + xy + yz) / (none + x + y + z + xy + yz),
            (z + xz + yz) / (none + x + y + z + xz + yz),
        ];
        if chances.iter().any(|&chance| chance > 0.7) {
            return Repeats::unknown(all / pairs);
        }
        let chance = chances.iter().product::<Real>();
        let mean = exp(log(chance) / 3.0);
        let share = (all / pairs - chance) / (1.0 - chance);
        let spread = (1.0 - 3.0 * mean * mean + 2.0 * mean * mean * mean).max(0.001);
        let error = sqrt((chance / spread + 1.0 / pairs) / pairs);
        let independent = share / error;
        let joint = [(xy, x, y), (xz, x, z), (yz, y, z)].map(|(both, one, other)| {
            let expected = one * other / none;
            let variance = expected * (1.0 + one / none) * (1.0 + other / none)
                + expected * expected * (1.0 / one + 1.0 / other);
            (both - expected, variance + 1.0)
        });
        let [together, variance, dependence] =
            joint
                .iter()
                .fold([0.0; 3], |[sum, variance, squares], (one, own)| {
                    [sum + one, variance + own, squares + one * one / own]
                });
        let common = together / sqrt(variance);
        // No third-order interaction: the axes may depend on each other in pairs.
        let expected = exp(log(xy) + log(xz) + log(yz) + log(none) - log(x) - log(y) - log(z));
        let inverse: Real = cells.iter().take(7).map(|cell| 1.0 / cell).sum();
        let pairwise = (all - expected) / sqrt(expected + expected * expected * inverse);
        let [one, two] = self.third.map(|number| number as Real / 3.0);
        let smooth = if two >= 20.0 && two >= 0.3 * one {
            let (expected, variance) = smooth([one, two]);
            (all - expected) / sqrt(expected + expected * expected * variance / 3.0)
        } else {
            0.0
        };
        let is_common = common >= 2.5 || dependence >= 11.0;
        let own = if is_common { 0.0 } else { independent };
        let z = if self.is_alternating() {
            own
        } else if all >= 16.0 {
            own.max(pairwise).max(smooth)
        } else {
            0.0
        };
        if is_common {
            let share = (all - expected).max(0.0) / pairs;
            let chance = expected / (pairs * (1.0 - share)).max(1.0);
            return Repeats::new(z - TOLD_OF_ALL + TOLD, share, all / pairs / TOLD, chance);
        }
        Repeats::new(z - TOLD_OF_ALL + TOLD, share, error, chance)
    }
}
