//! Points of a formula in a file: two columns of numbers, such as frequency and density.

use super::formula::Points;
use allanite_log::failure::{Failure, Place, quoted};
use std::{io::Read, path::Path};

/// The largest file, in bytes. Chosen by hand: 40 000 points.
const LARGEST: u64 = 1 << 20;

/// Reads the points of a file. Lines that begin with `#` or `%` are left out, and so is a first line of names.
///
/// # Errors
/// When the file cannot be read, or is no list of ascending points.
pub(super) fn points(path: &str) -> Result<Points, Failure> {
    let path = Path::new(path);
    let place = || Place::file(path);
    let (file, _) = allanite_log::regular_file::open(path)?;
    let mut text = String::new();
    file.take(LARGEST + 1)
        .read_to_string(&mut text)
        .map_err(|error| place().io(&error))?;
    if text.len() as u64 > LARGEST {
        return Err(place().failure("the file is too large for points", "give at most 1 MiB"));
    }
    let is_comment = |line: &&str| !line.is_empty() && !line.starts_with(['#', '%']);
    let lines = text.lines().map(str::trim).filter(is_comment);
    let mut points = Vec::new();
    for (at, line) in lines.enumerate() {
        let separators = |c: char| c.is_whitespace() || c == ',' || c == ';';
        let fields: Vec<&str> = line
            .split(separators)
            .filter(|field| !field.is_empty())
            .collect();
        let numbers = fields.iter().map(|field| field.parse::<f64>());
        match numbers.collect::<Result<Vec<_>, _>>().as_deref() {
            Ok(&[x, y]) => points.push([x, y]),
            Err(_) if at == 0 => {}
            _ => {
                let what = format!("{} is no point", quoted(line.as_bytes()));
                return Err(place().failure(what, "give two numbers in each line"));
            }
        }
    }
    Points::new(points).map_err(|(what, remedy)| place().failure(what, remedy))
}
