//! The effects of the package for Python are those of the catalogue: their names, parameters, units, domains and words.

mod class;
mod words;

use allanite::effect::{Description, EXPLAINED, Explain};
use std::{fs, path::Path};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The file that is made.
const PATH: &str = "src/python/python/allanite/effects.py";

/// Makes the file anew if this variable is set.
const RENEW: &str = "ALLANITE_RENEW_PYTHON";

const HEAD: &str = r#""""The effects of the catalogue, which are added to a model: ``model + Sinusoid(47)``.

A shape parameter that is given is where the fit of the shape begins, or, with ``fitted=False``, the shape itself. Without any,
the shape is looked for in the whole range that the record can show. Whole numbers are never fitted: one that is not given is
the least, or looked for with the rest of the shape. The coefficient is always fitted.

This file is made from the catalogue of the library, ``src/theory/effect``, and not edited:
``ALLANITE_RENEW_PYTHON=1 cargo test --test library python_effects`` makes it anew.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ._effect import Effect
"#;

#[test]
fn the_effects_of_python_are_those_of_the_catalogue() {
    let made = file(&EXPLAINED, |name| {
        let path = Path::new(ROOT).join(format!("src/theory/effect/{name}.rs"));
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    });
    let path = Path::new(ROOT).join(PATH);
    if std::env::var_os(RENEW).is_some() {
        fs::write(&path, &made).expect("a folder to write to");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == made,
        "{PATH} is out of date: {RENEW}=1 cargo test --test library python_effects"
    );
    assert!(HEAD.contains(&format!(
        "{RENEW}=1 cargo test --test library python_effects"
    )));
}

/// The file of Python with these effects. `source` gives the text of the file of an effect.
fn file(effects: &[&dyn Explain], source: impl Fn(&str) -> String) -> String {
    let descriptions: Vec<&Description> = effects.iter().map(|one| one.description()).collect();
    let names: Vec<String> = descriptions.iter().map(|of| class::name(of.name)).collect();
    let listed: String = names
        .iter()
        .map(|name| format!("    \"{name}\",\n"))
        .collect();
    let mut text = format!("{HEAD}\n__all__ = [\n    \"CATALOGUE\",\n    \"Effect\",\n{listed}]\n");
    for (effect, description) in effects.iter().zip(descriptions) {
        let source = source(description.name);
        text += "\n\n";
        text += &class::class(description, effect.explanation().what, &source);
    }
    let listed: String = names.iter().map(|name| format!("    {name},\n")).collect();
    text += &format!("\n\nCATALOGUE: tuple[type[Effect], ...] = (\n{listed})\n");
    text += "\"\"\"Every effect that the diagnosis knows, in its order.\"\"\"\n";
    text
}
