//! A recording: splits the input into lines and pushes their counts into the accumulators.

use allanite_host::{curve_file::AxisCurve, live::Live, record::with_evidence};
use allanite_log::{Evidence, Log, failure::Failure, unit::Unit};

/// A longer line, in bytes, is invalid. Chosen by hand.
const LONGEST_LINE: usize = 4096;

/// The samples recorded so far, as accumulators, and the line that is being received.
pub(super) struct Recording {
    rate_hz: f64,
    rate_per_count: f64,
    numbers: Numbers,
    unit: Unit,
    names: Option<Vec<String>>,
    /// The axes; their number is known from the first sample on.
    axes: Live,
    /// The bytes received of the next line.
    line: Vec<u8>,
    counts: Vec<i32>,
    garbled: u64,
    /// The invalid lines that would be valid if rates were read.
    with_decimals: u64,
    /// The first lines, as long as they do not show how many numbers a line has. `None` stands for an
    /// invalid line.
    first: Vec<Option<Vec<i32>>>,
    /// Whether the last line that was taken had no line end.
    unfinished: bool,
}

/// What is recorded at a moment.
pub(super) struct Snapshot {
    pub(super) rate_hz: f64,
    pub(super) samples: u64,
    pub(super) gaps: u64,
    pub(super) garbled: u64,
    /// The curves with what else is known, of which there are none while the record is too short.
    pub(super) curves: Vec<(AxisCurve, Evidence)>,
}

/// What the numbers of a line are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbers {
    /// Counts, which are whole numbers.
    Counts,
    /// Rates, which are rounded to counts.
    Rates,
}

/// So many lines of one width show the number of axes. A partial line or a banner before them does not.
const AGREEING: usize = 3;

/// After so many lines the width that most of them have is taken.
const UNDECIDED: usize = 64;

/// A line with more numbers is invalid.
const MOST_AXES: usize = 64;

