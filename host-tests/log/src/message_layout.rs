//! Messages of ROS of any type, by the definition that a bag has of them.

use super::{
    imu_message::Encoding,
    message_definition::{Field, Kind, LONGEST_LIST, columns, fields, is_shown},
};

/// The fields that a message may have for each of its bytes, and beside them: a type without fields takes no room.
const MOST_FIELDS_PER_BYTE: usize = 16;
const MOST_FIELDS: usize = 1 << 12;

/// The fields of a message type in their order.
#[derive(Debug)]
pub(super) struct Layout {
    fields: Vec<Field>,
    columns: Vec<String>,
}

/// A value of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Integer(i64),
    Float(f64),
}

impl Layout {
    /// The layout that a definition describes; `None` if it cannot be read, or claims too much.
    pub(super) fn of(schema: &str, definition: &str) -> Option<Self> {
        let fields = fields(schema, definition)?;
        let columns = columns(&fields)?;
        Some(Self { fields, columns })
    }

    /// The names of the numbers outside of lists of unknown length, as `imu.angular_velocity.x [rad/s]`.
    pub(super) fn columns(&self) -> &[String] {
        &self.columns
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

/// Reads a message from its beginning.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The number of fields that may still come.
    left: usize,
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
            left: MOST_FIELDS_PER_BYTE
                .saturating_mul(bytes.len())
                .saturating_add(MOST_FIELDS),
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
        self.left = self.left.checked_sub(1)?;
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
        // Each of them would take minutes, or gigabytes.
        let wide = "C c\n".repeat(99);
        let parts = |name: char| format!("===\nMSG: a/{name}\n");
        let names = "CDEFGHIJKLM";
        let nested = |lines: &str| -> String {
            let types = names.chars().zip(names.chars().skip(1));
            let part = |(name, next): (char, char)| {
                let lines = lines.replace('C', &next.to_string());
                format!("{}{lines}", parts(name))
            };
            types.map(part).collect()
        };
        let ends = format!("{}string s", parts('M'));
        assert!(Layout::of("a/B", &format!("{wide}{}{ends}", nested(&wide))).is_none());
        let lists = "C[16] c\n";
        assert!(Layout::of("a/B", &format!("{lists}{}{ends}", nested(lists))).is_none());
        assert!(Layout::of("a/B", &format!("float64 {}", "x".repeat(9999))).is_none());
        let nothing = Layout::of("a/B", "C[] c\n===\nMSG: a/C\n").unwrap();
        assert_eq!(nothing.read(&[0xff; 16], Encoding::Ros1), None);
    }
}
