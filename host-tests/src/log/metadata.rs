//! What the comment lines at the top of a log say about it.

use super::Options;
use crate::{
    failure::{Failure, Place, quoted},
    unit::Unit,
};
use std::path::Path;

/// `key=value` pairs of comment lines, such as `# rate_hz=100 unit=deg/s`, with their rows. Keys
/// that mean nothing here are left alone: the comments may be anybody's.
#[derive(Debug, Default)]
pub(super) struct Metadata {
    rate_hz: Option<(u64, String)>,
    scale: Option<(u64, String)>,
    unit: Option<(u64, String)>,
}

impl Metadata {
    /// Takes what a comment line says, `#` excluded; the first word on a subject counts.
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

    /// Rate, scale and unit: from the options, else from here, else as a log has them that does
    /// not say. Only the rate has no such value.
    pub(super) fn settle(&self, path: &Path, options: &Options) -> Result<Settled, Failure> {
        let rate_hz = match (options.rate_hz, &self.rate_hz) {
            (Some(rate_hz), _) => positive(rate_hz, "--rate", "samples per second")?,
            (None, Some((row, text))) => positive_text(path, *row, "rate_hz", text, "--rate HZ")?,
            (None, None) => {
                return Err(Place::file(path)
                    .failure("the sampling rate is not known", "give it with --rate HZ"));
            }
        };
        let scale = match (options.scale, &self.scale) {
            (Some(scale), _) => Some(positive(scale, "--scale", "rate units per count")?),
            (None, Some((row, text))) => Some(positive_text(
                path,
                *row,
                "scale",
                text,
                "--scale RATE_PER_COUNT",
            )?),
            (None, None) => None,
        };
        let unit = match (options.unit, &self.unit) {
            (Some(unit), _) => Some(unit),
            (None, Some((row, text))) => Some(Unit::from_name(text).ok_or_else(|| {
                Place::row(path, *row).failure(
                    format!(
                        "unit={} is neither deg/s nor rad/s",
                        quoted(text.as_bytes())
                    ),
                    "correct it or give --unit",
                )
            })?),
            (None, None) => None,
        };
        Ok(Settled {
            rate_hz,
            scale,
            unit,
        })
    }
}

/// What options and metadata agree on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settled {
    pub(super) rate_hz: f64,
    pub(super) scale: Option<f64>,
    pub(super) unit: Option<Unit>,
}

/// A positive, finite option.
fn positive(value: f64, option: &str, meaning: &str) -> Result<f64, Failure> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Failure::option(
            format!("{option} {value} is impossible"),
            format!("give a positive, finite number of {meaning}"),
        ))
    }
}

/// A positive, finite number of a comment line.
fn positive_text(
    path: &Path,
    row: u64,
    key: &str,
    text: &str,
    option: &str,
) -> Result<f64, Failure> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
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

    fn settle(comment: &str, options: &Options) -> Result<Settled, Failure> {
        let mut metadata = Metadata::default();
        metadata.read_comment(1, comment);
        metadata.settle(Path::new("a.csv"), options)
    }

    #[test]
    fn options_win_over_comments() {
        let options = Options {
            rate_hz: Some(200.0),
            ..Options::default()
        };
        let settled = settle(" rate_hz=100 unit=rad/s scale=0.05", &options).unwrap();
        assert_eq!(
            settled,
            Settled {
                rate_hz: 200.0,
                scale: Some(0.05),
                unit: Some(Unit::RadiansPerSecond),
            }
        );
    }

    #[test]
    fn rate_that_nobody_gives_is_asked_for() {
        let failure = settle(" recorded in the cellar", &Options::default()).unwrap_err();
        assert_eq!(
            failure.to_string(),
            "a.csv: the sampling rate is not known; give it with --rate HZ"
        );
    }

    #[test]
    fn comment_with_an_impossible_number_is_refused() {
        for comment in [
            "rate_hz=0",
            "rate_hz=NaN",
            "rate_hz=fast",
            "rate_hz=1 scale=-1",
        ] {
            let failure = settle(comment, &Options::default())
                .unwrap_err()
                .to_string();
            assert!(failure.starts_with("a.csv:1: "), "{failure}");
        }
    }
}
