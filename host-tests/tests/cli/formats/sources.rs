//! Rows of several sensors, columns that are no rates, and stamps of a coarse clock: told, and not read as something else.

use super::{read_text, try_read};
use allanite::Accumulator;
use allanite_log::{Log, OCTAVES, Options, TimeUnit, unit::Unit};
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fmt::Write as _, fs, sync::Arc};
use tempfile::TempDir;

/// White noise with six decimals.
fn noise(random: &mut Xoshiro256PlusPlus) -> String {
    let value: f64 = StandardNormal.sample(random);
    format!("{:.6}", 0.05 * value)
}

fn refused(text: &str) -> String {
    read_text(text, &Options::default()).unwrap_err()
}

#[test]
fn rows_of_sensors_that_a_column_names_are_not_one_gyro_of_twice_the_rate() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for (header, names) in [
        ("SensorId,time_s,gx,gy,gz", ["1", "2"]),
        ("device_id,time_s,gx,gy,gz", ["7", "9"]),
        ("imu,time_s,gx,gy,gz", ["0", "1"]),
        ("sensor,time_s,x,y,z", ["ACC", "GYR"]),
        ("frame_id,time_s,gx,gy,gz", ["left", "right"]),
        ("Name,time_s,gx,gy,gz", ["imu_a", "imu_b"]),
    ] {
        // One after the other, in blocks, and at random.
        for order in 0..3 {
            let mut text = format!("{header}\n");
            for n in 0..120 {
                let which = match order {
                    0 => n % 2,
                    1 => n / 5 % 2,
                    _ => random.random_range(0..2),
                };
                let [x, y, z] = [(); 3].map(|()| noise(&mut random));
                writeln!(
                    text,
                    "{},{:.2},{x},{y},{z}",
                    names[which],
                    f64::from(n as u32 / 2) / 100.0
                )
                .unwrap();
            }
            let line = refused(&text);
            let (name, _) = header.split_once(',').unwrap();
            let [one, other] = names;
            let expected = format!(
                "a.csv: the rows are those of 2 sensors, by column {name}: \"{one}\", \"{other}\"; \
                 keep those of one of them, such as with --rows {name}={one}"
            );
            assert_eq!(line, expected);
        }
    }
}

#[test]
fn labels_of_what_is_done_and_numbers_that_stay_are_no_sensors() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    for header in ["label,time_s,gx", "device_id,time_s,gx", "status,time_s,gx"] {
        let mut text = format!("{header}\n");
        for n in 0..200 {
            let mark = match header.split(',').next() {
                Some("label") => ["rest", "walk"][n / 150],
                Some("device_id") => "3",
                _ => ["0", "1"][n % 2],
            };
            writeln!(
                text,
                "{mark},{:.2},{}",
                n as f64 / 100.0,
                noise(&mut random)
            )
            .unwrap();
        }
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!(log.rate_hz, 100.0, "{header}");
    }
}

/// The rows that are kept are those of a log that has no others, whatever tells them apart.
#[test]
fn rows_of_one_sensor_are_kept() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    for (header, names) in [
        ("SensorId,time_s,gx,gy,gz", ["1", "2"]),
        ("sensor,time_s,x,y,z", ["ACC", "GYR"]),
        ("", ["acc", "gyro"]),
    ] {
        let (mut mixed, mut alone) = (format!("{header}\n"), format!("{header}\n"));
        for n in 0..400 {
            let name = names[n % 2];
            let [x, y, z] = [(); 3].map(|()| noise(&mut random));
            let row = format!("{name},{:.2},{x},{y},{z}\n", (n / 2) as f64 / 100.0);
            mixed += &row;
            if name == names[1] {
                alone += &row;
            }
        }
        let column = header.split_once(',').map_or("1", |(column, _)| column);
        let options = |name: &str| Options {
            rows: Some(format!("{column}={name}").parse().unwrap()),
            ..Options::default()
        };
        let kept = read_text(&mixed, &options(names[1])).unwrap();
        let alone = read_text(&alone, &Options::default()).unwrap();
        assert_eq!((kept.rate_hz, kept.axes.len()), (100.0, 3), "{header}");
        for (one, other) in kept.axes.iter().zip(&alone.axes) {
            assert!(one.accumulator == other.accumulator, "{header}");
            assert_eq!((&one.name, one.accumulator.samples()), (&other.name, 200));
        }
        let line = read_text(&mixed, &options("3")).unwrap_err();
        let expected = format!("a.csv: no row has \"3\" in column \"{column}\"; ");
        assert!(line.starts_with(&expected), "{line}");
    }
    for wrong in ["gyro", "=gyro", "sensor="] {
        assert!(wrong.parse::<allanite_log::RowChoice>().is_err(), "{wrong}");
    }
}

