//! Finds the column of a log that holds its time stamps, and their unit.

use super::{
    Options,
    columns::{AxisColumn, Columns, Look},
    gyroflow,
    names::{self, TimeUnit},
    pace::{Pace, possible_units},
    preamble::OF_ESP_IDF,
};
use crate::failure::{Failure, Place, brief, quoted};
use std::path::Path;

/// Fewer stamps say too little about the rate to contradict a told one.
const LEAST_STAMPS: usize = 9;

/// A column of time stamps, or two columns: the seconds and nanoseconds of messages of ROS.
#[derive(Clone, Debug)]
pub(super) struct TimeColumn {
    pub(super) columns: Vec<AxisColumn>,
    pub(super) pace: Pace,
    unit: TimeUnit,
    /// The step in which the stamps count, if the log tells it.
    step_s: Option<f64>,
    /// Whether the stamps are written as dates and times.
    pub(super) is_date: bool,
}

impl Columns {
    /// The time column. It is the column that the options name, or else the two columns of seconds
    /// and nanoseconds. Without these, it is the first column that is named like a time and
    /// advances in the first rows, or the only column without a name that rises by steps other than
    /// one.
    pub(super) fn time(
        &self,
        path: &Path,
        options: &Options,
    ) -> Result<Option<TimeColumn>, Failure> {
        let count = self.looks.len();
        if let Some(wanted) = &options.time {
            let column = self.find(path, wanted)?;
            let found = self.time_in(path, column, options)?;
            return found.map(Some).ok_or_else(|| {
                Place::file(path).failure(
                    format!(
                        "column {} holds no time stamps that advance",
                        quoted(wanted.as_bytes())
                    ),
                    "name another with --time, or give --rate",
                )
            });
        }
        if let Some(pair) = self.seconds_and_nanoseconds() {
            return Ok(Some(pair));
        }
        let named = |column: &usize| self.name(*column).is_some_and(names::is_time);
        let mut by_name: Vec<usize> = (0..count).filter(named).collect();
        // A message has several times. The one at which the sensor was sampled comes first.
        let is_sensors = |column: &usize| {
            let name = self.name(*column).unwrap_or_default();
            name.contains("header.stamp") || name.contains("timestamp_sample") || name == "TimeUS"
        };
        by_name.sort_by_key(|column| !is_sensors(column));
        // A temperature may be called T.
        let rises = |column: &usize| {
            let head = &self.heads[*column];
            let rising = head.windows(2).filter(|pair| pair[1] >= pair[0]).count();
            self.looks[*column] != Look::Number || 10 * (rising + 1) >= 8 * head.len()
        };
        if by_name.iter().any(rises) {
            by_name.retain(rises);
        }
        // Dates and times are often coarser than a number beside them.
        let dates = (0..count).filter(|&column| self.looks[column] == Look::Date);
        by_name.retain(|&column| self.looks[column] != Look::Date);
        by_name.extend(dates);
        for column in by_name {
            if let Some(found) = self.time_in(path, column, options)? {
                return Ok(Some(found));
            }
        }
        let unnamed = |column: &usize| {
            self.name(*column).is_none()
                && self.looks[*column] == Look::Rising
                && !is_index(&self.heads[*column])
        };
        let mut unnamed = (0..count).filter(unnamed);
        match (unnamed.next(), unnamed.next()) {
            (Some(column), None) => self.time_in(path, column, options),
            _ => Ok(None),
        }
    }

