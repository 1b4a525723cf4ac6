//! The parts of a log that the user leaves out.

use crate::failure::Failure;
use std::str::FromStr;

/// A time in a log, in seconds from its first row, or from its last row if it is negative, with the text that it was
/// written as.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    seconds: f64,
    is_from_end: bool,
    text: String,
}

/// A range of time that is left out of a log, written `311s..313s`.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeRange {
    from: Moment,
    to: Moment,
}

/// What is left out of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cuts {
    /// Where the record begins.
    pub from: Option<Moment>,
    /// Where the record ends.
    pub to: Option<Moment>,
    /// Stretches between these that are no part of the record.
    pub drop: Vec<TimeRange>,
}

impl FromStr for Moment {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const WRITE: &str =
            "write a time with its unit, such as 10s, 2.5min or 1h, or -12s from the end";
        let (is_from_end, size) = match text.strip_prefix('-') {
            Some(size) => (true, size),
            None => (false, text),
        };
        let unit = size.find(|c: char| !c.is_ascii_digit() && c != '.');
        let (number, unit) = size.split_at(unit.ok_or(WRITE)?);
        let number: f64 = number.parse().map_err(|_| WRITE)?;
        let unit_s = match unit.trim() {
            "ms" => 1e-3,
            "s" | "sec" => 1.0,
            "min" => 60.0,
            "h" => 3600.0,
            "d" => 86_400.0,
            _ => return Err(WRITE),
        };
        Ok(Self {
            seconds: number * unit_s,
            is_from_end,
            text: text.to_owned(),
        })
    }
}

impl FromStr for TimeRange {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let ends = text.split_once("..");
        let (from, to) = ends.ok_or("write FROM..TO, such as 311s..313s")?;
        let (from, to): (Moment, Moment) = (from.trim().parse()?, to.trim().parse()?);
        // Whether a time from the end lies behind one from the beginning depends on the log.
        if from.is_from_end == to.is_from_end && from.signed() >= to.signed() {
            return Err("the stretch ends before it begins: write FROM..TO");
        }
        Ok(Self { from, to })
    }
}

impl Moment {
    fn signed(&self) -> f64 {
        if self.is_from_end {
            -self.seconds
        } else {
            self.seconds
        }
    }

    fn in_log(&self, end_s: f64) -> f64 {
        if self.is_from_end {
            end_s - self.seconds
        } else {
            self.seconds
        }
    }
}

impl Cuts {
    /// Whether nothing is left out.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn moments(&self) -> impl Iterator<Item = &Moment> {
        let stretches = self.drop.iter().flat_map(|one| [&one.from, &one.to]);
        self.from.iter().chain(&self.to).chain(stretches)
    }

    /// Whether the end of the log has to be known.
    pub(super) fn need_end(&self) -> bool {
        self.moments().any(|moment| moment.is_from_end)
    }

    /// The times that are left out of a log that ends at this time.
    ///
    /// # Errors
    /// When nothing is left of the log.
    pub(super) fn dropped(&self, end_s: f64) -> Result<Dropped, Failure> {
        let from_s = self.from.as_ref().map_or(0.0, |from| from.in_log(end_s));
        let to_s = self
            .to
            .as_ref()
            .map_or(f64::INFINITY, |to| to.in_log(end_s));
        if from_s >= to_s {
            let text =
                |moment: &Option<Moment>| moment.as_ref().map_or("", |one| &one.text).to_owned();
            let (from, to) = (text(&self.from), text(&self.to));
            let (what, given) = match (from.as_str(), to.as_str()) {
                ("", to) => (format!("--to {to} leaves nothing"), "an end"),
                (from, "") => (format!("--from {from} leaves nothing"), "a beginning"),
                (from, to) => (format!("--to {to} is not behind --from {from}"), "times"),
            };
            return Err(Failure::option(
                what,
                format!("give {given} within the log"),
            ));
        }
        let stretch = |one: &TimeRange| {
            let text = format!("{}..{}", one.from.text, one.to.text);
            (one.from.in_log(end_s), one.to.in_log(end_s), text)
        };
        Ok(Dropped {
            from_s,
            to_s,
            stretches: self.drop.iter().map(stretch).collect(),
        })
    }
}

/// The times that are left out of a log, in seconds from its first row.
#[derive(Clone, Debug)]
pub(super) struct Dropped {
    from_s: f64,
    to_s: f64,
    stretches: Vec<(f64, f64, String)>,
}

impl Dropped {
    /// Nothing.
    pub(super) const NONE: Self = Self {
        from_s: 0.0,
        to_s: f64::INFINITY,
        stretches: Vec::new(),
    };

    /// Everything, so that all rows are looked at one by one.
    pub(super) const ALL: Self = Self {
        from_s: f64::INFINITY,
        to_s: f64::INFINITY,
        stretches: Vec::new(),
    };

    /// Whether nothing is left out.
    pub(super) fn is_none(&self) -> bool {
        self.from_s <= 0.0 && self.to_s == f64::INFINITY && self.stretches.is_empty()
    }

    /// Whether stretches in the middle are left out.
    pub(super) fn has_stretches(&self) -> bool {
        !self.stretches.is_empty()
    }

    /// Whether a row at this time is left out.
    pub(super) fn covers(&self, at_s: f64) -> bool {
        let within = |(from_s, to_s, _): &(f64, f64, String)| (*from_s..*to_s).contains(&at_s);
        at_s < self.from_s || at_s >= self.to_s || self.stretches.iter().any(within)
    }

    /// Whether this row and all behind it are left out.
    pub(super) fn ends_before(&self, at_s: f64) -> bool {
        at_s >= self.to_s
    }

    /// A stretch that begins behind the end of the log.
    pub(super) fn behind(&self, end_s: f64) -> Option<&str> {
        let behind = self.stretches.iter().find(|(from_s, ..)| *from_s > end_s);
        behind.map(|(.., text)| text.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_log_from_either_end() {
        let cuts = Cuts {
            from: Some("10s".parse().unwrap()),
            to: Some("-0.2min".parse().unwrap()),
            drop: vec![
                "311s..313s".parse().unwrap(),
                "-1h..350000ms".parse().unwrap(),
            ],
        };
        assert!(cuts.need_end());
        let dropped = cuts.dropped(3900.0).unwrap();
        for (at_s, covered) in [
            (0.0, true),
            (9.99, true),
            (10.0, false),
            (299.9, false),
            (300.0, true),
            (312.0, true),
            (350.0, false),
            (3887.9, false),
            (3888.0, true),
            (3900.0, true),
        ] {
            assert_eq!(dropped.covers(at_s), covered, "{at_s}");
        }
        assert!(cuts.dropped(15.0).is_err(), "--to lies before --from");
    }

    #[test]
    fn what_is_no_time_is_refused() {
        for text in ["10", "s", "-", "1m", "1.2.3s", "1e3s", "NaNs", "ten s"] {
            assert!(text.parse::<Moment>().is_err(), "{text}");
        }
        for text in ["10s", "20s..10s", "-10s..-20s", "10s..10s", "..10s"] {
            assert!(text.parse::<TimeRange>().is_err(), "{text}");
        }
    }
}
