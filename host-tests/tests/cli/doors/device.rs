//! What a device says of a record: the crate as a firmware uses it, and a product in C on this host and in QEMU.

use super::{RATE_HZ, UNIT, simulated::Rows};
use allanite::{
    Accumulator, Axes, Scale,
    axis::{CoursePart, Courses, GatePart, Gated, MomentPart, Moments},
    integrity::{Reason, Screen},
    spectrum::{Spectral, SpectrumReading},
};
use std::{fs::File, path::Path, process::Command};
use xtask::firmware::{CORTEX_M4F, c_library};

/// The names of the reasons by their numbers in C.
const NAMES: [&str; 15] = [
    "-",
    "stuck",
    "repeated",
    "coarse",
    "railed",
    "spiked",
    "moved",
    "missing",
    "left_out",
    "other",
    "dead_band",
    "misread",
    "changed",
    "unanswered",
    "stale",
];

/// What a device says: the first reason among the axes, and how many samples its gate left out.
pub(super) type Said = (String, u64);

/// What a device without a gate says.
pub(super) fn without_gate(rows: &Rows) -> Said {
    let mut axes = Axes::<20, 0, (), Moments, 3, (), Courses>::new();
    rows.iter().for_each(|&row| axes.push(row));
    said(axes, [])
}

/// What one with a gate says.
pub(super) fn with_gate(rows: &Rows) -> Said {
    let mut axes = Axes::<20, 1, Gated, Moments, 3, Spectral<64, 7, 140>, Courses>::new();
    rows.iter().for_each(|&row| axes.push((row, [0])));
    said(axes, [1.0])
}

/// What a core with little flash says, which keeps a screen of each axis beside its accumulator.
pub(super) fn by_screens(rows: &Rows) -> &'static str {
    let scale = Scale::new(UNIT as _, RATE_HZ as _).unwrap();
    let of_axis = |axis: usize| {
        let (mut accumulator, mut screen) = (Accumulator::<14>::new(), Screen::new());
        for row in rows {
            accumulator.push(row[axis]);
            screen.push(row[axis]);
        }
        screen.verdict(&accumulator.curve(scale), scale)
    };
    name([0, 1, 2].into_iter().find_map(of_axis))
}

fn said<const C: usize, G: GatePart, M: MomentPart, S: SpectrumReading, T: CoursePart>(
    mut axes: Axes<20, C, G, M, 3, S, T>,
    per_count: [allanite::Real; C],
) -> Said {
    let scale = Scale::new(UNIT as _, RATE_HZ as _).unwrap();
    let of_axis = |axis| axes.record(axis, (scale, per_count)).unwrap().invalid;
    let reason = [0, 1, 2].map(of_axis).into_iter().flatten().next();
    (name(reason).into(), axes.left_out())
}

fn name(reason: Option<Reason>) -> &'static str {
    reason.map_or("-", |reason| reason.name())
}

/// Whether a device with a gate says what others say of the whole record. What the gate left out is not in its record.
pub(super) fn is_like((reason, left_out): &Said, whole: &str) -> bool {
    reason == whole || *left_out > 0 && whole != "-"
}

/// The product in C that judges what it is sent, on this host and in QEMU.
pub(super) struct Products {
    commands: [Command; 2],
}

impl Products {
    /// Builds both into a folder.
    pub(super) fn build(folder: &Path) -> Self {
        let [here, there] = ["here", "there"].map(|name| folder.join(name));
        std::fs::create_dir_all(&here).unwrap();
        std::fs::create_dir_all(&there).unwrap();
        let here = c_library::build_for_host(&["judged.c", "host.c"], &here);
        let contents = c_library::Contents::ALL;
        let there = c_library::build_for_target(&CORTEX_M4F, contents, "judged.c", &there);
        let [here, there] = [here, there].map(|built| built.unwrap_or_else(|e| panic!("{e:#}")));
        Self {
            commands: [
                Command::new(here),
                c_library::in_emulator(&CORTEX_M4F, &there),
            ],
        }
    }

    /// What they say of a record.
    pub(super) fn judge(&mut self, folder: &Path, rows: &Rows) -> [Said; 2] {
        let counts = rows.iter().flatten();
        let bytes: Vec<u8> = counts.flat_map(|count| count.to_le_bytes()).collect();
        let path = folder.join("counts.bin");
        std::fs::write(&path, bytes).unwrap();
        self.commands.each_mut().map(|command| {
            let lines = c_library::lines(command.stdin(File::open(&path).unwrap()));
            let lines = lines.unwrap_or_else(|error| panic!("{error:#}"));
            let mut numbers = lines.iter().map(|line| line.parse::<u64>().unwrap());
            let left_out = numbers.next().unwrap();
            let reason = numbers.find(|&reason| reason > 0).unwrap_or_default();
            (NAMES[reason as usize].into(), left_out)
        })
    }
}