impl Recording {
    /// An empty recording of a gyro with this rate and scale. Without names, the first line gives the
    /// number of axes.
    ///
    /// # Errors
    /// When the rate or the scale is not a positive, finite number, or a name is empty or repeated.
    pub(super) fn new(
        rate_hz: f64,
        rate_per_count: f64,
        numbers: Numbers,
        unit: Unit,
        names: Option<Vec<String>>,
    ) -> Result<Self, Failure> {
        for (option, value) in [("--rate", rate_hz), ("--scale", rate_per_count)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Failure::option(
                    format!("{option} {value} is impossible"),
                    "give a positive, finite number",
                ));
            }
        }
        if let Some(names) = &names {
            let twice = |(i, name): (usize, &String)| names[..i].contains(name);
            if names.iter().any(String::is_empty) || names.iter().enumerate().any(twice) {
                return Err(Failure::option(
                    "--axes: a name is empty or repeated",
                    "give each axis a name of its own",
                ));
            }
        }
        Ok(Self {
            rate_hz,
            rate_per_count,
            numbers,
            unit,
            names,
            axes: Live::new(0),
            line: Vec::new(),
            counts: Vec::new(),
            garbled: 0,
            with_decimals: 0,
            first: Vec::new(),
            unfinished: false,
        })
    }

    /// Takes bytes in pieces of any length; a line counts as soon as it is complete.
    pub(super) fn take(&mut self, bytes: &[u8]) {
        for piece in bytes.split_inclusive(|&byte| byte == b'\n') {
            // One byte more than the longest line is enough to show that a line is too long.
            let room = (LONGEST_LINE + 1).saturating_sub(self.line.len());
            match piece.strip_suffix(b"\n") {
                Some(end) => {
                    self.line.extend_from_slice(&end[..end.len().min(room)]);
                    let line = std::mem::take(&mut self.line);
                    self.take_line(&line);
                    self.line = line;
                    self.line.clear();
                }
                None => self.line.extend_from_slice(&piece[..piece.len().min(room)]),
            }
        }
    }

    fn take_line(&mut self, line: &[u8]) {
        let line_is_short = line.len() <= LONGEST_LINE;
        let line = line.trim_ascii();
        if line_is_short && (line.is_empty() || line.starts_with(b"#")) {
            return;
        }
        self.counts.clear();
        let mut fields = line
            .split(|byte| b",; \t".contains(byte))
            .filter(|field| !field.is_empty());
        let unit = match self.numbers {
            Numbers::Counts => None,
            Numbers::Rates => Some(self.rate_per_count),
        };
        let counts = &mut self.counts;
        let read = line_is_short
            && fields.all(|field| {
                count(field, unit).is_some_and(|count| {
                    counts.push(count);
                    true
                })
            });
        if !read && line_is_short && unit.is_none() {
            let mut fields = line.split(|byte| b",; \t".contains(byte));
            let is_rate = |field: &[u8]| field.is_empty() || count(field, Some(1.0)).is_some();
            self.with_decimals += u64::from(fields.all(is_rate));
        }
        let number = self.names.as_ref().map_or(self.axes.width(), Vec::len);
        let is_row = read && !self.counts.is_empty() && self.counts.len() <= MOST_AXES;
        if number > 0 {
            self.take_row(is_row && self.counts.len() == number);
            return;
        }
        self.first.push(is_row.then(|| self.counts.clone()));
        let of_width = |width| {
            let rows = self.first.iter().flatten();
            rows.filter(|row| row.len() == width).count()
        };
        if of_width(self.counts.len()) >= AGREEING || self.first.len() >= UNDECIDED {
            self.settle();
        }
    }

    /// Takes the numbers of a line as a row, or counts an invalid line, after which there is a gap.
    fn take_row(&mut self, is_valid: bool) {
        if !is_valid {
            self.garbled += 1;
            self.axes.gap();
            return;
        }
        if self.axes.width() == 0 {
            self.axes = Live::new(self.counts.len());
        }
        let row: Vec<&[i32]> = self.counts.iter().map(std::slice::from_ref).collect();
        self.axes.push(&row);
    }

    /// Takes the first lines. Those that have as many numbers as most of them are rows.
    fn settle(&mut self) {
        let first = std::mem::take(&mut self.first);
        let width_of = |row: &Option<Vec<i32>>| row.as_ref().map_or(0, Vec::len);
        let lines_of = |width| first.iter().filter(|row| width_of(row) == width).count();
        let widths = (1..=MOST_AXES).filter(|&width| lines_of(width) > 0);
        let width = widths.max_by_key(|&width| lines_of(width)).unwrap_or(0);
        for row in &first {
            self.counts.clear();
            self.counts.extend(row.iter().flatten());
            self.take_row(width > 0 && width_of(row) == width);
        }
    }

    /// Takes what is left at the end of the input: a last line without a line end.
    pub(super) fn end(&mut self) {
        if !self.line.is_empty() {
            self.unfinished = true;
            self.take(b"\n");
        }
        self.settle();
    }

    /// Whether the last line had no line end.
    pub(super) const fn is_unfinished(&self) -> bool {
        self.unfinished
    }

    /// Number of samples of each axis so far.
    pub(super) fn samples(&self) -> u64 {
        self.axes.samples()
    }

    /// Number of gaps so far.
    pub(super) fn gaps(&self) -> u64 {
        self.axes.gaps()
    }

    /// Number of invalid lines so far.
    pub(super) const fn garbled(&self) -> u64 {
        self.garbled
    }

    /// What could be done about the invalid lines, if that is known.
    pub(super) fn remedy(&self) -> Option<String> {
        (self.with_decimals > 0).then(|| {
            format!(
                "{} of the invalid lines have decimals: give --decimals, and the resolution as --scale",
                self.with_decimals
            )
        })
    }

    /// What is recorded so far.
    pub(super) fn snapshot(&self) -> Snapshot {
        Snapshot {
            rate_hz: self.rate_hz,
            samples: self.samples(),
            gaps: self.gaps(),
            garbled: self.garbled(),
            curves: self.curves().ok().flatten().unwrap_or_default(),
        }
    }

    /// The curves of the samples so far, with what else they show, or `None` while there are fewer than two octaves.
    pub(super) fn curves(&self) -> Result<Option<Vec<(AxisCurve, Evidence)>>, Failure> {
        let names: Vec<String> = (0..self.axes.width()).map(|i| self.name(i)).collect();
        let curves = with_evidence(&Log {
            rate_hz: self.rate_hz,
            unit: self.unit,
            has_scale: true,
            axes: self.axes.axes(&names, self.rate_per_count),
            notes: Vec::new(),
        })?;
        let is_long = |(curve, _): &(AxisCurve, Evidence)| curve.octaves.len() >= 2;
        let long = !curves.is_empty() && curves.iter().all(is_long);
        Ok(long.then_some(curves))
    }

    fn name(&self, i: usize) -> String {
        match (&self.names, self.axes.width()) {
            (Some(names), _) => names[i].clone(),
            (None, 1) => "gyro".into(),
            (None, 2 | 3) => ["x", "y", "z"][i].into(),
            (None, _) => format!("axis{}", i + 1),
        }
    }
}

