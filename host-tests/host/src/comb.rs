//! Lines of a spectrum that are harmonics of one fundamental, and lines of the mains.
//!
//! A *story* says of some lines that they are harmonics of one fundamental: each has an order, and each may be folded
//! back at multiples of half the sample rate. Lines that are anywhere agree with some story by chance, and the more
//! numbers a story may choose, the more often. So a story is weighed by how unlikely its agreement is without it, less
//! what its numbers cost:
//!
//! ```text
//! weight = Σ [ln(half the rate / window) − 2 ln order − 2 ln(1 + folds) − const] − ln(number of choices of lines)
//! ```
//!
//! where `window` is the range of frequencies in which a line would have agreed. The orders have prior probabilities
//! in proportion to `1/order²`, which sum up to one. So the probability that lines anywhere agree with any story of a
//! weight above `w` is below `e^−w` (Boole's inequality), and one threshold serves short and long stories. Folds cost
//! as much, because most gyros filter what lies above half the sample rate.

/// A line of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The frequency, between 0 and half the sample rate.
    pub frequency_hz: f64,
    /// The standard error of the frequency.
    pub error_hz: f64,
    /// The width that the line does not exceed. `None` if it may have any width, or if its frequency changed.
    pub width_hz: Option<f64>,
}

/// Lines that are harmonics of one fundamental, or their aliases.
#[derive(Clone, Debug, PartialEq)]
pub struct Comb {
    /// The frequency of the fundamental, as all lines give it.
    pub fundamental_hz: f64,
    /// The nominal frequency of the mains, if the lines are those of mains. Only then a comb may have a single line.
    pub mains_hz: Option<f64>,
    /// The place of each line and its order, the lowest order first.
    pub members: Vec<(usize, u32)>,
}

/// The highest order. Chosen by hand: a record that shows more harmonics has the lower ones too, and with each order
/// the chance grows that a line agrees with it by accident.
const HIGHEST: u32 = 10;

/// The standard errors by which a line may differ from a harmonic. Chosen by hand: a line with Gaussian errors differs
/// by more in 0.3 %.
const AGREES: f64 = 3.0;

/// The standard errors of a 95 % interval.
const INTERVAL: f64 = 1.96;

/// The probability with which lines anywhere would agree as well, from which on they are not called a comb. Chosen by
/// hand, as for a test at 5 %.
const ACCIDENT: f64 = 0.05;

/// The same for mains. It is smaller, because whoever reads *mains* looks for wires and supplies.
const MAINS_ACCIDENT: f64 = 0.01;

/// How many times as probable a story of mains has to be as that of another source. Chosen by hand: the fundamental of
/// another source agrees with mains by chance in less than 2 %.
const RIVAL: f64 = 50.0;

/// The nominal frequencies of mains.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];

/// How far mains stray from the nominal frequency as a record shows them, relative to it: 0.2 % for the grid and 0.1 % for
/// the sample rate. Chosen by hand. EN 50160 (2010, 4.2.1) allows 1 %, but synchronous grids are nearly always within 0.2 %
/// (ENTSO-E keeps 50 Hz within 0.05 Hz). With 1 %, any line of a record at 100 Hz would agree by chance in 4 %, so that no
/// line could be told from one of mains.
const STRAYS: f64 = 0.003;

/// The width of a line of mains, relative to its frequency: that of the line from which a story begins, and that of the
/// others, which may be so weak that less is known of them. Chosen by hand: the frequency of a synchronous grid changes by
/// less than 0.05 Hz in a quarter of an hour, and vibration of an engine wanders by more. It does so in all harmonics alike.
const STEADY: f64 = 0.001;
const STEADY_TOO: f64 = 0.01;

/// What an order from 1 on costs beside twice its logarithm, and from 2 on: the logarithms of `Σ 1/k²`.
const FROM_ONE: f64 = 0.497_7;
const FROM_TWO: f64 = -0.438_5;

/// The frequency at which a sampled record shows a frequency.
fn alias(frequency_hz: f64, rate_hz: f64) -> f64 {
    (frequency_hz - rate_hz * (frequency_hz / rate_hz).round()).abs()
}

/// The frequency nearest to `near_hz` whose alias is `frequency_hz`.
fn unfolded(frequency_hz: f64, near_hz: f64, rate_hz: f64) -> f64 {
    let at = |sign: f64| {
        let turns = ((near_hz - sign * frequency_hz) / rate_hz).round();
        turns * rate_hz + sign * frequency_hz
    };
    let [above, below] = [at(1.0), at(-1.0)];
    if (above - near_hz).abs() < (below - near_hz).abs() {
        above
    } else {
        below
    }
}

