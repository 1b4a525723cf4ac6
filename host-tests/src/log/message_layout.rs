//! Messages of ROS of any type, by the definition that a bag has of them.

use super::imu_message::Encoding;
use std::collections::BTreeMap;

/// Limits of what a damaged definition may claim: how deep types lie in each other, and how many numbers a message shows.
/// Chosen by hand.
const DEEPEST: usize = 12;
const MOST_COLUMNS: usize = 200;

/// Longer lists are images and scans, whose numbers are no columns.
const LONGEST_LIST: usize = 16;

/// The fields of a message type in their order.
#[derive(Debug)]
pub(super) struct Layout {
    fields: Vec<(String, Kind)>,
}

#[derive(Clone, Debug)]
enum Kind {
    /// A number of so many bytes.
    Signed(usize),
    Unsigned(usize),
    Float(usize),
    /// Seconds and nanoseconds.
    Time,
    Text,
    Message(Vec<(String, Kind)>),
    /// A list whose length stands before it, if it has none.
    List(Box<Kind>, Option<usize>),
}

/// A value of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Integer(i64),
    Float(f64),
}

impl Layout {
    /// The layout that a definition describes, in the form of `.msg` files whose parts are separated by lines of `=`;
    /// `None` if it is another form, or if a part is missing.
    pub(super) fn of(schema: &str, definition: &str) -> Option<Self> {
        let mut parts: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        let mut part = "";
        for line in definition.lines().map(str::trim) {
            if let Some(name) = line.strip_prefix("MSG:") {
                part = name.trim();
                parts.entry(part).or_default();
            } else if !line.starts_with("==") {
                parts.entry(part).or_default().push(line);
            }
        }
        let fields = fields(&parts, "", schema, 0)?;
        let layout = Self { fields };
        (layout.columns().len() <= MOST_COLUMNS).then_some(layout)
    }

    /// The names of the numbers outside of lists of unknown length, as `imu.angular_velocity.x [rad/s]`.
    pub(super) fn columns(&self) -> Vec<String> {
        let mut names = Vec::new();
        for (name, kind) in &self.fields {
            name_columns(name, kind, &mut names);
        }
        names
    }

    /// The values of a message; `None` if it is shorter than its definition.
    pub(super) fn read(&self, bytes: &[u8], encoding: Encoding) -> Option<Vec<Value>> {
        let mut reader = Reader::new(bytes, encoding)?;
        let mut values = Vec::new();
        for (name, kind) in &self.fields {
            reader.field(name, kind, Some(&mut values))?;
        }
        Some(values)
    }
}

/// The fields of a part of a definition. A name without a package is one of the package of the type that uses it.
fn fields(
    parts: &BTreeMap<&str, Vec<&str>>,
    part: &str,
    schema: &str,
    depth: usize,
) -> Option<Vec<(String, Kind)>> {
    if depth > DEEPEST {
        return None;
    }
    let package = schema.split('/').next().unwrap_or_default();
    let mut found = Vec::new();
    for line in parts.get(part)? {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        let (Some(kind), Some(name)) = (words.next(), words.next()) else {
            continue;
        };
        // A constant takes no room.
        if name.contains('=') || words.next().is_some_and(|word| word.starts_with('=')) {
            continue;
        }
        found.push((name.to_owned(), kind_of(parts, kind, package, depth)?));
    }
    Some(found)
}

