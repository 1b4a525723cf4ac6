//! Rewrites a table in a process of its own, which has a limit of memory and of computing time.
//!
//! The formats of tables are read by crates of other projects, which allocate what a file claims, and a few hundred bytes
//! can claim gigabytes. The end of such a process is a message about the file, and not the end of the program.

use super::{arrow_rows::Written, rewrite::rewrite};
use crate::{
    failure::{Failure, Place},
    source::TableKind as Kind,
};
use serde::{Deserialize, Serialize};
use std::{
    ffi::{OsStr, OsString},
    io::Write as _,
    path::{Path, PathBuf},
    process::{Command, ExitCode, Stdio},
    sync::OnceLock,
};

/// The argument that asks for the work of such a process. Nobody else gives it.
const ASKED: &str = "__rewrite-table";

/// The memory that the process may take for each byte of the file, and at least, in bytes.
const MEMORY_PER_BYTE: u64 = 52;
const LEAST_MEMORY: u64 = 52 << 20;

/// The computing time that the process may take for each MiB of the file, and at least, in seconds.
const SECONDS_PER_MIB: u64 = 7;

/// The program that can be asked.
static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// What the process answers on its standard output.
#[derive(Serialize, Deserialize)]
enum Answer {
    /// What was written.
    Written(Written),
    /// What is wrong with it, and the remedy.
    Refused(String, String),
}

/// Does the work if this process is asked to, and returns its exit status. Otherwise this program is the one that is asked
/// from now on.
pub fn answer() -> Option<ExitCode> {
    let mut arguments = std::env::args_os().skip(1);
    if arguments.next().as_deref() != Some(OsStr::new(ASKED)) {
        if cfg!(target_os = "linux")
            && let Ok(program) = std::env::current_exe()
        {
            let _ = PROGRAM.set(program);
        }
        return None;
    }
    let asked: Vec<OsString> = arguments.collect();
    let [kind, topic, path, text, values] = asked.as_slice() else {
        return Some(ExitCode::from(2));
    };
    let kind = Kind::ALL.into_iter().find(|known| *kind == *known.name());
    let (Some(kind), topic) = (kind, topic.to_string_lossy()) else {
        return Some(ExitCode::from(2));
    };
    let (path, text, values) = (Path::new(path), Path::new(text), Path::new(values));
    let size = path.metadata().map_or(0, |file| file.len());
    limit(size);
    // An empty topic is that of nobody, because no topic has an empty name.
    let topic = Some(&*topic).filter(|topic| !topic.is_empty());
    let values = Some(values).filter(|values| !values.as_os_str().is_empty());
    let answer = match rewrite(path, kind, topic, (text, values)) {
        Ok(written) => Answer::Written(written),
        Err(Failure::Input { what, remedy, .. }) => Answer::Refused(what, remedy),
        Err(_) => return Some(ExitCode::from(2)),
    };
    let mut output = std::io::stdout().lock();
    let written = serde_json::to_writer(&mut output, &answer).is_ok() && output.flush().is_ok();
    Some(ExitCode::from(if written { 0 } else { 2 }))
}

/// The memory, in bytes, and the time, in seconds, for a file of a size.
fn limits(size: u64) -> (u64, u64) {
    let memory = MEMORY_PER_BYTE.saturating_mul(size).max(LEAST_MEMORY);
    (memory, SECONDS_PER_MIB.saturating_mul(1 + (size >> 20)))
}

/// Limits what this process may take.
#[cfg(target_os = "linux")]
fn limit(size: u64) {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let (memory, seconds) = limits(size);
    for (resource, most) in [(Resource::Data, memory), (Resource::Cpu, seconds)] {
        let limit = Rlimit {
            current: Some(most),
            maximum: Some(most),
        };
        // A limit that is lower already stays.
        let _ = setrlimit(resource, limit);
    }
}

#[cfg(not(target_os = "linux"))]
fn limit(_: u64) {}

/// Asks another process to rewrite a table. `None` if there is none that can be asked.
pub(super) fn ask(
    path: &Path,
    kind: Kind,
    topic: Option<&str>,
    (text, values): (&Path, Option<&Path>),
) -> Option<Result<Written, Failure>> {
    let here = || Place::file(path);
    let asked = Command::new(PROGRAM.get()?)
        .arg(ASKED)
        .arg(kind.name())
        .arg(topic.unwrap_or_default())
        .args([path, text, values.unwrap_or(Path::new(""))])
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let answer = serde_json::from_slice(&asked.stdout);
    Some(match (asked.status.success(), answer) {
        (true, Ok(Answer::Written(written))) => Ok(written),
        (true, Ok(Answer::Refused(what, remedy))) => Err(here().failure(what, remedy)),
        _ => {
            let size = path.metadata().map_or(0, |file| file.len());
            let (memory, seconds) = limits(size);
            let memory = memory >> 20;
            Err(here().failure(
                format!(
                    "damaged: to read it takes more than {memory} MiB of memory or {seconds} s"
                ),
                "check what it holds, and export it as CSV",
            ))
        }
    })
}
