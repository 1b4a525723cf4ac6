//! What stands above the rows: settings above the names of columns, and the scales of Gyroflow.

use super::{
    around::{assert_values, rows},
    read_text,
};
use allanite_log::{Options, unit::Unit};
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fmt::Write as _;

#[test]
fn settings_above_the_names_are_skipped() {
    let (text, values) = rows("M,x,y,z");
    for (settings, names) in [
        (
            "Test Name:,Static 01,,\nSample Rate:,100,Hz,\n",
            "ms,gx,gy,gz",
        ),
        (
            "Range,250,deg/s,\nFilter,42,Hz,\n\n",
            "time_ms,gyro_x,gyro_y,gyro_z",
        ),
        (
            "Serial,17,rev,B\n",
            "time_ms,gx,gy,gz\nms,deg/s,deg/s,deg/s",
        ),
    ] {
        let text = format!("{settings}{names}\n{text}");
        let log = read_text(&text, &Options::default());
        let log = log.unwrap_or_else(|line| panic!("{settings}: {line}"));
        assert_values(&log, &values, settings);
    }
    // Without names, it may be a row.
    let text = format!("Serial,17,rev,B\n{text}");
    let line = read_text(&text, &Options::default()).unwrap_err();
    assert!(
        line.contains("the first row mixes numbers and text"),
        "{line}"
    );
}

/// Gyroflow's log of motion has a step of the time in seconds and the sizes of counts in rad/s and in g above the names.
#[test]
fn the_scales_in_the_header_of_gyroflow_are_taken() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    for (time_step, scale) in [(0.001, 0.001), (0.000_02, 0.000_133), (1.0, 1.0)] {
        let mut text = format!(
            "GYROFLOW IMU LOG\nversion,1.3\nid,logger\norientation,YxZ\ntscale,{time_step}\ngscale,{scale}\nascale,0.0005\nt,gx,gy,gz,ax,ay,az\n"
        );
        let mut squares = 0.0;
        let mut last = None;
        for n in 0..400 {
            let [x, y, z] = [(); 3].map(|()| -> f64 {
                let value: f64 = StandardNormal.sample(&mut random);
                (20.0 * value).round()
            });
            let stamp = match time_step {
                1.0 => format!("{:.2}", 0.01 * f64::from(n)),
                step => format!("{}", (0.01 * f64::from(n) / step).round()),
            };
            writeln!(text, "{stamp},{x},{y},{z},1,2,2000").unwrap();
            squares += last.map_or(0.0, |last: f64| (scale * (x - last)).powi(2));
            last = Some(x);
        }
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!((log.rate_hz, log.unit), (100.0, Unit::RadiansPerSecond));
        assert_eq!((log.axes.len(), log.has_scale), (3, true));
        let octave = log.axes[0].accumulator.octave(0).unwrap();
        let sum = octave.sum.to_real() * log.axes[0].rate_per_count.powi(2);
        assert!((sum / squares - 1.0).abs() < 1e-9, "{time_step} {scale}");
        let words = format!("{scale} rad/s per count from the header of Gyroflow");
        assert!(log.notes[0].contains(&words), "{}", log.notes[0]);
    }
}
