//! Lines of a spectrum that are harmonics of one fundamental.

/// A line of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The frequency, between 0 and half the sample rate.
    pub frequency_hz: f64,
    /// The standard error of the frequency.
    pub error_hz: f64,
}

/// Lines that are harmonics of one fundamental, or their aliases.
#[derive(Clone, Debug, PartialEq)]
pub struct Comb {
    /// The frequency of the fundamental, as all lines give it.
    pub fundamental_hz: f64,
    /// The nominal frequency of the mains, if the fundamental agrees with it.
    pub mains_hz: Option<f64>,
    /// The place of each line and its order, the fundamental first.
    pub members: Vec<(usize, u32)>,
}

/// The highest order. Chosen by hand: a record that shows more harmonics has the lower ones too, and with each order
/// the chance grows that a line agrees with it by accident.
const HIGHEST: u32 = 10;

/// The standard errors by which a line may differ from a harmonic. Chosen by hand: a line with Gaussian errors differs
/// by more in 0.3 %.
const AGREES: f64 = 3.0;

/// The probability with which lines anywhere would agree as well, from which on they are not called a comb. Chosen by
/// hand, as for a test at 5 %.
const ACCIDENT: f64 = 0.05;

/// The nominal frequencies of mains, and how far they stray: in the grids of Europe and America by less than 0.2 Hz.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];
const STRAYS_HZ: f64 = 0.2;

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

/// The combs among the lines of a record with this sample rate, each line in one of them at most.
///
/// The fundamental of a comb is among its lines: as it is, or as an alias of the frequency of mains.
pub fn combs(lines: &[Line], rate_hz: f64) -> Vec<Comb> {
    let mut rest: Vec<usize> = (0..lines.len()).collect();
    let mut combs = Vec::new();
    loop {
        let all = rest.iter().flat_map(|&seed| {
            let own = lines[seed].frequency_hz;
            let mains = MAINS_HZ.map(|mains_hz| unfolded(own, mains_hz, rate_hz));
            std::iter::once(own)
                .chain(mains.into_iter().filter(|&f| mains_of(f).is_some()))
                .map(move |fundamental_hz| (seed, fundamental_hz))
        });
        let found = all.filter_map(|(seed, f)| comb(lines, &rest, seed, f, rate_hz));
        // Among combs of as many lines, the one with the lower harmonics is the simpler one. A frequency and its alias
        // have the same harmonics, and then that of the mains is the likelier one.
        let order = |comb: &Comb| comb.members.iter().map(|(_, order)| *order).max();
        let best = found.min_by_key(|comb| {
            let more = usize::MAX - comb.members.len();
            (more, order(comb), comb.mains_hz.is_none())
        });
        let Some(best) = best else {
            return combs;
        };
        rest.retain(|line| best.members.iter().all(|(member, _)| member != line));
        combs.push(best);
    }
}

fn mains_of(frequency_hz: f64) -> Option<f64> {
    let mut nominal = MAINS_HZ.into_iter();
    nominal.find(|mains| (frequency_hz - mains).abs() < STRAYS_HZ)
}

/// The comb whose fundamental is the line `seed` at this frequency, if other lines belong to it.
fn comb(lines: &[Line], rest: &[usize], seed: usize, first_hz: f64, rate_hz: f64) -> Option<Comb> {
    let mut members = vec![(seed, 1)];
    let half_hz = 0.5 * rate_hz;
    // The probability that a fundamental of mains and every other line agree by accident.
    let is_alias = first_hz != lines[seed].frequency_hz;
    let mut accident = match is_alias {
        true => MAINS_HZ.len() as f64 * 2.0 * STRAYS_HZ / half_hz,
        false => 1.0,
    };
    accident *= rest.len() as f64;
    let (mut weights, mut sum) = (0.0, 0.0);
    let mut add = |line: &Line, order: f64| {
        let true_hz = unfolded(line.frequency_hz, order * first_hz, rate_hz);
        let weight = (order / line.error_hz).powi(2);
        weights += weight;
        sum += weight * true_hz / order;
    };
    add(&lines[seed], 1.0);
    for &other in rest.iter().filter(|&&other| other != seed) {
        let line = &lines[other];
        let distance =
            |order: u32| (alias(f64::from(order) * first_hz, rate_hz) - line.frequency_hz).abs();
        let tolerance =
            |order: u32| AGREES * line.error_hz.hypot(f64::from(order) * lines[seed].error_hz);
        let taken = |order: u32| members.iter().any(|(_, other)| *other == order);
        let mut orders = 2..=HIGHEST;
        if let Some(order) = orders.find(|&k| !taken(k) && distance(k) <= tolerance(k)) {
            accident *= f64::from(order - 1) * 2.0 * tolerance(order) / half_hz;
            add(line, f64::from(order));
            members.push((other, order));
        }
    }
    let fundamental_hz = sum / weights;
    members.sort_by_key(|(_, order)| *order);
    (members.len() > 1 && accident < ACCIDENT).then(|| Comb {
        fundamental_hz,
        mains_hz: mains_of(fundamental_hz),
        members,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(frequencies: &[f64]) -> Vec<Line> {
        let line = |&frequency_hz: &f64| Line {
            frequency_hz,
            error_hz: 0.002,
        };
        frequencies.iter().map(line).collect()
    }

    fn orders(comb: &Comb) -> Vec<u32> {
        comb.members.iter().map(|(_, order)| *order).collect()
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
        let combs_of = |frequencies: &[f64]| combs(&lines(frequencies), 120.0);
        let found = combs_of(&[50.02, 19.96, 30.06]);
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].mains_hz, orders(&found[0])),
            (Some(50.0), vec![1, 2, 3])
        );
        assert!((found[0].fundamental_hz - 50.02).abs() < 1e-3);
        // The second harmonic of 50.02 Hz is not at 20.04 Hz.
        assert_eq!(combs_of(&[50.02, 20.04]), []);
        // At 80 Hz, 50.02 Hz itself is an alias.
        let found = combs(&lines(&[29.98, 20.04]), 80.0);
        assert_eq!(
            (found[0].mains_hz, orders(&found[0])),
            (Some(50.0), vec![1, 2])
        );
    }

    #[test]
    fn lines_that_are_no_harmonics_or_could_be_by_accident_are_no_comb() {
        assert_eq!(combs(&lines(&[7.7, 0.9]), 100.0), []);
        assert_eq!(combs(&lines(&[7.7]), 100.0), []);
        // A line whose frequency is hardly known is near some harmonic.
        let vague = [6.1, 12.6].map(|frequency_hz| Line {
            frequency_hz,
            error_hz: 0.3,
        });
        assert_eq!(combs(&vague, 100.0), []);
    }

    #[test]
    fn lines_anywhere_are_rarely_called_a_comb() {
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let is_comb = |_: &u32| {
            let pair = [50.0 * random(), 50.0 * random()];
            let lines = pair.map(|frequency_hz| Line {
                frequency_hz,
                error_hz: 0.01,
            });
            !combs(&lines, 100.0).is_empty()
        };
        let found = (0..10_000).filter(is_comb).count();
        assert!((1..500).contains(&found), "{found} of 10000");
    }
}
