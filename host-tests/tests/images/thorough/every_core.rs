//! The images on every core and the same computation on this host agree to the bit.

use crate::check::{
    agree_to_the_bit, finds_what_the_host_finds, has_no_path_to_a_panic, keeps_every_place, numbers,
};

use allanite::{Accumulator, Scale, course::Course};
use allanite_host::curve_file::{AxisCurve, CurveFile};
use allanite_log::{Axis, Evidence, SpectrumSums, unit::Unit};
use demonstration::{
    AMPLITUDES,
    diagnose::{HIDDEN, Hidden},
    lines,
    simulated::SimulatedGyro,
    stream::SEED,
};
use program::command;
use rayon::prelude::*;
use std::{
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};
use xtask::{
    firmware::{CORES, CORTEX_M4F, Core, Image, Precision, RISCV, agreement, run},
    watch::Watched,
};

#[test]
fn every_core_and_the_host_agree_to_the_bit() {
    let cores: Vec<Core> = Core::all().collect();
    cores.par_iter().for_each(agree_to_the_bit);
}

#[test]
fn a_whole_product_finds_in_double_precision_what_the_host_finds_to_the_bit() {
    finds_what_the_host_finds(&CORTEX_M4F.with(Precision::Double));
}

#[test]
fn an_interrupt_at_any_instruction_of_the_receiver_loses_no_sample_without_its_place() {
    [CORES[0], CORTEX_M4F, RISCV]
        .iter()
        .for_each(keeps_every_place);
}

