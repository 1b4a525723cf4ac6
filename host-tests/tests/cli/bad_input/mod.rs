//! Bad inputs of every kind end with an exit status and a line that says what is wrong, in little time and
//! memory.

/// A table of bad inputs: each, and what is said of it.
macro_rules! table {
    ($($given:expr => $expected:expr;)*) => {
        vec![$(($given, $expected)),*]
    };
}

mod arrays;
mod bags;
mod case;
mod claims;
mod corpus;
mod curves;
mod options;
mod pipes;
mod stored;
mod tables;
mod text;
mod ulogs;

use case::{Case, Usage};
pub(crate) use corpus::corpus;
use std::sync::{
    Mutex,
    atomic::{AtomicUsize, Ordering::Relaxed},
};
use std::thread;
use tempfile::TempDir;
pub(crate) use text::good as good_text;

/// Two programs run at a time.
const AT_ONCE: usize = 2;

#[test]
fn every_bad_input_ends_with_its_status_and_message_in_little_time_and_memory() {
    let cases: Vec<Case> = [
        text::cases(),
        arrays::cases(),
        bags::cases(),
        claims::cases(),
        ulogs::cases(),
        curves::cases(),
        stored::cases(),
        tables::cases(),
        options::cases(),
        pipes::cases(),
    ]
    .into_iter()
    .flatten()
    .collect();
    assert!(cases.len() >= 600, "{} cases", cases.len());
    println!("{} bad inputs", cases.len());
    run_all(&cases, &mut |_, _| {});
}

/// Runs every case, shows what it used, and fails if something is wrong with some of them.
fn run_all(cases: &[Case], show: &mut (dyn FnMut(&Case, Usage) + Send)) {
    let needed_kib = case::needed_kib();
    let next = AtomicUsize::new(0);
    let show = Mutex::new(show);
    let work = || {
        let mut wrong = Vec::new();
        while let Some(case) = cases.get(next.fetch_add(1, Relaxed)) {
            let folder = TempDir::new().unwrap();
            match case.run(folder.path(), needed_kib) {
                Ok(usage) => show.lock().unwrap()(case, usage),
                Err(what) => wrong.push(what),
            }
        }
        wrong
    };
    let wrong: Vec<String> = thread::scope(|scope| {
        let workers: Vec<_> = (0..AT_ONCE).map(|_| scope.spawn(work)).collect();
        let found = workers.into_iter().map(|worker| worker.join().unwrap());
        found.flatten().collect()
    });
    assert!(
        wrong.is_empty(),
        "{} of {} cases:\n{}",
        wrong.len(),
        cases.len(),
        wrong.join("\n")
    );
}
