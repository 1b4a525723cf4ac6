//! The README shows what its reader will see.

use host_tests::firmware::{
    Precision, Way,
    budgets::{self, target},
    figures,
};
use host_tests::program::output;
use std::{fs, path::Path};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// Commands of the `console` blocks, and the lines shown of each.
fn examples(readme: &str) -> Vec<(&str, Vec<&str>)> {
    let mut examples: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut inside = false;
    for line in readme.lines() {
        match line {
            "```console" => inside = true,
            "```" => inside = false,
            _ if !inside => {}
            _ => match line.strip_prefix("$ cargo allanite ") {
                Some(command) => examples.push((command, Vec::new())),
                None => examples.last_mut().expect("a command first").1.push(line),
            },
        }
    }
    examples
}

/// Takes the lines shown from those printed, in order: `...` stands for any number of lines.
fn find(shown: &[&str], printed: &[&str]) -> Result<(), String> {
    let mut rest = printed;
    for part in shown.split(|line| *line == "...") {
        if part.is_empty() {
            continue;
        }
        let found = rest.windows(part.len()).position(|window| window == part);
        let at =
            found.ok_or_else(|| format!("not printed, in this order:\n{}", part.join("\n")))?;
        rest = &rest[at + part.len()..];
    }
    Ok(())
}

#[test]
fn commands_print_what_is_shown() {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).unwrap();
    let examples = examples(&readme);
    assert!(examples.len() >= 4);
    for (command, shown) in examples {
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let printed = output(Path::new(ROOT), &arguments);
        let printed: Vec<&str> = printed.lines().map(str::trim_end).collect();
        assert!(shown.iter().filter(|line| **line != "...").count() >= 3);
        if let Err(missing) = find(&shown, &printed) {
            panic!("{command}: {missing}\nprinted:\n{}", printed.join("\n"));
        }
    }
}

#[test]
fn figures_are_those_of_the_budgets() {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).unwrap();
    let shown = figures::readme(&budgets::committed(Way::Rustup).unwrap()).unwrap();
    assert!(shown.lines().count() > 20);
    assert!(readme.contains(&shown), "the README lacks:\n{shown}");
}

#[test]
fn memory_that_is_promised_is_enough() {
    for way in Way::ALL {
        promised(way);
    }
}

fn promised(way: Way) {
    let budgets = budgets::committed(way).unwrap();
    for core in budgets["cores"].as_array().unwrap() {
        let ram = core["ram_bytes"].as_u64().unwrap();
        assert!(
            core["core"] != "Cortex-M0" || ram < 16 * 1024,
            "{way}: {core}"
        );
    }
    let most = |precision, figure: &str, kibibytes: u64| {
        let bytes = budgets[target(precision)][figure].as_u64().unwrap();
        assert!(bytes <= kibibytes * 1024, "{way}: {figure}: {bytes}");
    };
    for precision in Precision::ALL {
        most(precision, "ram_bytes_three_axes_20_with_diagnosis", 32);
        most(precision, "flash_bytes_accumulator", 3);
        most(precision, "stack_bytes_fit_20", 12);
        most(precision, "stack_bytes_diagnosis_20", 16);
    }
    most(Precision::Single, "flash_bytes_with_fit", 24);
    most(Precision::Single, "flash_bytes_with_diagnosis", 48);
}
