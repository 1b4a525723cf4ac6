//! Follows the time stamps of rows: it finds the sampling rate, missing samples and repeated rows.

use super::{
    field::{Flaw, Stamp},
    names::TimeUnit,
};
use std::time::Duration;

/// A step that is longer than this many usual steps is a gap, provided that it also exceeds
/// [`SCATTER`]. It lies half way between one step and the two steps that a lost sample leaves.
const GAP: f64 = 1.5;

/// A gap must exceed the usual step by this many times the usual scatter of steps. Chosen by hand; the
/// tests of this file hold it to a jitter of half a step.
const SCATTER: f64 = 5.0;

/// The largest share of rows that may follow a gap or repeat a stamp. Beyond it, the stamps are
/// refused. Chosen by hand; no study varies it.
const MOST_ODD: f64 = 0.05;

/// After this many gaps in a row, the log is taken to have changed its rate. Chosen by hand; no study
/// varies it.
const RUN: u32 = 16;

/// The number of steps in a block. The mean step of a block measures the rate. Chosen by hand; no study
/// varies it.
const BLOCK: u32 = 512;

/// The largest ratio between the mean steps of two blocks of one rate. Stamps that are written in
/// bursts of 25 can come close to it. Chosen by hand.
const TWO_RATES: f64 = 1.1;

/// How a stamp relates to the stamp of the row before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tick {
    /// The stamp follows the one before without a gap.
    Next,
    /// Samples are missing between the stamp before and this one.
    Gap,
    /// The stamp is equal to the one before.
    Repeated,
}

/// The usual distance between stamps, estimated from the first ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    /// The number of ticks in a second. A tick is the unit of the stamps.
    per_second: f64,
    /// The usual step, in ticks.
    step: f64,
    /// The longest step that is not a gap, in ticks.
    longest: f64,
}

impl Pace {
    /// The pace of the stamps `first`. Without a given `unit`, the unit is the one that makes the
    /// rate plausible. Returns `None` if the stamps never advance.
    pub(super) fn of(first: &[f64], unit: Option<TimeUnit>) -> Option<(Self, TimeUnit)> {
        let steps = first.windows(2).map(|pair| pair[1] - pair[0]);
        let mut steps: Vec<f64> = steps.filter(|&step| step > 0.0).collect();
        let step = quantile(&mut steps, 0.5)?;
        let mut scatter: Vec<f64> = steps.iter().map(|other| (other - step).abs()).collect();
        let scatter = quantile(&mut scatter, 0.9)?;
        let unit = unit.unwrap_or_else(|| plausible_unit(first[0], step));
        let pace = Self {
            per_second: unit.per_second(),
            step,
            longest: (GAP * step).max(step + SCATTER * scatter),
        };
        Some((pace, unit))
    }

    fn seconds(&self, ticks: f64) -> f64 {
        ticks / self.per_second
    }
}

/// The plausible unit of stamps. If `first` is a time since 1970 in some unit, it is that unit.
/// Otherwise it is the only unit that makes the rate lie between 10 Hz and 10 kHz. Units are a factor of a
/// thousand apart, and so are the ends of this range, which is chosen by hand.
fn plausible_unit(first: f64, step: f64) -> TimeUnit {
    // This range covers the years 2001 to 2286, in seconds since 1970.
    let since_1970 = |unit: &TimeUnit| (1e9..1e10).contains(&(first / unit.per_second()));
    let usual = |unit: &TimeUnit| (10.0..1e4).contains(&(unit.per_second() / step));
    let find = |is: &dyn Fn(&TimeUnit) -> bool| TimeUnit::ALL.into_iter().find(|unit| is(unit));
    find(&since_1970)
        .or_else(|| find(&usual))
        .unwrap_or(TimeUnit::S)
}

fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let at = (values.len() as f64 * share) as usize;
    (at < values.len()).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// Follows the stamps of a log, row after row.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    pace: Pace,
    last: Option<Stamp>,
    rows: u64,
    repeated: u64,
    gaps: u64,
    /// The longest gap, in ticks.
    longest_gap: f64,
    lost: f64,
    gaps_in_a_row: u32,
    /// The number of steps that are not gaps, their sum, and the sum of their squared differences
    /// from the usual step.
    steps: u64,
    sum: f64,
    squares: f64,
    /// The shortest and the longest step, in ticks.
    range: (f64, f64),
    block: (u32, f64),
    /// The shortest and the longest mean step of a block, in ticks.
    means: Option<(f64, f64)>,
}

impl Clock {
    pub(super) fn new(pace: Pace) -> Self {
        Self {
            pace,
            last: None,
            rows: 0,
            repeated: 0,
            gaps: 0,
            longest_gap: 0.0,
            lost: 0.0,
            gaps_in_a_row: 0,
            steps: 0,
            sum: 0.0,
            squares: 0.0,
            range: (f64::INFINITY, 0.0),
            block: (0, 0.0),
            means: None,
        }
    }

