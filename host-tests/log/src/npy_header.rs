//! Reads and writes the header of NumPy's array files, versions 1.0 to 3.0 of the format (NEP 1).
//!
//! No library is used, because the sizes and shapes in a hostile header must neither overflow nor
//! cause large allocations.

use std::{
    io::{self, Read, Write},
    path::{Path, PathBuf},
};

const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// The file beside an array that tells its rate, unit and scale, in a comment like that at the top of a log of text:
/// `log.npy.txt` for `log.npy`. The format of arrays has no place for them.
pub fn sidecar(array: &Path) -> PathBuf {
    let mut name = array.as_os_str().to_owned();
    name.push(".txt");
    name.into()
}

/// The longest header that is accepted, in bytes. The header of a plain array takes about a hundred.
/// Chosen by hand.
const LONGEST: usize = 1 << 14;

/// The kind of number that an array holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Signed integers.
    Signed,
    /// Unsigned integers.
    Unsigned,
    /// Floats.
    Float,
}

/// The element type, the memory order and the shape of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// The kind of the elements.
    pub kind: Kind,
    /// The size of an element, in bytes.
    pub size: usize,
    /// Whether the most significant byte comes first.
    pub big_endian: bool,
    /// Whether columns rather than rows are contiguous.
    pub fortran_order: bool,
    /// The number of elements along each dimension.
    pub shape: Vec<u64>,
}

impl Header {
    /// Reads the header and leaves the reader at the first element. The inner error describes a
    /// header that was read and is not valid.
    pub fn read(reader: &mut impl Read) -> io::Result<Result<Self, String>> {
        let mut start = [0; 8];
        reader.read_exact(&mut start)?;
        if start[..6] != MAGIC[..] {
            return Ok(Err("this is not a NumPy array file".into()));
        }
        let length = match start[6] {
            1 => {
                let mut bytes = [0; 2];
                reader.read_exact(&mut bytes)?;
                usize::from(u16::from_le_bytes(bytes))
            }
            2 | 3 => {
                let mut bytes = [0; 4];
                reader.read_exact(&mut bytes)?;
                u32::from_le_bytes(bytes) as usize
            }
            version => {
                return Ok(Err(format!(
                    "version {version} of the format is not supported"
                )));
            }
        };
        if length > LONGEST {
            return Ok(Err(format!(
                "the header has {length} bytes, too many for a plain array"
            )));
        }
        let mut text = vec![0; length];
        reader.read_exact(&mut text)?;
        let text = String::from_utf8_lossy(&text);
        Ok(Self::parse(&text))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let descr = value_of(text, "descr")?;
        let Some(descr) = descr.strip_prefix(['\'', '"']) else {
            return Err("a structured array is not a table of numbers".into());
        };
        let descr = descr.split(['\'', '"']).next().unwrap_or_default();
        let unknown = || format!("elements of type {descr:?} are not plain numbers");
        let mut characters = descr.chars();
        let big_endian = match characters.next() {
            Some('<' | '|') => false,
            Some('>') => true,
            Some('=') => cfg!(target_endian = "big"),
            _ => return Err(unknown()),
        };
        let kind = match characters.next() {
            Some('i') => Kind::Signed,
            Some('u') => Kind::Unsigned,
            Some('f') => Kind::Float,
            _ => return Err(unknown()),
        };
        let size = characters.as_str().parse().map_err(|_| unknown())?;
        match (kind, size) {
            (Kind::Float, 4 | 8) | (Kind::Signed | Kind::Unsigned, 1 | 2 | 4 | 8) => {}
            _ => return Err(unknown()),
        }

        let fortran_order = match value_of(text, "fortran_order")? {
            value if value.starts_with("True") => true,
            value if value.starts_with("False") => false,
            _ => return Err("the header does not give the memory order".into()),
        };

        let shapeless = || "the header gives no shape".to_owned();
        let shape = value_of(text, "shape")?
            .strip_prefix('(')
            .ok_or_else(shapeless)?;
        let (shape, _) = shape.split_once(')').ok_or_else(shapeless)?;
        let shape = shape
            .split(',')
            .map(str::trim)
            .filter(|length| !length.is_empty())
            .map(|length| length.parse().map_err(|_| shapeless()))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            kind,
            size,
            big_endian,
            fortran_order,
            shape,
        })
    }

    /// Writes the header, padded as NumPy does, so that the elements begin at a multiple of 64
    /// bytes.
    pub fn write(&self, writer: &mut impl Write) -> io::Result<()> {
        let kind = match self.kind {
            Kind::Signed => 'i',
            Kind::Unsigned => 'u',
            Kind::Float => 'f',
        };
        let order = match (self.size, self.big_endian) {
            (1, _) => '|',
            (_, false) => '<',
            (_, true) => '>',
        };
        let fortran_order = if self.fortran_order { "True" } else { "False" };
        // Each number is followed by a comma, because Python reads `(5,)` and `(5, 3,)` as tuples.
        let shape: String = self
            .shape
            .iter()
            .map(|length| format!("{length},"))
            .collect();
        let mut text = format!(
            "{{'descr': '{order}{kind}{}', 'fortran_order': {fortran_order}, 'shape': ({shape}), }}",
            self.size
        );
        let start = MAGIC.len() + 2 + 2;
        let padded = (start + text.len() + 1).next_multiple_of(64) - start;
        text.extend(std::iter::repeat_n(' ', padded - 1 - text.len()));
        text.push('\n');
        let length = u16::try_from(text.len()).map_err(|_| io::ErrorKind::InvalidInput)?;
        writer.write_all(MAGIC)?;
        writer.write_all(&[1, 0])?;
        writer.write_all(&length.to_le_bytes())?;
        writer.write_all(text.as_bytes())
    }
}

