//! The functions of a state: how many samples it has, its fit and its diagnosis.

use crate::{
    arguments::coerced,
    failure::{raised, refused},
};
use allanite::fit::State;
use allanite_host::interface::{
    Record,
    options::{Fitting, Search},
};
use allanite_log::{failure::Failure, pieces::Pieces, unit::Unit};
use datafusion::{
    arrow::{
        array::{
            Array, ArrayRef, AsArray, BinaryArray, BooleanArray, Float64Array, Int64Array,
            ListBuilder, StringArray, StringBuilder, StructArray,
        },
        buffer::NullBuffer,
        datatypes::{DataType, Field, FieldRef, Fields},
    },
    error::{DataFusionError, Result},
    logical_expr::{ColumnarValue, ScalarFunctionArgs, ScalarUDFImpl, Signature, Volatility},
};
use serde_json::{Value, json};
use std::sync::Arc;

/// The symbols of the coefficients, as the fields of `allan_fit` are named.
const SYMBOLS: [&str; 5] = ["Q", "N", "B", "K", "R"];

/// What is asked of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Question {
    Samples,
    Fit,
    Diagnosis,
}

/// A function whose first argument is a state.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct Answer {
    name: &'static str,
    question: Question,
    signature: Signature,
}

/// All of them.
pub(crate) fn all() -> [Answer; 3] {
    let answer = |name, question| Answer {
        name,
        question,
        signature: Signature::user_defined(Volatility::Immutable),
    };
    [
        answer("allan_samples", Question::Samples),
        answer("allan_fit", Question::Fit),
        answer("allan_diagnose", Question::Diagnosis),
    ]
}

impl ScalarUDFImpl for Answer {
    fn name(&self) -> &str {
        self.name
    }

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        let state = ("state", DataType::Binary);
        let arguments = match self.question {
            Question::Samples => vec![state],
            Question::Fit | Question::Diagnosis => vec![state, ("unit", DataType::Utf8)],
        };
        coerced(self.name, &arguments, given)
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(match self.question {
            Question::Samples => DataType::Int64,
            Question::Fit => DataType::Struct(of_fit()),
            Question::Diagnosis => DataType::Struct(of_diagnosis()),
        })
    }

    fn invoke_with_args(&self, arguments: ScalarFunctionArgs) -> Result<ColumnarValue> {
        let columns = ColumnarValue::values_to_arrays(&arguments.args)?;
        let other = || DataFusionError::Internal("columns of another type".to_owned());
        let states: &BinaryArray = columns
            .first()
            .and_then(|column| column.as_binary_opt())
            .ok_or_else(other)?;
        let units: Option<&StringArray> = columns.get(1).and_then(|column| column.as_string_opt());
        let answer = |(row, state): (usize, Option<&[u8]>)| {
            let Some(state) = state else {
                return Ok(None);
            };
            let pieces = Pieces::from_bytes(state).map_err(raised)?;
            let unit = units.filter(|units| units.is_valid(row));
            self.question
                .of(pieces, unit.map(|units| units.value(row)))
                .map(Some)
        };
        let rows = states.iter().enumerate().map(answer);
        Ok(ColumnarValue::Array(
            self.question.column(&rows.collect::<Result<Vec<_>>>()?),
        ))
    }
}

impl Question {
    /// The answer as a document: a number, or the values of the fields of the struct.
    fn of(self, pieces: Pieces, unit: Option<&str>) -> Result<Value> {
        let samples = pieces.samples();
        if self == Self::Samples {
            return Ok(samples.into());
        }
        let unit = unit.ok_or_else(|| {
            refused(
                "the unit is NULL",
                "name that of the scale, such as 'deg/s'",
            )
        })?;
        let stretches = pieces.stretches().count();
        let axes = [(AXIS.to_owned(), pieces)];
        let unit = Unit::from_name(unit).ok_or_else(|| {
            let names = Unit::ALL.map(Unit::name).join(", ");
            refused(
                format!("there is no unit {unit:?}"),
                &format!("choose from {names}"),
            )
        })?;
        let found = Record::of_pieces(&axes, unit).and_then(|record| match self {
            Self::Diagnosis => diagnosed(&record),
            _ => fitted(&record),
        });
        let mut row = match found {
            Ok(row) => row,
            // An axis that cannot be fitted must not end the query over all others.
            Err(Failure::Axis { what, remedy, .. }) => {
                let why = format!("{what}; {remedy}");
                json!({ "invalid": why, "conclusion": why })
            }
            Err(failure) => return Err(raised(failure)),
        };
        row["samples"] = samples.into();
        row["stretches"] = stretches.into();
        Ok(row)
    }

