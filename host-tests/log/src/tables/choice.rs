//! Which table of a file is read.

use super::wrong::Wrong;
use crate::failure::{one_line, quoted};

/// A table in a file that may hold several.
pub(super) struct Candidate {
    pub(super) name: String,
    pub(super) rows: u64,
}

/// The place of the table that is asked for, or else of the one with the most rows, and a note that names the others.
pub(super) fn choose(
    candidates: &[Candidate],
    topic: Option<&str>,
    what: &str,
) -> Result<(usize, Option<String>), Wrong> {
    let shown = |candidates: &[&Candidate]| {
        let shown = candidates.iter().take(20);
        let shown = shown.map(|one| format!("{} ({} rows)", one_line(&one.name), one.rows));
        shown.collect::<Vec<_>>().join(", ")
    };
    let all: Vec<&Candidate> = candidates.iter().collect();
    if let Some(wanted) = topic {
        let found = candidates.iter().position(|one| one.name == wanted);
        return found.map(|place| (place, None)).ok_or_else(|| {
            Wrong::unfit(
                format!("no {what} is named {}", quoted(wanted.as_bytes())),
                format!("choose with --topic from {}", shown(&all)),
            )
        });
    }
    let most = candidates.iter().map(|one| one.rows).max();
    let best: Vec<usize> = (0..candidates.len())
        .filter(|&place| Some(candidates[place].rows) == most)
        .collect();
    match best[..] {
        [] => Err(Wrong::unfit(
            format!("no {what} with numbers"),
            "export the log as CSV",
        )),
        [only] => {
            let others = all.iter().copied().filter(|one| one.name != all[only].name);
            let others = shown(&others.collect::<Vec<_>>());
            let note = format!(
                "{what} {}; others: {others} (choose with --topic)",
                one_line(&all[only].name)
            );
            Ok((only, (!others.is_empty()).then_some(note)))
        }
        _ => {
            let best: Vec<_> = best.iter().map(|&place| all[place]).collect();
            Err(Wrong::unfit(
                format!("{} {what}s fit equally well: {}", best.len(), shown(&best)),
                "choose one with --topic",
            ))
        }
    }
}
