//! The formats of ULog messages: the names, types and offsets of their fields.

use crate::failure::one_line;
use std::collections::HashMap;

/// The deepest nesting of formats that is accepted. A deeper one is taken for a circular definition.
/// Chosen by hand.
const DEEPEST: usize = 8;

/// The most fields of a format, those of nested formats included. PX4's largest formats have some
/// hundreds. Chosen by hand.
const MOST_FIELDS: usize = 4096;

/// The longest declaration of a field, and the longest name of a nested field, in bytes.
const LONGEST_NAME: usize = 256;

/// The most declarations in all formats of a file. PX4 writes some thousands.
const MOST_DECLARED: usize = 1 << 16;

/// The type of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Signed(usize),
    Unsigned(usize),
    Float,
    Double,
}

impl Kind {
    /// The basic type of this name.
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "int8_t" => Self::Signed(1),
            "int16_t" => Self::Signed(2),
            "int32_t" => Self::Signed(4),
            "int64_t" => Self::Signed(8),
            "uint8_t" | "bool" | "char" => Self::Unsigned(1),
            "uint16_t" => Self::Unsigned(2),
            "uint32_t" => Self::Unsigned(4),
            "uint64_t" => Self::Unsigned(8),
            "float" => Self::Float,
            "double" => Self::Double,
            _ => return None,
        })
    }

    const fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) => size,
            Self::Float => 4,
            Self::Double => 8,
        }
    }
}

/// A value of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Signed(i64),
    Unsigned(u64),
    Float(f64),
}

impl Value {
    pub(super) fn to_f64(self) -> f64 {
        match self {
            Self::Signed(value) => value as f64,
            Self::Unsigned(value) => value as f64,
            Self::Float(value) => value,
        }
    }
}

/// A field of a basic type in a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Field {
    /// The name of the field, preceded by the names of the fields that contain it: `gyro_rad[0]`.
    pub(super) name: String,
    kind: Kind,
    /// The offset of the field in the message, in bytes.
    offset: usize,
}

impl Field {
    /// The field's value, or `None` if the message is too short for it.
    pub(super) fn value(&self, message: &[u8]) -> Option<Value> {
        let bytes = message.get(self.offset..)?.get(..self.kind.size())?;
        let mut eight = [0; 8];
        eight[..bytes.len()].copy_from_slice(bytes);
        let bits = u64::from_le_bytes(eight);
        Some(match self.kind {
            Kind::Unsigned(_) => Value::Unsigned(bits),
            Kind::Signed(size) => {
                let unused = 64 - 8 * size as u32;
                Value::Signed((bits << unused) as i64 >> unused)
            }
            Kind::Float => Value::Float(f32::from_bits(bits as u32).into()),
            Kind::Double => Value::Float(f64::from_bits(bits)),
        })
    }
}

/// The formats that a log defines, by their names.
#[derive(Debug, Default)]
pub(super) struct Formats {
    formats: HashMap<String, Vec<Declaration>>,
    /// The number of declarations that were read.
    declared: usize,
}

/// The declaration of a field, such as `float[3] gyro_rad`.
#[derive(Debug)]
struct Declaration {
    kind: String,
    count: Option<usize>,
    name: String,
}

impl Formats {
    /// Takes a definition such as `sensor_gyro:uint64_t timestamp;float x;…`.
    pub(super) fn define(&mut self, text: &[u8]) -> Result<(), String> {
        let text = String::from_utf8_lossy(text);
        let (name, fields) = text.split_once(':').ok_or("a format has no name")?;
        let fields = fields.split(';').filter(|field| !field.trim().is_empty());
        if name.len() > LONGEST_NAME {
            return Err("a format has a name of more than 256 bytes".into());
        }
        let declarations = fields.map(|field| {
            let wrong = || format!("format {name}: a field is malformed");
            if field.len() > LONGEST_NAME {
                return Err(format!(
                    "format {name}: a field has more than {LONGEST_NAME} bytes"
                ));
            }
            let (kind, name) = field.trim().split_once(' ').ok_or_else(wrong)?;
            let (kind, count) = match kind.split_once('[') {
                None => (kind, None),
                Some((kind, count)) => {
                    let count = count.strip_suffix(']').and_then(|count| count.parse().ok());
                    (kind, Some(count.ok_or_else(wrong)?))
                }
            };
            Ok(Declaration {
                kind: kind.to_owned(),
                count,
                name: one_line(name.trim()),
            })
        });
        let declarations = declarations.take(MOST_DECLARED + 1);
        let declarations = declarations.collect::<Result<Vec<_>, String>>()?;
        self.declared += declarations.len() + 1;
        if self.declared > MOST_DECLARED {
            return Err(format!("the formats have more than {MOST_DECLARED} fields"));
        }
        self.formats.insert(name.trim().to_owned(), declarations);
        Ok(())
    }