    /// The time in a column, or `None` if its values do not advance.
    ///
    /// # Errors
    /// When the unit in its name is not known, or when none is told and not exactly one fits.
    fn time_in(
        &self,
        path: &Path,
        column: usize,
        options: &Options,
    ) -> Result<Option<TimeColumn>, Failure> {
        if self.looks[column] == Look::Text {
            return Ok(None);
        }
        let head = &self.heads[column];
        let pace_of = |unit| {
            let stamps = self.longer.get(column).map_or(&[][..], Vec::as_slice);
            let pace = Pace::of_cut(stamps, unit).or_else(|| Pace::of(head, unit))?;
            Some(match self.are_written_twice(column) {
                true => pace.without_bursts(),
                false => pace,
            })
        };
        if self.looks[column] == Look::Date {
            return Ok(pace_of(TimeUnit::Ns).map(|pace| TimeColumn {
                columns: vec![self.time_axis(column)],
                pace,
                unit: TimeUnit::Ns,
                step_s: None,
                is_date: true,
            }));
        }
        let Some(possible) = possible_units(head) else {
            return Ok(None);
        };
        let fail = |what: String| {
            Place::file(path).failure(
                match self.name(column) {
                    Some(name) => format!("time column {name}: {what}"),
                    None => format!("column {} as the time: {what}", column + 1),
                },
                "choose with --time-unit, or give --rate",
            )
        };
        let told = match options.time_unit {
            None => TimeUnit::of_name(self.name(column).unwrap_or_default()).map_err(|text| {
                fail(format!("the unit {} is not known", quoted(text.as_bytes())))
            })?,
            unit => unit,
        };
        let of_blackbox = self.name(column) == Some("time") && self.said.contains("blackbox");
        let told = told.or(of_blackbox.then_some(TimeUnit::Us));
        let of_esp_idf = column == 0 && self.said.contains(OF_ESP_IDF);
        let told = told.or(of_esp_idf.then_some(TimeUnit::Ms));
        let header = gyroflow::Header::of(&self.said).filter(|_| told.is_none());
        if let Some(step_s) = header.and_then(|header| header.time_step_s()) {
            return Ok(Pace::of_ticks(head, step_s.recip()).map(|pace| TimeColumn {
                columns: vec![self.time_axis(column)],
                pace,
                unit: TimeUnit::S,
                step_s: Some(step_s),
                is_date: false,
            }));
        }
        let unit = match (told, possible.as_slice()) {
            (Some(unit), _) | (None, &[unit]) => unit,
            (None, []) => {
                return Err(fail("no unit is told, and none gives a usual rate".into()));
            }
            (None, several) => {
                let one = |unit: &TimeUnit| {
                    let rate_hz = Pace::of(head, *unit).map_or(f64::NAN, |pace| pace.usual_hz());
                    format!("{} ({} Hz)", unit.name(), brief(rate_hz))
                };
                let units: Vec<String> = several.iter().map(one).collect();
                return Err(fail(format!(
                    "no unit is told, and it may be {}",
                    units.join(" or ")
                )));
            }
        };
        Ok(pace_of(unit).map(|pace| TimeColumn {
            columns: vec![self.time_axis(column)],
            pace,
            unit,
            step_s: None,
            is_date: false,
        }))
    }

    /// Whether most rows that share the stamp of the row before also share its values, so that they are no samples of
    /// their own.
    fn are_written_twice(&self, time: usize) -> bool {
        let stamps = &self.heads[time];
        let numbers = (0..self.looks.len()).filter(|&column| {
            column != time
                && self.looks[column] == Look::Number
                && self.heads[column].len() == stamps.len()
        });
        let numbers: Vec<&Vec<f64>> = numbers.map(|column| &self.heads[column]).collect();
        let shared = (1..stamps.len()).filter(|&row| stamps[row] == stamps[row - 1]);
        let (mut all, mut twice) = (0, 0);
        for row in shared {
            all += 1;
            twice += usize::from(numbers.iter().all(|column| column[row] == column[row - 1]));
        }
        2 * twice > all
    }

    /// Checks that a told rate is not contradicted by time stamps whose unit is told too. Stamps that
    /// count rows say nothing about the rate.
    ///
    /// # Errors
    /// When the first stamps have another rate.
    pub(super) fn check_rate(
        &self,
        path: &Path,
        options: &Options,
        rate_hz: f64,
    ) -> Result<(), Failure> {
        let is_given = |wanted: &String| self.find(path, wanted).ok();
        let named = |column: &usize| self.name(*column).is_some_and(names::is_time);
        let by_name = (0..self.looks.len()).filter(named);
        for column in options.time.iter().filter_map(is_given).chain(by_name) {
            let head = &self.heads[column];
            if self.looks[column] == Look::Text || head.len() < LEAST_STAMPS || is_index(head) {
                continue;
            }
            let told = TimeUnit::of_name(self.name(column).unwrap_or_default());
            // Without a word about the unit, it is known where only one makes the rate plausible.
            let only = || match possible_units(head).as_deref() {
                Some(&[unit]) if self.looks[column] == Look::Rising => Some(unit),
                _ => None,
            };
            let told = told.unwrap_or(None).or_else(only);
            let Some(unit) = options.time_unit.or(told) else {
                continue;
            };
            let Some(pace) = Pace::of(head, unit) else {
                continue;
            };
            if !pace.agrees(head, rate_hz) {
                return Err(Place::file(path).failure(
                    format!(
                        "the rate is said to be {} Hz, but the time stamps of {} give {} Hz",
                        brief(rate_hz),
                        self.called(column),
                        brief(pace.mean_hz(head))
                    ),
                    "omit --rate, correct --time-unit, or drop the column of time stamps",
                ));
            }
            return Ok(());
        }
        Ok(())
    }

