//! The table of the study.

use super::{Coefficient, Experiment};
use std::fmt::{self, Display, Formatter};

impl Display for Experiment {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} records of {} h at {} Hz for each gyro; coefficients {}",
            self.records, self.hours, self.rate_hz, self.truth
        )?;
        writeln!(
            f,
            "Negative squares count as zero in the mean, in the deviation and in the rms error."
        )?;
        for gyro in &self.gyros {
            writeln!(
                f,
                "\n{:<8} {:<17} {:>10} {:>10} {:>18} {:>9}",
                gyro.name, "method", "mean", "deviation", "rms error", "negative"
            )?;
            for coefficient in &gyro.coefficients {
                coefficient.write(f)?;
            }
        }
        Ok(())
    }
}

impl Coefficient {
    fn write(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} = {} {}", self.symbol, brief(self.truth), self.unit)?;
        for one in &self.methods {
            writeln!(
                f,
                "{:<8} {:<17} {:>10} {:>10} {:>7.2} % ± {:>4.2} % {:>7.1} %",
                "",
                one.method,
                brief(one.mean),
                brief(one.deviation),
                100.0 * one.rms_error,
                100.0 * one.rms_error_error,
                100.0 * one.negative
            )?;
        }
        Ok(())
    }
}

/// A number with four significant digits.
fn brief(value: f64) -> String {
    let digits = 3 - value.abs().log10().floor().clamp(-12.0, 3.0) as i32;
    let text = format!("{value:.*}", digits.unsigned_abs() as usize);
    if text.contains('.') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}