    /// The basic fields of a format in their order, without padding.
    pub(super) fn fields(&self, format: &str) -> Result<Vec<Field>, String> {
        let mut fields = Vec::new();
        let mut visits = MOST_FIELDS;
        self.flatten(format, "", &mut 0, (DEEPEST, &mut visits), &mut fields)?;
        fields.retain(|field| !field.name.contains("_padding"));
        Ok(fields)
    }

    fn flatten(
        &self,
        format: &str,
        prefix: &str,
        offset: &mut usize,
        (deeper, visits): (usize, &mut usize),
        fields: &mut Vec<Field>,
    ) -> Result<(), String> {
        let declarations = self.formats.get(format);
        let declarations = declarations.ok_or_else(|| format!("format {format} is not defined"))?;
        let too_long = || format!("format {format} is too long");
        let next = deeper.checked_sub(1).ok_or_else(too_long)?;
        for declaration in declarations {
            for i in 0..declaration.count.unwrap_or(1) {
                // Visits are counted, because a format may be empty and then adds no field.
                *visits = visits.checked_sub(1).ok_or_else(too_long)?;
                let mut name = format!("{prefix}{}", declaration.name);
                if name.len() > LONGEST_NAME {
                    return Err(too_long());
                }
                if declaration.count.is_some() {
                    name += &format!("[{i}]");
                }
                match Kind::of(&declaration.kind) {
                    None => {
                        let prefix = name + ".";
                        let budget = (next, &mut *visits);
                        self.flatten(&declaration.kind, &prefix, offset, budget, fields)?;
                    }
                    Some(kind) => {
                        let at = *offset;
                        *offset += kind.size();
                        fields.push(Field {
                            name,
                            kind,
                            offset: at,
                        });
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn fields_lie_one_behind_the_other_nested_ones_too() {
        let mut formats = Formats::default();
        formats.define(b"point:float x;int16_t[2] q;").unwrap();
        let text = b"topic:uint64_t timestamp;point[2] p;uint8_t[4] _padding0;bool b;";
        formats.define(text).unwrap();
        let fields = formats.fields("topic").unwrap();
        let places: Vec<_> = fields.iter().map(|f| (f.name.as_str(), f.offset)).collect();
        assert_eq!(
            places,
            [
                ("timestamp", 0),
                ("p[0].x", 8),
                ("p[0].q[0]", 12),
                ("p[0].q[1]", 14),
                ("p[1].x", 16),
                ("p[1].q[0]", 20),
                ("p[1].q[1]", 22),
                ("b", 28)
            ]
        );
        let mut message = [0; 29];
        message[14..16].copy_from_slice(&(-2i16).to_le_bytes());
        message[16..20].copy_from_slice(&1.5f32.to_le_bytes());
        assert_eq!(fields[3].value(&message), Some(Value::Signed(-2)));
        assert_eq!(fields[4].value(&message), Some(Value::Float(1.5)));
        assert_eq!(fields[7].value(&message[..28]), None);
    }

    #[test]
    fn formats_that_are_circles_or_endless_are_refused() {
        let mut formats = Formats::default();
        for text in [
            &b"a:b x;"[..],
            b"b:a[2] x;",
            b"c:float[4294967296] x;",
            b"d:e x;",
            b"empty:",
            b"f:empty[4294967295] x;",
            b"g:empty[4000] x;empty[4000] y;",
        ] {
            formats.define(text).unwrap();
        }
        for name in ["a", "c", "d", "f", "g", "none"] {
            assert!(formats.fields(name).is_err(), "{name}");
        }
        assert!(formats.define(b"no colon").is_err());
        assert!(formats.define(b"f:float[x] y;").is_err());
        let long = format!("h:float {};", "x".repeat(300));
        assert!(formats.define(long.as_bytes()).is_err());
    }

    proptest! {
        #[test]
        fn any_text_is_a_format_or_refused(texts in prop::collection::vec("[ab:;\\[\\]0-9 ]{0,40}", 0..6)) {
            let mut formats = Formats::default();
            for text in &texts {
                let _ = formats.define(text.as_bytes());
            }
            let _ = formats.fields("a");
        }
    }
}
