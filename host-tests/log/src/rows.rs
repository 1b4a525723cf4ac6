//! Follows the rows of a pass: their stamps, which of them the user leaves out, and which hold no sample.

use super::{
    clock::{Clock, Tick},
    cuts::Dropped,
    field::{Field, Stamp},
    table::{Stop, Visitor},
};
use crate::failure::Failure;

/// The largest share of rows that may hold no sample. Chosen by hand: it is the share of lost samples with which a record
/// is still valid.
const MOST_LOST: f64 = 0.1;

/// What became of the rows of a pass.
#[derive(Debug, Default)]
pub(super) struct Tally {
    rows: u64,
    /// The rows without a sample, and the failure of the first one.
    lost: u64,
    first: Option<Failure>,
    /// The rows that the user leaves out.
    pub(super) cut: u64,
    /// The time of the last row, in seconds from the first one, where rows are left out by their time.
    pub(super) end_s: f64,
}

impl Tally {
    /// Refuses a log many of whose rows hold no sample.
    pub(super) fn check(&mut self) -> Result<(), Failure> {
        let (lost, rows) = (self.lost, self.rows - self.cut);
        match self
            .first
            .take_if(|_| lost as f64 > MOST_LOST * rows as f64)
        {
            Some(first) if lost > 1 => {
                Err(first.and(&format!("{lost} of {rows} rows hold no sample")))
            }
            Some(first) => Err(first),
            None => Ok(()),
        }
    }

    /// A note on the rows that hold no sample.
    pub(super) fn note(&self) -> Option<String> {
        let first = self.first.as_ref()?;
        let samples = match self.lost {
            1 => "1 sample lost".into(),
            lost => format!("{lost} samples lost, the first"),
        };
        Some(format!("{samples} in {}", first.found()))
    }
}

/// What a stamp says of its row.
pub(super) enum Followed {
    /// It is that of the row before.
    Repeated,
    /// All rows are left out from here on.
    BehindTheEnd,
    /// It is that of a row at a time, before which so many samples are missing.
    Row { at_s: f64, missing: u64 },
}

/// A visitor whose first columns are the time. It reports missing samples to the visitor inside, and leaves out rows.
/// Unless `EACH` is set, there is neither a time nor a row to leave out, and values may come in runs.
pub(super) struct Rows<'a, V, const EACH: bool> {
    pub(super) clock: Option<Clock>,
    pub(super) tally: Tally,
    /// The number of time columns.
    columns: usize,
    /// Whether the rows come one after the other.
    is_by_rows: bool,
    /// The seconds of the current row, if seconds and nanoseconds are in two columns.
    seconds: Option<Stamp>,
    /// The first stamp, or the sample rate where there are no stamps.
    first: Option<Stamp>,
    rate_hz: f64,
    dropped: &'a Dropped,
    /// Whether no row is left out by its time.
    is_whole: bool,
    /// The column that is shown, and the samples of time before the present row.
    column: usize,
    at: u64,
    /// Whether the present row is left out, whether that is because of its time, and whether all rows behind it are.
    is_left_out: bool,
    is_cut: bool,
    has_ended: bool,
    /// Samples that are missing before the next row, and those that a comment says are.
    missing: u64,
    told: u64,
    visitor: &'a mut V,
}

impl<'a, V: Visitor, const EACH: bool> Rows<'a, V, EACH> {
    pub(super) fn new(
        clock: Option<(Clock, usize)>,
        rate_hz: f64,
        is_by_rows: bool,
        dropped: &'a Dropped,
        visitor: &'a mut V,
    ) -> Self {
        let columns = clock.as_ref().map_or(0, |(_, columns)| *columns);
        Self {
            clock: clock.map(|(clock, _)| clock),
            tally: Tally::default(),
            columns,
            is_by_rows,
            seconds: None,
            first: None,
            rate_hz,
            is_whole: dropped.is_none(),
            dropped,
            column: 0,
            at: 0,
            is_left_out: false,
            is_cut: false,
            has_ended: false,
            missing: 0,
            told: 0,
            visitor,
        }
    }

    /// Begins a row of a log without stamps.
    fn begin(&mut self) {
        self.at += 1;
        let at_s = (self.at - 1) as f64 / self.rate_hz;
        self.decide(at_s, 0);
    }

    /// Follows the stamp of a row.
    #[inline]
    fn follow(&mut self, stamp: Stamp) -> Result<Followed, Stop> {
        let Some(clock) = &mut self.clock else {
            return Ok(Followed::Repeated);
        };
        let stamp = clock.unwrap(stamp);
        let first = *self.first.get_or_insert(stamp);
        // The time of a row matters only where rows are left out by it.
        let at_s = match self.is_whole {
            true => 0.0,
            false => clock.seconds(stamp.since(first)),
        };
        if self.dropped.ends_before(at_s) {
            self.has_ended = true;
            return Ok(Followed::Row { at_s, missing: 0 });
        }
        let missing = match clock.tick(stamp).map_err(Stop::Clock)? {
            Tick::Repeated => return Ok(Followed::Repeated),
            Tick::Next => 0,
            Tick::Gap(missing) => missing,
        };
        let told = std::mem::take(&mut self.told);
        let missing = missing.max(told);
        Ok(Followed::Row { at_s, missing })
    }

    /// Whether a row follows the one before, and is not left out.
    #[inline]
    fn is_plain(&self, at_s: f64, missing: u64) -> bool {
        missing + self.missing == 0
            && (self.is_whole || (!self.has_ended && !self.dropped.covers(at_s)))
    }

