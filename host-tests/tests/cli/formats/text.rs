//! Text as loggers write it, and the messages for what is not clear in it.

use super::{counts, read_text};
use allanite::Accumulator;
use allanite_log::{OCTAVES, Options};
use program::rows;
use std::fmt::Write as _;

fn rate(rate_hz: f64) -> Options {
    Options {
        rate_hz: Some(rate_hz),
        ..Options::default()
    }
}

/// Rows of three counts, joined by a separator.
fn rows(separator: &str) -> String {
    let rows = counts()
        .into_iter()
        .map(|row| row[..3].iter().map(i32::to_string).collect::<Vec<_>>());
    rows.fold(String::new(), |mut text, row| {
        let _ = writeln!(text, "{}", row.join(separator));
        text
    })
}

#[test]
fn the_same_rows_are_read_whatever_separates_them() {
    let expected = read_text(&rows(","), &rate(100.0)).unwrap();
    let texts = [
        rows(", "),
        rows(";"),
        rows("\t"),
        rows(" "),
        rows("   "),
        rows(" \t "),
        rows(",").replace('\n', ",\n"),
        rows(";").replace('\n', ",0\n").replace(';', ",0;"),
        rows(" ").replace('\n', " \r\n"),
        format!("gx gy gz\n{}", rows("  ")),
        format!(
            "a logger, version 2\nstarted: 12:00:00\n\ngx;gy;gz\n{}",
            rows(";")
        ),
        format!("gx,gy,gz\ndeg/s,deg/s,deg/s\n{}", rows(",")),
        format!("{}# the end\n", rows(",")),
    ];
    for text in texts {
        let log = read_text(&text, &rate(100.0)).unwrap_or_else(|line| panic!("{line}\n{text}"));
        assert_eq!(log.axes.len(), 3, "{text}");
        for (axis, expected) in log.axes.iter().zip(&expected.axes) {
            assert!(axis.accumulator == expected.accumulator, "{text}");
        }
    }
}

#[test]
fn comments_among_the_rows_are_gaps_or_refused() {
    let whole = rows(",");
    let lines: Vec<&str> = whole.lines().collect();
    let with = |comment: &str| {
        let (first, rest) = lines.split_at(20);
        format!(
            "gx,gy,gz\n{}\n{comment}\n{}\n",
            first.join("\n"),
            rest.join("\n")
        )
    };
    for comment in ["# lost 500 samples", "#dropped: 3", "# 12 samples missing"] {
        let log = read_text(&with(comment), &rate(100.0)).unwrap();
        let mut expected = Accumulator::<OCTAVES>::new();
        for (i, row) in counts().iter().enumerate() {
            if i == 20 {
                expected.gap();
            }
            expected.push(row[0]);
        }
        assert!(log.axes[0].accumulator == expected, "{comment}");
        let notes = log.notes.join("\n");
        assert!(notes.contains("a comment tells of"), "{notes}");
    }
    let log = read_text(&with("# lost 0 samples"), &rate(100.0)).unwrap();
    assert_eq!(log.axes[0].accumulator.gaps(), 0);
    for comment in ["# lost samples", "# 12:03 lost 5", "# door opened", "#"] {
        let line = read_text(&with(comment), &rate(100.0)).unwrap_err();
        let expected = "; remove it, or write `# lost N samples` if samples are missing there";
        assert!(
            line.starts_with("a.csv:22: a comment among the rows: ") && line.ends_with(expected),
            "{line}"
        );
    }
}

#[test]
fn the_reason_why_the_rate_is_not_known_is_named() {
    let numbered = |header: &str, first: &dyn Fn(usize) -> String| {
        let lines = counts()
            .into_iter()
            .enumerate()
            .map(|(i, row)| format!("{},{}\n", first(i), row[0]));
        format!("{header}{}", lines.collect::<String>())
    };
    for (text, expected) in rows! {
        rows(","), "there is no header, and no column rises as a time does";
        format!("gx,gy,gz\n{}", rows(",")), "none of the columns gx, gy, gz is named like a time";
        numbered("time,gx\n", &|_| "7".into()), "the values of time do not advance";
        numbered("time,gx\n", &|i| format!("{i}h")), "the values of time are neither numbers nor dates of ISO 8601";
        numbered("n,gx\n", &|i| i.to_string()), "n only counts rows, and no column is a time";
        numbered("tick,gx\n", &|i| (5 * i).to_string()), "no column is named like a time, though tick rises";
        numbered("", &|i| format!("{},{}", 5 * i, 7 * i)), "there is no header, and column 1, column 2 all rise as times do";
    } {
        let line = read_text(&text, &Options::default()).unwrap_err();
        let expected = format!(
            "a.csv: the sampling rate is not known: {expected}; \
             give it with --rate HZ, or name a column of time stamps with --time"
        );
        assert_eq!(line, expected);
    }
}

#[test]
fn angles_are_no_axes_and_constant_axes_do_not_stop_the_others() {
    let lines = counts()
        .into_iter()
        .map(|row| format!("{},{},{},5\n", row[0], row[1], row[2]));
    let lines: String = lines.collect();
    let text = format!("roll_deg,x_rate,y_rate,z_rate\n{lines}");
    let log = read_text(&text, &rate(100.0)).unwrap();
    let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["x_rate", "y_rate"]);
    let notes = log.notes.join("\n");
    assert!(
        notes.contains("axis z_rate never changes its value: left out"),
        "{notes}"
    );
    let choice = |column: &str| Options {
        columns: Some(vec![column.parse().unwrap()]),
        ..rate(100.0)
    };
    let line = read_text(&text, &choice("roll_deg")).unwrap_err();
    assert!(
        line.starts_with("a.csv: column roll_deg is an angle, not a rate; "),
        "{line}"
    );
    let line = read_text(&text, &choice("z_rate")).unwrap_err();
    assert!(
        line.starts_with("a.csv: axis z_rate never changes its value; "),
        "{line}"
    );
    let text = format!("gyro_rad[0],gyro_rad[1],gyro_rad[2],other\n{lines}");
    let log = read_text(&text, &choice("gyro_rad")).unwrap();
    let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["gyro_rad[0]", "gyro_rad[1]", "gyro_rad[2]"]);
}

#[test]
fn rows_of_several_sensors_are_not_mixed() {
    let lines = counts().into_iter().enumerate();
    let lines: String = lines
        .map(|(i, row)| format!("{},{},{}\n", 5000 * (i / 2), i % 2, row[0]))
        .collect();
    let line = read_text(&format!("TimeUS,I,GyrX\n{lines}"), &Options::default()).unwrap_err();
    assert_eq!(
        line,
        "a.csv: the rows are those of 2 sensors, by column I: \"0\", \"1\"; \
         keep those of one of them, such as with --rows I=0"
    );
}
