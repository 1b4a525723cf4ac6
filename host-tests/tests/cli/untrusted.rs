//! Files that change while they are read, names that are not what they look like, and outputs that others protected.

use super::bad_input::good_text;
use program::{output, refusal};
use std::{
    fs::{self, OpenOptions},
    io::Write as _,
    path::Path,
    sync::atomic::{AtomicBool, Ordering::SeqCst},
    thread,
    time::Duration,
};
use tempfile::TempDir;

/// A log of three axes with these names.
fn named(folder: &Path, names: &str) {
    let text = good_text(600);
    let (_, rows) = text.split_once('\n').unwrap();
    let rows = rows.split_once('\n').unwrap().1;
    let text = format!("# rate_hz=100 unit=deg/s scale=0.0001\n{names}\n{rows}");
    fs::write(folder.join("a.csv"), text).unwrap();
}

/// A log that takes a while to read.
fn long(file: &Path) -> u64 {
    let rows = (0..4_000_000_u64).map(|n| format!("{}\n", n.wrapping_mul(0x9e37_79b9) >> 8 & 1023));
    let text: String = std::iter::once("# rate_hz=100\ngx\n".into())
        .chain(rows)
        .collect();
    fs::write(file, &text).unwrap();
    text.len() as u64
}

#[test]
fn names_show_all_of_their_characters() {
    let folder = TempDir::new().unwrap();
    named(
        folder.path(),
        "\"a\u{202e}gnp.exe\",\"g\u{200b}y\",\"g\u{9b}z\"",
    );
    for command in [
        &["fit", "a.csv", "--columns", "1,2,3"][..],
        &["diagnose", "a.csv", "--columns", "1,2,3"],
        &["fit", "a.csv", "--columns", "1,2,3", "--json"],
        &["export", "-f", "kalibr", "a.csv", "--columns", "1,2,3"],
        &["fit", "a.csv", "--columns", "9"],
    ] {
        let ended = program::run(folder.path(), command);
        let said = [ended.stdout, ended.stderr].concat();
        let said = String::from_utf8(said).unwrap();
        let is_hidden = |c: char| matches!(c, '\u{202e}' | '\u{200b}' | '\u{7f}'..='\u{9f}');
        assert!(!said.contains(is_hidden), "{command:?}: {said}");
        assert!(
            said.contains("\\u202egnp.exe") || command[3] == "9",
            "{command:?}: {said}"
        );
    }
    output(
        folder.path(),
        &["measure", "a.csv", "--columns", "1,2,3", "-o", "m.json"],
    );
    let text = fs::read_to_string(folder.path().join("m.json")).unwrap();
    assert!(text.contains("a\\\\u202egnp.exe") && !text.contains('\u{202e}'));
}

#[test]
fn names_are_no_formulas_in_tables() {
    let folder = TempDir::new().unwrap();
    named(folder.path(), "\"=cmd|'/C calc'!A0\",+gy,@gz");
    let arguments = [
        "export",
        "-f",
        "csv",
        "a.csv",
        "--columns",
        "1,2,3",
        "-o",
        "t.csv",
    ];
    output(folder.path(), &arguments);
    let mut names = Vec::new();
    for table in ["t.csv", "t.course.csv", "t.spectrum.csv"] {
        let Ok(text) = fs::read_to_string(folder.path().join(table)) else {
            continue;
        };
        let mut rows = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        for row in rows.records() {
            let row = row.unwrap();
            names.push(row[0].to_owned());
            // Numbers keep their signs.
            assert!(
                row.iter()
                    .skip(1)
                    .all(|cell| cell.is_empty() || cell.parse::<f64>().is_ok())
            );
        }
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names, ["'+gy", "'=cmd|'/C calc'!A0", "'@gz"]);
}

#[cfg(unix)]
#[test]
fn an_output_keeps_its_permissions_and_one_that_is_protected_is_left_alone() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = TempDir::new().unwrap();
    named(folder.path(), "gx,gy,gz");
    let file = folder.path().join("m.json");
    let mode = || fs::metadata(&file).unwrap().permissions().mode() & 0o777;
    for private in [0o600, 0o640, 0o666] {
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(private)).unwrap();
        output(folder.path(), &["measure", "a.csv", "-o", "m.json"]);
        assert_eq!(mode(), private);
        assert!(fs::read_to_string(&file).unwrap().starts_with('{'));
    }
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o444)).unwrap();
    let line = refusal(folder.path(), &["measure", "a.csv", "-o", "m.json"]);
    assert_eq!(
        line,
        "m.json: is protected from writing; name another output, or allow writing to it"
    );
    assert_eq!((fs::read(&file).unwrap(), mode()), (b"old".to_vec(), 0o444));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[cfg(unix)]
