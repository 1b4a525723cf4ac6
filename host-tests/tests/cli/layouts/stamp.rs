//! Stamps: the same moments in the ways of many loggers.

use super::random::Random;

/// The manner in which a moment is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Manner {
    /// No stamp at all.
    None,
    /// Whole ticks, so many a second, in a counter of so many bits, or from 1970.
    Whole {
        per_second: u64,
        bits: Option<u32>,
        is_epoch: bool,
    },
    /// A number with decimals, in units of so many a second.
    Decimal {
        per_second: u64,
        decimals: usize,
        is_epoch: bool,
    },
    /// A date and a time: what stands between them, decimals of the second, and what stands behind.
    Date(char, usize, &'static str),
    /// A date and a time in two columns.
    TwoColumns(usize),
    /// The time of day with colons, which may go over midnight.
    Clock(usize),
    /// The time of day as one number, `HHMMSS.sss`.
    Hhmmss(usize),
    /// The week of the GPS and the seconds in it.
    Week(usize),
    /// Whole seconds and the nanoseconds or microseconds beside them.
    Pair(u64),
}

/// What stands as stamps in a log.
pub(super) struct Stamps {
    pub(super) manner: Manner,
    /// The names of the columns.
    pub(super) names: Vec<String>,
    /// The unit for a second row of the header.
    pub(super) below: String,
    /// Whether name or form tells the unit.
    pub(super) is_told: bool,
    start_ns: u64,
}

/// 2026-03-02 07:48:00.
const EPOCH_S: u64 = 1_772_437_680;

impl Stamps {
    pub(super) fn new(rate_hz: f64, has_header: bool, random: &mut Random) -> Self {
        let mut manner = manner(rate_hz, random);
        // Without a name, nobody knows that a counter does not count a part of a second that is a power of ten.
        if let Manner::Whole {
            per_second: 32_768 | 10_000,
            ..
        } = manner
            && !has_header
        {
            manner = Manner::None;
        }
        let (names, is_told) = names(manner, random);
        let start_ns = match manner {
            Manner::Whole {
                per_second,
                bits: Some(bits),
                ..
            } => {
                // The counter begins anew within the first seconds of the record.
                let round = (1_u64 << bits) as f64 / per_second as f64;
                (1e9 * (round - random.between(0.1, 0.6)).max(0.0)) as u64
            }
            Manner::Whole { is_epoch: true, .. } | Manner::Decimal { is_epoch: true, .. } => {
                EPOCH_S * 1_000_000_000 + random.below(1_000_000_000) as u64
            }
            Manner::Pair(_) => EPOCH_S * 1_000_000_000 + 123_456_789,
            Manner::Clock(_) if random.chance(0.3) => 86_399_300_000_000,
            Manner::Hhmmss(_) if random.chance(0.3) => 43_199_000_000_000,
            Manner::Clock(_) | Manner::Hhmmss(_) => 43_100_000_000_000,
            _ if random.chance(0.4) => 0,
            _ => random.below(90_000) as u64 * 1_000_003,
        };
        let below = match manner {
            Manner::Whole {
                per_second: 1_000_000_000,
                ..
            } => "ns",
            Manner::Whole {
                per_second: 1_000_000,
                ..
            } => "us",
            Manner::Whole {
                per_second: 1000, ..
            }
            | Manner::Decimal {
                per_second: 1000, ..
            } => "ms",
            Manner::Decimal { .. } => "s",
            _ => "",
        };
        Self {
            manner,
            names,
            below: below.to_owned(),
            is_told,
            start_ns,
        }
    }

    pub(super) fn columns(&self) -> usize {
        match self.manner {
            Manner::None => 0,
            Manner::TwoColumns(_) | Manner::Week(_) | Manner::Pair(_) => 2,
            _ => 1,
        }
    }