/// What an order costs, with the folds of its frequency at half the sample rate and at zero.
fn cost(order: u32, true_hz: f64, rate_hz: f64) -> f64 {
    let folds = (2.0 * true_hz / rate_hz).floor();
    2.0 * f64::from(order).ln() + 2.0 * (1.0 + folds).ln()
}

/// The logarithm of the number of ways to choose some of several things.
fn ln_choices(all: usize, chosen: usize) -> f64 {
    let one = |i: usize| ((all - i) as f64 / (i + 1) as f64).ln();
    (0..chosen).map(one).sum()
}

/// A comb and its weight.
struct Story {
    comb: Comb,
    weight: f64,
}

/// The combs among the lines of a record with this sample rate, each line in one of them at most.
///
/// The fundamental of a comb is among its lines, unless it is that of mains.
pub fn combs(lines: &[Line], rate_hz: f64) -> Vec<Comb> {
    let mut rest: Vec<usize> = (0..lines.len()).collect();
    let mut combs = Vec::new();
    loop {
        let lines = Lines {
            lines,
            rest: &rest,
            rate_hz,
        };
        let own = rest.iter().filter_map(|&seed| lines.own(seed));
        let own = heaviest(own).filter(|own| own.weight > -ACCIDENT.ln());
        let rival = own.as_ref().map_or(0.0, |own| own.weight + RIVAL.ln());
        let mains = rest.iter().flat_map(|&seed| lines.mains(seed));
        let mains =
            heaviest(mains).filter(|mains| mains.weight > (-MAINS_ACCIDENT.ln()).max(rival));
        let Some(best) = mains.or(own) else {
            return combs;
        };
        let members = &best.comb.members;
        rest.retain(|line| members.iter().all(|(member, _)| member != line));
        combs.push(best.comb);
    }
}

fn heaviest(stories: impl Iterator<Item = Story>) -> Option<Story> {
    stories.max_by(|one, other| one.weight.total_cmp(&other.weight))
}

/// The lines that are not in a comb yet.
struct Lines<'a> {
    lines: &'a [Line],
    rest: &'a [usize],
    rate_hz: f64,
}