#[test]
fn an_output_that_cannot_be_written_leaves_the_old_one() {
    let folder = TempDir::new().unwrap();
    named(folder.path(), "gx,gy,gz");
    for command in [
        "measure a.csv -o old.json",
        "export -f csv a.csv -o old.csv",
        "plot a.csv -o old.svg",
        "plot a.csv -o old.png",
        "report a.csv -o old.html",
        "simulate mems --duration 600 -o old.csv",
        "simulate mems --duration 600 -o old.npy",
    ] {
        let arguments: Vec<&str> = command.split(' ').collect();
        let old = folder.path().join(arguments.last().unwrap());
        fs::write(&old, "old").unwrap();
        let names = || {
            let entries = fs::read_dir(folder.path()).unwrap().flatten();
            let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
            names.sort();
            names
        };
        let before = names();
        // No file may be longer than a block.
        let ended = std::process::Command::new("sh")
            .args(["-c", "ulimit -f 1; exec \"$0\" \"$@\""])
            .arg(program::path())
            .args(&arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let errors = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.code(), Some(2), "{command}: {errors}");
        let last = errors.lines().last().unwrap();
        assert!(last.contains("File too large"), "{command}: {errors}");
        assert_eq!(fs::read(&old).unwrap(), b"old", "{command}");
        assert_eq!(names(), before, "{command}");
    }
}

#[test]
fn a_log_that_becomes_shorter_while_it_is_read_is_refused() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("a.csv");
    let length = long(&file);
    let text = fs::read(&file).unwrap();
    // Before the program begins, and after it has ended, the log is as good as any other.
    let is_refused = |delay: u64| {
        fs::write(&file, &text).unwrap();
        let arguments = ["measure", "a.csv", "-o", "m.json"];
        let child = program::piped(&mut program::command(folder.path(), &arguments));
        thread::sleep(Duration::from_millis(delay));
        let opened = OpenOptions::new().write(true).open(&file).unwrap();
        opened.set_len(length / 2).unwrap();
        let ended = child.wait_with_output().unwrap();
        let errors = String::from_utf8(ended.stderr).unwrap();
        if ended.status.success() {
            return false;
        }
        assert!(
            errors.ends_with(
                "it became shorter while it was read; end what writes to it, and read it again\n"
            ),
            "{errors}"
        );
        ended.status.code() == Some(2)
    };
    assert!((1..40).map(|delay| 8 * delay).any(is_refused));
}

#[test]
fn a_log_that_grows_is_read_to_a_line_that_it_had_at_first() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("a.csv");
    let length = long(&file);
    let is_read = AtomicBool::new(false);
    let errors = thread::scope(|scope| {
        scope.spawn(|| {
            let mut opened = OpenOptions::new().append(true).open(&file).unwrap();
            // Lines come in pieces, so that the file mostly ends within one.
            while !is_read.load(SeqCst) {
                opened.write_all(b"51\n512\n51").unwrap();
                thread::sleep(Duration::from_micros(50));
            }
        });
        let ended = program::run(folder.path(), &["measure", "a.csv", "-o", "m.json"]);
        is_read.store(true, SeqCst);
        assert!(ended.status.success());
        String::from_utf8(ended.stderr).unwrap()
    });
    let (_, told) = errors
        .split_once("it grew while it was read: the first ")
        .unwrap();
    let (bytes, _) = told.split_once(" bytes are the record").unwrap();
    let bytes: usize = bytes.parse().unwrap();
    let text = fs::read(&file).unwrap();
    assert!(bytes as u64 >= length && bytes < text.len() && text[bytes - 1] == b'\n');
    let curve = allanite_host::curve_file::CurveFile::read(&folder.path().join("m.json")).unwrap();
    let lines = text[..bytes].iter().filter(|&&byte| byte == b'\n').count();
    assert_eq!(curve.axes[0].samples, lines as u64 - 2);
}

#[cfg(target_os = "linux")]
#[test]
fn files_of_the_system_that_never_end_are_not_waited_for() {
    let folder = TempDir::new().unwrap();
    for path in ["/proc/kmsg", "/proc/self/cmdline", "/dev/zero", "/dev/tty"] {
        let line = refusal(folder.path(), &["fit", path]);
        assert!(line.starts_with(&format!("{path}: ")), "{line}");
    }
}