    /// Decides whether a row is left out before which so many samples are missing.
    fn decide(&mut self, at_s: f64, missing: u64) {
        if self.column == 0 {
            self.tally.end_s = at_s;
        }
        self.missing += missing;
        self.is_cut = self.dropped.covers(at_s);
        self.is_left_out = self.is_cut;
        if self.is_cut {
            self.count_cut();
        } else {
            self.tell_missing();
        }
    }

    fn count_cut(&mut self) {
        self.missing += 1;
        self.tally.cut += u64::from(self.column == 0);
    }

    /// Tells the visitor what is missing before the present row.
    #[inline]
    fn tell_missing(&mut self) {
        if self.missing > 0 {
            let missing = std::mem::take(&mut self.missing);
            // Where columns lie one behind the other, rows are missing at the beginning alone, of all columns at once.
            if self.is_by_rows || self.column == 0 {
                self.visitor.gap(missing);
            }
        }
    }
}

impl<V: Visitor, const EACH: bool> Visitor for Rows<'_, V, EACH> {
    /// A time tells whether its own row is left out, and whether samples are missing before it.
    const BY_ROWS: bool = EACH;
    const ONLY_COUNTS: bool = V::ONLY_COUNTS;

    type Followed = Followed;

    #[inline]
    fn visit<F: Field>(&mut self, column: usize, value: F) -> Result<(), Stop> {
        if column == 0 {
            self.tally.rows += 1;
        }
        if EACH && self.has_ended {
            self.tally.cut += u64::from(column == 0);
            return Ok(());
        }
        if let Some(axis) = column.checked_sub(self.columns) {
            if EACH && self.columns == 0 && (axis == 0 || !self.is_by_rows) {
                if axis != self.column {
                    (self.column, self.at, self.missing) = (axis, 0, 0);
                }
                self.begin();
            } else if axis == 0 && !self.is_left_out {
                // A row may have been lost whose stamp was shown together with that of the present one.
                self.tell_missing();
            }
            return match self.is_left_out {
                false => self.visitor.visit(axis, value),
                true => Ok(()),
            };
        }
        let mut stamp = value.stamp().map_err(Stop::NoStamp)?;
        if column + 1 < self.columns {
            self.seconds = Some(stamp);
            return Ok(());
        }
        if let Some(seconds) = self.seconds {
            stamp = stamp.behind_seconds(seconds);
        }
        let followed = self.follow(stamp)?;
        self.settle(followed);
        Ok(())
    }

    fn visit_run<F: Field>(&mut self, column: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        let axis = column - self.columns;
        if axis == 0 {
            // The stamps count their rows.
            if !EACH {
                self.tally.rows += values.len() as u64;
            }
            self.tell_missing();
        }
        self.visitor.visit_run(axis, values)
    }

    fn takes_stamps(&self) -> bool {
        EACH && self.columns == 1 && self.is_by_rows
    }

    fn visit_stamps<F: Field>(
        &mut self,
        stamps: &[F],
    ) -> (usize, Result<Option<Self::Followed>, Stop>) {
        for (row, stamp) in stamps.iter().enumerate() {
            self.tally.rows += 1;
            if self.has_ended {
                self.tally.cut += 1;
                return (row, Ok(Some(Followed::BehindTheEnd)));
            }
            let followed = stamp.stamp().map_err(Stop::NoStamp);
            match followed.and_then(|stamp| self.follow(stamp)) {
                Ok(Followed::Row { at_s, missing }) if self.is_plain(at_s, missing) => {
                    self.tally.end_s = at_s;
                    (self.is_cut, self.is_left_out) = (false, false);
                }
                followed => return (row, followed.map(Some)),
            }
        }
        (stamps.len(), Ok(None))
    }

    fn settle(&mut self, followed: Followed) {
        match followed {
            Followed::Repeated => self.is_left_out = true,
            Followed::Row { at_s, missing } => self.decide(at_s, missing),
            Followed::BehindTheEnd => {}
        }
    }

    fn gap(&mut self, missing: u64) {
        match self.clock {
            // The stamps show what is missing as well.
            Some(_) => self.told += missing,
            None => {
                self.at += missing;
                self.missing += missing;
            }
        }
    }

    fn lose_row(
        &mut self,
        shown: Option<usize>,
        failure: impl FnOnce() -> Failure,
    ) -> Result<(), Failure> {
        if !self.is_by_rows {
            return Err(failure());
        }
        if shown.is_none() {
            self.tally.rows += 1;
            if EACH && self.clock.is_none() && !self.has_ended {
                self.at += 1;
                let at_s = (self.at - 1) as f64 / self.rate_hz;
                self.is_cut = self.dropped.covers(at_s);
            }
        }
        if self.has_ended || self.is_cut {
            self.tally.cut += u64::from(shown.is_none());
            self.missing += u64::from(self.clock.is_none());
            return Ok(());
        }
        // The stamps around a row without a stamp show whether a sample is missing there.
        let axis = shown.and_then(|column| column.checked_sub(self.columns));
        if let Some(axis) = axis {
            self.visitor.forget(axis);
        }
        if axis.is_some() || self.clock.is_none() {
            self.missing += 1;
        }
        self.tally.lost += 1;
        if self.tally.first.is_none() {
            self.tally.first = Some(failure());
        }
        Ok(())
    }
}