#[test]
fn interrupted_watch_of_an_image_saves_the_curve_of_what_the_image_sent() {
    let folder = tempfile::tempdir().expect("a folder");
    let curve = folder.path().join("curve.json");
    for milliseconds in [0, 137, 611] {
        let watch = ["watch", "--rate", "100", "--axes", "image"];
        let mut watch = command(folder.path(), &watch);
        watch
            .args(["--save-every", "0.2", "--output"])
            .arg(&curve)
            .stdout(Stdio::null());
        let mut watched = Watched::start(&mut watch).expect("the image and the command line");
        let watch = &mut watched.watch;
        let begun = Instant::now();
        while !curve.exists() {
            assert!(watch.try_wait().is_ok_and(|status| status.is_none()));
            assert!(
                begun.elapsed().as_secs() < 300,
                "no curve was saved in time"
            );
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(Duration::from_millis(milliseconds));
        let kill = format!("kill -INT {}", watch.id());
        assert!(
            Command::new("sh")
                .args(["-c", &kill])
                .status()
                .is_ok_and(|status| status.success())
        );
        assert!(watch.wait().is_ok_and(|status| status.success()));

        let saved = CurveFile::read(&curve).expect("a curve");
        let samples = saved.axes[0].samples;
        let mut accumulator = Accumulator::new();
        let (mut spectrum, mut course) = (SpectrumSums::new(), Course::new());
        for count in SimulatedGyro::new(AMPLITUDES, SEED).take(samples as usize) {
            accumulator.push(count);
            spectrum.push_slice(&[count]);
            course.push(count, []);
        }
        let axis = Axis {
            zero: 0.0,
            spectrum,
            name: "image".to_owned(),
            rate_per_count: 1.0,
            accumulator,
            evidence: Some(Evidence {
                course: Some(course),
                ..Evidence::default()
            }),
        };
        let sent = AxisCurve::of(&axis, 100.0, Unit::DegreesPerSecond).expect("a curve");
        assert!(samples > 100, "{samples}");
        assert_eq!(saved.axes, [sent], "after {samples} samples");
        std::fs::remove_file(&curve).expect("a file");
    }
}

/// Images without any panic, so that the linker finds no path to one.
const PANIC_FREE: [&str; 9] = [
    "footprint_nothing",
    "footprint_accumulator",
    "footprint_five_terms",
    "footprint_self_test",
    "footprint_fit",
    "footprint_diagnosis",
    "footprint_spectrum",
    "footprint_everything",
    "footprint_words",
];

/// Those of them whose arithmetic `footprint_everything` does too: they are not built with checks, which takes a minute each.
const IN_EVERYTHING: [&str; 5] = [
    "footprint_nothing",
    "footprint_accumulator",
    "footprint_fit",
    "footprint_diagnosis",
    "footprint_spectrum",
];

#[test]
fn images_have_no_path_to_a_panic_with_and_without_checked_arithmetic() {
    for name in PANIC_FREE {
        for profile in ["firmware", "checked"] {
            if profile == "checked" && IN_EVERYTHING.contains(&name) {
                continue;
            }
            for core in Precision::ALL.map(|precision| CORTEX_M4F.with(precision)) {
                has_no_path_to_a_panic(name, &core, profile);
            }
        }
    }
}

#[test]
fn image_finds_hidden_effects_as_the_host_does_to_the_bit() {
    for precision in Precision::ALL {
        let core = CORTEX_M4F.with(precision);
        for Hidden { case, effect, .. } in HIDDEN {
            let told = |lines: Result<Vec<String>, anyhow::Error>| {
                lines.unwrap_or_else(|error| panic!("{core}, {case}: {error:#}"))
            };
            let there = told(agreement::told(&core, "hidden_effect", &[case]));
            println!("{core}, {case}\n{}", there.join("\n"));
            let here = told(agreement::told_here(precision, "hidden_effect", &[case]));
            assert_eq!(agreement::first_difference(&here, &there), None, "{core}");

            let after = |start: &str| -> Vec<&str> {
                let lines = there.iter().filter_map(|line| line.strip_prefix(start));
                lines.filter_map(|rest| rest.split(' ').next()).collect()
            };
            assert_eq!(after("verdict "), ["Improved"]);
            assert_eq!(
                (after("added "), after("ambiguous ")),
                (vec![effect], vec![]),
                "{case}"
            );
            let errors: Vec<f64> = there.iter().filter_map(|line| chi_squared(line)).collect();
            let (first, last) = (errors[0], errors[errors.len() - 1]);
            assert!(last < 0.3 * first, "{case}: {errors:?}");
        }
    }
}

/// The χ² in a line about a fit.
fn chi_squared(line: &str) -> Option<f64> {
    let (_, rest) = line.split_once(" chi_squared ")?;
    rest.split(' ').next()?.parse().ok()
}

#[test]
fn samples_that_a_late_main_loop_loses_are_counted_and_become_gaps() {
    for core in [CORES[0], CORTEX_M4F, RISCV].map(|core| core.with(Precision::Double)) {
        println!("{core}");
        let run = Image::build_for("interrupt", &core).and_then(|image| run(&image));
        let run = run.unwrap_or_else(|error| panic!("{error:#}"));
        println!("{}", run.lines.join("\n"));
        assert!(run.status.success(), "the image ended with {}", run.status);
        let told = |kind: &str| -> Vec<&str> {
            let start = format!("info {kind} ");
            let lines = run.lines.iter();
            lines.filter_map(|line| line.strip_prefix(&start)).collect()
        };
        let [record, total] = ["record", "total"].map(|kind| told(kind)[0]);
        let [seed, octaves] = numbers(record, ["seed", "octaves"]);
        let [made, taken, lost] = numbers(total, ["made", "taken", "lost"]);
        assert_eq!(taken + lost, made);

        // The host replays the same record, and loses what the image lost.
        let mut gyro = SimulatedGyro::new(AMPLITUDES, seed.into());
        let mut accumulator = Accumulator::<12>::new();
        assert_eq!(octaves, 12);
        let (mut taken_here, mut lost_here) = (0, 0);
        let gaps = told("gap");
        for line in &gaps {
            let [after, lost] = numbers(line, ["after", "lost"]);
            for count in gyro.by_ref().take((after - taken_here) as usize) {
                accumulator.push(count);
            }
            accumulator.lost(lost.into());
            gyro.by_ref().take(lost as usize).for_each(drop);
            (taken_here, lost_here) = (after, lost_here + lost);
        }
        for count in gyro.take((taken - taken_here) as usize) {
            accumulator.push(count);
        }
        // The losses are failed reads, overflows of the queue, and lost samples at the end that no
        // later sample reveals.
        assert!(gaps.len() >= 5 && lost_here > 400, "{gaps:?}");
        assert!(
            lost_here + 100 < lost,
            "{lost_here} of {lost} before the end"
        );
        let curve = accumulator.curve(Scale::new(1.0 / 131.0, 100.0).unwrap());
        let mut here = Vec::new();
        lines::curve(&curve, |line| here.push(format!("info {line}")));
        let octaves = run.lines.iter();
        let there = octaves.filter(|line| line.starts_with("info octave"));
        assert!(there.eq(&here), "{:?}, here {here:?}", run.lines);
    }
}
