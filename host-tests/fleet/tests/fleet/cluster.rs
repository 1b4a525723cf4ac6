//! Queries on a cluster of processes.

use crate::{
    logs::{Fleet, found, random, write},
    queries::STATES,
};
use datafusion::{
    arrow::array::RecordBatch, parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder,
};
use rand::RngExt as _;
use std::{
    fs::File,
    net::{SocketAddr, TcpListener, TcpStream},
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const PROGRAM: &str = env!("CARGO_BIN_EXE_allanite-fleet");

/// The time in s after which an executor is given up.
const PATIENCE: &str = "4";

/// The time in which everything has to come.
const LIMIT: Duration = Duration::from_secs(120);

/// A process that ends with the test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn started(arguments: &[&str]) -> Process {
    let mut command = Command::new(PROGRAM);
    command.args(arguments).stdout(Stdio::null());
    Process(command.spawn().unwrap())
}

/// A scheduler and executors on this machine.
struct Cluster {
    scheduler: (SocketAddr, Process),
    executors: Vec<Process>,
}

/// An address whose port and the one above it are free.
fn free() -> SocketAddr {
    loop {
        let first = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = first.local_addr().unwrap();
        let above = address.port().checked_add(1);
        if above.is_some_and(|port| TcpListener::bind(("127.0.0.1", port)).is_ok()) {
            return address;
        }
    }
}

/// Waits until something is so.
fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < LIMIT, "{what} takes more than {LIMIT:?}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Waits until a process serves its address.
fn serves(process: &mut Process, address: SocketAddr) {
    until("a process", || {
        assert_eq!(process.0.try_wait().unwrap(), None, "it has ended");
        TcpStream::connect(address).is_ok()
    });
}

impl Cluster {
    fn new(folder: &Path) -> Self {
        let address = free();
        let mut scheduler = started(&[
            "scheduler",
            "--bind",
            &address.to_string(),
            "--patience",
            PATIENCE,
        ]);
        serves(&mut scheduler, address);
        let mut cluster = Self {
            scheduler: (address, scheduler),
            executors: Vec::new(),
        };
        for number in 0..2 {
            cluster.add(&folder.join(number.to_string()));
        }
        cluster
    }

    /// Starts an executor of one thread that keeps results in this folder.
    fn add(&mut self, folder: &Path) {
        let (own, scheduler) = (free(), self.scheduler.0.to_string());
        let folder = folder.to_str().unwrap();
        let mut executor = started(&[
            "executor",
            "--scheduler",
            &scheduler,
            "--bind",
            &own.to_string(),
            "--threads",
            "1",
            "--folder",
            folder,
            "--patience",
            PATIENCE,
        ]);
        serves(&mut executor, own);
        self.executors.push(executor);
    }

    /// Begins a query over logs.
    fn ask(&self, query: &str, logs: &Path, output: &Path) -> Process {
        let scheduler = format!("df://{}", self.scheduler.0);
        let logs = format!("logs={}", logs.display());
        let output = output.to_str().unwrap();
        started(&[
            "query",
            "--scheduler",
            &scheduler,
            "--table",
            &logs,
            "--partitions",
            "16",
            "--rows",
            "3",
            "--output",
            output,
            query,
        ])
    }
}

/// Waits for a query.
fn answered(mut query: Process, output: &Path) -> Vec<RecordBatch> {
    let mut status = None;
    until("the query", || {
        status = query.0.try_wait().unwrap();
        status.is_some()
    });
    assert!(status.is_some_and(|status| status.success()), "{status:?}");
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(output).unwrap()).unwrap();
    reader.build().unwrap().map(Result::unwrap).collect()
}

/// The files below a folder.
fn files(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return usize::from(folder.is_file());
    };
    entries.map(|entry| files(&entry.unwrap().path())).sum()
}

#[test]
fn two_executors_give_the_same_bytes_and_one_that_is_killed_changes_none() {
    const FLEET: Fleet = Fleet {
        devices: 4,
        samples: 3_000_000,
    };
    let folder = tempfile::tempdir().unwrap();
    let logs = folder.path().join("logs");
    let mut random = random(3);
    write(
        &logs,
        FLEET.rows(|| random.random_range(1..40_000)),
        32,
        7,
        &mut random.clone(),
    );
    let expected = FLEET.states();
    let works = folder.path().join("works");
    let mut cluster = Cluster::new(&works);
    let output = folder.path().join("states.parquet");
    let query = cluster.ask(STATES, &logs, &output);
    assert_eq!(found(&answered(query, &output)), expected);
    let work_of = |number: usize| files(&works.join(number.to_string()));
    let before = [0, 1].map(work_of);
    assert!(
        before.iter().all(|&files| files > 0),
        "an executor had no work: {before:?}"
    );

    // Half-way, after it has done some of the work.
    let mut query = cluster.ask(STATES, &logs, &output);
    until("the second executor's work", || work_of(1) > before[1]);
    cluster.executors[1].0.kill().unwrap();
    assert!(
        query.0.try_wait().unwrap().is_none(),
        "the query ended before"
    );
    assert_eq!(
        found(&answered(query, &output)),
        expected,
        "with a killed executor"
    );

    // Another one comes in its place.
    cluster.add(&works.join("2"));
    let query = cluster.ask(STATES, &logs, &output);
    assert_eq!(
        found(&answered(query, &output)),
        expected,
        "with a new executor"
    );
}

#[test]
fn what_cannot_be_asked_has_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let logs = folder.path().join("logs");
    write(&logs, Fleet::SMALL.rows(|| 20_000), 1, 7, &mut random(3));
    let logs = format!("logs={}", logs.display());
    let nobody = format!("df://{}", free());
    let nowhere = folder.path().join("none/states.parquet");
    let nowhere = nowhere.to_str().unwrap();
    for (arguments, message) in [
        (
            vec![
                "query",
                "--table",
                &logs,
                "SELECT allan_stat(start) FROM logs",
            ],
            "allan_stat",
        ),
        (
            vec!["query", "--table", &logs, "SELECT start FROM log"],
            "log",
        ),
        (vec!["query", "--table", &logs, "SELECT FROM"], "Expected"),
        (
            vec![
                "query",
                "--table",
                &logs,
                "SELECT allan_state(start, device, rate, scale) FROM logs",
            ],
            "a list of whole numbers",
        ),
        (
            vec!["query", "--table", "logs=nothing", STATES],
            "nothing: no such file or folder",
        ),
        (
            vec!["query", "--table", &logs, "--output", nowhere, STATES],
            "none/states.parquet",
        ),
        (
            vec!["query", "--table", &logs, "--scheduler", &nobody, STATES],
            "nobody answers",
        ),
        (
            vec!["query", "--table", &logs, "--scheduler", "nobody", STATES],
            "--scheduler nobody",
        ),
        (
            vec!["executor", "--scheduler", "nobody"],
            "--scheduler nobody",
        ),
    ] {
        let output = Command::new(PROGRAM).args(&arguments).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(
            errors.lines().count() == 1 && errors.contains(message),
            "{arguments:?}: {errors}"
        );
    }
}
