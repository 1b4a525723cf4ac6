//! Counters that begin anew: a timer of few bits that overflows, and a time of day at midnight.

use super::{field::Stamp, pace::Pace};
use crate::failure::plural;

/// The bits of counters whose overflow is recognised: timers of microcontrollers, and signed numbers without their sign.
pub(super) const BITS: [i32; 4] = [16, 24, 31, 32];

/// The units in which a counter counts, in a second. It may be written in another one, such as microseconds as seconds.
const COUNTED: [(f64, &str); 4] = [(1.0, "s"), (1e3, "ms"), (1e6, "µs"), (1e9, "ns")];

/// The times that begin anew, in seconds: of half a day, of a day and of the week of GPS.
const PERIODS: [(f64, &str); 3] = [(43_200.0, "12 h"), (86_400.0, "24 h"), (604_800.0, "7 d")];

/// The step over a wrap differs from the usual one by at most so many times its scatter, or by this share of it, or by one
/// where stamps are whole. Chosen by hand. A counter that is reset hardly agrees so by chance.
const AGREES: (f64, f64) = (10.0, 0.01);

/// Once a counter has wrapped, as many samples may be lost where it wraps again. Chosen by hand.
const MOST_LOST: f64 = 16.0;

/// A counter of so many samples is longer than usual losses, so that half of it is no loss. Chosen by hand.
const LONG: f64 = 1e4;

/// A number at which stamps begin anew, in ticks, and how it is called.
#[derive(Clone, Debug, PartialEq)]
struct Modulus {
    ticks: f64,
    name: String,
}

/// Follows stamps that begin anew, and turns them into stamps that go on.
#[derive(Clone, Debug)]
pub(super) struct Wraps {
    /// The moduli that the stamps may have; one of them once they wrapped.
    moduli: Vec<Modulus>,
    last: Option<Stamp>,
    times: u64,
}

impl Wraps {
    /// The wraps of numbers of this pace.
    pub(super) fn of_numbers(pace: &Pace) -> Self {
        let of_bits = |bits: i32| {
            COUNTED.map(|(per_second, unit)| Modulus {
                ticks: 2f64.powi(bits) * (pace.per_second() / per_second),
                name: format!("2^{bits} {unit}"),
            })
        };
        let mut moduli: Vec<Modulus> = BITS.into_iter().flat_map(of_bits).collect();
        moduli.extend(Self::of_times(pace).moduli);
        Self {
            moduli,
            last: None,
            times: 0,
        }
    }

    /// The wraps of times of day of this pace.
    pub(super) fn of_times(pace: &Pace) -> Self {
        let period = |(seconds, name): (f64, &str)| Modulus {
            ticks: seconds * pace.per_second(),
            name: name.into(),
        };
        Self {
            moduli: PERIODS.into_iter().map(period).collect(),
            last: None,
            times: 0,
        }
    }

    /// The stamp as it would be if none had begun anew. Stamps that go back in any other way are left as they are.
    pub(super) fn unwrap(&mut self, stamp: Stamp, pace: &Pace) -> Stamp {
        let last = self.last.replace(stamp);
        if let Some(last) = last
            && stamp.since(last) < 0.0
        {
            let is_wrap = |modulus: &&Modulus| self.is_wrap(modulus, [last, stamp], pace);
            let fitting: Vec<&Modulus> = self.moduli.iter().filter(is_wrap).collect();
            if let [only] = fitting.as_slice() {
                self.moduli = vec![(*only).clone()];
                self.times += 1;
            }
        }
        match (self.times, self.moduli.first()) {
            (times @ 1.., Some(modulus)) => {
                // Behind the rows of a sensor that wrapped, those of the next one begin before the wrap again.
                let goes_back = modulus.ticks > LONG * pace.step
                    && last.is_some_and(|last| stamp.since(last) > 0.5 * modulus.ticks);
                self.times -= u64::from(goes_back);
                stamp.later((times - u64::from(goes_back)) as f64 * modulus.ticks)
            }
            _ => stamp,
        }
    }

    /// Whether the step between two stamps is a usual one if they wrap at a modulus, and both are below it.
    fn is_wrap(&self, modulus: &Modulus, [last, stamp]: [Stamp; 2], pace: &Pace) -> bool {
        let zero = Stamp::Whole(0);
        let ticks = modulus.ticks;
        let is_within = |range: [f64; 2]| {
            let mut ends = [last, stamp].into_iter().map(|one| one.since(zero));
            ends.all(|end| range[0] <= end && end < range[1])
        };
        if !is_within([0.0, ticks]) && !is_within([-0.5 * ticks, 0.5 * ticks]) {
            return false;
        }
        let step = stamp.since(last) + ticks;
        let cut = match stamp {
            Stamp::Whole(_) => 1.0,
            Stamp::Real(_) => 0.0,
        };
        let most = (AGREES.0 * pace.scatter).max(AGREES.1 * pace.step).max(cut);
        let is_usual = step <= pace.longest && (step - pace.step).abs() <= most;
        step > 0.0 && (is_usual || (self.times > 0 && step < MOST_LOST * pace.step))
    }