fn kind_of(
    parts: &BTreeMap<&str, Vec<&str>>,
    name: &str,
    package: &str,
    depth: usize,
) -> Option<Kind> {
    if let Some((of, length)) = name
        .strip_suffix(']')
        .and_then(|name| name.rsplit_once('['))
    {
        let length = match length {
            "" => None,
            bounded if bounded.starts_with("<=") => None,
            length => Some(length.parse().ok()?),
        };
        return Some(Kind::List(
            kind_of(parts, of, package, depth)?.into(),
            length,
        ));
    }
    Some(match name {
        "bool" | "byte" | "char" | "uint8" => Kind::Unsigned(1),
        "uint16" => Kind::Unsigned(2),
        "uint32" => Kind::Unsigned(4),
        "uint64" => Kind::Unsigned(8),
        "int8" => Kind::Signed(1),
        "int16" => Kind::Signed(2),
        "int32" => Kind::Signed(4),
        "int64" => Kind::Signed(8),
        "float32" => Kind::Float(4),
        "float64" => Kind::Float(8),
        "time" | "duration" => Kind::Time,
        "builtin_interfaces/Time" | "builtin_interfaces/Duration" => Kind::Time,
        "builtin_interfaces/msg/Time" | "builtin_interfaces/msg/Duration" => Kind::Time,
        text if text.starts_with("string") => Kind::Text,
        "Header" => return kind_of(parts, "std_msgs/Header", package, depth),
        name => {
            let short = name.replace("/msg/", "/");
            let full = format!("{package}/{name}");
            let is = |part: &&&str| {
                let part = part.replace("/msg/", "/");
                part == short || part == full
            };
            let part = parts.keys().find(is)?;
            Kind::Message(fields(parts, part, part, depth + 1)?)
        }
    })
}

/// A covariance is no measurement.
fn is_shown(name: &str) -> bool {
    !name.contains("covariance")
}

fn name_columns(name: &str, kind: &Kind, names: &mut Vec<String>) {
    match kind {
        _ if !is_shown(name) || names.len() > MOST_COLUMNS => {}
        Kind::Signed(_) | Kind::Unsigned(_) | Kind::Float(_) => names.push(with_unit(name)),
        Kind::Time => names.push(format!("{name} [ns]")),
        Kind::Message(fields) => {
            for (field, kind) in fields {
                name_columns(&format!("{name}.{field}"), kind, names);
            }
        }
        Kind::List(of, Some(length)) if *length <= LONGEST_LIST => {
            for place in 0..*length {
                name_columns(&format!("{name}[{place}]"), of, names);
            }
        }
        Kind::Text | Kind::List(..) => {}
    }
}

/// The units that ROS prescribes (REP 103).
fn with_unit(name: &str) -> String {
    let units = [
        ("angular_velocity.", "rad/s"),
        ("linear_acceleration.", "m/s^2"),
    ];
    let known = units.iter().find(|(quantity, _)| name.contains(quantity));
    known.map_or_else(|| name.to_owned(), |(_, unit)| format!("{name} [{unit}]"))
}

