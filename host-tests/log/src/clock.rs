//! Follows the time stamps of rows: it finds the sampling rate, missing samples and repeated rows.

use super::{
    field::{Flaw, Stamp},
    pace::Pace,
    wrap::Wraps,
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

/// A late stamp is followed by this many rows at most, none of which waited, until the stamps are where they would be if it
/// had been on time. A reader that is late again while it catches up takes longer, but not more rows than the second number.
/// Chosen by hand; `cargo xtask study stamps` counts what they miss.
const MOST_LATE: (u64, u64) = (16, 128);

/// The least of some stamps is early, by about so many times their scatter. Chosen by hand.
const EARLY: f64 = 0.9;

/// The rows at the end of a log that are too few to tell whether a stamp before them is late.
const LAST: u64 = 3;

/// A step below this share of the usual one is that of a row that waited for the reader.
const WAITED: f64 = 0.5;

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
    wraps: Wraps,
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
    /// The rows of the first burst and the step behind it. A log may begin within a burst.
    first_burst: (u64, f64),
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
    /// The last row behind it that waited for the reader.
    waited: u64,
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
            wraps: Wraps::of_numbers(&pace),
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
            first_burst: (0, 0.0),
            sharing: 0,
            range: (f64::INFINITY, 0.0),
            block: (0, 0.0),
            means: None,
        }
    }

    /// The same clock for stamps that are written as times of day.
    pub(super) fn of_times(mut self) -> Self {
        self.wraps = Wraps::of_times(&self.pace);
        self
    }

    /// The next row's stamp as it would be if the counter behind it had not begun anew.
    pub(super) fn unwrap(&mut self, stamp: Stamp) -> Stamp {
        self.wraps.unwrap(stamp, &self.pace)
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
        if self.is_clock_time(last, stamp) {
            return Err(Flaw::stamps(format!(
                "time stamps go from {last} to {stamp}, as hours, minutes and seconds in one number do"
            )));
        }
        if !self.behind.is_empty() {
            self.end_delays(stamp, step);
        }
        let is_long = step > self.pace.longest;
        let known = self.late.pop_if(|late| late.row == self.rows);
        if let Some(late) = known {
            let delay = step - (late.lost + 1) as f64 * self.pace.step;
            self.delayed = (self.delayed.0 + 1, self.delayed.1.max(delay));
        }
        if !is_long && known.is_none() {
            return self.follow_plainly(step, rows);
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
                waited: self.rows,
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
        self.follow_plainly(step, rows)
    }

    /// Takes a step behind which nothing is missing.
    fn follow_plainly(&mut self, step: f64, rows: u64) -> Result<Tick, Flaw> {
        self.gaps_in_a_row = 0;
        if self.rows_of_steps == 0 && self.pace.rows > 1.0 {
            self.first_burst = (rows, step);
        }
        self.rows_of_steps += rows;
        self.step(step)?;
        Ok(Tick::Next)
    }

    /// Whether a minute begins between two stamps of the form HHMMSS, of which a minute has hundred and an hour ten thousand.
    fn is_clock_time(&self, last: Stamp, stamp: Stamp) -> bool {
        // Few steps are that long, and nothing of what is below needs to be computed for the others.
        if stamp.since(last) < self.pace.step + 39.0 * self.pace.per_second {
            return false;
        }
        let [last_s, now_s] = [last, stamp].map(|one| self.seconds(one.since(Stamp::Whole(0))));
        let skipped = now_s - last_s - self.pace.seconds(self.pace.step);
        let is_skip = [40.0, 4040.0]
            .iter()
            .any(|skip| (skipped - skip).abs() < 0.5);
        is_skip && last_s.rem_euclid(100.0) >= 59.0 && now_s.rem_euclid(100.0) < 1.0
    }

    /// A difference of stamps in seconds.
    pub(super) fn seconds(&self, ticks: f64) -> f64 {
        self.pace.seconds(ticks)
    }

    /// Finds out which stamps behind the last gaps were late: the rows behind them catch up with their stamps, so that they
    /// leave less for lost.
    fn end_delays(&mut self, stamp: Stamp, step: f64) {
        let (now, pace) = (self.rows, self.pace);
        // The rows of a burst are not that regular.
        let is_burst = pace.rows > 1.0;
        let early = if is_burst {
            0.0
        } else {
            EARLY * pace.scatter / pace.step
        };
        for gap in &mut self.behind {
            if step < WAITED * pace.step {
                gap.waited = now;
            }
            let samples = stamp.since(gap.before) / pace.step * pace.rows;
            gap.least = gap.least.min(samples - (now - gap.first) as f64 + early);
        }
        let rows = |number: u64| (number as f64 * pace.rows) as u64;
        let (quiet, most) = (rows(MOST_LATE.0), rows(MOST_LATE.1));
        let is_settled = |gap: &mut Behind| {
            gap.lost() == 0 || now - gap.waited >= quiet || now - gap.row >= most
        };
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
        // Nothing was lost before the last rows of a log whose other stamps are late.
        let is_last = |gap: &&Behind| self.rows - gap.row < LAST && !self.found.is_empty();
        let (last, open): (Vec<&Behind>, Vec<&Behind>) = self.behind.iter().partition(is_last);
        let last = last.into_iter().map(|gap| Late {
            row: gap.row,
            lost: 0,
        });
        let open = open
            .into_iter()
            .filter_map(|gap| self.late(gap))
            .chain(last);
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
        // With a few bursts, the first one would be a large part of all.
        let (rows, step) = match self.steps {
            0..3 => (0, 0.0),
            _ => self.first_burst,
        };
        let rate_hz = (self.rows_of_steps - rows) as f64 / self.pace.seconds(self.sum - step);
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
        text + &self.wraps.report().unwrap_or_default()
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
mod tests;
