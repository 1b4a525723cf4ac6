//! Simulated records as NumPy files of counts.

use crate::{OCTAVES, RATE_HZ, quantum, record};
use allanite::Curve;
use allanite_host::simulate::{Coefficients, Hidden, Simulator};
use allanite_log::npy_header::{Header, Kind};
use anyhow::Result;
use std::{
    fs::File,
    io::{BufWriter, Write},
    path::Path,
};

/// The sampling rate, in Hz, and the size of a count of a gyro, in deg/s.
pub(super) fn scale(coefficients: Coefficients) -> [f64; 2] {
    [RATE_HZ, quantum(coefficients, RATE_HZ)]
}

/// Writes the record of a seed, and hands its counts over in order. Returns its curve.
pub(super) fn write(
    path: &Path,
    coefficients: Coefficients,
    hidden: &[Hidden],
    [samples, seed]: [u64; 2],
    mut watch: impl FnMut(&[i32]),
) -> Result<Curve<OCTAVES>> {
    let mut file = BufWriter::new(File::create(path)?);
    let header = Header {
        kind: Kind::Signed,
        size: 4,
        big_endian: false,
        fortran_order: false,
        shape: vec![samples],
    };
    header.write(&mut file)?;
    let mut written = Ok(());
    let mut simulator = Simulator::with_hidden(coefficients, hidden, RATE_HZ, seed);
    let curve = record(&mut simulator, coefficients, samples as usize, |counts| {
        watch(counts);
        let bytes: Vec<u8> = counts
            .iter()
            .flat_map(|count| count.to_le_bytes())
            .collect();
        if written.is_ok() {
            written = file.write_all(&bytes);
        }
    });
    written?;
    file.flush()?;
    Ok(curve)
}