    /// The smallest step, in s.
    pub(super) fn resolution(&self) -> f64 {
        match self.manner {
            Manner::None => 0.0,
            Manner::Whole { per_second, .. } => 1.0 / per_second as f64,
            Manner::Decimal {
                per_second,
                decimals,
                ..
            } => 0.1_f64.powi(decimals as i32) / per_second as f64,
            Manner::Date(_, decimals, _)
            | Manner::TwoColumns(decimals)
            | Manner::Clock(decimals)
            | Manner::Hhmmss(decimals)
            | Manner::Week(decimals) => 0.1_f64.powi(decimals as i32),
            Manner::Pair(per_second) => 1.0 / per_second as f64,
        }
    }

    /// The value of `--time-unit` that goes with the stamps.
    pub(super) fn time_unit(&self) -> Option<&'static str> {
        match self.manner {
            Manner::Whole { per_second, .. } | Manner::Decimal { per_second, .. } => {
                match per_second {
                    1 => Some("s"),
                    1000 => Some("ms"),
                    1_000_000 => Some("us"),
                    1_000_000_000 => Some("ns"),
                    _ => None,
                }
            }
            Manner::Week(_) => Some("s"),
            _ => None,
        }
    }

    /// The text of a moment, in ns from the first.
    pub(super) fn written(&self, moment_ns: u64) -> Vec<String> {
        let ns = self.start_ns + moment_ns;
        let decimal = |ns: u128, decimals: usize| {
            let step = 10_u128.pow(9 - decimals as u32);
            let whole = ns / step;
            let one = 10_u128.pow(decimals as u32);
            if decimals == 0 {
                return whole.to_string();
            }
            format!("{}.{:0decimals$}", whole / one, whole % one)
        };
        let clock = |decimals: usize, colon: &str| {
            let day = ns % 86_400_000_000_000;
            let minutes = day / 60_000_000_000;
            let seconds = decimal(u128::from(day % 60_000_000_000), decimals);
            let width = 2 + usize::from(decimals > 0) + decimals;
            format!(
                "{:02}{colon}{:02}{colon}{seconds:0>width$}",
                minutes / 60,
                minutes % 60
            )
        };
        match self.manner {
            Manner::None => Vec::new(),
            Manner::Whole {
                per_second, bits, ..
            } => {
                let ticks = u128::from(ns) * u128::from(per_second) / 1_000_000_000;
                let ticks = bits.map_or(ticks, |bits| ticks % (1 << bits));
                vec![ticks.to_string()]
            }
            Manner::Decimal {
                per_second,
                decimals,
                ..
            } => vec![decimal(u128::from(ns) * u128::from(per_second), decimals)],
            Manner::Date(between, decimals, behind) => {
                vec![format!(
                    "2026-03-02{between}{}{behind}",
                    clock(decimals, ":")
                )]
            }
            Manner::TwoColumns(decimals) => vec!["2026-03-02".into(), clock(decimals, ":")],
            Manner::Clock(decimals) => vec![clock(decimals, ":")],
            Manner::Hhmmss(decimals) => vec![clock(decimals, "")],
            Manner::Week(decimals) => {
                let tow = u128::from(ns) + 425_384_000_000_000;
                vec!["2405".into(), decimal(tow, decimals)]
            }
            Manner::Pair(per_second) => vec![
                (ns / 1_000_000_000).to_string(),
                (ns % 1_000_000_000 / (1_000_000_000 / per_second)).to_string(),
            ],
        }
    }
}

