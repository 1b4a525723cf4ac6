//! Tables of text whose numbers are written down in binary when they are parsed, so that no later pass parses them again: a log of
//! floats takes two passes or more.

use super::{
    columns::{AxisColumn, Columns, Look},
    csv::Csv,
    field::{Exact, Field, Flaw, Nanoseconds, Stamp},
    metadata::Metadata,
    table::{Ended, Stop, Table, Visitor},
    values::{Kind, NumberFile, NumberWriter, Told},
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use std::{cell::RefCell, fs::File, io::BufWriter};
use tempfile::NamedTempFile;

/// A shorter text is parsed again sooner than it is written down.
const SHORTEST: u64 = 1 << 18;

/// A longer one may leave no room for its numbers.
const LONGEST: u64 = 1 << 32;

/// The numbers may take so many times as many bytes as the file, which may be packed.
const MOST_TIMES: u64 = 4;

/// A text, and the numbers of the columns that were asked for.
pub(super) struct Cached {
    text: Csv,
    length: u64,
    numbers: RefCell<Option<(Vec<AxisColumn>, NumberFile)>>,
}

impl Cached {
    /// A text whose file has so many bytes.
    pub(super) fn new(text: Csv, length: u64) -> Self {
        Self {
            text,
            length,
            numbers: RefCell::new(None),
        }
    }

    /// Writes down what the visitor is shown, if that is worth it.
    fn pass_writing<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        // Counts take one pass, and a log of floats ends it at once.
        let is_worth_it = !V::ONLY_COUNTS && (SHORTEST..=LONGEST).contains(&self.length);
        let file = is_worth_it.then(NamedTempFile::new);
        let Some(Ok(file)) = file else {
            return self.text.pass(axes, visitor, progress);
        };
        let (file, path) = file.into_parts();
        let kinds = axes.iter().map(|axis| Some(self.kind(axis.column)));
        let kinds: Vec<Option<Kind>> = kinds.collect();
        let writer = NumberWriter::new(kinds.clone(), BufWriter::new(file));
        let mut writing = Writing {
            visitor,
            kinds: kinds.into_iter().flatten().collect(),
            written: Some(writer),
            most: self.length.saturating_mul(MOST_TIMES),
        };
        let ended = self.text.pass(axes, &mut writing, progress)?;
        let layout = writing.written.take().map(NumberWriter::finish);
        if let (Ended::AtTheLastRow, Some(Ok(layout))) = (&ended, layout) {
            let numbers = NumberFile { file: path, layout };
            *self.numbers.borrow_mut() = Some((axes.to_vec(), numbers));
        }
        Ok(ended)
    }

    /// What the values of a column are, by the first of them.
    fn kind(&self, column: usize) -> Kind {
        let columns = self.text.columns();
        let is_whole = |head: &Vec<f64>| head.iter().all(|number| number.fract() == 0.0);
        match columns.looks.get(column) {
            Some(Look::Date) => Kind::Date,
            _ if columns.heads.get(column).is_some_and(is_whole) => Kind::Int64,
            _ => Kind::Float,
        }
    }
}

impl Told for Cached {
    fn place(&self, row: u64) -> Place {
        self.text.place_of(row)
    }

    fn of_stamp(&self, row: u64, flaw: &Flaw) -> Option<Failure> {
        self.text.of_other_sensor(row, flaw)
    }
}

impl Table for Cached {
    fn metadata(&self) -> &Metadata {
        self.text.metadata()
    }

    fn columns(&self) -> &Columns {
        self.text.columns()
    }

    fn notes(&self) -> Vec<String> {
        self.text.notes()
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        if let Some((columns, numbers)) = &*self.numbers.borrow()
            && columns == axes
            && !V::ONLY_COUNTS
        {
            let places: Vec<usize> = (0..axes.len()).collect();
            return numbers.pass((&places, axes), visitor, self, progress);
        }
        self.pass_writing(axes, visitor, progress)
    }
}

/// A visitor that writes down what it is shown, unless something but numbers is among it.
struct Writing<'a, V> {
    visitor: &'a mut V,
    kinds: Vec<Kind>,
    written: Option<NumberWriter<BufWriter<File>>>,
    most: u64,
}

impl<V: Visitor> Writing<'_, V> {
    /// Adds a value of the present row.
    #[inline]
    fn write(&mut self, axis: usize, value: [u8; 8]) {
        let Some(written) = &mut self.written else {
            return;
        };
        written.put(axis, value);
        if axis + 1 == self.kinds.len()
            && (written.end_rows(1).is_err() || written.length() > self.most)
        {
            self.written = None;
        }
    }
}