    /// The answers of all rows.
    fn column(self, rows: &[Option<Value>]) -> ArrayRef {
        match self {
            Self::Samples => Arc::new(Int64Array::from_iter(
                rows.iter().map(|row| row.as_ref()?.as_i64()),
            )),
            Self::Fit => of_fields(of_fit(), rows),
            Self::Diagnosis => of_fields(of_diagnosis(), rows),
        }
    }
}

/// The name of the axis.
const AXIS: &str = "gyro";

/// The diagnosis of a record.
fn diagnosed(record: &Record) -> Result<Value, Failure> {
    let diagnosis = record.diagnose(&Search::default(), &mut |_| true)?;
    let mut row = json!({ "conclusion": diagnosis.conclusion().join(" ") });
    if let Some(axis) = diagnosis.document().axes.first() {
        row["verdict"] = axis.verdict.into();
        row["missing"] = json!(axis.missing);
    }
    Ok(row)
}

/// The five terms of a record.
fn fitted(record: &Record) -> Result<Value, Failure> {
    let fits = record.fit(&Fitting::default())?;
    let mut row = json!({});
    let document = fits.document();
    let Some(axis) = document.axes.first() else {
        return Ok(row);
    };
    row["invalid"] = json!(axis.invalid);
    row["adequate"] = json!(axis.adequate);
    row["chi2"] = json!(axis.chi2);
    row["dof"] = json!(axis.dof);
    for term in &axis.coefficients {
        let measured = |value: f64| match term.state {
            State::Measured => json!(value),
            _ => Value::Null,
        };
        row[term.symbol] = measured(term.value);
        row[format!("{}_lower", term.symbol)] = measured(term.lower);
        row[format!("{}_upper", term.symbol)] = json!(term.upper);
    }
    Ok(row)
}

/// The fields of `allan_fit`.
fn of_fit() -> Fields {
    let field = |name: &str, kind: DataType| Field::new(name, kind, true);
    let mut fields = vec![
        field("samples", DataType::Int64),
        field("stretches", DataType::Int64),
        field("invalid", DataType::Utf8),
        field("adequate", DataType::Boolean),
        field("chi2", DataType::Float64),
        field("dof", DataType::Int64),
    ];
    for symbol in SYMBOLS {
        fields.extend(
            ["", "_lower", "_upper"].map(|end| field(&format!("{symbol}{end}"), DataType::Float64)),
        );
    }
    fields.into()
}

/// The fields of `allan_diagnose`.
fn of_diagnosis() -> Fields {
    let effects = DataType::List(Arc::new(Field::new_list_field(DataType::Utf8, true)));
    [
        ("verdict", DataType::Utf8),
        ("missing", effects),
        ("conclusion", DataType::Utf8),
    ]
    .map(|(name, kind)| Field::new(name, kind, true))
    .to_vec()
    .into()
}

/// Documents as rows of a struct.
fn of_fields(fields: Fields, rows: &[Option<Value>]) -> ArrayRef {
    let column = |field: &FieldRef| -> ArrayRef {
        let values = || rows.iter().map(|row| row.as_ref()?.get(field.name()));
        match field.data_type() {
            DataType::Boolean => Arc::new(
                values()
                    .map(|value| value?.as_bool())
                    .collect::<BooleanArray>(),
            ),
            DataType::Int64 => Arc::new(
                values()
                    .map(|value| value?.as_i64())
                    .collect::<Int64Array>(),
            ),
            DataType::Float64 => Arc::new(
                values()
                    .map(|value| value?.as_f64())
                    .collect::<Float64Array>(),
            ),
            DataType::List(_) => {
                let mut lists = ListBuilder::new(StringBuilder::new());
                for value in values() {
                    let list = value.and_then(Value::as_array);
                    for one in list.into_iter().flatten() {
                        lists.values().append_option(one.as_str());
                    }
                    lists.append(list.is_some());
                }
                Arc::new(lists.finish())
            }
            _ => Arc::new(
                values()
                    .map(|value| value?.as_str())
                    .collect::<StringArray>(),
            ),
        }
    };
    let columns = fields.iter().map(column).collect();
    let are_there: NullBuffer = rows
        .iter()
        .map(Option::is_some)
        .collect::<Vec<bool>>()
        .into();
    Arc::new(StructArray::new(fields, columns, Some(are_there)))
}