#[test]
fn increments_of_an_angle_are_no_rates_until_they_are_scaled() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    for header in [
        "time_s,dtheta_x (rad),dtheta_y (rad),dtheta_z (rad)",
        "time_s,X_DELTANG,Y_DELTANG,Z_DELTANG",
        "time_s,delta_angle[0],delta_angle[1],delta_angle[2]",
        "time_s,DeltaAngle_x (rad),DeltaAngle_y (rad),DeltaAngle_z (rad)",
    ] {
        let mut text = format!("{header}\n");
        for n in 0..100 {
            let [x, y, z] = [(); 3].map(|()| noise(&mut random));
            writeln!(text, "{:.2},{x},{y},{z}", f64::from(n) / 100.0).unwrap();
        }
        let line = refused(&text);
        assert!(
            line.contains("has increments of an angle, and no rates; give as --scale"),
            "{line}"
        );
        let scaled = Options {
            scale: Some(100.0),
            unit: Some(Unit::RadiansPerSecond),
            ..Options::default()
        };
        let log = read_text(&text, &scaled).unwrap();
        assert_eq!((log.axes.len(), log.rate_hz), (3, 100.0));
    }
}

#[test]
fn a_curve_of_deviations_is_no_log() {
    let curve = |names: &str, factor: f64| {
        let mut text = format!("{names}\n");
        for n in 0..40 {
            let tau = 0.01 * factor.powi(n);
            writeln!(text, "{tau:.6},{:.6}", 0.005 / tau.sqrt()).unwrap();
        }
        text
    };
    let told = Options {
        rate_hz: Some(100.0),
        ..Options::default()
    };
    for (names, factor) in [
        ("tau_s,adev_dps", 1.3),
        ("Averaging time (s),Allan deviation (deg/s)", 1.2),
        ("time_s,gx", 1.5),
        ("", 1.3),
    ] {
        for options in [Options::default(), told.clone()] {
            let line = read_text(&curve(names, factor), &options).unwrap_err();
            assert_eq!(
                line,
                "a.csv: this is a curve of deviations over averaging times, not a log of samples; give the log that it was computed from"
            );
        }
    }
}

/// The samples and the rate of a log whose stamps are cut to whole milliseconds.
fn cut_to_milliseconds(rate_hz: f64, phase: f64, scatter_ms: f64, rows: u32) -> Log {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut text = String::from("millis,gx\n");
    for n in 0..rows {
        let scatter = scatter_ms * random.random_range(-1.0..1.0);
        let stamp = (1000.0 * f64::from(n) / rate_hz + phase + scatter).floor();
        writeln!(text, "{stamp},{}", noise(&mut random)).unwrap();
    }
    let options = Options {
        time_unit: Some(TimeUnit::Ms),
        ..Options::default()
    };
    read_text(&text, &options).unwrap_or_else(|line| panic!("{rate_hz}: {line}"))
}

#[test]
fn whole_milliseconds_lose_no_sample_of_a_sensor_with_another_rate() {
    for rate_hz in [
        562.5, 640.0, 667.0, 833.0, 909.0, 952.0, 960.0, 988.0, 994.0, 1006.0, 1012.0, 1040.0,
        1100.0, 1125.0,
    ] {
        for phase in [0.0, 0.37, 0.81] {
            let log = cut_to_milliseconds(rate_hz, phase, 0.0, 4000);
            assert!(
                (log.rate_hz / rate_hz - 1.0).abs() < 1e-3,
                "{rate_hz}: {}",
                log.rate_hz
            );
            let accumulator: &Accumulator<OCTAVES> = &log.axes[0].accumulator;
            assert_eq!(
                (accumulator.samples(), accumulator.gaps()),
                (4000, 0),
                "{rate_hz}"
            );
            assert!(accumulator.bridged().is_empty(), "{rate_hz}");
        }
    }
}

