//! JSON schemas of documents, which are made from the types that are serialised.

use crate::verdict;
use allanite::{diagnosis::Verdict, integrity::Reason};
use allanite_log::unit::Unit;
use schemars::{
    JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings, json_schema,
    transform::RecursiveTransform,
};
use serde_json::Value;
use std::{borrow::Cow, collections::BTreeMap};

/// Numbers by their names; those that are not finite are `null`.
pub type Numbers = BTreeMap<String, Option<f64>>;

/// The schema of documents of a type, in JSON Schema 2020-12.
pub fn of<T: JsonSchema>(title: &str) -> Schema {
    let settings = SchemaSettings::draft2020_12()
        .for_serialize()
        .with_transform(RecursiveTransform(one_line));
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".to_owned(), title.into());
    schema
}

/// Descriptions come from comments, whose lines are those of the source.
fn one_line(schema: &mut Schema) {
    if let Some(Value::String(description)) = schema.get_mut("description") {
        *description = description.replace('\n', " ");
    }
}

/// A text that is one of some names.
fn one_of(names: impl IntoIterator<Item = &'static str>) -> Schema {
    let names: Vec<&str> = names.into_iter().collect();
    json_schema!({ "type": "string", "enum": names })
}

/// Types of texts that are one of some names, for the fields that hold these.
macro_rules! names {
    ($($(#[$doc:meta])* $name:ident: $names:expr;)*) => {
        $(
            $(#[$doc])*
            pub struct $name;

            impl JsonSchema for $name {
                fn schema_name() -> Cow<'static, str> {
                    stringify!($name).into()
                }

                fn inline_schema() -> bool {
                    true
                }

                fn json_schema(_: &mut SchemaGenerator) -> Schema {
                    one_of($names)
                }
            }
        )*
    };
}

names! {
    /// The verdict of a diagnosis.
    VerdictName: Verdict::NAMES.into_iter().chain([verdict::NOT_STATIONARY]);
    /// Why a record is not valid.
    ReasonName: Reason::NAMES;
    /// The unit of a rate or an acceleration.
    UnitName: Unit::ALL.map(Unit::name);
    /// Whether a coefficient is known.
    StateName: ["measured", "upper_bound", "not_observable"];
    /// What happens during a record.
    EventName: ["motion", "noise_change", "burst", "step", "warm_up", "other"];
}
