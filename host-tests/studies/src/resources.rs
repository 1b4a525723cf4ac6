//! What this process has used, and which sources it was built from.

use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use std::{fs, process::Command};

/// What a process used from its start until its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Resources {
    /// CPU time of all threads, in the program and in the system, in s.
    pub cpu_s: f64,
    /// The largest resident memory, in bytes; NaN where the system does not tell.
    pub peak_bytes: f64,
}

impl Resources {
    /// What this process has used until now.
    pub fn used() -> Self {
        Self {
            cpu_s: cpu_s(),
            peak_bytes: peak_bytes(),
        }
    }
}

/// The CPU time of all threads of this process until now, in s.
pub fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The largest resident memory of this process until now, in bytes. The figure is that of Linux, `VmHWM`, which begins
/// anew with the program; `ru_maxrss` would include the memory of the process that started it. NaN elsewhere.
pub fn peak_bytes() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kib.map_or(f64::NAN, |kib| 1024.0 * kib)
}

/// The commit of the sources, with a plus where files were changed since; `unknown` outside of a repository.
pub fn commit() -> String {
    let mut git = Command::new("git");
    git.current_dir(env!("CARGO_MANIFEST_DIR"));
    git.args(["describe", "--always", "--dirty=+", "--exclude=*"]);
    let output = git.output().ok().filter(|output| output.status.success());
    output.map_or_else(
        || "unknown".to_owned(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    )
}
