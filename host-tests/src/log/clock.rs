//! Follows the time stamps of rows: it finds the sampling rate, missing samples and repeated rows.

use super::{
    field::{Flaw, Stamp},
    pace::Pace,
};
use crate::failure::plural;
use std::time::Duration;

/// The largest share of rows that may follow a gap or repeat a stamp. Beyond it, the stamps are
/// refused. Chosen by hand; no study varies it.
const MOST_ODD: f64 = 0.05;

/// The same for rows that follow a gap where stamps are exact: their steps are whole numbers of samples. Every fifth row
/// missing is still refused, because a rate that changes by turns looks so too. Chosen by hand.
const MOST_GAPS: f64 = 0.2;

/// The largest distance of a gap from a whole number of samples, and of steps from the usual one (root mean square), of
/// exact stamps. Chosen by hand.
const EXACT: (f64, f64) = (0.1, 0.05);

/// A late stamp is followed by this many rows at most until the stamps are where they would be if it had been on time.
/// Chosen by hand.
const MOST_LATE: u64 = 16;

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
    /// So many samples are missing between the stamp before and this one.
    Gap(u64),
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
    /// The number of rows in these steps: as many as steps, or more where several rows share a stamp.
    rows_of_steps: u64,
    /// The number of rows behind the first one with the present stamp.
    sharing: u64,
    /// The shortest and the longest step, in ticks.
    range: (f64, f64),
    block: (u32, f64),
    /// The shortest and the longest mean step of a block, in ticks.
    means: Option<(f64, f64)>,
    /// The number of gaps that are no whole number of samples.
    off_grid: u64,
    /// The rows whose stamps are known to be late, latest first.
    late: Vec<Late>,
    /// Their number so far, and the longest delay in ticks.
    delayed: (u64, f64),
    /// The last gaps.
    behind: Vec<Behind>,
    /// The rows whose stamps turned out to be late.
    found: Vec<Late>,
}

/// A row whose stamp is late, so that fewer samples are lost before it than the stamp tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Late {
    /// The row, counted from 1.
    row: u64,
    /// The samples that are lost before it.
    lost: u64,
}

/// A gap that may turn out to be a late stamp.
#[derive(Clone, Copy, Debug)]
struct Behind {
    /// The row behind it.
    row: u64,
    /// The stamp in front of it, and the first row with that stamp.
    before: Stamp,
    first: u64,
    /// Its length, in ticks.
    step: f64,
    /// The samples that the stamps behind it leave for lost, at least.
    least: f64,
}

impl Behind {
    /// The samples that are lost in it.
    fn lost(&self) -> u64 {
        self.least.round().max(0.0) as u64
    }
}

impl Clock {
    /// A clock of this pace. The stamps of some rows are known to be late.
    pub(super) fn new(pace: Pace, late: &[Late]) -> Self {
        let mut late = late.to_vec();
        late.sort_unstable_by_key(|late| std::cmp::Reverse(late.row));
        Self {
            off_grid: 0,
            late,
            delayed: (0, 0.0),
            behind: Vec::new(),
            found: Vec::new(),
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
            rows_of_steps: 0,
            sharing: 0,
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
            if self.pace.rows > 1.0 {
                self.sharing += 1;
                return Ok(Tick::Next);
            }
            self.repeated += 1;
            return Ok(Tick::Repeated);
        }
        let rows = 1 + std::mem::take(&mut self.sharing);
        self.end_delays(stamp);
        let is_long = step > self.pace.longest;
        let known = self.late.pop_if(|late| late.row == self.rows);
        if let Some(late) = known {
            let delay = step - (late.lost + 1) as f64 * self.pace.step;
            self.delayed = (self.delayed.0 + 1, self.delayed.1.max(delay));
        }
        let samples = step / self.pace.step;
        let told = ((samples.round() - 1.0) * self.pace.rows.round()).max(0.0) as u64;
        let lost = match known {
            Some(late) => late.lost,
            None if is_long => told,
            None => 0,
        };
        if is_long && known.is_none() {
            self.behind.push(Behind {
                row: self.rows,
                before: last,
                first: self.rows - rows,
                step,
                least: told as f64,
            });
            self.off_grid += u64::from((samples - samples.round()).abs() > EXACT.0);
        }
        if lost > 0 {
            if known.is_some() {
                // The rows that catch up count for the rate, and so does their delay.
                self.rows_of_steps += rows;
                self.sum += step - lost as f64 / self.pace.rows * self.pace.step;
            }
            self.gaps += 1;
            self.longest_gap = self.longest_gap.max(step);
            self.lost += lost as f64;
            self.gaps_in_a_row += 1;
            if self.gaps_in_a_row >= RUN {
                return Err(self.two_rates(step, self.pace.step));
            }
            return Ok(Tick::Gap(lost));
        }
        self.gaps_in_a_row = 0;
        self.rows_of_steps += rows;
        self.step(step)?;
        Ok(Tick::Next)
    }

