//! Which rows of a log are read, where a column tells the sensors apart of which they are.

/// The rows that have a value in a column, written `column=value`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowChoice {
    /// The column's name in the header, or its number, counted from 1.
    pub column: String,
    /// The value, as the log writes it, or another number that is equal to it.
    pub value: String,
}

impl std::str::FromStr for RowChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.rsplit_once('=');
        let parts = parts.map(|(column, value)| (column.trim(), value.trim()));
        match parts {
            Some((column, value)) if !column.is_empty() && !value.is_empty() => Ok(Self {
                column: column.to_owned(),
                value: value.to_owned(),
            }),
            _ => Err("write COLUMN=VALUE"),
        }
    }
}