    /// Describes how often the stamps began anew, and at what.
    pub(super) fn report(&self) -> Option<String> {
        let modulus = self.moduli.first().filter(|_| self.times > 0)?;
        let times = match self.times {
            1 => "once".into(),
            times => plural(times, "time"),
        };
        Some(format!("; wraps {times}, at {}", modulus.name))
    }
}

#[cfg(test)]
mod tests {
    use super::{super::names::TimeUnit, *};

    /// What became of stamps.
    fn unwrapped(stamps: &[f64], unit: TimeUnit) -> (Vec<f64>, Option<String>) {
        let pace = Pace::of(&stamps[..20], unit).unwrap();
        let mut wraps = Wraps::of_numbers(&pace);
        let zero = Stamp::Whole(0);
        let whole = |stamp: f64| match stamp.fract() == 0.0 {
            true => Stamp::Whole(stamp as i64),
            false => Stamp::Real(stamp),
        };
        let unwrap = |&stamp: &f64| wraps.unwrap(whole(stamp), &pace).since(zero);
        (stamps.iter().map(unwrap).collect(), wraps.report())
    }

    #[test]
    fn counters_of_known_bits_and_times_of_day_go_on_where_they_begin_anew() {
        let two = |bits: i32| 2f64.powi(bits);
        for (unit, step, modulus, name) in [
            (TimeUnit::Us, 10_000.0, two(32), "2^32 µs"),
            (TimeUnit::Us, 1250.0, two(16), "2^16 µs"),
            (TimeUnit::Ms, 10.0, two(31), "2^31 ms"),
            (TimeUnit::Ms, 5.0, two(16), "2^16 ms"),
            (TimeUnit::Ns, 5e6, two(32), "2^32 ns"),
            (TimeUnit::Us, 2000.0, two(24), "2^24 µs"),
            (TimeUnit::S, 0.01, two(32) / 1e6, "2^32 µs"),
            (TimeUnit::S, 0.01, two(32) / 1e3, "2^32 ms"),
            (TimeUnit::S, 0.005, 86_400.0, "24 h"),
            (TimeUnit::Ms, 20.0, 604_800_000.0, "7 d"),
        ] {
            let first = modulus - 25.4 * step;
            let all = (0..70).map(|i| first + f64::from(i) * step);
            let all: Vec<f64> = match unit {
                TimeUnit::S => all.collect(),
                _ => all.map(f64::round).collect(),
            };
            let stamps: Vec<f64> = all.iter().map(|stamp| stamp % modulus).collect();
            let (found, report) = unwrapped(&stamps, unit);
            let is_near = |(one, other): (&f64, &f64)| (one - other).abs() < 1e-3 * step;
            assert!(found.iter().zip(&all).all(is_near), "{name}");
            assert_eq!(report, Some(format!("; wraps once, at {name}")));
        }
    }

    #[test]
    fn stamps_that_go_back_in_another_way_stay_as_they_are() {
        let regular: Vec<f64> = (0..100)
            .map(|i| 4_294_500_000.0 + 5000.0 * f64::from(i))
            .collect();
        for back in [0.0, 3000.0, 40_000.0, 4_294_000_000.0] {
            let mut stamps = regular.clone();
            stamps.extend((0..10).map(|i| back + 5000.0 * f64::from(i)));
            let (found, report) = unwrapped(&stamps, TimeUnit::Us);
            assert_eq!((found, report), (stamps, None), "{back}");
        }
    }

    /// Two sensors, whose rows follow each other in a file, are read over midnight: each of them wraps.
    #[test]
    fn the_rows_of_another_sensor_behind_a_wrap_go_back() {
        let of_one = (0..200).map(|i| (86_399.0 + 0.02 * f64::from(i)) % 86_400.0);
        let of_one: Vec<f64> = of_one.collect();
        let (found, _) = unwrapped(&[&of_one[..], &of_one[..]].concat(), TimeUnit::S);
        let [first, second] = [&found[..200], &found[200..]];
        assert!(first.is_sorted());
        assert_eq!(first, second);
    }
}
