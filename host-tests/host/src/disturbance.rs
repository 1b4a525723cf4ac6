//! Why a record is not valid, in words: what disturbed it, when and for how long, and how to leave that out.

use crate::number::number;
use allanite::integrity::Reason;
use allanite_log::{
    self as log, Disturbance,
    failure::brief,
    unit::{Sensor, Unit},
};

/// More stretches than this are not cut out one by one. Chosen by hand.
const MOST: usize = 5;

/// A record of which more than this share would be left out is to be recorded again. Chosen by hand.
const MOST_CUT: f64 = 0.5;

/// The place of a change is known to so much of the time before it. Chosen by hand: a record has 32 blocks or more.
const MARGIN: f64 = 0.04;

/// Motion is a knock if it takes no longer, in seconds. Chosen by hand.
const KNOCK_S: f64 = 5.0;

/// Why a record is not valid. What disturbed it is said with its time, with its axis where another one shows it, and with
/// the options that leave it out; repeats are said with the rate of the sensor.
pub fn invalid(
    reason: &Reason,
    disturbance: Option<&Disturbance>,
    (axis, rate_hz, unit): (&str, f64, Unit),
) -> String {
    if let Reason::Repeated {
        times,
        changes,
        samples,
    } = *reason
    {
        let own = changes as f64 / samples as f64;
        let words = log::repeats_said(1.0 - own, times > 0);
        let rate = log::rate_of(own, samples, rate_hz);
        return format!(
            "{words}: the sensor runs at {rate} Hz, and the repeats make its noise look filtered; read it at its own rate, \
             or leave the repeats out, which `--repeats drop` does where it is certain which samples repeat"
        );
    }
    if let Reason::Changed { after, percent } = *reason {
        return changed(after as f64 / rate_hz, f64::from(percent) / 100.0);
    }
    let mut text = reason.to_string();
    if unit.sensor() == Sensor::Accelerometer {
        text = text.replacen("the gyro", "the accelerometer", 1);
    }
    let is_of = |disturbance: &&Disturbance| match reason {
        Reason::Moved { .. } => disturbance.is_motion,
        Reason::Spiked { .. } => !disturbance.is_motion,
        _ => false,
    };
    let Some(disturbance) = disturbance.filter(is_of) else {
        return text;
    };
    if let Some((options, what)) = cut(disturbance) {
        text += &format!(", or add {options} ({what})");
    }
    let seen = match (disturbance.axis == axis, disturbance.is_motion) {
        (true, _) => String::new(),
        (false, true) => format!(
            ", seen in axis {}: motion about one axis makes all axes invalid",
            disturbance.axis
        ),
        (false, false) => format!(", in axis {} too", disturbance.axis),
    };
    text + &format!(" (first at {} s{seen})", number(disturbance.at_s))
}

/// The noise is another one from a time on. Either part can be read alone.
fn changed(at_s: f64, factor: f64) -> String {
    let direction = if factor < 1.0 { "fell" } else { "rose" };
    let step_s = step(MARGIN * at_s);
    let time = |seconds: f64| {
        let digits = (-step_s.log10()).ceil().max(0.0) as usize;
        format!("{seconds:.digits$}s")
    };
    let before = ((1.0 - MARGIN) * at_s / step_s).floor() * step_s;
    let behind = ((1.0 + MARGIN) * at_s / step_s).ceil() * step_s;
    format!(
        "the noise {direction} to {factor} of what it was, at about {} s, as another range, rate or filter of the sensor makes it; keep \
         the settings of the sensor and record again, or read one part alone, with --to {} or --from {}",
        number(at_s),
        time(before),
        time(behind)
    )
}

/// The options that leave out what disturbed a record, and what that is. `None` where it is too much.
fn cut(disturbance: &Disturbance) -> Option<(String, String)> {
    let stretches = &disturbance.stretches_s;
    let cut_s: f64 = stretches.iter().map(|(from_s, to_s)| to_s - from_s).sum();
    let end_s = disturbance.end_s;
    if stretches.is_empty() || stretches.len() > MOST || cut_s > MOST_CUT * end_s {
        return None;
    }
    let one = |&(from_s, to_s): &(f64, f64)| {
        let long_s = to_s - from_s;
        // What rings dies away slowly, and begins at once.
        let (margin_s, step_s) = (0.25 * long_s, step(long_s));
        let before_s = ((from_s - 0.1 * long_s) / step_s).floor() * step_s;
        let behind_s = ((to_s + margin_s) / step_s).ceil() * step_s;
        let (at, long) = (number(from_s), brief((100.0 * long_s).round() / 100.0));
        let time = |seconds: f64| {
            let digits = (-step_s.log10()).ceil().max(0.0) as usize;
            format!("{seconds:.digits$}s")
        };
        if before_s <= 0.0 {
            let option = format!("--from {}", time(behind_s));
            (option, format!("motion until {} s", number(to_s)))
        } else if behind_s >= end_s {
            // Counted from the end, which is where the hand that stops the record comes.
            let left_s = ((end_s - from_s + margin_s) / step_s).ceil() * step_s;
            let what = format!("motion from {at} s to the end, {long} s");
            (format!("--to -{}", time(left_s)), what)
        } else {
            let option = format!("--drop {}..{}", time(before_s), time(behind_s));
            let what = match (disturbance.is_motion, long_s <= KNOCK_S) {
                (false, _) => "a spike",
                (true, true) => "a knock",
                (true, false) => "motion",
            };
            (option, format!("{what} at {at} s for {long} s"))
        }
    };
    let (options, whats): (Vec<_>, Vec<_>) = stretches.iter().map(one).unzip();
    Some((options.join(" "), whats.join("; ")))
}

/// The step to which the ends of a cut are rounded: a power of ten, at most the length that is cut out.
fn step(long_s: f64) -> f64 {
    10f64.powf(long_s.log10().floor()).clamp(1e-3, 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_options_cover_what_disturbed_the_record() {
        let disturbance = |stretches_s: &[(f64, f64)]| Disturbance {
            axis: "gx".into(),
            is_motion: true,
            at_s: 0.0,
            stretches_s: stretches_s.to_vec(),
            end_s: 600.0,
        };
        let cut = |stretches_s: &[(f64, f64)]| cut(&disturbance(stretches_s));
        let (options, what) = cut(&[(0.0, 8.3), (311.2, 312.6), (588.2, 600.0)]).unwrap();
        assert_eq!(options, "--from 11s --drop 311s..313s --to -20s");
        assert!(what.contains("a knock at 311.2 s for 1.4 s"), "{what}");
        assert_eq!(cut(&[(100.0, 500.0)]), None, "most of the record");
        assert_eq!(cut(&[(1.0, 2.0); 9]), None, "too many");
    }
}
