//! Questions of the explore page, of any contents, and its records, of any contents: each question is answered, or refused in a
//! line.

use allanite::effect::CATALOGUE;
use allanite_cli::command::explore::{Session, What};
use serde_json::{Value, json};
use std::{path::Path, sync::OnceLock};

/// Curves of a real gyro.
const ADIS16405: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/adis16405.json");

const ASKED: [What; 3] = [What::Fit, What::Drawing, What::Table];

/// The records are read once.
static SESSION: OnceLock<(String, Session)> = OnceLock::new();

fn session() -> &'static (String, Session) {
    SESSION.get_or_init(|| {
        let text = Session::about(Path::new(ADIS16405)).unwrap();
        let session = Session::parse(text.as_bytes()).unwrap();
        (text, session)
    })
}

/// Asks what the first byte selects: with the other bytes as they are, with effects and shapes that they encode, or about
/// records that they damage.
pub fn check(bytes: &[u8]) {
    let Some((&first, rest)) = bytes.split_first() else {
        return;
    };
    let what = ASKED[usize::from(first) % ASKED.len()];
    let (text, session) = session();
    match first {
        0..80 => judge(what, session.ask(what, rest)),
        80..200 => judge(what, session.ask(what, &question(rest))),
        _ => {
            let damaged = damaged(text, rest);
            let asked =
                Session::parse(&damaged).and_then(|session| session.ask(what, br#"{"record":0}"#));
            judge(what, asked);
        }
    }
}

/// What numbers, texts and lists of JSON are made of.
const SIGNS: &[u8] = b"0123456789-.eE,:[]{}nulltrue\"";

/// The text of a session, in which pairs of a place and a byte overwrite digits and signs.
fn damaged(text: &str, bytes: &[u8]) -> Vec<u8> {
    let mut damaged = text.as_bytes().to_vec();
    for change in bytes.as_chunks::<4>().0 {
        let place = u32::from_le_bytes([change[0], change[1], change[2], 0]) as usize;
        let at = place % damaged.len();
        damaged[at] = match change[3] {
            byte @ 128.. => byte & 127,
            byte => SIGNS[usize::from(byte) % SIGNS.len()],
        };
    }
    damaged
}

/// An answer has the form of its kind, and a refusal is one line of text.
fn judge(what: What, answered: Result<Vec<u8>, allanite_log::failure::Failure>) {
    let answer = match answered {
        Ok(answer) => String::from_utf8(answer).expect("text"),
        Err(failure) => {
            let error = failure.to_string();
            assert!(!error.trim().is_empty());
            assert!(!error.contains(|c: char| c.is_control()), "{error:?}");
            return;
        }
    };
    match what {
        What::Drawing => {
            assert!(answer.contains("<svg") && answer.trim_end().ends_with("</svg>"));
        }
        What::Table => {
            let mut lines = answer.lines().skip(1);
            let columns = lines.next().expect("a head").split(',').count();
            // Names of files and axes may have a comma, numbers have none.
            assert!(lines.count() > 1 && columns == 8, "{answer}");
        }
        What::Fit => {
            let answer: Value = serde_json::from_str(&answer).expect("JSON");
            let share = answer["p_value"].as_f64();
            assert!(share.is_none_or(|p| (0.0..=1.0).contains(&p)), "{share:?}");
            assert!(answer["models"].is_array() && answer["command"].is_string());
        }
    }
}

/// A question with effects, shapes and numbers that mean something mostly.
fn question(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.iter().copied();
    let mut next = || bytes.next().unwrap_or(0);
    let record = next() % 8;
    let judged: Vec<u8> = (0..next() % 4).map(|_| next() % 8).collect();
    let with: Vec<String> = (0..next() % 10)
        .map(|_| {
            let effect = CATALOGUE[usize::from(next()) % CATALOGUE.len()];
            let mut text = effect.name().to_owned();
            for (place, parameter) in effect.parameters().iter().enumerate() {
                text.push(if place == 0 { ':' } else { ',' });
                let choice = next();
                let reciprocal = parameter.reciprocal.filter(|_| choice % 3 == 0);
                text += reciprocal.map_or(parameter.name, |reciprocal| reciprocal.name);
                text.push(if choice % 2 == 0 { '=' } else { '~' });
                text += &match next() {
                    0 => String::new(),
                    1 => "nan".to_owned(),
                    2 => "1e999".to_owned(),
                    3 => "-1".to_owned(),
                    4 => "\u{1b}[31m".to_owned(),
                    number if parameter.is_whole => (number % 9).to_string(),
                    number => 10_f64.powf((f64::from(number) - 130.0) / 30.0).to_string(),
                };
            }
            text
        })
        .collect();
    let without: Vec<&str> = (0..next() % 4)
        .map(|_| CATALOGUE[usize::from(next()) % CATALOGUE.len()].name())
        .collect();
    let question = json!({
        "record": record, "judged": judged, "with": with, "without": without,
    });
    question.to_string().into_bytes()
}
