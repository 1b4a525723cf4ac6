//! A bad input: files, a command, and what must come of it.

use std::{
    collections::BTreeSet,
    ffi::OsString,
    fs,
    io::{Read, Write},
    path::Path,
    process::Command,
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// The longest time that a command may compute, in seconds.
const LONGEST_S: u64 = 10;

/// The longest time that a command may take, so that one that waits for ever is found. A busy machine may
/// need several times the computing time.
const LONGEST: Duration = Duration::from_secs(100);

/// The memory that a bad input may take beyond what the program needs for a good one.
const SPARE_KIB: u64 = 64 << 10;

/// A bad input.
pub(crate) struct Case {
    name: String,
    files: Vec<(String, Vec<u8>)>,
    /// Shell commands that prepare the folder.
    prepare: String,
    arguments: Vec<String>,
    input: Vec<u8>,
    status: i32,
    expected: String,
    /// Whether the input may turn out to be good.
    is_ambiguous: bool,
}

/// A command on one bad file, which is refused with a line that contains `expected`.
pub(crate) fn refused(
    file: &str,
    bytes: impl Into<Vec<u8>>,
    command: &str,
    expected: &str,
) -> Case {
    Case {
        name: format!("{command} on {file}"),
        files: vec![(file.to_owned(), bytes.into())],
        prepare: String::new(),
        arguments: command.split_whitespace().map(String::from).collect(),
        input: Vec::new(),
        status: 2,
        expected: expected.to_owned(),
        is_ambiguous: false,
    }
}

impl Case {
    /// The case with another exit status.
    pub(crate) fn status(mut self, status: i32) -> Self {
        self.status = status;
        self
    }

    /// The case of an input that may turn out to be good.
    pub(crate) fn ambiguous(mut self) -> Self {
        self.is_ambiguous = true;
        self
    }

    /// The case with a further file, which may lie in a folder.
    pub(crate) fn beside(mut self, file: String, bytes: Vec<u8>) -> Self {
        self.files.push((file, bytes));
        self
    }

    /// The case with shell commands that prepare the folder.
    pub(crate) fn prepared(mut self, commands: &str) -> Self {
        self.prepare = commands.to_owned();
        self
    }

    /// The case with bytes on standard input.
    pub(crate) fn fed(mut self, input: &[u8]) -> Self {
        self.input = input.to_vec();
        self
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The files, and the words of the command.
    pub(crate) fn parts(&self) -> (&[(String, Vec<u8>)], &[String]) {
        (&self.files, &self.arguments)
    }

    /// Runs the command, and returns what it used, or what is wrong with its end.
    pub(crate) fn run(&self, folder: &Path, needed_kib: u64) -> Result<Usage, String> {
        for (name, bytes) in &self.files {
            let file = folder.join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, bytes).unwrap();
        }
        if !self.prepare.is_empty() {
            let mut shell = Command::new("sh");
            let shell = shell.args(["-c", &self.prepare]).current_dir(folder);
            assert!(shell.status().unwrap().success(), "{}", self.prepare);
        }
        let before = names_in(folder);
        let arguments: Vec<&str> = self.arguments.iter().map(String::as_str).collect();
        let ended = limited(folder, &arguments, &self.input, needed_kib + SPARE_KIB);
        let wrong = |what: &str| {
            let name = &self.name;
            let expected = &self.expected;
            Err(format!("{name}: {what}, expected {expected:?}: {ended:?}"))
        };
        match ended.status {
            None => wrong("still running"),
            Some(0 | 2) if ended.has_controls() => wrong("control characters"),
            Some(0 | 2) if self.is_ambiguous => Ok(ended.usage),
            status if status != Some(self.status) => wrong("another exit status"),
            _ if !ended.errors.contains(&self.expected) => wrong("another message"),
            _ if self.status == 2 && !is_one_line(&ended.errors) => wrong("not one clear line"),
            _ if self.status == 2 && !self.names_place(&ended.errors) => wrong("no place"),
            _ if self.status == 2 && names_in(folder) != before => wrong("another file"),
            _ if !self.files_are_in(folder) => wrong("a changed input"),
            _ => Ok(ended.usage),
        }
    }
}

impl Case {
    /// Whether the files of the case are as they were.
    fn files_are_in(&self, folder: &Path) -> bool {
        let mut files = self.files.iter();
        files.all(|(name, bytes)| fs::read(folder.join(name)).is_ok_and(|found| found == *bytes))
    }

    /// Whether the last line names an option, the standard input, or one of the arguments: a file with its place in it,
    /// or a value.
    fn names_place(&self, errors: &str) -> bool {
        let last = errors.lines().last().unwrap_or_default();
        let mut words = self.arguments.iter().skip(1);
        let is_told = ["--", "standard input"]
            .iter()
            .any(|place| last.contains(place));
        is_told || words.any(|word| last.contains(word.as_str()))
    }
}

/// The names of what is in a folder.
fn names_in(folder: &Path) -> BTreeSet<OsString> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name()).collect()
}