    /// A difference of stamps in seconds.
    pub(super) fn seconds(&self, ticks: f64) -> f64 {
        self.pace.seconds(ticks)
    }

    /// Finds out which stamps behind the last gaps were late: the rows behind them catch up with their stamps, so that they
    /// leave less for lost.
    fn end_delays(&mut self, stamp: Stamp) {
        let (now, pace) = (self.rows, self.pace);
        for gap in &mut self.behind {
            let samples = stamp.since(gap.before) / pace.step * pace.rows;
            gap.least = gap.least.min(samples - (now - gap.first) as f64);
        }
        let longest = (MOST_LATE as f64 * pace.rows) as u64;
        let is_settled = |gap: &mut Behind| gap.lost() == 0 || now - gap.row >= longest;
        let settled: Vec<Behind> = self.behind.extract_if(.., is_settled).collect();
        for gap in settled {
            if let Some(late) = self.late(&gap) {
                self.found.push(late);
                // The shorter steps of the rows that caught up are in the present block.
                self.block.0 += 1;
                self.block.1 += gap.step - late.lost as f64 * pace.step;
            }
        }
    }

    /// The late stamp behind a gap, if fewer samples are lost than it tells.
    fn late(&self, gap: &Behind) -> Option<Late> {
        let told = (gap.step / self.pace.step).round() - 1.0;
        let (row, lost) = (gap.row, gap.lost());
        ((lost as f64) < told * self.pace.rows.round()).then_some(Late { row, lost })
    }

    /// The rows whose stamps turned out to be late, in any order.
    pub(super) fn found_late(&self) -> Vec<Late> {
        let open = self.behind.iter().filter_map(|gap| self.late(gap));
        self.found.iter().copied().chain(open).collect()
    }

