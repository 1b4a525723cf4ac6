//! A curve file holds all that a fit needs, to the bit, and impossible values are refused.

use allanite::course::Course;
use allanite_host::curve_file::{AxisCurve, CurveFile, FORMAT, VERSION};
use allanite_log::{Axis, Evidence, OCTAVES, SpectrumSums, unit::Unit};
use program::rows;
use std::{fs, path::Path};
use tempfile::TempDir;

/// The curve of some counts, with or without a gap.
fn curve(samples: u32, gap: bool) -> AxisCurve {
    let mut accumulator = allanite::Accumulator::<OCTAVES>::new();
    let (mut spectrum, mut course) = (SpectrumSums::new(), Course::new());
    let mut state = 1u32;
    for i in 0..samples {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let count = (state >> 8) as i32 - (1 << 23);
        accumulator.push(count);
        spectrum.push_slice(&[count]);
        course.push(count, []);
        if gap && i == samples / 3 {
            accumulator.gap();
            spectrum.gap();
            course.gap();
        }
    }
    let axis = Axis {
        zero: 0.0,
        spectrum,
        name: "gx".into(),
        rate_per_count: 0.05,
        accumulator,
        evidence: Some(Evidence {
            course: Some(course),
            ..Evidence::default()
        }),
    };
    AxisCurve::of(&axis, 100.0, Unit::DegreesPerSecond).unwrap()
}

fn file() -> CurveFile {
    let mut second = curve(100, true);
    second.axis = "gy".into();
    CurveFile::new(vec![curve(1000, false), second])
}

/// Reads the text and returns the file or the error message.
fn read(text: &str) -> Result<CurveFile, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("c.json");
    fs::write(&path, text).unwrap();
    CurveFile::read(&path).map_err(|failure| {
        let line = failure.to_string();
        assert!(!line.contains('\n') && line.contains("; "), "{line}");
        line.replace(&format!("{}/", folder.path().display()), "")
    })
}

#[test]
fn file_reads_back_to_the_bit() {
    let mut file = file();
    file.axes[0].source = Some("a bench".into());
    file.axes[0].licence = Some("CC0".into());
    let text = file.to_json().unwrap();
    assert!(text.contains(FORMAT) && text.contains(&format!("\"version\": {VERSION}")));
    let back = read(&text).unwrap();
    assert_eq!(back, file);
    for (axis, same) in file.axes.iter().zip(&back.axes) {
        assert_eq!(axis.curve().unwrap(), same.curve().unwrap());
        assert_eq!(axis.curve().unwrap().points().len(), axis.octaves.len());
    }
}

#[test]
fn sparse_levels_and_the_course_read_back_to_the_bit() {
    let curve = curve(2000, false);
    let file = CurveFile::new(vec![curve.clone()]);
    let back = read(&file.to_json().unwrap()).unwrap();
    let [same] = back.axes.as_slice() else {
        panic!("{} axes", back.axes.len());
    };
    let spectrum = same.spectrum().unwrap();
    assert_eq!(spectrum, curve.spectrum().unwrap());
    // The 250 blocks of 8 samples have 6 segments.
    assert_eq!((spectrum.bins().len(), spectrum.sparse().len()), (28, 28));
    let course = same.course().unwrap().unwrap();
    assert_eq!(Some(&course), curve.course().unwrap().as_ref());
    // 62 blocks of 32 samples are complete.
    assert_eq!((course.block(), course.blocks()), (32, 62));
    assert_eq!(course.densities().len(), 61);
}

#[test]
fn control_characters_in_names_become_blanks() {
    let mut file = file();
    file.axes[1].axis = "g\u{1b}[31m".into();
    assert_eq!(
        read(&file.to_json().unwrap()).unwrap().axes[1].axis,
        "g [31m"
    );
}

#[test]
fn sums_beyond_64_bits_keep_every_digit() {
    let mut accumulator = allanite::Accumulator::<OCTAVES>::new();
    for i in 0..400u32 {
        accumulator.push(if i / 8 % 2 == 0 { i32::MIN } else { i32::MAX });
    }
    let axis = Axis {
        zero: 0.0,
        spectrum: SpectrumSums::new(),
        name: "gx".into(),
        rate_per_count: 1e-9,
        accumulator,
        evidence: None,
    };
    let file = CurveFile::new(vec![
        AxisCurve::of(&axis, 8000.0, Unit::RadiansPerSecond).unwrap(),
    ]);
    assert!(
        file.axes[0]
            .octaves
            .iter()
            .any(|octave| octave.sum > u128::from(u64::MAX))
    );
    assert_eq!(read(&file.to_json().unwrap()).unwrap(), file);
}

