//! Bad logs of text.

use super::case::{Case, refused};
use flate2::{Compression, write::GzEncoder};
use program::rows;
use std::{fmt::Write as _, io::Write as _};

/// Numbers that look like white noise and are the same in every run.
pub(crate) fn noise() -> impl Iterator<Item = i64> {
    let mut state = 1_u32;
    std::iter::from_fn(move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        Some(i64::from(state >> 20) - 2048)
    })
}

/// Rows of three columns.
fn rows(count: usize) -> String {
    let mut noise = noise();
    (0..count).fold(String::new(), |mut text, _| {
        let [x, y, z] = [(); 3].map(|()| noise.next().unwrap());
        let _ = writeln!(text, "{x},{y},{z}");
        text
    })
}

/// A good log.
pub(crate) fn good(count: usize) -> String {
    format!(
        "# rate_hz=100 unit=deg/s scale=0.01\ngx,gy,gz\n{}",
        rows(count)
    )
}

/// A log of one axis with these stamps.
fn stamped(header: &str, stamps: impl IntoIterator<Item = i64>) -> String {
    let rows = stamps.into_iter().zip(noise());
    rows.fold(format!("{header}\n"), |mut text, (stamp, count)| {
        let _ = writeln!(text, "{stamp},{count}");
        text
    })
}