impl Lines<'_> {
    /// The comb whose fundamental is the line `seed`, if other lines belong to it.
    fn own(&self, seed: usize) -> Option<Story> {
        let first_hz = self.lines[seed].frequency_hz;
        let story = self.with_harmonics((seed, 1), first_hz, FROM_TWO, |_, _| true);
        (story.comb.members.len() > 1).then_some(story)
    }

    /// The combs of mains of which the line `seed` is a harmonic. All their lines are steady.
    fn mains(&self, seed: usize) -> Vec<Story> {
        let mut stories = Vec::new();
        let line = &self.lines[seed];
        for (mains_hz, order) in MAINS_HZ
            .into_iter()
            .flat_map(|mains_hz| (1..=HIGHEST).map(move |order| (mains_hz, order)))
        {
            let is_within = |line: &Line, order: u32, share: f64| {
                let most = share * f64::from(order) * mains_hz;
                line.width_hz.is_some_and(|width_hz| width_hz <= most)
            };
            let is_steady = |line: &Line, order: u32| is_within(line, order, STEADY_TOO);
            let nominal_hz = f64::from(order) * mains_hz;
            let true_hz = unfolded(line.frequency_hz, nominal_hz, self.rate_hz);
            let room_hz = STRAYS * nominal_hz + INTERVAL * line.error_hz;
            if (true_hz - nominal_hz).abs() > room_hz || !is_within(line, order, STEADY) {
                continue;
            }
            let first_hz = true_hz / f64::from(order);
            let others = if order == 1 { FROM_TWO } else { FROM_ONE };
            let mut story = self.with_harmonics((seed, order), first_hz, others, is_steady);
            story.weight += self.agreement(room_hz) - (MAINS_HZ.len() as f64).ln();
            story.weight -= FROM_ONE + cost(order, true_hz, self.rate_hz);
            story.comb.mains_hz = Some(mains_hz);
            stories.push(story);
        }
        stories
    }

    /// How unlikely it is that a line anywhere agrees with a frequency within a tolerance, as a weight.
    fn agreement(&self, tolerance_hz: f64) -> f64 {
        (0.25 * self.rate_hz / tolerance_hz).max(1.0).ln()
    }

    /// The comb of a line of known order and of its harmonics, for a fundamental at this frequency, and the weight of the
    /// harmonics. Beside twice its logarithm, an order costs `order_costs`.
    fn with_harmonics(
        &self,
        (seed, seed_order): (usize, u32),
        first_hz: f64,
        order_costs: f64,
        belongs: impl Fn(&Line, u32) -> bool,
    ) -> Story {
        let mut members = vec![(seed, seed_order)];
        let mut weight = -(self.rest.len() as f64).ln();
        let seed_error_hz = self.lines[seed].error_hz / f64::from(seed_order);
        for &other in self.rest.iter().filter(|&&other| other != seed) {
            let line = &self.lines[other];
            let gain = |order: u32| {
                let true_hz = f64::from(order) * first_hz;
                let off_hz = (alias(true_hz, self.rate_hz) - line.frequency_hz).abs();
                let error_hz = line.error_hz.hypot(f64::from(order) * seed_error_hz);
                let agrees = off_hz <= AGREES * error_hz && belongs(line, order);
                let gain = self.agreement(AGREES * error_hz) - order_costs;
                (agrees, gain - cost(order, true_hz, self.rate_hz))
            };
            let taken = |order: u32| members.iter().any(|(_, other)| *other == order);
            let free = (1..=HIGHEST).filter(|&order| !taken(order));
            let gains = free.map(|order| (order, gain(order)));
            let gains = gains.filter(|(_, (agrees, gain))| *agrees && *gain > 0.0);
            let best = gains.max_by(|(_, (_, one)), (_, (_, other))| one.total_cmp(other));
            if let Some((order, (_, gain))) = best {
                weight += gain;
                members.push((other, order));
            }
        }
        weight -= ln_choices(self.rest.len() - 1, members.len() - 1);
        members.sort_by_key(|(_, order)| *order);
        let comb = Comb {
            fundamental_hz: self.fundamental_hz(&members, first_hz),
            mains_hz: None,
            members,
        };
        Story { comb, weight }
    }

    /// The frequency of the fundamental, as all lines give it, near a first guess.
    fn fundamental_hz(&self, members: &[(usize, u32)], first_hz: f64) -> f64 {
        let (mut weights, mut sum) = (0.0, 0.0);
        for &(place, order) in members {
            let (line, order) = (&self.lines[place], f64::from(order));
            let true_hz = unfolded(line.frequency_hz, order * first_hz, self.rate_hz);
            let weight = (order / line.error_hz).powi(2);
            weights += weight;
            sum += weight * true_hz / order;
        }
        sum / weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(frequency_hz: f64) -> Line {
        Line {
            frequency_hz,
            error_hz: 0.002,
            width_hz: Some(0.005),
        }
    }

    fn lines(frequencies: &[f64]) -> Vec<Line> {
        frequencies
            .iter()
            .map(|&frequency_hz| line(frequency_hz))
            .collect()
    }

    fn orders(comb: &Comb) -> Vec<u32> {
        comb.members.iter().map(|(_, order)| *order).collect()
    }

    /// The nominal frequencies and the orders of the combs.
    fn told(lines: &[Line], rate_hz: f64) -> Vec<(Option<f64>, Vec<u32>)> {
        let combs = combs(lines, rate_hz);
        combs
            .iter()
            .map(|comb| (comb.mains_hz, orders(comb)))
            .collect()
    }

    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn harmonics_of_one_fundamental_are_a_comb() {
        let combs = combs(&lines(&[12.2011, 6.1, 18.2991]), 100.0);
        let [comb] = &combs[..] else {
            panic!("{combs:?}")
        };
        assert_eq!(comb.members, [(1, 1), (0, 2), (2, 3)]);
        assert!((comb.fundamental_hz - 6.1).abs() < 3e-4, "{comb:?}");
        assert_eq!(comb.mains_hz, None);
    }

    #[test]
    fn mains_are_named_where_all_aliases_agree() {
        // At 120 Hz, 100.04 Hz appears at 19.96 Hz and 150.06 Hz at 30.06 Hz.
        let found = combs(&lines(&[50.02, 19.96, 30.06]), 120.0);
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].mains_hz, orders(&found[0])),
            (Some(50.0), vec![1, 2, 3])
        );
        assert!((found[0].fundamental_hz - 50.02).abs() < 1e-3);
        // The second harmonic of 50.02 Hz is not at 20.04 Hz.
        assert_eq!(combs(&lines(&[50.02, 20.04]), 120.0), []);
        // The fundamental itself need not be seen.
        assert_eq!(
            told(&lines(&[150.06, 250.1]), 1000.0),
            [(Some(50.0), vec![3, 5])]
        );
    }

    #[test]
    fn one_line_is_mains_only_where_the_spectrum_is_wide() {
        assert_eq!(told(&[line(50.02)], 1000.0), [(Some(50.0), vec![1])]);
        assert_eq!(told(&[line(59.95)], 1000.0), [(Some(60.0), vec![1])]);
        assert_eq!(told(&[line(50.2)], 1000.0), []);
        // One line in a hundred is as near to 50 Hz or 60 Hz by chance, or nearer.
        assert_eq!(told(&[line(49.98)], 100.0), []);
        // At 80 Hz, 50.02 Hz appears at 29.98 Hz.
        assert_eq!(told(&[line(29.98)], 80.0), []);
    }

    #[test]
    fn a_line_that_wanders_or_may_be_wide_is_not_mains() {
        for width_hz in [None, Some(0.2)] {
            let wide = |frequency_hz| Line {
                width_hz,
                ..line(frequency_hz)
            };
            assert_eq!(told(&[wide(50.02)], 1000.0), []);
            // They are harmonics nevertheless.
            let found = told(&[wide(50.02), wide(100.04)], 1000.0);
            assert_eq!(found, [(None, vec![1, 2])]);
        }
        // Of a weak harmonic, less is known.
        let weak = Line {
            width_hz: Some(0.2),
            ..line(100.04)
        };
        assert_eq!(
            told(&[line(50.02), weak], 1000.0),
            [(Some(50.0), vec![1, 2])]
        );
    }

    #[test]
    fn low_harmonics_are_told_rather_than_high_or_folded_ones_of_mains() {
        // At 40 Hz, 50 Hz appears at 10 Hz, and 6 times as much at 20 Hz; at 60 Hz, twice as much does. At 100 Hz,
        // 60 Hz and twice as much appear at 40 Hz and 20 Hz. An engine makes the same lines.
        for (frequencies, rate_hz) in [
            ([10.0, 19.99], 40.0),
            ([10.0, 20.0], 60.0),
            ([20.0, 40.0], 100.0),
            ([10.0, 20.0], 90.0),
        ] {
            let found = told(&lines(&frequencies), rate_hz);
            assert_eq!(found, [(None, vec![1, 2])], "{rate_hz} Hz");
        }
        // Vibration that wanders: the lines are no harmonics within their errors, and a large order does not help.
        assert_eq!(combs(&lines(&[10.01, 19.93]), 40.0), []);
        assert_eq!(combs(&lines(&[10.01, 19.93]), 100.0), []);
        // All harmonics of an engine at 600 rpm, of which the fifth one is at 50 Hz.
        let all = lines(&[10.0, 20.0, 30.0, 50.0]);
        assert_eq!(told(&all, 1000.0), [(None, vec![1, 2, 3, 5])]);
    }

    #[test]
    fn lines_that_are_no_harmonics_or_could_be_by_accident_are_no_comb() {
        assert_eq!(combs(&lines(&[7.7, 0.9]), 100.0), []);
        assert_eq!(combs(&lines(&[7.7]), 100.0), []);
        // A line whose frequency is hardly known is near some harmonic.
        let vague = [6.1, 12.6].map(|frequency_hz| Line {
            frequency_hz,
            error_hz: 0.3,
            width_hz: None,
        });
        assert_eq!(combs(&vague, 100.0), []);
    }

    #[test]
    fn lines_anywhere_are_rarely_called_a_comb_and_more_rarely_mains() {
        let mut random = Random(1);
        for rate_hz in [40.0, 80.0, 100.0, 120.0, 200.0, 1000.0, 8000.0] {
            for number in 1..=4 {
                let (mut all, mut mains) = (0, 0);
                for _ in 0..4000 {
                    let anywhere = (0..number).map(|_| Line {
                        frequency_hz: 0.5 * rate_hz * random.next(),
                        error_hz: 0.01 * (0.1 + random.next()),
                        width_hz: Some(0.005),
                    });
                    let found = combs(&anywhere.collect::<Vec<_>>(), rate_hz);
                    all += usize::from(!found.is_empty());
                    mains += usize::from(found.iter().any(|comb| comb.mains_hz.is_some()));
                }
                assert!(all < 200, "{number} lines at {rate_hz} Hz: {all} of 4000");
                assert!(
                    mains < 40,
                    "{number} lines at {rate_hz} Hz: {mains} of 4000"
                );
            }
        }
    }

    #[test]
    fn combs_anywhere_are_found_and_rarely_called_mains() {
        let mut random = Random(2);
        let mut normal = || {
            // Irwin and Hall's sum of twelve.
            (0..12).map(|_| random.next()).sum::<f64>() - 6.0
        };
        let mut told_mains = 0;
        let mut found = 0;
        let mut fundamentals = Random(3);
        for _ in 0..2000 {
            let first_hz = 3.0 + 60.0 * fundamentals.next();
            let harmonics = [1.0, 2.0, 3.0].map(|order| Line {
                frequency_hz: order * first_hz + 0.002 * normal(),
                ..line(0.0)
            });
            let combs = combs(&harmonics, 400.0);
            found += usize::from(combs.iter().any(|comb| orders(comb) == [1, 2, 3]));
            told_mains += usize::from(combs.iter().any(|comb| comb.mains_hz.is_some()));
        }
        assert!(found > 1950, "{found} of 2000");
        assert!((1..40).contains(&told_mains), "{told_mains} of 2000");
    }
}