    /// Takes the stamp of the next row, and returns how it relates to the one before.
    pub(super) fn tick(&mut self, stamp: Stamp) -> Result<Tick, Flaw> {
        self.rows += 1;
        let Some(last) = self.last.replace(stamp) else {
            return Ok(Tick::Next);
        };
        let step = stamp.since(last);
        if step < 0.0 {
            return Err(Flaw::stamps(format!(
                "time stamps go back from {last} to {stamp}"
            )));
        }
        if step == 0.0 {
            self.repeated += 1;
            return Ok(Tick::Repeated);
        }
        if step > self.pace.longest {
            self.gaps += 1;
            self.longest_gap = self.longest_gap.max(step);
            self.lost += (step / self.pace.step).round() - 1.0;
            self.gaps_in_a_row += 1;
            if self.gaps_in_a_row >= RUN {
                return Err(self.two_rates(step, self.pace.step));
            }
            return Ok(Tick::Gap);
        }
        self.gaps_in_a_row = 0;
        self.step(step)?;
        Ok(Tick::Next)
    }

    fn step(&mut self, step: f64) -> Result<(), Flaw> {
        let difference = step - self.pace.step;
        self.steps += 1;
        self.sum += step;
        self.squares += difference * difference;
        self.range = (self.range.0.min(step), self.range.1.max(step));
        self.block.0 += 1;
        self.block.1 += step;
        if self.block.0 == BLOCK {
            let mean = self.block.1 / f64::from(BLOCK);
            self.block = (0, 0.0);
            let (shortest, longest) = self.means.unwrap_or((mean, mean));
            if mean > TWO_RATES * shortest {
                return Err(self.two_rates(mean, shortest));
            }
            if longest > TWO_RATES * mean {
                return Err(self.two_rates(mean, longest));
            }
            self.means = Some((shortest.min(mean), longest.max(mean)));
        }
        Ok(())
    }

    fn two_rates(&self, now: f64, before: f64) -> Flaw {
        let [now, before] = [now, before].map(|ticks| span(self.pace.seconds(ticks)));
        Flaw::stamps(format!(
            "two rates in one log: time stamps are {now} apart up to here, and were {before} apart before"
        ))
    }

    /// The sampling rate, in Hz, rounded to nine digits.
    ///
    /// # Errors
    /// Fails if so many rows follow a gap or repeat a stamp that the rate is not known, or if the
    /// rate is not positive and finite.
    pub(super) fn rate_hz(&self) -> Result<f64, Flaw> {
        let odd = |what: &str, count: u64| {
            Flaw::stamps(format!(
                "time stamps {what} in {count} of {} rows: too coarse, or written in bursts",
                self.rows
            ))
        };
        let most = MOST_ODD * self.rows as f64;
        if self.repeated as f64 > most {
            return Err(odd("repeat", self.repeated));
        }
        if self.gaps as f64 > most {
            return Err(odd("jump", self.gaps));
        }
        let rate_hz = self.pace.per_second * self.steps as f64 / self.sum;
        let rounded = format!("{rate_hz:.8e}").parse().unwrap_or(rate_hz);
        if f64::is_finite(rounded) && rounded > 0.0 {
            Ok(rounded)
        } else {
            Err(Flaw::stamps("the time stamps give no rate".into()))
        }
    }

    /// Describes how regular the stamps are, with the gaps and the rows that were left out.
    pub(super) fn report(&self) -> String {
        let steps = self.steps.max(1) as f64;
        let mean = self.sum / steps;
        let offset = mean - self.pace.step;
        let jitter = (self.squares / steps - offset * offset).max(0.0).sqrt();
        let greatest = (mean - self.range.0).max(self.range.1 - mean);
        let [step, jitter, greatest] =
            [mean, jitter, greatest].map(|ticks| span(self.pace.seconds(ticks)));
        let mut text = format!("time stamps {step} apart, jitter {jitter} rms, {greatest} at most");
        if self.gaps > 0 {
            text += &format!(
                "; {}, the longest {}, about {} samples lost",
                count(self.gaps, "gap"),
                span(self.pace.seconds(self.longest_gap)),
                self.lost
            );
        }
        if self.repeated > 0 {
            text += &format!(
                "; {} with a repeated stamp left out",
                count(self.repeated, "row")
            );
        }
        text
    }
}