#[test]
fn whole_milliseconds_of_stamps_that_scatter_lose_no_sample() {
    for rate_hz in [930.0, 949.7, 975.0, 1030.0, 1060.0] {
        for scatter_ms in [0.1, 0.3] {
            let log = cut_to_milliseconds(rate_hz, 0.4, scatter_ms, 20_000);
            let rate = log.rate_hz;
            assert!((rate / rate_hz - 1.0).abs() < 1e-3, "{rate_hz}: {rate}");
            let accumulator: &Accumulator<OCTAVES> = &log.axes[0].accumulator;
            let counted = (accumulator.samples(), accumulator.gaps());
            assert_eq!(counted, (20_000, 0), "{rate_hz}, {scatter_ms}");
        }
    }
}

#[test]
fn samples_that_are_lost_at_random_are_still_lost() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    let mut text = String::from("millis,gx\n");
    let mut rows = 0;
    for n in 0..4000 {
        if random.random_range(0..20) > 0 {
            writeln!(text, "{n},{}", noise(&mut random)).unwrap();
            rows += 1;
        }
    }
    let log = read_text(
        &text,
        &Options {
            time_unit: Some(TimeUnit::Ms),
            ..Options::default()
        },
    );
    let log = log.unwrap();
    assert_eq!(
        (log.rate_hz, log.axes[0].accumulator.samples()),
        (1000.0, rows)
    );
    assert!(!log.axes[0].accumulator.bridged().is_empty());
}

#[test]
fn a_log_that_begins_within_a_second_has_the_rate_of_its_whole_seconds() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    for (first, rate) in [(37, 100), (3, 50), (90, 95)] {
        let mut text = String::from("timestamp,gx\n");
        for n in 0..8 * rate {
            let second = 1_700_000_000 + (n + rate - first) / rate;
            writeln!(text, "{second},{}", noise(&mut random)).unwrap();
        }
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!(log.rate_hz, f64::from(rate));
    }
}

#[test]
fn hours_minutes_and_seconds_in_one_number_are_told() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(8);
    let mut text = String::from("utc_time,gx\n");
    for n in 0..2000_u32 {
        let (minute, second) = (
            59 + n / 1000,
            f64::from(n % 1000) / 50.0 + 40.0 * f64::from(n < 1000),
        );
        let hour = 12 + minute / 60;
        writeln!(
            text,
            "{:02}{:02}{second:06.3},{}",
            hour,
            minute % 60,
            noise(&mut random)
        )
        .unwrap();
    }
    let line = refused(&text);
    assert!(
        line.contains("as hours, minutes and seconds in one number do; "),
        "{line}"
    );
}

#[test]
fn an_accelerometer_that_feels_one_unit_of_gravity_is_in_g() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    for (gravity, unit) in [
        (1.0, Unit::StandardGravity),
        (9.81, Unit::MetresPerSecondSquared),
    ] {
        let mut text = String::from("time_s,ax,ay,az\n");
        for n in 0..200 {
            let [x, y, z] = [0.0, 0.0, gravity].map(|mean| {
                let value: f64 = StandardNormal.sample(&mut random);
                mean + 0.002 * value
            });
            writeln!(text, "{:.2},{x:.5},{y:.5},{z:.5}", f64::from(n) / 100.0).unwrap();
        }
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!(log.unit, unit);
    }
}

