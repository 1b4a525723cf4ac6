//! Files that are no logs for this program, and the command that makes one of them.

use crate::failure::{Failure, Place, one_line};
use std::path::Path;

/// The magic bytes at the beginning of a file, what the file is, and the remedy. `FILE` stands for its name.
const MAGICS: [(&[u8], &str, &str); 15] = [
    (
        b"H Product:Blackbox",
        "a flight log of Betaflight",
        "convert it with `blackbox_decode FILE`, and give the .csv file",
    ),
    (
        b"\xa3\x95\x80",
        "a flight log of ArduPilot",
        "convert it with `mavlogdump.py --types IMU --format csv FILE > imu.csv`",
    ),
    (
        b"FMT, 128, 89,",
        "a flight log of ArduPilot",
        "convert it with `mavlogdump.py --types IMU --format csv FILE > imu.csv`",
    ),
    (
        b"MATLAB 5.0",
        "a file of MATLAB",
        "save its table in MATLAB with `writematrix(TABLE, 'log.csv')`",
    ),
    (
        b"MATLAB 7.3",
        "a file of MATLAB",
        "save its table in MATLAB with `writematrix(TABLE, 'log.csv')`",
    ),
    (
        b"\x89HDF\r\n\x1a\n",
        "an HDF5 file",
        "export its table with `h5dump -d DATASET -y -w 0 -o log.csv FILE`",
    ),
    (
        b"PAR1",
        "a Parquet file",
        "convert it with `duckdb -c \"COPY 'FILE' TO 'log.csv'\"`",
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
const EXTENSIONS: [(&str, &str, &str); 8] = [
    (
        "bbl",
        "a flight log of Betaflight",
        "convert it with `blackbox_decode FILE`, and give the .csv file",
    ),
    (
        "bfl",
        "a flight log of Betaflight",
        "convert it with `blackbox_decode FILE`, and give the .csv file",
    ),
    (
        "tlog",
        "a telemetry log of MAVLink",
        "convert it with `mavlogdump.py --types HIGHRES_IMU --format csv FILE > imu.csv`",
    ),
    (
        "xlsx",
        "a workbook",
        "save its sheet as CSV, such as with `soffice --convert-to csv FILE`",
    ),
    (
        "npz",
        "several NumPy arrays",
        "save the one with the gyro with numpy.save",
    ),
    ("zip", "an archive", "unpack it with `unzip FILE`"),
    (
        "mat",
        "a file of MATLAB",
        "save its table in MATLAB with `writematrix(TABLE, 'log.csv')`",
    ),
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
