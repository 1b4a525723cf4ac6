//! What was found in a step, as the pages of `report` and `explore` show it.

use super::words::Finding;
use serde::Serialize;

/// A [`Finding`] in JSON.
#[derive(Serialize)]
pub(crate) struct Found {
    name: String,
    found: Option<String>,
    lines: Vec<(&'static str, String)>,
    ambiguous: Option<String>,
}

impl From<Finding> for Found {
    fn from(finding: Finding) -> Self {
        let lines = finding.lines().into_iter();
        Self {
            lines: lines
                .map(|(label, text)| (label, text.to_owned()))
                .collect(),
            name: finding.name,
            found: finding.found,
            ambiguous: finding.ambiguous,
        }
    }
}
