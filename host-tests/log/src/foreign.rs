//! Files that are no logs for this program, and the command that makes one of them.

use crate::failure::{Failure, Place, one_line};
use std::path::Path;

/// The magic bytes at the beginning of a file, what the file is, and the remedy. `FILE` stands for its name.
const MAGICS: [(&[u8], &str, &str); 12] = [
    (
        b"FMT, 128, 89,",
        "a flight log of ArduPilot",
        "convert it with `mavlogdump.py --types IMU --format csv FILE > imu.csv`",
    ),
    (
        b"MDF     ",
        "a measurement in the format MDF",
        "write a table in which invalid samples are NaN, with asammdf and pandas: `mdf = MDF('FILE'); DataFrame({name: \
         Series(s.samples, s.timestamps) for name in NAMES for s in [mdf.get(name)]}).to_csv('log.csv', index_label='time_s')`",
    ),
    (
        b"TDSm",
        "a measurement of LabVIEW in the format TDMS",
        "export its group with the gyro as CSV, such as with npTDMS",
    ),
    (
        b"$IMURAW",
        "a file of raw IMU data in the format IMR",
        "export it as text with the program that made it, or give the receiver's own log as CSV",
    ),
    (
        b"(\xb5/\xfd",
        "compressed with zstd",
        "unpack it with `zstd -d FILE`",
    ),
    (
        b"\xfd7zXZ\0",
        "compressed with xz",
        "unpack it with `xz -dk FILE`",
    ),
    (
        b"BZh",
        "compressed with bzip2",
        "unpack it with `bunzip2 -k FILE`",
    ),
    (
        b"\xfa\xff",
        "a binary log of Xsens",
        "export it as text with MT Manager",
    ),
    (
        b"\xff\xfe",
        "text in UTF-16",
        "convert it with `iconv -f UTF-16 -t UTF-8 FILE > log.csv`",
    ),
    (
        b"\xfe\xff",
        "text in UTF-16",
        "convert it with `iconv -f UTF-16 -t UTF-8 FILE > log.csv`",
    ),
    (b"\x93NUMPY", "a NumPy array", "rename it to .npy"),
    (b"%PDF", "a document", "give the log itself"),
];

/// The extensions of files whose beginning does not tell what they are.
const EXTENSIONS: [(&str, &str, &str); 4] = [
    (
        "tlog",
        "a telemetry log of MAVLink",
        "convert it with `mavlogdump.py --types HIGHRES_IMU --format csv FILE > imu.csv`",
    ),
    (
        "npz",
        "several NumPy arrays",
        "save the one with the gyro with numpy.save",
    ),
    ("zip", "an archive", "unpack it with `unzip FILE`"),
    (
        "mtb",
        "a binary log of Xsens",
        "export it as text with MT Manager",
    ),
];

/// The failure of a file that begins like those of another program.
pub(super) fn refusal(path: &Path, start: &[u8]) -> Option<Failure> {
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    let of_start = MAGICS.iter().find(|(magic, ..)| start.starts_with(magic));
    let of_start = of_start.map(|(_, what, remedy)| (what, remedy));
    let of_name = EXTENSIONS.iter().find(|(name, ..)| *name == extension);
    // MATLAB writes text with this name too: `save -ascii`.
    let is_text = start
        .iter()
        .all(|&byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace());
    let of_name = of_name.filter(|(name, ..)| *name != "mat" || !is_text);
    let of_name = of_name.map(|(_, what, remedy)| (what, remedy));
    let (what, remedy) = of_start.or(of_name)?;
    Some(failure(path, what, remedy))
}

/// The failure of a file that is not a log.
pub(super) fn failure(path: &Path, what: &str, remedy: &str) -> Failure {
    let name = one_line(&path.to_string_lossy());
    Place::file(path).failure(format!("this is {what}"), remedy.replace("FILE", &name))
}