    fn step(&mut self, step: f64) -> Result<(), Flaw> {
        let difference = step - self.pace.step;
        self.steps += 1;
        self.sum += step;
        self.squares += difference * difference;
        self.range = (self.range.0.min(step), self.range.1.max(step));
        self.block.0 += 1;
        self.block.1 += step;
        if self.block.0 >= BLOCK {
            let mean = self.block.1 / f64::from(self.block.0);
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
        if self.gaps as f64 > self.most_gaps() {
            let (gaps, rows) = (self.gaps, self.rows);
            return Err(Flaw::stamps(format!(
                "time stamps jump in {gaps} of {rows} rows: rows are missing, or stamps are too coarse"
            )));
        }
        let rate_hz = self.rows_of_steps as f64 / self.pace.seconds(self.sum);
        let rounded = format!("{rate_hz:.8e}").parse().unwrap_or(rate_hz);
        if (1e-6..=1e9).contains(&rounded) {
            Ok(rounded)
        } else {
            Err(Flaw::stamps("the time stamps give no rate".into()))
        }
    }

    /// The largest number of gaps with which the rate is known.
    fn most_gaps(&self) -> f64 {
        let is_exact = self.off_grid as f64 <= MOST_ODD * self.gaps as f64
            && self.jitter() <= EXACT.1 * self.pace.step;
        self.rows as f64 * if is_exact { MOST_GAPS } else { MOST_ODD }
    }

    /// The root mean square of the steps' differences from their mean, in ticks.
    fn jitter(&self) -> f64 {
        let steps = self.steps.max(1) as f64;
        let offset = self.sum / steps - self.pace.step;
        (self.squares / steps - offset * offset).max(0.0).sqrt()
    }

    /// Describes how regular the stamps are, with the gaps and the rows that were left out.
    pub(super) fn report(&self) -> String {
        let steps = self.steps.max(1) as f64;
        let mean = self.sum / steps;
        let jitter = self.jitter();
        let greatest = (mean - self.range.0).max(self.range.1 - mean);
        let [step, jitter, greatest] =
            [mean, jitter, greatest].map(|ticks| span(self.pace.seconds(ticks)));
        let mut text = format!("time stamps {step} apart, jitter {jitter} rms, {greatest} at most");
        if self.gaps > 0 {
            text += &format!(
                "; {}, the longest {}, about {} lost",
                plural(self.gaps, "gap"),
                span(self.pace.seconds(self.longest_gap)),
                plural(self.lost as u64, "sample")
            );
        }
        if self.pace.rows > 1.0 {
            text += &format!("; about {:.1} rows share a stamp", self.pace.rows);
        }
        if self.delayed.0 > 0 {
            text += &format!(
                "; {}, by {} at most",
                plural(self.delayed.0, "late stamp"),
                span(self.pace.seconds(self.delayed.1))
            );
        }
        if self.repeated > 0 {
            text += &format!(
                "; {} with a repeated stamp left out",
                plural(self.repeated, "row")
            );
        }
        text
    }
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
        Clock::new(Pace::of(&first, unit).unwrap(), &[])
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
        assert_eq!((ticks[300], ticks[501]), (Tick::Repeated, Tick::Gap(20)));
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
    fn a_late_stamp_is_no_gap_and_a_lost_sample_is_one() {
        // Every twentieth stamp is 4 ms late, one of them with two more behind it, and a sample is lost.
        let mut stamps: Vec<i64> = (0..1000).map(|i| 5000 * i).collect();
        for i in (19..1000).step_by(20) {
            stamps[i] += 4000;
        }
        stamps[400] += 9000;
        stamps[401] += 4500;
        stamps.remove(705);
        let (first, _) = run(&stamps);
        assert_eq!(
            first.found_late().len(),
            50,
            "all but the last row: {:?}",
            first.found_late()
        );
        let pace = Pace::of(&[0.0, 5000.0, 10_000.0, 15_000.0], TimeUnit::Us).unwrap();
        let mut clock = Clock::new(pace, &first.found_late());
        let tick = |&stamp: &i64| clock.tick(Stamp::Whole(stamp)).unwrap();
        let ticks: Vec<Tick> = stamps.iter().map(tick).collect();
        let gaps: Vec<usize> = (0..997)
            .filter(|&i| matches!(ticks[i], Tick::Gap(_)))
            .collect();
        assert_eq!(gaps, [705]);
        assert!((clock.rate_hz().unwrap() / 200.0 - 1.0).abs() < 2e-3);
        let report = clock.report();
        assert!(
            report.contains("; 50 late stamps, by 5ms at most"),
            "{report}"
        );
    }

    #[test]
    fn a_sample_lost_before_a_late_stamp_is_one_loss() {
        let mut stamps: Vec<i64> = (0..1000).map(|i| 5000 * i).collect();
        stamps[400] += 9000;
        stamps[401] += 4500;
        stamps.remove(399);
        let (first, ticks) = run(&stamps);
        assert_eq!(ticks[399], Tick::Gap(3));
        let pace = Pace::of(&[0.0, 5000.0, 10_000.0, 15_000.0], TimeUnit::Us).unwrap();
        let mut clock = Clock::new(pace, &first.found_late());
        let tick = |&stamp: &i64| clock.tick(Stamp::Whole(stamp)).unwrap();
        let ticks: Vec<Tick> = stamps.iter().map(tick).collect();
        assert_eq!(ticks[399], Tick::Gap(1));
        assert_eq!(ticks.iter().filter(|&&tick| tick != Tick::Next).count(), 1);
        assert_eq!(clock.rate_hz().unwrap(), 200.0);
    }

    #[test]
    fn stamps_rounded_to_a_third_of_a_step_tell_each_loss() {
        for step in [2.5_f64, 2.74, 3.1, 3.5, 4.6, 5.755] {
            let rows = (0..2000).filter(|i| i % 97 != 96);
            let stamps: Vec<i64> = rows.map(|i| (step * f64::from(i)) as i64).collect();
            let (first, ticks) = run(&stamps);
            let gaps = ticks.iter().filter(|&&tick| tick == Tick::Gap(1)).count();
            assert_eq!((gaps, first.found_late()), (20, Vec::new()), "{step}");
            let rate = first.rate_hz().unwrap() * step / 1e6;
            assert!((rate - 1.0).abs() < 1e-3, "{step}: {rate}");
        }
    }

    #[test]
    fn rows_that_share_a_stamp_give_the_rate_of_rows() {
        let shared: Vec<i64> = (0..1000).map(|i| i / 4 * 10_000).collect();
        let (clock, ticks) = run(&shared);
        assert!(ticks.iter().all(|&tick| tick == Tick::Next));
        assert_eq!(clock.rate_hz().unwrap(), 400.0);
        let report = clock.report();
        assert!(
            report.ends_with("; about 4.0 rows share a stamp"),
            "{report}"
        );
        // A burst is lost, and another one comes later.
        let stamps: Vec<i64> = (0..1000)
            .filter(|i| i / 4 != 70)
            .map(|i| i / 4 * 10_000)
            .collect();
        let (clock, ticks) = run(&stamps);
        assert_eq!(
            ticks
                .iter()
                .filter(|tick| matches!(tick, Tick::Gap(_)))
                .count(),
            1
        );
        assert_eq!(clock.rate_hz().unwrap(), 400.0);
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
                        assert!(percent <= 22.0, "{percent} % missing gave {rate_hz} Hz");
                        assert!((rate_hz / 100.0 - 1.0).abs() < 1e-2, "{rate_hz} Hz");
                    }
                    Err(flaw) => assert!(percent >= 18.0, "{percent} % missing: {flaw:?}"),
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
