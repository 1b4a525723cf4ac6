//! Tests commands with many files: every good file is processed, and results are printed in the
//! order of the arguments.

use program::{command, json, output, refusal};
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

const FILES: usize = 200;
/// The index of the log that breaks off within a word.
const BROKEN: usize = 77;

/// Small logs of different noise and length, one of which is broken.
fn folder() -> (TempDir, Vec<String>) {
    let folder = TempDir::new().unwrap();
    let mut random = 1_u32;
    let mut names = Vec::new();
    for file in 0..FILES {
        // The lengths differ, so that the logs finish out of order.
        let samples = if file % 10 == 0 {
            20_000
        } else {
            300 + 7 * file
        };
        let mut text = String::from("# rate_hz=100 scale=0.01 unit=deg/s\ngx\n");
        for _ in 0..samples {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            text += &format!("{}\n", (random >> 20) as usize % (20 + file));
        }
        if file == BROKEN {
            text = "brok".into();
        }
        let name = format!("log{file}.csv");
        fs::write(folder.path().join(&name), text).unwrap();
        names.push(name);
    }
    (folder, names)
}

/// The standard output, the standard error and the exit status of a command.
fn run(folder: &Path, arguments: &[&str], files: &[String]) -> (String, String, Option<i32>) {
    let run = command(folder, arguments).args(files).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(run.stdout), text(run.stderr), run.status.code())
}

#[test]
fn broken_file_among_many_is_named_and_the_others_make_one_table() {
    let (folder, names) = folder();
    let (table, errors, status) = run(folder.path(), &["fit"], &names);
    assert_eq!(status, Some(2));
    assert_eq!(errors.lines().count(), 1, "{errors}");
    assert!(errors.contains(&format!("log{BROKEN}.csv:")), "{errors}");
    let is_name = |line: &&str| line.starts_with("log");
    let listed: Vec<&str> = table.lines().filter(is_name).collect();
    let mut wanted = names.clone();
    wanted.remove(BROKEN);
    assert_eq!(listed, wanted);
    assert!(table.starts_with("axis"));
    assert!(
        table.lines().all(|line| line.chars().count() <= 80),
        "{table}"
    );
    let alone = output(folder.path(), &["fit", &names[0]]);
    let walk = alone
        .lines()
        .find(|line| line.contains("angle random walk"))
        .unwrap();
    let words: Vec<&str> = walk.split_whitespace().collect();
    let customary = words[words.iter().position(|word| *word == "°/√h").unwrap() - 1];
    let first = table.lines().skip_while(|line| !is_name(line)).nth(1);
    let first = first.unwrap();
    assert!(
        first.split_whitespace().any(|word| word == customary),
        "{customary}: {first}"
    );
}

#[test]
fn json_of_many_files_contains_each_as_for_a_single_file() {
    let (folder, names) = folder();
    let (text, errors, status) = run(folder.path(), &["fit", "--json"], &names);
    assert_eq!(status, Some(2));
    let document: Value = serde_json::from_str(&text).unwrap();
    let files = document["files"].as_array().unwrap();
    let (lines, _, _) = run(folder.path(), &["fit", "--json-lines"], &names);
    let lines: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(&lines, files);
    let listed: Vec<&str> = files
        .iter()
        .map(|file| file["file"].as_str().unwrap())
        .collect();
    assert_eq!(listed, names);
    let error = files[BROKEN]["error"].as_str().unwrap();
    assert_eq!(format!("allanite: {error}\n"), errors);
    assert!(errors.contains("no rows"), "{errors}");
    for file in [0, 3, FILES - 1] {
        let alone = json(folder.path(), &["fit", &names[file]]);
        assert_eq!(alone["axes"], files[file]["axes"]);
    }
}

#[test]
fn comparisons_and_diagnoses_of_several_files_are_printed_in_order_with_names() {
    let (folder, names) = folder();
    for command in ["compare", "diagnose"] {
        let three = [&names[5], &names[0], &names[2]];
        let texts = three.map(|name| output(folder.path(), &[command, name]));
        let together = output(folder.path(), &[command, three[0], three[1], three[2]]);
        let parts: Vec<String> = three
            .iter()
            .zip(texts)
            .map(|(name, text)| format!("{name}\n{text}"))
            .collect();
        assert_eq!(together, parts.join("\n"));
        let document = json(folder.path(), &[command, three[0], three[1]]);
        let alone = json(folder.path(), &[command, three[1]]);
        assert_eq!(document["files"][1]["axes"], alone["axes"]);
    }
}

#[test]
fn measure_writes_one_curve_file_per_log_into_a_folder() {
    let (folder, names) = folder();
    let refused = refusal(
        folder.path(),
        &["measure", &names[0], &names[1], "--output", "curves"],
    );
    assert!(
        refused.starts_with("curves: several logs need a folder"),
        "{refused}"
    );
    fs::create_dir(folder.path().join("curves")).unwrap();
    let some = &names[BROKEN - 2..BROKEN + 2];
    let (text, errors, status) = run(folder.path(), &["measure", "--output", "curves"], some);
    assert_eq!((status, errors.lines().count()), (Some(2), 1));
    assert_eq!(text.lines().count(), 3);
    for name in some {
        let curve = format!("curves/{}", name.replace(".csv", ".json"));
        let there = folder.path().join(&curve).exists();
        assert_eq!(there, !name.contains(&BROKEN.to_string()), "{curve}");
        if there {
            let fit = output(folder.path(), &["fit", &curve]);
            assert_eq!(fit, output(folder.path(), &["fit", name]));
        }
    }
}
