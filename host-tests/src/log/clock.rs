//! Follows the time stamps of rows: it finds the sampling rate, missing samples and repeated rows.

use super::{
    field::{Flaw, Stamp},
    pace::Pace,
};
use std::time::Duration;

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
            let (gaps, rows) = (self.gaps, self.rows);
            return Err(Flaw::stamps(format!(
                "time stamps jump in {gaps} of {rows} rows: rows are missing, or stamps are too coarse"
            )));
        }
        let rate_hz = self.steps as f64 / self.pace.seconds(self.sum);
        let rounded = format!("{rate_hz:.8e}").parse().unwrap_or(rate_hz);
        if (1e-6..=1e9).contains(&rounded) {
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
    use super::{super::names::TimeUnit, *};

    fn clock(stamps: &[i64], unit: TimeUnit) -> Clock {
        let first: Vec<f64> = stamps.iter().take(100).map(|&stamp| stamp as f64).collect();
        Clock::new(Pace::of(&first, unit).unwrap())
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

    /// Records of 100 Hz from which rows are missing at random are read with few losses, and refused
    /// with more, however many.
    #[test]
    fn missing_rows_are_refused_by_one_monotonic_rule() {
        let mut state = 7_u64;
        let mut share = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / 2f64.powi(31)
        };
        for percent in (0..=60).map(f64::from) {
            for _ in 0..10 {
                let jittered = |i: i64| 10_000 * i + (i * i * 7919) % 1000;
                let rows = (0..5000).filter(|_| share() >= 0.01 * percent);
                let stamps: Vec<i64> = rows.map(jittered).collect();
                let mut clock = clock(&stamps, TimeUnit::Us);
                let ticks = stamps.iter().map(|&stamp| clock.tick(Stamp::Whole(stamp)));
                let ticked = ticks.collect::<Result<Vec<_>, _>>();
                match ticked.and_then(|_| clock.rate_hz()) {
                    Ok(rate_hz) => {
                        assert!(percent <= 6.0, "{percent} % missing gave {rate_hz} Hz");
                        assert!((rate_hz / 100.0 - 1.0).abs() < 1e-2, "{rate_hz} Hz");
                    }
                    Err(flaw) => assert!(percent >= 4.0, "{percent} % missing: {flaw:?}"),
                }
            }
        }
        for pattern in [3, 4, 5] {
            let rows = (0..5000).filter(|i| i % pattern != 0);
            let stamps: Vec<i64> = rows.map(|i| 10_000 * i).collect();
            let mut clock = clock(&stamps, TimeUnit::Us);
            for &stamp in &stamps {
                let _ = clock.tick(Stamp::Whole(stamp));
            }
            assert!(clock.rate_hz().is_err(), "every row {pattern} missing");
        }
    }
}
