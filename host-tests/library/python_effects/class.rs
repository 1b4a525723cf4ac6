//! An effect as a class of Python.

use super::words::{in_python, paragraph, sentence, wrapped};
use allanite::effect::{Description, Domain, Parameter};

/// An attribute of a class: a shape parameter, or the quantity by which it is known as well.
struct Attribute {
    name: &'static str,
    is_whole: bool,
    words: String,
}

/// The name of a class: that of the type in Rust.
pub(crate) fn name(effect: &str) -> String {
    let parts = effect.split('_').map(|part| {
        let (first, rest) = part.split_at(1);
        format!("{}{rest}", first.to_uppercase())
    });
    parts.collect()
}

/// The class of an effect, whose words stand in its file of Rust, and in `what`.
pub(crate) fn class(description: &Description, what: &str, source: &str) -> String {
    let parameters = description.parameters;
    let attributes: Vec<Attribute> = parameters.iter().flat_map(attributes).collect();
    let name = name(description.name);
    // A number alone does not say which of two quantities it is.
    let has_choice = parameters
        .iter()
        .any(|parameter| parameter.reciprocal.is_some());
    let keywords = if has_choice { ", kw_only=True" } else { "" };
    let mut text = format!("@dataclass(frozen=True{keywords})\nclass {name}(Effect):\n");
    let first = sentence(what);
    text += &format!("    \"\"\"{first}\n\n");
    let paragraph = paragraph(source, &name);
    // The first sentence may be the same.
    let rest = paragraph.strip_prefix(&first).unwrap_or(&paragraph);
    text += &wrapped(&in_python(rest), 4);
    if !attributes.is_empty() {
        text += "\n    Attributes\n    ----------\n";
    }
    for attribute in &attributes {
        let kind = type_of(attribute);
        text += &format!("    {} : {kind}, optional\n", attribute.name);
        text += &wrapped(&attribute.words, 8);
    }
    text += "    \"\"\"\n\n";
    text += &format!("    NAME: ClassVar[str] = \"{}\"\n", description.name);
    let whole: Vec<String> = attributes
        .iter()
        .filter(|attribute| attribute.is_whole)
        .map(|attribute| format!("\"{}\",", attribute.name))
        .collect();
    if !whole.is_empty() {
        let whole = whole.join(" ");
        text += &format!("    WHOLE: ClassVar[tuple[str, ...]] = ({whole})\n");
    }
    if !attributes.is_empty() {
        text += "\n";
    }
    for attribute in &attributes {
        text += &format!(
            "    {}: {} | None = None\n",
            attribute.name,
            type_of(attribute)
        );
    }
    text
}

fn type_of(attribute: &Attribute) -> &'static str {
    if attribute.is_whole { "int" } else { "float" }
}

/// The attributes of a parameter. The quantity of a data sheet comes first.
fn attributes(parameter: &Parameter) -> Vec<Attribute> {
    let (own, is_whole) = match parameter.domain() {
        Domain::Positive => (above_zero(parameter.unit), false),
        Domain::Whole { low, high } => (format!("A whole number, {low} to {high}."), true),
    };
    let attribute = |name, words| Attribute {
        name,
        is_whole,
        words,
    };
    let Some(other) = parameter.reciprocal else {
        return vec![attribute(parameter.name, own)];
    };
    let either = format!(
        "{} It is {:.6}/``{}``, and one of the two is given.",
        above_zero(other.unit),
        other.product,
        parameter.name
    );
    vec![
        attribute(other.name, either),
        attribute(parameter.name, own),
    ]
}

fn above_zero(unit: &str) -> String {
    match unit {
        "" => "A number above 0.".to_owned(),
        unit => format!("In {unit}, above 0."),
    }
}