impl<V: Visitor> Visitor for Writing<'_, V> {
    /// Text comes by rows anyway.
    const BY_ROWS: bool = true;

    type Followed = ();

    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        if self.written.is_some() {
            match self.kinds[axis] {
                Kind::Date => {
                    if let Ok(Stamp::Whole(stamp)) = value.stamp()
                        && !value.is_number()
                    {
                        self.write(axis, stamp.to_ne_bytes());
                        return self.visitor.visit(axis, Nanoseconds(stamp));
                    }
                }
                Kind::Float => {
                    if let Ok(Exact::Float(number)) = value.exact() {
                        self.write(axis, number.to_ne_bytes());
                        return self.visitor.visit(axis, number);
                    }
                }
                _ => {
                    let whole = match value.exact() {
                        Ok(Exact::Float(number)) if number.fract() == 0.0 => Some(number as i64),
                        Ok(Exact::Whole(number)) => i64::try_from(number).ok(),
                        _ => None,
                    };
                    if let Some(whole) = whole {
                        self.write(axis, whole.to_ne_bytes());
                        return self.visitor.visit(axis, whole);
                    }
                }
            }
            self.written = None;
        }
        self.visitor.visit(axis, value)
    }

    fn gap(&mut self, missing: u64) {
        self.written = None;
        self.visitor.gap(missing);
    }

    fn forget(&mut self, columns: usize) {
        self.written = None;
        self.visitor.forget(columns);
    }

    fn lose_row(
        &mut self,
        shown: Option<usize>,
        failure: impl FnOnce() -> Failure,
    ) -> Result<(), Failure> {
        self.written = None;
        self.visitor.lose_row(shown, failure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Options, reading::read_table};
    use std::fmt::Write as _;

    const ROWS: usize = 9000;

    /// A log of two axes and a temperature, written by a row and its time.
    fn log(line: impl Fn(usize, f64, [f64; 2]) -> String) -> String {
        let mut text = "time [s],gx [deg/s],gy [deg/s],temp [C]\n".to_owned();
        let mut random = 1_u32;
        for row in 0..ROWS {
            let noise = [(); 2].map(|()| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(random >> 4) / 1e8 - 1.3
            });
            let _ = writeln!(text, "{}", line(row, row as f64 / 200.0, noise));
        }
        text
    }

    fn usual(row: usize, time: f64, [x, y]: [f64; 2]) -> String {
        format!("{time},{x},{y},{}", 25.0 + row as f64 / 1e4)
    }

    /// What a text is read as, and whether its numbers were written down.
    fn read(text: &str, is_long: bool) -> (String, bool) {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("log.csv");
        std::fs::write(&path, text).unwrap();
        let options = Options::default();
        let table = Csv::open(&path, false, &options).unwrap();
        let length = if is_long { LONGEST } else { 0 };
        let table = Cached::new(table, length);
        let covariates = crate::Covariates::Found;
        let watched = crate::reading::Watched {
            covariates: &covariates,
            moments: true,
            spectrogram: false,
            first_sample: None,
        };
        let wanted = (None, Some(watched));
        let read = read_table(&table, &path, &options, wanted, &ProgressBar::hidden());
        let said = match read {
            Ok(log) => format!("{log:?}"),
            Err(failure) => failure.to_string(),
        };
        let folder = folder.path().display().to_string();
        (said.replace(&folder, ""), table.numbers.borrow().is_some())
    }

    #[test]
    fn numbers_that_are_written_down_are_those_of_the_text() {
        type Line = fn(usize, f64, [f64; 2]) -> String;
        let lines: [(&str, bool, Line); 9] = [
            ("floats", true, usual),
            ("gaps", true, |row, time, noise| {
                usual(row, time + (row / 2000) as f64 / 50.0, noise)
            }),
            ("repeated stamps", true, |row, _, noise| {
                usual(row, (row - row / 2500) as f64 / 200.0, noise)
            }),
            ("a late stamp", true, |row, time, noise| {
                let late = [0.012, 0.008, 0.004].get(row.wrapping_sub(5000));
                usual(row, time + late.unwrap_or(&0.0), noise)
            }),
            ("dates", true, |row, time, [x, y]| {
                let (minute, second) = ((time / 60.0) as u32, time % 60.0);
                format!(
                    "2026-01-02T03:{minute:02}:{second:06.3},{x},{y},{}",
                    row / 1000
                )
            }),
            ("whole seconds", true, |row, _, [x, y]| {
                format!("{row},{x},{y},25")
            }),
            ("a comment", false, |row, time, noise| {
                let comment = if row == 4000 {
                    "# lost 3 samples\n"
                } else {
                    ""
                };
                let lost = if row < 4000 { 0.0 } else { 0.015 };
                format!("{comment}{}", usual(row, time + lost, noise))
            }),
            ("a value is missing", false, |row, time, [x, y]| match row {
                6000 => format!("{time},,{y},25"),
                _ => usual(row, time, [x, y]),
            }),
            ("stamps go back", false, |row, time, noise| {
                usual(row, if row == 7000 { time - 1.0 } else { time }, noise)
            }),
        ];
        for (name, is_written, line) in lines {
            let text = log(line);
            let [(plain, never), (written, once)] = [false, true].map(|long| read(&text, long));
            assert!(plain == written, "{name}");
            assert_eq!(
                [never, once],
                [false, is_written],
                "{name}: {}",
                &plain[..plain.len().min(300)]
            );
        }
    }

    #[test]
    fn the_place_of_a_row_is_its_line() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("log.csv");
        let rows: String = (0..20)
            .map(|row| format!("{}.5,{row}.25\n\n", row))
            .collect();
        std::fs::write(&path, format!("# rate_hz=100\nx,y\n{rows}")).unwrap();
        let table = Csv::open(&path, false, &Options::default()).unwrap();
        let said = |row| table.place_of(row).failure("odd", "look").to_string();
        assert!(said(0).ends_with(":3: odd; look"), "{}", said(0));
        assert!(said(4).ends_with(":11: odd; look"), "{}", said(4));
    }
}
