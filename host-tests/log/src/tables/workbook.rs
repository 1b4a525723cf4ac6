//! Workbooks of Excel and LibreOffice, one of whose sheets is the table.

use super::{
    choice::{Candidate, choose},
    wrong::Wrong,
};
use crate::converted::Text;
use calamine::{Data, Reader as _, open_workbook_auto};
use std::path::Path;

pub(super) fn convert(
    path: &Path,
    topic: Option<&str>,
    text: &mut Text,
) -> Result<Option<String>, Wrong> {
    let mut book = open_workbook_auto(path).map_err(Wrong::damaged)?;
    let mut sheets = Vec::new();
    for name in book.sheet_names() {
        let sheet = book.worksheet_range(&name).map_err(Wrong::damaged)?;
        let rows = sheet.rows();
        let rows = rows.filter(|row| row.iter().any(|cell| number(cell).is_some()));
        let rows = rows.count() as u64;
        if rows > 1 {
            sheets.push((Candidate { name, rows }, sheet));
        }
    }
    let (candidates, mut sheets): (Vec<_>, Vec<_>) = sheets.into_iter().unzip();
    let (chosen, note) = choose(&candidates, topic, "sheet")?;
    let sheet = sheets.swap_remove(chosen);
    let mut writer = csv::WriterBuilder::new()
        .flexible(true)
        .from_writer(&mut *text);
    for row in sheet
        .rows()
        .filter(|row| row.iter().any(|cell| *cell != Data::Empty))
    {
        let cells = row.iter().map(written);
        writer.write_record(cells).map_err(Wrong::damaged)?;
    }
    writer.flush()?;
    Ok(note)
}

fn number(cell: &Data) -> Option<f64> {
    match cell {
        Data::Int(value) => Some(*value as f64),
        Data::Float(value) => Some(*value),
        _ => None,
    }
}

/// The text of a cell. Dates are those that the sheet shows, in milliseconds; durations are in seconds.
fn written(cell: &Data) -> String {
    match cell {
        Data::Empty | Data::Error(_) => String::new(),
        Data::DateTime(time) if time.is_duration() => (time.as_f64() * 86_400.0).to_string(),
        Data::DateTime(time) => {
            let (year, month, day, hour, minute, second, milli) = time.to_ymd_hms_milli();
            format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{milli:03}")
        }
        cell => cell.to_string(),
    }
}