    fn time_axis(&self, column: usize) -> AxisColumn {
        AxisColumn {
            axis: names::bare(&self.called(column)).to_owned(),
            column,
        }
    }

    /// The two columns of a name such as `header.stamp.sec` and `header.stamp.nanosec`.
    fn seconds_and_nanoseconds(&self) -> Option<TimeColumn> {
        let all = || 0..self.looks.len();
        let lower = |column: usize| self.name(column).map(str::to_lowercase);
        all().find_map(|seconds| {
            let name = lower(seconds)?;
            let prefix = name.strip_suffix("secs").or(name.strip_suffix("sec"))?;
            let is_behind = |column: &usize| {
                let name = lower(*column).unwrap_or_default();
                let rest = name.strip_prefix(prefix);
                rest.is_some_and(|rest| ["nsec", "nsecs", "nanosec"].contains(&rest))
            };
            let behind = all().find(is_behind)?;
            let rows = self.heads[seconds].iter().zip(&self.heads[behind]);
            let first: Vec<f64> = rows.map(|(sec, nanosec)| sec * 1e9 + nanosec).collect();
            Some(TimeColumn {
                columns: vec![self.time_axis(seconds), self.time_axis(behind)],
                pace: Pace::of(&first, TimeUnit::Ns)?,
                unit: TimeUnit::Ns,
                step_s: None,
                is_date: false,
            })
        })
    }
}

impl TimeColumn {
    /// The name of the column in messages.
    pub(super) fn name(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|one| one.axis.as_str()).collect();
        names.join(" and ")
    }

    /// The unit of the stamps, or their form.
    pub(super) fn unit_name(&self) -> String {
        match (self.is_date, self.step_s) {
            (true, _) => "dates and times".into(),
            (false, Some(step_s)) => format!("steps of {} s", brief(step_s)),
            (false, None) => self.unit.name().into(),
        }
    }
}

impl Columns {
    /// The reason why no column holds time stamps, for a log whose rate is not told.
    pub(super) fn why_no_time(&self) -> String {
        let all = 0..self.looks.len();
        let list = |columns: &[usize]| {
            let called: Vec<String> = columns.iter().map(|&column| self.called(column)).collect();
            called.join(", ")
        };
        let named = |column: &usize| self.name(*column).is_some_and(names::is_time);
        let named: Vec<usize> = all.clone().filter(named).collect();
        let is_text = |column: &usize| self.looks[*column] == Look::Text;
        let (texts, numbers): (Vec<usize>, Vec<usize>) = named.into_iter().partition(is_text);
        if !numbers.is_empty() {
            return format!("the values of {} do not advance", list(&numbers));
        }
        if !texts.is_empty() {
            return format!(
                "the values of {} are neither numbers nor dates of ISO 8601",
                list(&texts)
            );
        }
        let rising = |column: &usize| self.looks[*column] == Look::Rising;
        let rising: Vec<usize> = all.filter(rising).collect();
        let (rows, others): (Vec<usize>, Vec<usize>) = rising
            .into_iter()
            .partition(|&column| is_index(&self.heads[column]));
        match (rows.as_slice(), others.as_slice(), &self.names) {
            (_, [], None) if rows.is_empty() => {
                "there is no header, and no column rises as a time does".into()
            }
            (_, [_, _, ..], None) => format!(
                "there is no header, and {} all rise as times do",
                list(&others)
            ),
            (_, [_, ..], Some(_)) => format!(
                "no column is named like a time, though {} rises",
                list(&others)
            ),
            ([_, ..], _, _) => format!("{} only counts rows, and no column is a time", list(&rows)),
            _ => {
                const FEW: usize = 8;
                let names = self.names.as_deref().unwrap_or_default();
                let more = if names.len() > FEW { ", …" } else { "" };
                let few: Vec<&str> = names.iter().take(FEW).map(String::as_str).collect();
                format!(
                    "none of the columns {}{more} is named like a time",
                    few.join(", ")
                )
            }
        }
    }
}

fn is_index(numbers: &[f64]) -> bool {
    numbers.windows(2).all(|pair| pair[1] - pair[0] == 1.0)
}
