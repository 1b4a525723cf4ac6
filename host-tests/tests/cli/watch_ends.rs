//! Whatever ends `watch`, and at whatever moment, its record holds what was received more than a second before.

use super::watch::{Sent, check_prefix, lines};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serialport::{SerialPort, TTYPort};
use std::{
    fs,
    io::{Read, Write},
    path::Path,
    process::{Child, ChildStdin, Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering::SeqCst},
    },
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// What was received so long before the end is in the record.
const LONGEST_LOSS: Duration = Duration::from_secs(1);

/// What happens to a program that draws on a terminal.
#[derive(Clone, Copy, Debug)]
enum End {
    /// The terminal is closed, as when a connection breaks.
    Closed,
    /// A signal comes.
    Signal(&'static str),
    /// The terminal takes no more text, and then a signal comes.
    Stalled,
    /// The folder of the output is removed, and some time later a signal comes.
    FolderGone,
    /// The disk is full, and a signal comes.
    DiskFull,
}

const ENDS: [End; 9] = [
    End::Closed,
    End::Signal("HUP"),
    End::Signal("INT"),
    End::Signal("TERM"),
    End::Signal("QUIT"),
    End::Signal("KILL"),
    End::Stalled,
    End::FolderGone,
    End::DiskFull,
];

/// The program on a terminal that is its controlling one, as it is in a shell.
struct Watching {
    child: Child,
    terminal: Option<TTYPort>,
    folder: TempDir,
}

impl Watching {
    fn start(end: End) -> Self {
        let folder = TempDir::new().unwrap();
        fs::create_dir(folder.path().join("out")).unwrap();
        fs::create_dir(folder.path().join("tmp")).unwrap();
        let (terminal, port) = TTYPort::pair().unwrap();
        let name = port.name().unwrap();
        if matches!(end, End::DiskFull) {
            let link = folder.path().join("out/curve.json");
            std::os::unix::fs::symlink("/dev/full", link).unwrap();
        }
        // The first terminal that the leader of a session opens becomes its controlling one.
        // The other end of the terminal must not stay open in the program.
        let shell = "for i in 3 4 5 6 7 8 9; do eval \"exec $i>&-\"; done; \
                     exec >$0 2>&1; stty rows 40 cols 100 <$0; exec \"$@\"";
        let child = Command::new("setsid")
            .args(["sh", "-c", shell, &name])
            .arg(program::path())
            .args(["watch", "--rate", "100", "--scale", "0.01"])
            .args(["--axes", "left,right", "--output", "out/curve.json"])
            .current_dir(folder.path())
            .env("TMPDIR", folder.path().join("tmp"))
            .stdin(Stdio::piped())
            .spawn()
            .unwrap();
        // The program has the terminal open by the time that it reads its input.
        thread::sleep(Duration::from_millis(100));
        drop(port);
        Self {
            child,
            terminal: Some(terminal),
            folder,
        }
    }

    /// The folder in which the record is, and whether it is the second place.
    fn record(&self) -> Option<std::path::PathBuf> {
        let of = |folder: &str| {
            let entries = fs::read_dir(self.folder.path().join(folder)).ok()?;
            let files = entries.flatten().map(|entry| entry.path());
            let mut curves = files.filter(|file| {
                let is_curve = file
                    .extension()
                    .is_some_and(|extension| extension == "json");
                is_curve && file.metadata().is_ok_and(|file| file.is_file())
            });
            curves.next()
        };
        of("out").or_else(|| of("tmp"))
    }