#[test]
fn axes_as_a_dictionary_and_as_runs_and_a_time_as_a_duration_are_read() {
    use arrow::{
        array::{
            ArrayRef, DictionaryArray, DurationMillisecondArray, Float64Array, Int32Array,
            RecordBatch, RunArray,
        },
        datatypes::Int32Type,
        ipc::writer::FileWriter,
    };
    let mut random = Xoshiro256PlusPlus::seed_from_u64(10);
    let mut values = || -> Vec<f64> {
        let draw = |_| StandardNormal.sample(&mut random);
        (0..200).map(draw).collect::<Vec<f64>>()
    };
    let keys = Int32Array::from_iter_values((0..200).map(|n| n * 7 % 200));
    let x = DictionaryArray::<Int32Type>::new(keys, Arc::new(Float64Array::from(values())));
    // Runs of one to three equal values.
    let ends = (0..100).map(|n| 2 * n + 1 + n % 2);
    let levels = Float64Array::from_iter_values(values().into_iter().take(100));
    let y = RunArray::try_new(&Int32Array::from_iter_values(ends), &levels).unwrap();
    let time = DurationMillisecondArray::from_iter_values((0..200).map(|n| 5 * n));
    let batch = RecordBatch::try_from_iter([
        ("time", Arc::new(time) as ArrayRef),
        ("gyro_x", Arc::new(x)),
        ("gyro_y", Arc::new(y)),
        ("gyro_z", Arc::new(Float64Array::from(values()))),
    ])
    .unwrap();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.arrow");
    let mut writer =
        FileWriter::try_new(fs::File::create(&path).unwrap(), &batch.schema()).unwrap();
    writer.write(&batch).unwrap();
    writer.finish().unwrap();
    let log = try_read(&path, &Options::default()).unwrap();
    let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(
        (names.as_slice(), log.rate_hz),
        (&["gyro_x", "gyro_y", "gyro_z"][..], 200.0)
    );
}

/// Columns of noise, of velocities or angles, which are sums of it, and of an accelerometer whose last axis feels gravity.
fn bare(kinds: &[&str]) -> String {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(8);
    let mut sums = [[0.6_f64, -0.778, 0.573]; 2];
    let mut text = String::new();
    for row in 0..600 {
        write!(text, "{:.3}", 12.5 + f64::from(row) / 200.0).unwrap();
        for (kind, sums) in kinds.iter().zip(&mut sums) {
            for (axis, sum) in sums.iter_mut().enumerate() {
                let white: f64 = StandardNormal.sample(&mut random);
                *sum += 2e-4 * white;
                let value = match *kind {
                    "rate" => 0.004 * white,
                    "force" if axis == 2 => 9.81 + 0.02 * white,
                    "force" => 0.02 * white,
                    _ => *sum,
                };
                write!(text, ",{value:.6}").unwrap();
            }
        }
        text.push('\n');
    }
    text
}

#[test]
fn velocities_beside_rates_neither_feel_gravity_nor_take_an_axis() {
    for kinds in [["rate", "velocity"], ["rate", "force"]] {
        let log = read_text(&bare(&kinds), &Options::default()).unwrap();
        let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
        assert_eq!(names, ["gx", "gy", "gz"], "{kinds:?}");
    }
}

#[test]
fn three_angles_without_a_name_are_no_rates() {
    let expected = "a.csv: column 2, column 3, column 4 hardly change from row to row, as angles do and the rates of a sensor at \
                    rest do not; give rates, or --columns gx=2,gy=3,gz=4 if they are";
    assert_eq!(refused(&bare(&["angle"])), expected);
    read_text(&bare(&["rate"]), &Options::default()).unwrap();
}

/// Two sensors in one table, of which each has rows of its own.
#[test]
fn the_gyro_is_found_beside_an_accelerometer_whose_name_is_known() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut text = "t_s,pqr[0],pqr[1],pqr[2],acc[0],acc[1],acc[2]\n".to_owned();
    for n in 0..400 {
        let [x, y, z] = [(); 3].map(|()| noise(&mut random));
        match n % 2 {
            0 => writeln!(text, "{:.4},{x},{y},{z},,,", f64::from(n) / 200.0).unwrap(),
            _ => writeln!(text, "{:.4},,,,{x},{y},9.8{z}", f64::from(n) / 200.0).unwrap(),
        }
    }
    let log = read_text(
        &text.replace("9.8-", "9.8").replace("9.80.", "9.80"),
        &Options::default(),
    );
    let log = log.unwrap();
    assert_eq!(log.axes[0].name, "pqr[0]");
    assert!((log.rate_hz - 100.0).abs() < 0.1, "{}", log.rate_hz);
}
