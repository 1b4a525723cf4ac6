//! What of an HDF5 file is left out, because it cannot be read.

use super::wrong::Wrong;
use crate::{converted::LEFT_OUT, failure::one_line};
use hdf5_pure::{Dataset, Error, FormatError};

/// The command of the HDF Group that unpacks a file, and writes it in the oldest form that holds it.
const UNPACK: &str = "unpack it with `h5repack -f NONE IN OUT`";

/// The command that copies values of elsewhere into a file.
const GATHER: &str = "copy its values into the file with `h5repack -l CONTI IN OUT`";

/// The filters that are read: deflate, shuffle, fletcher32, scale-offset and LZF.
const READ: [u16; 5] = [1, 2, 3, 6, 32000];

/// The filters of HDF5 and of its plugins that are not read, by the numbers under which the HDF Group registers them.
const FILTERS: [(u16, &str); 14] = [
    (4, "szip"),
    (5, "nbit"),
    (305, "LZO"),
    (307, "bzip2"),
    (32001, "blosc"),
    (32004, "lz4"),
    (32008, "bitshuffle"),
    (32013, "zfp"),
    (32015, "zstd"),
    (32017, "SZ"),
    (32018, "FCIDECOMP"),
    (32024, "SZ3"),
    (32026, "blosc2"),
    (32028, "sperr"),
];

/// Why a data set or link is left out.
enum Reason {
    /// It is packed by a filter with this number.
    Filter(u16),
    /// Its values are elsewhere.
    Elsewhere(&'static str),
    /// It is of a form that is newer than the reader.
    Newer,
    /// It is a soft link to this path.
    Link(String),
    /// It is damaged, as the reader says.
    Damaged(String),
}

impl Reason {
    fn of(error: &Error) -> Self {
        match error {
            Error::Format(FormatError::UnsupportedFilter(number)) => Self::Filter(*number),
            Error::Format(FormatError::UnsupportedVirtualLayout) => {
                Self::Elsewhere("its values are those of other data sets")
            }
            Error::Format(FormatError::UnsupportedExternalStorage) => {
                Self::Elsewhere("its values are in another file")
            }
            // HDF5 2.0 writes version 5, which no earlier library reads.
            Error::Format(FormatError::InvalidLayoutVersion(5)) => Self::Newer,
            _ => Self::Damaged(one_line(&error.to_string())),
        }
    }

    fn said(&self) -> String {
        match self {
            Self::Filter(number) => {
                let filter = FILTERS.iter().find(|(known, _)| known == number);
                let name = filter.map_or("of a plugin", |(_, name)| name);
                format!("it is packed by filter {number}, {name}, which is not read")
            }
            Self::Elsewhere(what) => (*what).to_owned(),
            Self::Newer => "it is in the form of HDF5 2.0, which is not read".into(),
            Self::Link(to) => format!("it is a soft link to {}", one_line(to)),
            Self::Damaged(what) => format!("it is damaged: {what}"),
        }
    }

    /// What makes it one that is read, if something does.
    fn remedy(&self) -> Option<&'static str> {
        match self {
            Self::Filter(_) | Self::Newer => Some(UNPACK),
            Self::Elsewhere(_) => Some(GATHER),
            Self::Link(_) | Self::Damaged(_) => None,
        }
    }
}

/// The data sets and links that are left out, with the reason for each.
#[derive(Default)]
pub(super) struct LeftOut(Vec<(String, Reason)>);

impl LeftOut {
    /// A data set that cannot be read. A filter that is not known is the reason, whichever error it leads to.
    pub(super) fn dataset(&mut self, place: String, dataset: Option<&Dataset>, error: &Error) {
        let filters = dataset.map(Dataset::filters).unwrap_or_default();
        let strange = filters.iter().find(|number| !READ.contains(number));
        let reason = match (Reason::of(error), strange) {
            (Reason::Damaged(_), Some(&number)) => Reason::Filter(number),
            (reason, _) => reason,
        };
        self.0.push((place, reason));
    }

    pub(super) fn link(&mut self, place: String, to: String) {
        self.0.push((place, Reason::Link(to)));
    }

    /// One line on all of them, if there are any.
    pub(super) fn note(&self) -> Option<String> {
        const FEW: usize = 5;
        let said = self.0.iter().take(FEW);
        let said = said.map(|(place, reason)| format!("{} ({})", one_line(place), reason.said()));
        let mut note = LEFT_OUT.to_owned() + &said.collect::<Vec<_>>().join(", ");
        if self.0.len() > FEW {
            note += &format!(" and {} more", self.0.len() - FEW);
        }
        let remedy = self.0.iter().find_map(|(_, reason)| reason.remedy());
        note += &remedy.map_or(String::new(), |remedy| format!("; {remedy}"));
        (!self.0.is_empty()).then_some(note)
    }

    /// The refusal of a file of which nothing else is left.
    pub(super) fn refusal(&self) -> Option<Wrong> {
        let mut all = self.0.iter();
        let whole = all.find_map(|(place, reason)| Some((place, reason, reason.remedy()?)));
        if let Some((place, reason, remedy)) = whole {
            let what = format!(
                "no data set can be read: {}: {}",
                one_line(place),
                reason.said()
            );
            return Some(Wrong::unfit(what, remedy));
        }
        self.0.iter().find_map(|(place, reason)| match reason {
            Reason::Damaged(what) => Some(Wrong::damaged(format!("{}: {what}", one_line(place)))),
            _ => None,
        })
    }
}