fn count(count: u64, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// Formats a length of time with three digits, such as `5ms` or `1s 250ms`.
fn span(seconds: f64) -> String {
    if seconds < 0.5e-9 {
        return "0s".into();
    }
    let digit = 10f64.powf(2.0 - seconds.log10().floor());
    let rounded = (seconds * digit).round() / digit;
    // The value is rounded to whole nanoseconds, because a float of days is not exact in them.
    let rounded = (rounded * 1e9).round().min(1e18) as u64;
    humantime::format_duration(Duration::from_nanos(rounded)).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clock(stamps: &[i64], unit: TimeUnit) -> Clock {
        let first: Vec<f64> = stamps.iter().take(100).map(|&stamp| stamp as f64).collect();
        Clock::new(Pace::of(&first, Some(unit)).unwrap().0)
    }

    fn run(stamps: &[i64]) -> (Clock, Vec<Tick>) {
        let mut clock = clock(stamps, TimeUnit::Us);
        let tick = |&stamp: &i64| clock.tick(Stamp::Whole(stamp)).unwrap();
        let ticks = stamps.iter().map(tick).collect();
        (clock, ticks)
    }

    #[test]
    fn regular_stamps_give_the_rate_to_nine_digits() {
        let stamps: Vec<i64> = (0..1000).map(|i| 7_000_000 + 5000 * i).collect();
        let (clock, ticks) = run(&stamps);
        assert!(ticks.iter().all(|&tick| tick == Tick::Next));
        assert_eq!(clock.rate_hz().unwrap(), 200.0);
        assert_eq!(
            clock.report(),
            "time stamps 5ms apart, jitter 0s rms, 0s at most"
        );
    }

    #[test]
    fn missing_and_repeated_rows_are_counted_and_do_not_change_the_rate() {
        let mut stamps: Vec<i64> = (0..1000).map(|i| 5000 * i).collect();
        stamps.drain(500..520);
        stamps.insert(300, stamps[299]);
        let (clock, ticks) = run(&stamps);
        assert_eq!((ticks[300], ticks[501]), (Tick::Repeated, Tick::Gap));
        assert_eq!(ticks.iter().filter(|&&tick| tick != Tick::Next).count(), 2);
        assert_eq!(clock.rate_hz().unwrap(), 200.0);
        assert!(
            clock.report().ends_with(
                "; 1 gap, the longest 105ms, about 20 samples lost; \
                 1 row with a repeated stamp left out"
            ),
            "{}",
            clock.report()
        );
    }

    #[test]
    fn jitter_of_half_a_step_is_no_gap() {
        // The stamps follow a fixed sequence that deviates by up to half a step from the regular
        // one.
        let stamps: Vec<i64> = (0..2000)
            .map(|i| 5000 * i + (i * i * 7919) % 2500)
            .collect();
        let (clock, ticks) = run(&stamps);
        assert!(ticks.iter().all(|&tick| tick == Tick::Next));
        assert!((clock.rate_hz().unwrap() / 200.0 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn stamps_that_go_back_and_two_rates_are_refused() {
        let fast = |n: i64| (0..n).map(|i| 5000 * i).collect::<Vec<_>>();
        let refusal = |stamps: Vec<i64>| {
            let mut clock = clock(&stamps, TimeUnit::Us);
            let mut ticks = stamps.iter().map(|&stamp| clock.tick(Stamp::Whole(stamp)));
            ticks.find_map(Result::err).unwrap().what
        };
        let mut back = fast(500);
        back[400] = 3;
        assert_eq!(refusal(back), "time stamps go back from 1995000 to 3");
        let mut slower = fast(2000);
        slower.extend((1..1000).map(|i| 5000 * 1999 + 10_000 * i));
        assert!(refusal(slower).starts_with("two rates in one log: time stamps are 10ms apart"));
        let mut faster = fast(2000);
        faster.extend((1..2000).map(|i| 5000 * 1999 + 2500 * i));
        assert!(refusal(faster).contains("and were 5ms apart"));
    }

    #[test]
    fn bursts_and_coarse_stamps_give_no_rate() {
        let coarse: Vec<i64> = (0..1000).map(|i| i / 4 * 10_000).collect();
        assert!(
            run(&coarse)
                .0
                .rate_hz()
                .unwrap_err()
                .what
                .contains("repeat in 750 of")
        );
    }

    #[test]
    fn unit_that_is_not_given_is_the_plausible_one() {
        for (first, step, unit) in [
            (0.0, 0.005, TimeUnit::S),
            (1.7e9, 0.01, TimeUnit::S),
            (1.7e9, 5000.0, TimeUnit::S),
            (0.0, 5.0, TimeUnit::Ms),
            (1.2e8, 4000.0, TimeUnit::Us),
            (1.403e18, 5e6, TimeUnit::Ns),
            (0.0, 5e6, TimeUnit::Ns),
        ] {
            assert_eq!(plausible_unit(first, step), unit, "{first} {step}");
        }
    }
}
