//! Characters around every row and between its values.

use super::{random::Random, stamp::Manner};

/// The characters around the rows of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Glue {
    None,
    Brackets,
    Parentheses,
    SemicolonBehind,
    CommaBehind,
    Checksum,
    /// `$IMU,…*5A`, as NMEA 0183 frames its sentences.
    Nmea,
    /// `imu: …`
    Tag,
    /// `12:30:00.010 -> …`, as a serial monitor writes.
    Arrow,
    /// `I (312) imu: …`, as ESP-IDF writes.
    Esp,
    /// Quotes around every value.
    Quotes,
    /// A label in front of every value.
    Labels,
}

impl Glue {
    pub(super) fn new(manner: Manner, has_header: bool, random: &mut Random) -> Self {
        if manner == Manner::None && random.chance(0.35) {
            return random.of(&[Self::Arrow, Self::Esp]);
        }
        if random.chance(0.65) {
            return Self::None;
        }
        match random.below(if has_header { 6 } else { 9 }) {
            0 => Self::Brackets,
            1 => Self::Parentheses,
            2 => Self::SemicolonBehind,
            3 => Self::CommaBehind,
            4 => Self::Quotes,
            5 => Self::Checksum,
            6 => Self::Nmea,
            7 => Self::Tag,
            _ => Self::Labels,
        }
    }

    /// Whether the glue holds the time of the row.
    pub(super) fn has_time(self) -> bool {
        matches!(self, Self::Arrow | Self::Esp)
    }

    /// A row of values with its glue.
    pub(super) fn around(self, cells: &[String], separator: &str, moment_ns: u64) -> String {
        if self == Self::Quotes {
            let quoted = cells.iter().map(|cell| format!("\"{cell}\""));
            return quoted.collect::<Vec<_>>().join(separator);
        }
        if self == Self::Labels {
            let labelled = cells.iter().enumerate();
            let labelled = labelled.map(|(column, cell)| format!("v{column}:{cell}"));
            return labelled.collect::<Vec<_>>().join(separator);
        }
        let row = cells.join(separator);
        let sum = row.bytes().fold(0_u8, |sum, byte| sum ^ byte);
        let ms = moment_ns / 1_000_000;
        match self {
            Self::Brackets => format!("[{row}]"),
            Self::Parentheses => format!("({row})"),
            Self::SemicolonBehind => format!("{row};"),
            Self::CommaBehind => format!("{row}{}", separator.trim_end()),
            Self::Checksum => format!("{row}*{sum:02X}"),
            Self::Nmea => format!("$PIMU{separator}{row}*{sum:02X}"),
            Self::Tag => format!("imu: {row}"),
            Self::Arrow => format!(
                "12:{:02}:{:02}.{:03} -> {row}",
                30 + ms / 60_000,
                ms / 1000 % 60,
                ms % 1000
            ),
            Self::Esp => format!("I ({}) imu: {row}", 312 + ms),
            _ => row,
        }
    }

    /// The header above such rows.
    pub(super) fn header(self, names: &[String], separator: &str) -> String {
        let row = names.join(separator);
        match self {
            Self::SemicolonBehind => format!("{row};"),
            Self::CommaBehind => format!("{row}{}", separator.trim_end()),
            Self::Arrow | Self::Esp => self.around(names, separator, 0),
            _ => row,
        }
    }
}
