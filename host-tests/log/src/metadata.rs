//! Reads what the lines at the top of a log say about it.

use super::Options;
use crate::{
    failure::{Failure, Place, brief, quoted},
    unit::Unit,
};
use std::{
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

/// The rates in Hz that a log can have, and the sizes of a count. Beyond them, something else was meant.
const RATES_HZ: RangeInclusive<f64> = 1e-6..=1e9;
const SCALES: RangeInclusive<f64> = 1e-30..=1e30;

/// The `key=value` pairs of comment lines, such as `# rate_hz=100 unit=deg/s`, with their rows.
/// Unknown keys are ignored, because other programs may have written them.
#[derive(Debug, Default)]
pub(super) struct Metadata {
    rate_hz: Option<(u64, String)>,
    /// The rate in a line that is no `key=value` pair.
    preamble_hz: Option<(u64, String)>,
    scale: Option<(u64, String)>,
    unit: Option<(u64, String)>,
    /// The file with the comments, if it is another one than the log.
    file: Option<PathBuf>,
}

impl Metadata {
    /// The comments of a file beside the log.
    pub(super) fn of_file(path: &Path) -> Self {
        Self {
            file: Some(path.to_owned()),
            ..Self::default()
        }
    }

    /// The file beside the log that tells something of it.
    pub(super) fn told_in(&self) -> Option<&Path> {
        let tells = self.rate_hz.is_some() || self.scale.is_some() || self.unit.is_some();
        self.file.as_deref().filter(|_| tells)
    }

    /// Reads a comment line without its `#`. The first value of a key counts.
    pub(super) fn read_comment(&mut self, row: u64, comment: &str) {
        for word in comment.split([' ', ',', ';', '\t']) {
            let Some((key, value)) = word.split_once('=') else {
                continue;
            };
            let slot = match key {
                "rate_hz" => &mut self.rate_hz,
                "scale" => &mut self.scale,
                "unit" => &mut self.unit,
                _ => continue,
            };
            slot.get_or_insert_with(|| (row, value.trim().to_owned()));
        }
    }

    /// Reads a line above the rows that other programs write: `// Sample rate: 100.0Hz`, `OutputRate:,60`. The rate in
    /// a comment `rate_hz=…` counts more.
    pub(super) fn read_line(&mut self, row: u64, line: &str) {
        const KEYS: [&str; 8] = [
            "sample rate",
            "sampling rate",
            "samplerate",
            "sample_rate",
            "output rate",
            "outputrate",
            "update rate",
            "sampling frequency",
        ];
        let line = line.to_lowercase();
        let Some((_, rest)) = KEYS.iter().find_map(|key| line.split_once(key)) else {
            return;
        };
        let rest = rest.trim_start_matches(|c: char| !c.is_ascii_digit());
        let end = rest
            .find(|c: char| !c.is_ascii_digit() && c != '.')
            .unwrap_or(rest.len());
        let (number, unit) = rest.split_at(end);
        let is_rate = number
            .parse::<f64>()
            .is_ok_and(|rate_hz| RATES_HZ.contains(&rate_hz));
        let is_other = unit.trim_start().starts_with(['k', 'm']);
        if is_rate && !is_other {
            self.preamble_hz
                .get_or_insert_with(|| (row, number.to_owned()));
        }
    }

    /// The rate that a line above the rows tells, if it is the one that is taken.
    pub(super) fn rate_of_preamble(&self, options: &Options) -> Option<(u64, &str)> {
        let (row, text) = self.preamble_hz.as_ref()?;
        (options.rate_hz.is_none() && self.rate_hz.is_none()).then_some((*row, text.as_str()))
    }

    /// The sampling rate in Hz, from the options or else from the comments.
    pub(super) fn rate_hz(&self, path: &Path, options: &Options) -> Result<Option<f64>, Failure> {
        let path = self.file.as_deref().unwrap_or(path);
        let told = self.rate_hz.as_ref().or(self.preamble_hz.as_ref());
        Ok(match (options.rate_hz, told) {
            (Some(rate_hz), _) => {
                let told = positive(rate_hz, "--rate", "samples per second", RATES_HZ)?;
                Some(told)
            }
            (None, Some((row, text))) => Some(positive_text(
                path,
                *row,
                ("rate_hz", text),
                "--rate HZ",
                RATES_HZ,
            )?),
            (None, None) => None,
        })
    }

    /// The scale in rate units per count, from the options or else from the comments.
    pub(super) fn scale(&self, path: &Path, options: &Options) -> Result<Option<f64>, Failure> {
        let path = self.file.as_deref().unwrap_or(path);
        Ok(match (options.scale, &self.scale) {
            (Some(scale), _) => {
                let told = positive(scale, "--scale", "rate units per count", SCALES)?;
                Some(told)
            }
            (None, Some((row, text))) => {
                let option = "--scale RATE_PER_COUNT";
                Some(positive_text(path, *row, ("scale", text), option, SCALES)?)
            }
            (None, None) => None,
        })
    }

    /// The unit in the comments.
    pub(super) fn unit(&self, path: &Path) -> Result<Option<Unit>, Failure> {
        let path = self.file.as_deref().unwrap_or(path);
        let Some((row, text)) = &self.unit else {
            return Ok(None);
        };
        Unit::from_name(text).map(Some).ok_or_else(|| {
            Place::row(path, *row).failure(
                format!(
                    "unit={} is not one of deg/s, rad/s, m/s^2 and g",
                    quoted(text.as_bytes())
                ),
                "correct it or give --unit",
            )
        })
    }
}

/// Returns the value of an option if it is positive and finite.
fn positive(
    value: f64,
    option: &str,
    meaning: &str,
    range: RangeInclusive<f64>,
) -> Result<f64, Failure> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(Failure::option(
            format!("{option} {} is impossible", brief(value)),
            format!(
                "give {meaning}, from {:e} to {:e}",
                range.start(),
                range.end()
            ),
        ))
    }
}