/// Reads a message from its beginning.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// ROS 2 aligns a number to its own size.
    is_aligned: bool,
    is_big: bool,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8], encoding: Encoding) -> Option<Self> {
        let (is_big, bytes) = match encoding {
            Encoding::Ros1 => (false, bytes),
            Encoding::Cdr => match bytes.split_first_chunk::<4>()? {
                ([0, 0, ..], rest) => (true, rest),
                ([0, 1, ..], rest) => (false, rest),
                _ => return None,
            },
        };
        Some(Self {
            bytes,
            at: 0,
            is_aligned: encoding == Encoding::Cdr,
            is_big,
        })
    }

    /// The next so many bytes as an integer, at most eight of them.
    fn integer(&mut self, size: usize) -> Option<u64> {
        if self.is_aligned {
            self.at = self.at.next_multiple_of(size);
        }
        let bytes = self.bytes.get(self.at..self.at + size)?;
        self.at += size;
        let add = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        Some(match self.is_big {
            true => bytes.iter().fold(0, add),
            false => bytes.iter().rev().fold(0, add),
        })
    }

    fn signed(&mut self, size: usize) -> Option<i64> {
        let unused = 64 - 8 * size as u32;
        Some((self.integer(size)? << unused).cast_signed() >> unused)
    }

    /// Reads a field, and keeps its values if it is shown.
    fn field(&mut self, name: &str, kind: &Kind, values: Option<&mut Vec<Value>>) -> Option<()> {
        let mut values = values.filter(|_| is_shown(name));
        match kind {
            Kind::Message(fields) => {
                for (field, kind) in fields {
                    self.field(field, kind, values.as_deref_mut())?;
                }
                return Some(());
            }
            Kind::List(of, length) => {
                let count = match length {
                    Some(length) => *length,
                    None => self.integer(4)? as usize,
                };
                let before = self.at;
                let mut shown =
                    values.filter(|_| length.is_some_and(|length| length <= LONGEST_LIST));
                for _ in 0..count {
                    self.field("", of, shown.as_deref_mut())?;
                    // A list of nothing has any length.
                    if self.at == before {
                        return None;
                    }
                }
                return Some(());
            }
            Kind::Text => {
                let length = self.integer(4)? as usize;
                self.at = self.at.checked_add(length)?;
                return (self.at <= self.bytes.len()).then_some(());
            }
            _ => {}
        }
        let value = match kind {
            Kind::Signed(size) => Value::Integer(self.signed(*size)?),
            Kind::Unsigned(size) => Value::Integer(self.integer(*size)?.cast_signed()),
            Kind::Float(4) => Value::Float(f32::from_bits(self.integer(4)? as u32).into()),
            Kind::Float(_) => Value::Float(f64::from_bits(self.integer(8)?)),
            _ => {
                let seconds = self.signed(4)?;
                Value::Integer(seconds * 1_000_000_000 + self.signed(4)?)
            }
        };
        if let Some(values) = values {
            values.push(value);
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEFINITION: &str = "
        uint8 MODE_A=1   # a constant
        Header header
        string<=8 mode \"x\"
        sensor_msgs/Imu imu
        Sample[2] samples
        float32[] scan
        ===============
        MSG: std_msgs/Header
        builtin_interfaces/Time stamp
        string frame_id
        ===============
        MSG: sensor_msgs/Imu
        float64[9] angular_velocity_covariance
        geometry_msgs/Vector3 angular_velocity
        ===============
        MSG: geometry_msgs/Vector3
        float64 x
        ===============
        MSG: my_msgs/Sample
        int16 raw";

    fn message() -> Vec<u8> {
        let mut bytes = vec![0, 1, 0, 0];
        bytes.extend(7_i32.to_le_bytes());
        bytes.extend(5_u32.to_le_bytes());
        bytes.extend(*b"\x02\0\0\0i\0\0\0\x01\0\0\0\0\0\0\0");
        bytes.extend([0; 72]);
        bytes.extend(0.25_f64.to_le_bytes());
        bytes.extend((-3_i16).to_le_bytes());
        bytes.extend(4_i16.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(1_f32.to_le_bytes());
        bytes
    }

    #[test]
    fn a_message_that_contains_an_imu_is_read_by_its_definition() {
        let layout = Layout::of("my_msgs/msg/Board", DEFINITION).unwrap();
        let names = [
            "header.stamp [ns]",
            "imu.angular_velocity.x [rad/s]",
            "samples[0].raw",
            "samples[1].raw",
        ];
        assert_eq!(layout.columns(), names);
        let bytes = message();
        let expected = [
            Value::Integer(7_000_000_005),
            Value::Float(0.25),
            Value::Integer(-3),
            Value::Integer(4),
        ];
        assert_eq!(layout.read(&bytes, Encoding::Cdr).unwrap(), expected);
        for cut in 0..bytes.len() {
            assert_eq!(layout.read(&bytes[..cut], Encoding::Cdr), None, "{cut}");
        }
    }

    #[test]
    fn a_definition_that_lacks_a_part_or_contains_itself_is_refused() {
        assert!(Layout::of("a/B", "C c").is_none());
        assert!(Layout::of("a/B", "C c\n===\nMSG: a/C\nC c").is_none());
        assert!(Layout::of("a/B", "C[99999999] c\n===\nMSG: a/C\nfloat64[16] c").is_some());
        let nothing = Layout::of("a/B", "C[] c\n===\nMSG: a/C\n").unwrap();
        assert_eq!(nothing.read(&[0xff; 16], Encoding::Ros1), None);
    }
}