fn manner(rate_hz: f64, random: &mut Random) -> Manner {
    let whole = |per_second, bits, is_epoch| Manner::Whole {
        per_second,
        bits,
        is_epoch,
    };
    let decimal = |per_second, decimals, is_epoch| Manner::Decimal {
        per_second,
        decimals,
        is_epoch,
    };
    let fine = if rate_hz > 400.0 { 6 } else { 3 };
    loop {
        let manner = match random.below(34) {
            0 | 1 => Manner::None,
            2 | 3 => whole(1_000_000, None, false),
            4 => whole(1_000_000, Some(32), false),
            5 => whole(1_000_000, Some(31), false),
            6 => whole(1_000_000, Some(24), false),
            7 => whole(1_000_000, Some(16), false),
            8 | 9 => whole(1000, None, false),
            10 => whole(1000, Some(16), false),
            11 => whole(1000, Some(32), false),
            12 => whole(1_000_000_000, None, true),
            13 => whole(1_000_000_000, None, false),
            14 => whole(1_000_000, None, true),
            15 => whole(1000, None, true),
            16 => whole(32_768, random.of(&[None, Some(16), Some(24)]), false),
            17 => whole(10_000, Some(32), false),
            18 | 19 => decimal(1, fine, false),
            20 => decimal(1, 6, false),
            21 => decimal(1, 9, false),
            22 => decimal(1, 6, true),
            23 => decimal(1000, 3, false),
            24 => decimal(1000, 1, true),
            25 => Manner::Date('T', fine, random.of(&["", "Z", "+00:00"])),
            26 => Manner::Date(' ', fine, ""),
            27 => Manner::TwoColumns(fine),
            28 | 29 => Manner::Clock(fine),
            30 => Manner::Hhmmss(fine),
            31 => Manner::Week(fine),
            32 => Manner::Pair(random.of(&[1_000_000_000, 1_000_000])),
            _ => whole(1, None, true),
        };
        let possible = match manner {
            Manner::Whole {
                per_second: 1000, ..
            } => rate_hz < 2000.0,
            // Twenty rows at least stand between two beginnings of the counter.
            Manner::Whole {
                per_second,
                bits: Some(bits),
                ..
            } => (1_u64 << bits) as f64 * rate_hz / per_second as f64 > 20.0,
            Manner::Whole { per_second: 1, .. } => rate_hz < 500.0,
            _ => true,
        };
        if possible {
            return manner;
        }
    }
}

/// Names of the columns, and whether name or form tells the unit.
fn names(manner: Manner, random: &mut Random) -> (Vec<String>, bool) {
    let one = |name: &str, is_told: bool| (vec![name.to_owned()], is_told);
    let plain = ["time", "timestamp", "Time", "t", "stamp", "Timestamp"];
    match manner {
        Manner::None => (Vec::new(), true),
        Manner::Whole {
            per_second: 32_768 | 10_000,
            ..
        } => one(random.of(&["ticks", "tick", "clock_ticks"]), false),
        Manner::Whole { per_second, .. } | Manner::Decimal { per_second, .. } => {
            let told = match per_second {
                1 => ["time_s", "Time (s)", "t [s]", "elapsed (s)", "seconds"],
                1000 => ["time_ms", "Time (ms)", "t [ms]", "millis", "timestamp_ms"],
                1_000_000 => ["time_us", "Time (us)", "t [us]", "micros", "timestamp_us"],
                _ => [
                    "time_ns",
                    "Time (ns)",
                    "#timestamp [ns]",
                    "nanos",
                    "timestamp_ns",
                ],
            };
            if random.chance(0.65) {
                one(random.of(&told), true)
            } else {
                one(random.of(&plain), false)
            }
        }
        Manner::Date(..) => one(random.of(&["time", "datetime", "Timestamp", "Date"]), true),
        Manner::TwoColumns(_) => (vec!["date".into(), "time".into()], true),
        Manner::Clock(_) => one(random.of(&["time", "time of day", "UTC", "clock"]), true),
        Manner::Hhmmss(_) => one(random.of(&["utc", "time", "utc_time", "hhmmss"]), false),
        Manner::Week(_) => {
            let names = random.of(&[
                ["week", "tow"],
                ["GPS week", "GPS seconds"],
                ["gps_week", "tow_s"],
            ]);
            (names.map(String::from).to_vec(), true)
        }
        Manner::Pair(per_second) => {
            let names = if per_second == 1_000_000 {
                random.of(&[["sec", "usec"], ["tv_sec", "tv_usec"]])
            } else {
                random.of(&[
                    ["sec", "nanosec"],
                    ["secs", "nsecs"],
                    ["stamp.sec", "stamp.nanosec"],
                ])
            };
            (names.map(String::from).to_vec(), true)
        }
    }
}
