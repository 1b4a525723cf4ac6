//! Questions of the explore page, of any contents: each is answered, or refused in a line.

use allanite::effect::CATALOGUE;
use host_tests::{
    command::explore::{Answered, Questions},
    program::ADIS16405,
};
use serde_json::{Value, json};
use std::{path::Path, sync::OnceLock};

const NAMES: [&str; 5] = ["fit", "drawing", "table", "diagnose", "page"];

/// The records are read once.
static QUESTIONS: OnceLock<Questions> = OnceLock::new();

/// Asks what the first byte selects: with the other bytes as they are, or with effects and shapes that they encode.
pub fn check(bytes: &[u8]) {
    let Some((&first, body)) = bytes.split_first() else {
        return;
    };
    let name = NAMES[usize::from(first) % NAMES.len()];
    let questions = QUESTIONS.get_or_init(|| Questions::about(Path::new(ADIS16405)).unwrap());
    let body = match first {
        0..100 => body.to_vec(),
        _ => question(body),
    };
    let Some(answered) = questions.ask(name, &body) else {
        assert_eq!(name, "page");
        return;
    };
    judge(name, &answered);
}

/// An answer has the form of its kind, and a refusal is one line of text.
fn judge(name: &str, answered: &Answered) {
    let text = std::str::from_utf8(&answered.body).expect("text");
    let json = || serde_json::from_str::<Value>(text).expect("JSON");
    match (answered.status, name) {
        (200, "drawing") => assert!(text.contains("<svg") && text.trim_end().ends_with("</svg>")),
        (200, "table") => {
            let mut lines = text.lines().skip(1);
            let columns = lines.next().expect("a head").split(',').count();
            // Names of files and axes may have a comma, numbers have none.
            assert!(lines.count() > 10 && columns == 8, "{text}");
        }
        (200, "diagnose") => drop(json()),
        (200, _) => {
            let answer = json();
            let share = answer["p_value"].as_f64();
            assert!(share.is_none_or(|p| (0.0..=1.0).contains(&p)), "{share:?}");
            assert!(answer["models"].is_array() && answer["command"].is_string());
        }
        (400, _) => {
            let answer = json();
            let error = answer["error"].as_str().expect("an error");
            assert!(!error.trim().is_empty());
            assert!(!error.contains(|c: char| c.is_control()), "{error:?}");
        }
        (status, _) => panic!("status {status}"),
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