/// The last line tells what is wrong, and what to do about it behind a semicolon. Notes may stand before it.
fn is_one_line(errors: &str) -> bool {
    let last = errors.lines().last().unwrap_or_default();
    errors.ends_with('\n')
        && errors.lines().all(|line| line.starts_with("allanite: "))
        && last
            .rsplit_once("; ")
            .is_some_and(|(_, remedy)| !remedy.trim().is_empty())
        && last.len() < 2000
}

/// What a command used: the time that passed, and its most memory, which is looked at every few milliseconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Usage {
    pub(crate) seconds: f64,
    pub(crate) kib: u64,
}

/// How a command ended.
#[derive(Debug)]
struct Ended {
    usage: Usage,
    status: Option<i32>,
    output: String,
    errors: String,
}

impl Ended {
    fn has_controls(&self) -> bool {
        let is_control = |c: char| {
            let is_invisible = matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
            c.is_control() && c != '\n' && c != '\t' || is_invisible
        };
        self.output.contains(is_control) || self.errors.contains(is_control)
    }
}

/// Runs the program with a limited address space.
fn limited(folder: &Path, arguments: &[&str], input: &[u8], most_kib: u64) -> Ended {
    let mut command = Command::new("sh");
    command
        .args([
            "-c",
            &format!("ulimit -v {most_kib}; ulimit -t {LONGEST_S}; exec \"$0\" \"$@\""),
        ])
        .arg(program::path())
        .args(arguments)
        .current_dir(folder)
        // Otherwise every thread reserves 64 MiB.
        .env("MALLOC_ARENA_MAX", "1");
    let mut child = program::piped(&mut command);
    let mut pipe = child.stdin.take().unwrap();
    let input = input.to_vec();
    // A command that does not read its input closes it.
    let sender = thread::spawn(move || drop(pipe.write_all(&input)));
    let mut output = child.stdout.take().unwrap();
    let mut errors = child.stderr.take().unwrap();
    let outputs = thread::spawn(move || {
        let mut text = Vec::new();
        output.read_to_end(&mut text).unwrap();
        String::from_utf8_lossy(&text).into_owned()
    });
    let errors = thread::spawn(move || {
        let mut text = Vec::new();
        errors.read_to_end(&mut text).unwrap();
        String::from_utf8_lossy(&text).into_owned()
    });
    let begun = Instant::now();
    let mut usage = Usage::default();
    let mut status = child.try_wait().unwrap();
    while status.is_none() && begun.elapsed() < LONGEST {
        usage.kib = usage.kib.max(most_resident_kib(child.id()));
        thread::sleep(Duration::from_millis(2));
        status = child.try_wait().unwrap();
    }
    if status.is_none() {
        child.kill().unwrap();
        child.wait().unwrap();
    }
    usage.seconds = begun.elapsed().as_secs_f64();
    sender.join().unwrap();
    Ended {
        usage,
        status: status.map(|status| status.code().unwrap_or(-1)),
        output: outputs.join().unwrap(),
        errors: errors.join().unwrap(),
    }
}

/// The most memory that a process had so far; 0 where the system does not tell.
fn most_resident_kib(process: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let number = line.and_then(|line| line.trim().strip_suffix(" kB"));
    number
        .and_then(|number| number.trim().parse().ok())
        .unwrap_or(0)
}

/// The address space that the program needs for a good log, in KiB.
pub(crate) fn needed_kib() -> u64 {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("good.csv"), super::text::good(5000)).unwrap();
    let works =
        |kib: u64| limited(folder.path(), &["diagnose", "good.csv"], &[], kib).status == Some(0);
    let (mut low, mut high) = (0, 1 << 20);
    assert!(works(high), "a good log is read");
    while high - low > 4 << 10 {
        let middle = (low + high) / 2;
        match works(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    high
}