#[test]
fn impossible_figures_are_refused_with_axis_and_octave() {
    type Change = fn(&mut CurveFile);
    let cases: [(Change, &str); 30] = rows! {
        |f| f.axes.clear(), "no axes";
        |f| f.axes[1].axis = "gx".into(), "two axes are named \"gx\"";
        |f| f.axes[1].axis.clear(), "axis 2 has no name";
        |f| f.axes[1].rate_hz = 0.0, "axis \"gy\": rate_hz 0 is impossible";
        |f| f.axes[1].rate_hz = -1.0, "axis \"gy\": rate_hz -1 is impossible";
        |f| f.axes[1].rate_per_count = -2.0, "axis \"gy\": rate_per_count -2 is impossible";
        |f| f.axes[1].rate_per_count = 1e300, "does not follow from the sum";
        |f| f.axes[1].rate_hz = 1e300, "axis \"gy\": rate_hz 1.000e300 is impossible";
        |f| f.axes[1].axis = "g".repeat(5000), "axis 2: the name";
        |f| f.axes[1].samples = u64::MAX, "18446744073709551615 samples are impossible";
        |f| f.axes[1].gaps = u64::MAX, "18446744073709551615 gaps in 100 samples are impossible";
        |f| f.axes[0].octaves.truncate(1), "axis \"gx\": a fit needs two octaves, and the file has 1";
        |f| f.axes[0].octaves[1].m = 3, "octave m = 3: the averaging factor is not a power of two";
        |f| f.axes[0].octaves[0].m = 0, "octave m = 0: averaging factors must ascend";
        |f| f.axes[0].octaves[2].m = 2, "octave m = 2: averaging factors must ascend";
        |f| f.axes[0].octaves[2].m = 1 << 30, "octave m = 1073741824: the averaging factor is not";
        |f| f.axes[0].octaves[2].tau_s *= 1.001, "octave m = 4: tau_s 0.04004";
        |f| f.axes[0].octaves[3].differences += 1, "octave m = 8: 494 differences of 1000 samples are impossible";
        |f| f.axes[0].samples -= 1, "octave m = 1: 999 differences of 999 samples are impossible";
        |f| f.axes[1].octaves[0].differences = 100,
            "axis \"gy\": octave m = 1: 100 differences of 100 samples are impossible";
        |f| f.axes[1].octaves[0].differences = 5, "5 differences of 100 samples are impossible";
        |f| f.axes[0].octaves[4].sum += f.axes[0].octaves[4].sum >> 20, "does not follow from the sum";
        |f| f.axes[0].octaves[4].variance *= -1.0, "does not follow from the sum";
        |f| f.axes[0].octaves[4].sum = u128::MAX,
            "octave m = 16: a sum of 340282366920938463463374607431768211455 is too large";
        |f| f.axes[0].course.as_mut().unwrap().block = 3,
            "axis \"gx\": course: a course of 62 blocks of 3 samples, or its densities, are impossible";
        |f| f.axes[0].course.as_mut().unwrap().blocks = 31, "course: a course of 31 blocks of 16 samples";
        |f| f.axes[0].course.as_mut().unwrap().densities.truncate(60), "course: a course of 62 blocks of 16 samples";
        |f| f.axes[0].course.as_mut().unwrap().densities[3] = -1.0, "course: a course of 62 blocks of 16 samples";
        |f| f.axes[0].course.as_mut().unwrap().block = 32, "course: the blocks are longer than the record";
        |f| f.axes[0].course.as_mut().unwrap().densities[3] = 1e300, "course: the densities contradict the octaves";
    };
    assert!(read(&file().to_json().unwrap()).is_ok());
    for (change, expected) in cases {
        let mut file = file();
        change(&mut file);
        let line = read(&file.to_json().unwrap()).unwrap_err();
        assert!(
            line.starts_with("c.json: ") && line.contains(expected),
            "{line}"
        );
        assert!(
            line.ends_with("; restore the file or measure the log again"),
            "{line}"
        );
    }
}

#[test]
fn text_that_is_not_a_curve_file_is_refused_with_its_line() {
    let good = file().to_json().unwrap();
    for (text, expected) in rows! {
        String::new(), "c.json:1: not a curve file: EOF";
        "{}".into(), "c.json:1: not a curve file: missing field `format`";
        "[1, 2]".into(), "c.json:1: not a curve file";
        good.replace(&format!("\"version\": {VERSION}"), "\"version\": 99"), "c.json: the format has version 99";
        good.replace(FORMAT, "another"), "c.json: the format is \"another\"";
        good.replacen("100.0", "NaN", 1), "c.json:7: not a curve file: expected value";
        good.replacen("100.0", "1e999", 1), "c.json:7: not a curve file: number out of range";
        good.replacen("\"samples\": 1000", "\"samples\": -1", 1), "c.json:10: not a curve file";
        good.replacen("deg/s", "furlong/s", 1), "c.json:8: not a curve file: unknown variant";
        good.replacen("gaps", "holes", 1), "c.json:11: not a curve file: unknown field `holes`";
        good.replacen("\"m\": 1,", "\"m\": 4294967297,", 1), "c.json:14: not a curve file";
        good[..good.len() / 2].into(), "not a curve file: EOF";
        format!("{good}{good}"), "not a curve file: trailing characters";
    } {
        let line = read(&text).unwrap_err();
        assert!(line.contains(expected), "{line}\nis not\n{expected}");
    }
}

#[test]
fn curve_files_of_real_gyros_are_complete_and_name_their_source() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data");
    for (name, samples, rate_hz) in [
        ("adis16405.json", 1_000_000, 100.0),
        ("mpu6050.json", 64_906, 99.32),
    ] {
        let file = CurveFile::read(&data.join(name)).unwrap();
        let names: Vec<_> = file.axes.iter().map(|axis| axis.axis.as_str()).collect();
        assert_eq!(names, ["gx", "gy", "gz"]);
        for axis in &file.axes {
            assert_eq!((axis.samples, axis.rate_hz), (samples, rate_hz));
            assert!(axis.source.is_some() && axis.licence.is_some());
        }
    }
}

#[test]
fn file_that_is_too_large_is_refused() {
    let folder = TempDir::new().unwrap();
    let huge = folder.path().join("huge.json");
    fs::write(&huge, vec![b' '; (1 << 24) + 1]).unwrap();
    let line = CurveFile::read(&huge).unwrap_err().to_string();
    assert!(
        line.contains("a curve file is smaller than 16 MiB"),
        "{line}"
    );
}
