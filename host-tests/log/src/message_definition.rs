//! The definition of a message type of ROS, in the form of `.msg` files whose parts are separated by lines of `=`.

use std::collections::BTreeMap;

/// Limits of what a damaged definition may claim: how deep types lie in each other, how many fields all of them have,
/// how long a name is, in bytes, and how many numbers a message shows. Chosen by hand.
const DEEPEST: usize = 12;
const MOST_FIELDS: usize = 1 << 12;
const LONGEST_NAME: usize = 256;
const MOST_COLUMNS: usize = 200;

/// Longer lists are images and scans, whose numbers are no columns.
pub(super) const LONGEST_LIST: usize = 16;

/// The name and the kind of a field.
pub(super) type Field = (String, Kind);

#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// A number of so many bytes.
    Signed(usize),
    Unsigned(usize),
    Float(usize),
    /// Seconds and nanoseconds.
    Time,
    Text,
    Message(Vec<Field>),
    /// A list whose length stands before it, if it has none.
    List(Box<Kind>, Option<usize>),
}

/// The lines of a part that are fields: their types and names.
type Lines<'a> = Vec<(&'a str, &'a str)>;

/// The parts of a definition by their names without `/msg/`, each with its full name.
struct Parts<'a> {
    first: Lines<'a>,
    named: BTreeMap<String, (&'a str, Lines<'a>)>,
    /// The number of fields that may still be found.
    left: usize,
}

/// The fields that a definition describes; `None` if it has another form, if a part is missing, or if it claims too much.
pub(super) fn fields(schema: &str, definition: &str) -> Option<Vec<Field>> {
    let mut parts = Parts {
        first: Vec::new(),
        named: BTreeMap::new(),
        left: MOST_FIELDS,
    };
    let mut part: Option<String> = None;
    for line in definition.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix("MSG:") {
            let name = name.trim();
            let short = name.replace("/msg/", "/");
            parts
                .named
                .entry(short.clone())
                .or_insert_with(|| (name, Vec::new()));
            part = Some(short);
        } else if let Some(field) = field(line) {
            match part.as_ref().and_then(|part| parts.named.get_mut(part)) {
                Some((_, lines)) => lines.push(field),
                None => parts.first.push(field),
            }
        }
    }
    let first = std::mem::take(&mut parts.first);
    parts.fields(&first, schema, 0)
}

/// The type and the name in a line. Comments, constants, which take no room, and separators have none.
fn field(line: &str) -> Option<(&str, &str)> {
    let line = line.split('#').next().unwrap_or_default();
    if line.starts_with("==") {
        return None;
    }
    let mut words = line.split_whitespace();
    let (kind, name) = (words.next()?, words.next()?);
    let is_constant = name.contains('=') || words.next().is_some_and(|word| word.starts_with('='));
    (!is_constant).then_some((kind, name))
}

impl Parts<'_> {
    /// The fields of a part. A name without a package is one of the package of the type that uses it.
    fn fields(&mut self, lines: &Lines, schema: &str, depth: usize) -> Option<Vec<Field>> {
        if depth > DEEPEST {
            return None;
        }
        let package = schema.split('/').next().unwrap_or_default();
        let mut found = Vec::new();
        for (kind, name) in lines {
            self.left = self.left.checked_sub(1)?;
            if name.len() > LONGEST_NAME || kind.len() > LONGEST_NAME {
                return None;
            }
            found.push(((*name).to_owned(), self.kind(kind, package, depth)?));
        }
        Some(found)
    }

    fn kind(&mut self, name: &str, package: &str, depth: usize) -> Option<Kind> {
        if let Some((of, length)) = name
            .strip_suffix(']')
            .and_then(|name| name.rsplit_once('['))
        {
            let length = match length {
                "" => None,
                bounded if bounded.starts_with("<=") => None,
                length => Some(length.parse().ok()?),
            };
            return Some(Kind::List(self.kind(of, package, depth)?.into(), length));
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
            "Header" => return self.kind("std_msgs/Header", package, depth),
            name => {
                let short = name.replace("/msg/", "/");
                let full = format!("{package}/{name}");
                let found = self.named.get(&short).or_else(|| self.named.get(&full));
                // The part is taken out, so that a type that contains itself ends here.
                let key = found.map(|(part, _)| part.replace("/msg/", "/"))?;
                let (part, lines) = self.named.remove(&key)?;
                let fields = self.fields(&lines, part, depth + 1);
                self.named.insert(key, (part, lines));
                Kind::Message(fields?)
            }
        })
    }
}

/// A covariance is no measurement.
pub(super) fn is_shown(name: &str) -> bool {
    !name.contains("covariance")
}

/// The names of the numbers outside of lists of unknown length, as `imu.angular_velocity.x [rad/s]`; `None` if they are
/// too many.
pub(super) fn columns(fields: &[Field]) -> Option<Vec<String>> {
    let mut columns = Columns {
        names: Vec::new(),
        left: MOST_FIELDS,
    };
    for (name, kind) in fields {
        columns.add(name, kind)?;
    }
    Some(columns.names)
}

struct Columns {
    names: Vec<String>,
    /// The number of fields that may still be looked at: lists in lists have many without a number in them.
    left: usize,
}

impl Columns {
    fn add(&mut self, name: &str, kind: &Kind) -> Option<()> {
        self.left = self.left.checked_sub(1)?;
        if !is_shown(name) {
            return Some(());
        }
        match kind {
            Kind::Signed(_) | Kind::Unsigned(_) | Kind::Float(_) => {
                self.names.push(with_unit(name));
            }
            Kind::Time => self.names.push(format!("{name} [ns]")),
            Kind::Message(fields) => {
                for (field, kind) in fields {
                    self.add(&format!("{name}.{field}"), kind)?;
                }
            }
            Kind::List(of, Some(length)) if *length <= LONGEST_LIST => {
                for place in 0..*length {
                    self.add(&format!("{name}[{place}]"), of)?;
                }
            }
            Kind::Text | Kind::List(..) => {}
        }
        (self.names.len() <= MOST_COLUMNS).then_some(())
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