/// The count that a field says: a whole number, or a rate in counts of this size.
fn count(field: &[u8], rate_per_count: Option<f64>) -> Option<i32> {
    let Some(rate_per_count) = rate_per_count else {
        return atoi_simd::parse::<i32, false, false>(field).ok();
    };
    let rate: f64 = std::str::from_utf8(field).ok()?.parse().ok()?;
    let count = (rate / rate_per_count).round();
    let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&count);
    fits.then_some(count as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::Accumulator;
    use allanite_log::OCTAVES;

    fn recording() -> Recording {
        recording_of(Numbers::Counts, 1.0)
    }

    fn recording_of(numbers: Numbers, rate_per_count: f64) -> Recording {
        Recording::new(100.0, rate_per_count, numbers, Unit::DegreesPerSecond, None).unwrap()
    }

    /// What is kept of each axis.
    fn sums(recording: &Recording) -> Vec<Accumulator<OCTAVES>> {
        let names = ["x", "y"].map(String::from);
        let axes = recording.axes.axes(&names, 1.0).into_iter();
        axes.map(|axis| axis.accumulator).collect()
    }

    #[test]
    fn rates_with_decimals_make_the_curve_of_their_counts() {
        let (mut counts, mut rates) = (recording(), recording_of(Numbers::Rates, 0.004));
        let mut unread = recording();
        for i in 0..300 {
            let count = i * i % 17 - 8;
            counts.take(format!("{count},{i}\n").as_bytes());
            let rate = f64::from(count) * 0.004;
            // A rate that is rounded to its own decimals lies beside its count.
            let line = format!("{rate:.4},{:e}\n", 0.004 * f64::from(i) + 0.001);
            rates.take(line.as_bytes());
            unread.take(line.as_bytes());
        }
        for line in ["nan,1\n", "inf,1\n", "1e300,1\n", "0x1,1\n"] {
            rates.take(line.as_bytes());
            counts.take(b"none\n");
        }
        assert!(sums(&rates) == sums(&counts));
        assert_eq!((rates.samples(), rates.garbled()), (300, 4));
        assert_eq!(counts.remedy(), None);
        unread.end();
        assert_eq!((unread.samples(), unread.garbled()), (0, 300));
        let remedy = unread.remedy().unwrap();
        assert!(
            remedy.starts_with("300 of the invalid lines have decimals"),
            "{remedy}"
        );
    }

    #[test]
    fn pieces_of_any_length_make_the_same_curve() {
        let text: String = (0..500_i32)
            .map(|i| match i % 50 {
                49 => format!("{i},oops\n"),
                7 => format!("# {i}\n\n{i};{}\r\n", i * i % 17),
                _ => format!("{i}, -{}\n", i * i % 31),
            })
            .collect();
        let mut whole = recording();
        whole.take(text.as_bytes());
        assert_eq!(
            (whole.samples(), whole.garbled(), whole.gaps()),
            (490, 10, 10)
        );
        for piece in [1, 2, 3, 7, 64, 1000] {
            let mut pieces = recording();
            text.as_bytes()
                .chunks(piece)
                .for_each(|piece| pieces.take(piece));
            assert!(sums(&pieces) == sums(&whole), "pieces of {piece}");
        }
    }

    #[test]
    fn invalid_line_leaves_a_gap_and_unfinished_line_is_ignored() {
        let garbled = [
            "1 2\n",
            "1.5\n",
            "99999999999\n",
            "\u{fffd}\n",
            "--1\n",
            ",\n",
            &format!("{}\n", "1".repeat(2 * LONGEST_LINE)),
            &format!("{}5\n", " ".repeat(2 * LONGEST_LINE)),
        ]
        .map(str::to_owned);
        for line in garbled {
            let mut recording = recording();
            recording.take(b"5\n6\n");
            recording.take(line.as_bytes());
            recording.take(b"7\n8");
            recording.settle();
            let counted = (recording.samples(), recording.garbled(), recording.gaps());
            assert_eq!(counted, (3, 1, 1), "{line:?}");
        }
    }

    #[test]
    fn partial_first_line_or_banner_does_not_fix_the_number_of_axes() {
        for banner in ["34\n", "gyro 2.1\n", "3 2 1\n", "2024\n1 2 3 4\nready\n"] {
            let mut recording = recording();
            recording.take(banner.as_bytes());
            for i in 0..300 {
                recording.take(format!("{i} {}\n", i * i % 17).as_bytes());
            }
            let lines = banner.lines().count() as u64;
            let counted = (recording.samples(), recording.garbled(), recording.gaps());
            assert_eq!(counted, (300, lines, 0), "{banner:?}");
        }
    }

    #[test]
    fn last_line_without_a_line_end_is_taken_when_the_input_ends() {
        let mut recording = recording();
        recording.take(b"5\n6\n7");
        assert_eq!(recording.samples(), 0);
        recording.end();
        assert_eq!((recording.samples(), recording.is_unfinished()), (3, true));
    }

    #[test]
    fn any_bytes_are_taken_without_a_panic() {
        let mut random = 7_u32;
        let mut recording = recording();
        for _ in 0..2000 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            recording.take(&random.to_le_bytes());
        }
        recording.end();
        assert!(recording.garbled() > 0);
    }
}