fn regular(header: &str, step: i64) -> String {
    stamped(header, (0..300).map(|i: i64| i.saturating_mul(step)))
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub(crate) fn cases() -> Vec<Case> {
    let good = good(60);
    // A row in nine without a sample is too many.
    let short = self::good(8);
    let after = |row: &str| format!("{short}{row}\n");
    let named = |header: &str| format!("# rate_hz=100\n{header}\n{}", rows(60));
    let said = |comment: &str| format!("# {comment}\ngx,gy,gz\n{}", rows(60));
    let lost = (0..3000)
        .filter(|i| i * i % 1009 % 10 > 2)
        .map(|i| 10_000 * i);
    let levels = (0..600).zip(noise()).map(|(i, count)| {
        let gap = if i < 300 { 0 } else { 1_000_000_000 };
        let level = if i < 300 { 0.0 } else { 2f64.powi(30) };
        format!("{},{}\n", 5000 * i + gap, level + count as f64 * 1e-5)
    });
    let wide = |columns: usize| {
        let header: Vec<String> = (0..columns).map(|i| format!("g{i}")).collect();
        let row = vec!["1"; columns].join(",");
        format!(
            "# rate_hz=9\n{}\n{}",
            header.join(","),
            format!("{row}\n").repeat(12)
        )
    };
    let not_a_number = "a.csv:11: axis gy: \"two\" is not a number; correct it or choose other columns with --columns";
    let constant = "a.csv: axis gx never changes its value; check the sensor, or choose other columns with --columns";
    let too_wide = "a.csv: axis gx: the range of its values is too wide or too narrow for floats; \
                    scale the values or remove the outliers";
    let mixed = "a.csv:2: the first row mixes numbers and text such as \"gx\"; make it a header of names only, or correct it";
    let twice = "a.csv: two columns are named \"b\"; tell them apart by number, such as --columns gx=1,gy=2";
    let no_header = "a.csv: the sampling rate is not known: there is no header, and no column rises as a time does; \
                     give it with --rate HZ, or name a column of time stamps with --time";
    let no_time = "a.csv: the sampling rate is not known: none of the columns gx is named like a time; \
                   give it with --rate HZ, or name a column of time stamps with --time";
    let texts: Vec<(String, &str)> = table! {
        String::new() => "a.csv: the file is empty; record some samples";
        "\n\n".into() => "no rows";
        "# nothing\n# here\n".into() => "a.csv: no rows; record some samples";
        "\u{feff}".into() => "the file is empty";
        "# rate_hz=9\ngx,gy\n".into() => "a.csv: no rows; record some samples";
        "# rate_hz=9\ngx\n1\n2\n".into() => "a.csv: 2 samples are too few: two octaves need 9; record longer";
        after("1,2") => "a.csv:11: 2 values where the first row has 3; correct the row or cut the record there";
        after("1,2,3,4") => "a.csv:11: 4 values where the first row has 3; correct the row or cut the record there";
        after("1") => "1 value where the first row has 3";
        after("1,two,3") => not_a_number;
        short.replace('\n', "\r\n\r\n\r\n") + "1,two,3\r\n" => "a.csv:31: axis gy: \"two\" is not a number; ";
        format!("# rate_hz=9\n\"gx\",\"gyro\ny\",\"gz\"\n{}\"1\",two,3", rows(8)) => "a.csv:12: axis gyro y: \"two\" is not a number; ";
        after("1,0x10,3") => "\"0x10\" is not a number";
        after("1,1_000,3") => "\"1_000\" is not a number";
        after("1,--1,3") => "\"--1\" is not a number";
        after("1,1e,3") => "\"1e\" is not a number";
        after("1,\u{1b}[31m,3") => "is not a number";
        after("1,nan,3") => "a.csv:11: axis gy: \"nan\" is not a finite number; cut the record there or remove the value";
        after("inf,2,3") => "\"inf\" is not a finite number";
        after("1,2,-inf") => "a.csv:11: axis gz: \"-inf\" is not a finite number";
        after("1e999,2,3") => "a.csv:11: axis gx: \"1e999\" is not a finite number";
        after("1,,3") => "a.csv:11: axis gy: a value is missing; cut the record there or fill it in";
        after(",,") => "a value is missing";
        after("1,\"2,3") => "where the first row has 3";
        after(&format!("1,\"2\n{}", rows(100_000))) => "a.csv:11: a row is longer than 1024 KiB; look for a quote that is never closed";
        after("\0\0\0") => "this is not text";
        "# rate_hz=9\ngx\n".to_owned() + &"5\n".repeat(50) => constant;
        "# rate_hz=9\ngx\n".to_owned() + &"0.5\n".repeat(50) => constant;
        "# rate_hz=9\ngx\n-1e308\n1e308\n".to_string() + "1e308\n-1e308\n" => too_wide;
        "# rate_hz=9\ngx\n1e9\n".to_owned() + &"0.1\n0.2\n".repeat(50) => "2^-30 of the range";
        format!("time_us,gx [deg/s]\n{}", levels.collect::<String>()) => "2^-30 of the range";
        format!("# {}\n{good}", "x".repeat(70_000)) => "a line has 64 KiB or more";
        "x".repeat(1 << 20) => "a.csv:1: a line has 64 KiB or more; check that the file is text";
        "1;2,5\n2;3,5\n".repeat(30) => "the sampling rate is not known";
        named("gx,7,gz") => mixed;
        format!("7,8\n{good}") => "2 values where the rows below have 3";
        "only words\n".repeat(1 << 20) => "the sampling rate is not known";
        "# words\n".repeat(1 << 20) => "no rows";
        "1 2;3,4\t5 ".repeat(5000) + "\n" => "columns, more than 256";
        after("# door opened\n1,2,3") => "a comment among the rows";
        // What is kept of the rows behind a long one is no longer than they are.
        format!("{}{}1\n{}# door opened\n1,2,3\n", self::good(20), "1,".repeat(30_000), rows(2000)) => "a comment among the rows";
        after("# lost 99999999999999999999999 samples\n1,2,3") => "a comment among the rows";
        after("# \u{1b}[2J\n1,2,3") => "a comment among the rows";
        "H Product:Blackbox\n".into() => "no log with numbers";
        "a\0b,c\n".into() => "not text";
        regular("time_us,roll_deg", 5000) => "none of 2 columns looks like an axis";
        named("a,b,b") => twice;
        named("a,\u{1b}[2J,\u{1b}[2J") => "two columns are named";
        "# rate_hz=9\na,b\n".to_owned() + &"x,y\n".repeat(30) => "none of 2 columns looks like an axis";
        wide(257) => "257 columns, more than 256";
        wide(30_000) => "KiB or more";
        "1,".repeat(20_000) + "1\n" => "20001 columns, more than 256";
        wide(200) => "200 axes, more than 64";
        said("rate_hz=0") => "a.csv:1: rate_hz=\"0\" is not a positive, finite number";
        said("rate_hz=NaN") => "is not a positive, finite number";
        said("rate_hz=fast") => "is not a positive, finite number";
        said("rate_hz=1e300") => "rate_hz=1.000e300 is impossible";
        said("rate_hz=100 scale=-1") => "scale=\"-1\" is not a positive, finite number";
        said("rate_hz=100 scale=1e300") => "scale=1.000e300 is impossible";
        said("rate_hz=100 unit=furlong") => "unit=\"furlong\" is not one of";
        said("nothing") => "the sampling rate is not known";
        rows(60) => no_header;
        "gx\n1\n2\n4\n".into() => no_time;
        regular("t,gx", 1) => "it may be s (1 Hz) or ms (1000 Hz)";
        regular("t [min],gx", 1) => "the unit \"min\" is not known";
        stamped("time_us,gx", (0..300).chain([7]).map(|i| i * 5000)) => "time stamps go back";
        stamped("time_us,gx", lost) => "rows are missing";
        stamped("time_us,gx", (0..300).map(|_| 5)) => "the sampling rate is not known";
        regular("time_us,gx [rpm]", 5000) => "the unit \"rpm\" is not known";
        regular("time_us,gyro_rpm_x", 5000) => "the unit \"rpm\" is not known";
        format!("# rate_hz=9 unit=rad/s\ngx [deg/s]\n{}", "1\n2\n".repeat(9)) => "but the columns are named in deg/s";
        named("gx [deg/s],gy [rad/s],gz [deg/s]") => "have different units";
    };
    let commands: Vec<((&str, String), &str)> = table! {
        ("fit --rate 50", regular("time_us,gx", 5000)) => "the time stamps of time_us give 200 Hz";
        ("fit --sensor accel", named("gx,gy,gz")) => "no column is named like an axis of a accelerometer";
        ("fit --rate 9 --columns gx", rows(60)) => "there is no column \"gx\"; there is no header: choose by number from 1 to 3";
        ("fit --rate 9 --columns 0", rows(60)) => "there is no column \"0\"; there is no header: choose by number from 1 to 3";
        ("fit --scale 1e6", good.clone()) => "is impossible for a gyro at rest";
        ("diagnose --covariates gx", good.clone()) => "is an axis";
        ("diagnose --covariates t,t", named("gx,t,gz")) => "is named twice";
        ("diagnose --covariates none", good.clone()) => "there is no column \"none\"";
    };
    let mut cases: Vec<Case> = commands
        .into_iter()
        .map(|((command, text), expected)| {
            refused("a.csv", text, &format!("{command} a.csv"), expected)
        })
        .collect();
    for (text, expected) in texts {
        // Of a longer text, the compression alone may be refused.
        if (1..4000).contains(&text.len()) && expected.starts_with("a.csv") {
            let packed = expected.replace("a.csv:", "a.csv.gz:");
            let measure = "measure a.csv.gz -o new.json";
            cases.push(refused("a.csv.gz", gzip(text.as_bytes()), measure, &packed));
        }
        cases.push(refused("a.csv", text, "fit a.csv", expected));
    }
    cases.extend(invalid());
    let packed = gzip(good.as_bytes());
    let mut flipped = packed.clone();
    flipped[40] ^= 0x55;
    let packs: Vec<(Vec<u8>, &str)> = table! {
        Vec::new() => "a.csv.gz: ";
        b"gx,gy\n1,2\n".to_vec() => "not a gzip stream";
        packed[..5].to_vec() => "the gzip stream ends in the middle";
        packed[..packed.len() / 2].to_vec() => "the gzip stream ends in the middle";
        flipped => "a.csv.gz";
        gzip(b"") => "a.csv.gz: ";
        gzip(&vec![b'\n'; 1 << 27]) => "unpacks to more than 100 times its size";
        gzip(&"0,0,0\n".repeat(1 << 22).into_bytes()) => "a.csv.gz";
        gzip(&vec![b','; 1 << 26]) => "KiB or more";
        gzip(&vec![0; 1 << 26]) => "KiB or more";
    };
    cases.extend(
        packs
            .into_iter()
            .map(|(bytes, expected)| refused("a.csv.gz", bytes, "fit a.csv.gz --rate 9", expected)),
    );
    // Bytes of other kinds of files.
    let others: [(&[u8], &str); 4] = [
        (b"\xff\xfeg\0x\0\n\x001\0\n\0", "a.csv"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x01\0", "a.csv"),
        (b"1\r2\r3\r4\r", "samples are too few"),
        (&[0xff; 3000], "a.csv"),
    ];
    let others =
        others.map(|(bytes, expected)| refused("a.csv", bytes, "fit a.csv --rate 9", expected));
    cases.extend(others);
    cases
}

/// Logs that are read but not valid, which `export` refuses unless it is told otherwise.
fn invalid() -> Vec<Case> {
    let log = |value: &dyn Fn(usize, i64) -> i64| {
        let counts = noise().take(4000).enumerate();
        counts.fold(String::from("gx\n"), |mut text, (at, count)| {
            let _ = writeln!(text, "{}", value(at, count));
            text
        })
    };
    let held: Vec<i64> = noise().take(2000).collect();
    let reasons = rows! {
        log(&|_, count| i64::from(count > 2000)), "the noise is below half a count";
        log(&|at, _| held[at / 2]), "every second sample repeats the one before";
        log(&|at, count| { count + if (2000..2400).contains(&at) { 400_000 } else { 0 } }), "the gyro was moved";
    };
    let export = "export -f kalibr --rate 100 --scale 0.01 --unit deg/s --repeats keep a.csv";
    let both = |(text, reason): (String, &str)| {
        let refusal = refused("a.csv", text.clone(), export, reason);
        let told = format!("{export} --despite-invalid");
        [refusal, refused("a.csv", text, &told, reason).status(0)]
    };
    reasons.into_iter().flat_map(both).collect()
}
