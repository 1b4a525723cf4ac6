//! Bad inputs of every kind end with an exit status and a line that says what is wrong, in little time and
//! memory.

mod arrays;
mod bags;
mod case;
mod curves;
mod messages;
mod options;
mod pipes;
mod stored;
mod text;
mod ulogs;

use case::Case;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::thread;
use tempfile::TempDir;

/// Two programs run at a time.
const AT_ONCE: usize = 2;

#[test]
fn every_bad_input_ends_with_its_status_and_message_in_little_time_and_memory() {
    let cases: Vec<Case> = [
        text::cases(),
        arrays::cases(),
        bags::cases(),
        ulogs::cases(),
        curves::cases(),
        stored::cases(),
        options::cases(),
        pipes::cases(),
    ]
    .into_iter()
    .flatten()
    .collect();
    assert!(cases.len() >= 600, "{} cases", cases.len());
    let needed_kib = case::needed_kib();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut ended = Vec::new();
        loop {
            let place = next.fetch_add(1, Relaxed);
            let Some(case) = cases.get(place) else {
                return ended;
            };
            let folder = TempDir::new().unwrap();
            ended.push((place, case.run(folder.path(), needed_kib)));
        }
    };
    println!("{} bad inputs", cases.len());
    let mut ended: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..AT_ONCE).map(|_| scope.spawn(work)).collect();
        let found = workers.into_iter().map(|worker| worker.join().unwrap());
        found.flatten().collect()
    });
    ended.sort_by_key(|(place, _)| *place);
    let (mut wrong, mut messages) = (Vec::new(), Vec::new());
    for (_, message) in ended {
        match message {
            Ok(message) => messages.push(message),
            Err(what) => {
                wrong.push(what);
                messages.push(String::new());
            }
        }
    }
    let names = messages::numbered(cases.iter().map(Case::name));
    wrong.extend(messages::compare(&names, &messages));
    assert!(
        wrong.is_empty(),
        "{} faults in {} cases:\n{}",
        wrong.len(),
        cases.len(),
        wrong.join("\n")
    );
}