/// Returns a number in a comment line if it is positive and finite.
fn positive_text(
    path: &Path,
    row: u64,
    (key, text): (&str, &str),
    option: &str,
    range: RangeInclusive<f64>,
) -> Result<f64, Failure> {
    match text.parse::<f64>() {
        Ok(value) if range.contains(&value) => Ok(value),
        Ok(value) if value.is_finite() && value > 0.0 => Err(Place::row(path, row).failure(
            format!("{key}={} is impossible", brief(value)),
            format!("correct it or give {option}"),
        )),
        _ => Err(Place::row(path, row).failure(
            format!(
                "{key}={} is not a positive, finite number",
                quoted(text.as_bytes())
            ),
            format!("correct it or give {option}"),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(comment: &str) -> Metadata {
        let mut metadata = Metadata::default();
        metadata.read_comment(1, comment);
        metadata
    }

    #[test]
    fn options_win_over_comments() {
        let options = Options {
            rate_hz: Some(200.0),
            ..Options::default()
        };
        let metadata = read(" rate_hz=100 unit=rad/s scale=0.05");
        let path = Path::new("a.csv");
        assert_eq!(metadata.rate_hz(path, &options).unwrap(), Some(200.0));
        assert_eq!(metadata.scale(path, &options).unwrap(), Some(0.05));
        assert_eq!(metadata.unit(path).unwrap(), Some(Unit::RadiansPerSecond));
    }

    #[test]
    fn comment_with_an_impossible_number_is_refused() {
        for comment in [
            "rate_hz=0",
            "rate_hz=NaN",
            "rate_hz=fast",
            "rate_hz=1 scale=-1",
        ] {
            let (metadata, path) = (read(comment), Path::new("a.csv"));
            let options = Options::default();
            let rate = metadata.rate_hz(path, &options);
            let read = rate.and_then(|_| metadata.scale(path, &options));
            let failure = read.unwrap_err().to_string();
            assert!(failure.starts_with("a.csv:1: "), "{failure}");
        }
    }
}