/// The text that follows the key in a Python dictionary.
fn value_of<'a>(text: &'a str, key: &str) -> Result<&'a str, String> {
    let quotes = [format!("'{key}'"), format!("\"{key}\"")];
    quotes
        .iter()
        .find_map(|quoted| text.split_once(quoted.as_str()))
        .and_then(|(_, rest)| rest.trim_start().strip_prefix(':'))
        .map(str::trim_start)
        .ok_or_else(|| format!("the header has no {key}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_header_reads_back_and_is_aligned() {
        let header = Header {
            kind: Kind::Float,
            size: 8,
            big_endian: false,
            fortran_order: false,
            shape: vec![1_000_000, 3],
        };
        let mut bytes = Vec::new();
        header.write(&mut bytes).unwrap();
        assert_eq!(bytes.len() % 64, 0);
        assert_eq!(Header::read(&mut bytes.as_slice()).unwrap(), Ok(header));
    }

    #[test]
    fn header_as_numpy_writes_it_is_read() {
        let text = "{'descr': '>i2', 'fortran_order': True, 'shape': (7, 3), }   \n";
        let header = Header::parse(text).unwrap();
        assert_eq!((header.kind, header.size), (Kind::Signed, 2));
        assert!(header.big_endian && header.fortran_order);
        assert_eq!(header.shape, [7, 3]);
    }

    #[test]
    fn other_types_are_named_and_refused() {
        for (descr, word) in [
            ("'<c16'", "<c16"),
            ("[('a', '<i4')]", "structured"),
            ("'|O'", "|O"),
        ] {
            let text = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': (7,), }}");
            let error = Header::parse(&text).unwrap_err();
            assert!(error.contains(word), "{error}");
        }
    }

    #[test]
    fn any_bytes_are_refused_without_a_panic() {
        for bytes in [
            &b""[..],
            b"\x93NUMPY",
            b"\x93NUMPY\x02\0\xff\xff\xff\xff",
            b"PK\x03\x04.....",
        ] {
            assert!(!matches!(Header::read(&mut &bytes[..]), Ok(Ok(_))));
        }
        for text in [
            "",
            "{'descr': '",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
        ] {
            assert!(Header::parse(text).is_err());
        }
    }
}
