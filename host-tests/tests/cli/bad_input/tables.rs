//! Bad tables of other programs in binary.

use super::case::{Case, refused};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fs, path::Path};

/// Files that are good.
const FILES: [&str; 10] = [
    "LOG00001.BBL",
    "ardupilot.bin",
    "excel.xlsx",
    "h5py.h5",
    "matlab-v73.mat",
    "matlab.mat",
    "pandas.feather",
    "pandas.parquet",
    "polars.arrows",
    "polars.parquet",
];

/// The number of changed copies of each file.
const COPIES: u64 = 16;

pub(crate) fn cases() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/origins");
    let mut cases = vec![
        refused("a.bbl", "", "fit a.bbl", "no log with numbers"),
        refused("a.parquet", "PAR1", "fit a.parquet", "ends in the middle"),
        refused("a.arrow", "ARROW1\0\0", "fit a.arrow", "damaged"),
        refused("a.mat", "MATLAB 5.0", "fit a.mat", "damaged"),
        refused("a.mf4", "MDF     4.10", "fit a.mf4", "in the format MDF"),
        refused("a.tdms", "TDSm\0\0", "fit a.tdms", "in the format TDMS"),
        refused("a.imr", "$IMURAW\0\0", "fit a.imr", "in the format IMR"),
        refused("a.xlsx", "PK\x03\x04\0", "fit a.xlsx", "damaged"),
    ];
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for file in FILES {
        let good = fs::read(folder.join(file)).expect("a file of the repository");
        let command = format!("fit {file} --topic nothing");
        // Tables of Arrow stand alone in their file.
        let is_alone = file.starts_with('p');
        let expected = if is_alone {
            "no topics"
        } else {
            "is named \"nothing\""
        };
        cases.push(refused(file, good.clone(), &command, expected));
        for _ in 0..COPIES {
            let mut bytes = good.clone();
            if random.random_bool(0.25) {
                bytes.truncate(random.random_range(16..good.len()));
            }
            // The ends of most formats say where the rest is.
            for _ in 0..random.random_range(1..6) {
                let at = match random.random_range(0..3) {
                    0 => random.random_range(0..bytes.len()),
                    1 => random.random_range(0..bytes.len().min(256)),
                    _ => random.random_range(bytes.len().saturating_sub(512)..bytes.len()),
                };
                bytes[at] = match random.random_range(0..3) {
                    0 => 0xff,
                    1 => 0x7f,
                    _ => random.random(),
                };
            }
            cases.push(refused(file, bytes, &format!("fit {file}"), "").ambiguous());
        }
    }
    cases
}