    fn wait(&mut self, longest: Duration) -> bool {
        let begun = Instant::now();
        while begun.elapsed() < longest {
            if self.child.try_wait().unwrap().is_some() {
                return true;
            }
            thread::sleep(Duration::from_millis(5));
        }
        false
    }
}

/// When how many samples had been sent.
type Noted = Arc<Mutex<Vec<(Instant, u64)>>>;

/// Sends lines at the rate of a sensor, and notes when how many samples were sent.
fn send(mut pipe: ChildStdin, sent: Vec<Sent>) -> (Noted, Arc<AtomicBool>, thread::JoinHandle<()>) {
    let (noted, over) = (
        Arc::new(Mutex::new(Vec::new())),
        Arc::new(AtomicBool::new(false)),
    );
    let (note, is_over) = (noted.clone(), over.clone());
    let sender = thread::spawn(move || {
        let mut samples = 0;
        for piece in sent.chunks(20) {
            let text: String = piece.iter().map(|line| line.line()).collect();
            if is_over.load(SeqCst) || pipe.write_all(text.as_bytes()).is_err() {
                return;
            }
            samples += piece
                .iter()
                .filter(|line| matches!(line, Sent::Sample(_)))
                .count() as u64;
            note.lock().unwrap().push((Instant::now(), samples));
            thread::sleep(Duration::from_millis(10));
        }
    });
    (noted, over, sender)
}

/// Ends a recording at a random moment. Returns what is wrong with its record.
fn end(end: End, seed: u64) -> Result<(), String> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let sent = lines(100_000, seed);
    let mut watching = Watching::start(end);
    let (noted, over, sender) = send(watching.child.stdin.take().unwrap(), sent.clone());
    let mut terminal = watching.terminal.take().unwrap();
    terminal.set_timeout(Duration::from_millis(20)).unwrap();
    let moment = Duration::from_millis(random.random_range(1200..2400));
    let begun = Instant::now();
    let read = |terminal: &mut TTYPort| {
        if !matches!(end, End::Stalled) {
            let _ = terminal.read(&mut [0; 1 << 16]);
        }
        thread::sleep(Duration::from_millis(5));
    };
    while begun.elapsed() < moment {
        read(&mut terminal);
        if matches!(end, End::FolderGone) && begun.elapsed() > moment / 2 {
            let _ = fs::remove_dir_all(watching.folder.path().join("out"));
        }
    }
    let ended = Instant::now();
    let sent_before = |at: Instant| {
        let noted = noted.lock().unwrap();
        let before = noted.iter().rev().find(|(when, _)| *when < at);
        before.map_or(0, |(_, samples)| *samples)
    };
    let well_before = sent_before(ended - LONGEST_LOSS);
    let name = match end {
        End::Closed => None,
        End::Signal(name) => Some(name),
        End::Stalled | End::FolderGone | End::DiskFull => Some("TERM"),
    };
    match name {
        None => drop(terminal),
        Some(name) => {
            program::signal(&watching.child, name);
            // What the program prints at the end is read too.
            let until = Instant::now() + Duration::from_millis(1500);
            while Instant::now() < until && watching.child.try_wait().unwrap().is_none() {
                read(&mut terminal);
            }
        }
    }
    let mut problem = None;
    if matches!(end, End::Stalled) && watching.child.try_wait().unwrap().is_none() {
        // It waits for its terminal, but its record is saved, so that the next signal ends it at once.
        program::signal(&watching.child, "TERM");
    }
    if !watching.wait(Duration::from_secs(10)) {
        watching.child.kill().unwrap();
        watching.child.wait().unwrap();
        problem = Some("it did not end".to_owned());
    }
    over.store(true, SeqCst);
    sender.join().unwrap();
    let record = watching.record().ok_or("no record")?;
    let samples = check_prefix(&record, &sent);
    if samples < well_before {
        problem = Some(format!("{samples} of {well_before} samples"));
    }
    let is_second = record.parent().unwrap().ends_with("tmp");
    if is_second != matches!(end, End::FolderGone | End::DiskFull) {
        problem = Some(format!("the record is in {}", record.display()));
    }
    problem.map_or(Ok(()), |problem| {
        Err(format!("{end:?}, seed {seed}, after {moment:?}: {problem}"))
    })
}

/// Ends so many recordings, one after the other, because a terminal of one would stay open in the program of another.
fn end_many(many: u64) {
    let end = |seed: u64| end(ENDS[seed as usize % ENDS.len()], seed).err();
    let wrong: Vec<String> = (0..many).filter_map(end).collect();
    assert!(
        wrong.is_empty(),
        "{} of {many}:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// Runs another test of this program in a process of its own: where all tests share one, the programs of the others would
/// keep the terminals of this one open.
fn apart(test: &str) {
    let tested = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--ignored", "--nocapture"])
        .output()
        .unwrap();
    let [said, errors] = [&tested.stdout, &tested.stderr].map(|text| String::from_utf8_lossy(text));
    let is_right = tested.status.success() && said.contains("1 passed");
    assert!(is_right, "{said}\n{errors}");
}

#[test]
fn a_record_is_saved_whatever_ends_it() {
    apart("watch_ends::every_end_saves_the_record");
}

#[test]
#[ignore = "another test runs it in a process of its own"]
fn every_end_saves_the_record() {
    end_many(ENDS.len() as u64);
}

mod thorough {
    use super::*;

    #[test]
    fn a_record_is_saved_whatever_ends_it_at_200_moments() {
        end_many(200);
    }
}

#[test]
fn a_record_of_which_the_folder_is_gone_tells_where_it_is() {
    let folder = TempDir::new().unwrap();
    let [out, tmp] = ["out", "tmp"].map(|name| folder.path().join(name));
    fs::create_dir(&out).unwrap();
    fs::create_dir(&tmp).unwrap();
    let arguments = [
        "watch",
        "--rate",
        "100",
        "--scale",
        "0.01",
        "--output",
        "out/curve.json",
    ];
    let mut command = program::command(folder.path(), &arguments);
    let mut child = program::piped(command.args(["--axes", "left,right"]).env("TMPDIR", &tmp));
    let mut pipe = child.stdin.take().unwrap();
    let sent = lines(3000, 3);
    let text: String = sent.iter().map(|line| line.line()).collect();
    pipe.write_all(text.as_bytes()).unwrap();
    thread::sleep(Duration::from_millis(700));
    fs::remove_dir_all(&out).unwrap();
    thread::sleep(Duration::from_millis(700));
    drop(pipe);
    let ended = child.wait_with_output().unwrap();
    let errors = String::from_utf8(ended.stderr).unwrap();
    let last = errors.lines().last().unwrap();
    let start = "allanite: out/curve.json: its folder does not exist, and the record is in ";
    let place = last
        .strip_prefix(start)
        .and_then(|rest| rest.split_once("; "));
    let (place, _) = place.unwrap_or_else(|| panic!("{errors}"));
    assert_eq!(ended.status.code(), Some(2));
    check_prefix(Path::new(place), &sent);
    // A record that is private is not shown to everybody.
    use std::os::unix::fs::PermissionsExt as _;
    let mode = fs::metadata(place).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}
