//! The READMEs and the crate's page show what their readers will see.

use clap::Parser as _;
use program::{output, rows};
use std::{cmp::Reverse, fs, path::Path};
use xtask::{
    CommandLine, cost,
    firmware::{
        Precision,
        budgets::{self, target},
        figures,
    },
};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The project's page.
const README: &str = "README.md";

/// The page of the published crate.
const PUBLISHED: &str = "src/README.md";

/// The pages of the manual that print commands with what they say.
const WITH_COMMANDS: [(&str, usize); 2] = [
    ("host-tests/doc/tour.md", 6),
    ("host-tests/doc/commands.md", 1),
];

/// The page with the figures.
const FIGURES: &str = "host-tests/doc/firmware.md";

/// The crate's page is the documentation of this file.
const CRATE_PAGE: &str = "src/lib.rs";

/// A rounded figure of the crate's page may differ by this share from the budget.
const ROUNDED: f64 = 0.1;

/// The text of a file.
fn text(path: &str) -> String {
    let text = fs::read_to_string(Path::new(ROOT).join(path));
    text.unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Commands of the `console` blocks, and the lines shown of each.
fn examples(page: &str) -> Vec<(&str, Vec<&str>)> {
    let mut examples: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
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

/// The place of the printed lines that have most words in common with those that a page shows.
fn likest(shown: &[&str], printed: &[&str]) -> Option<usize> {
    let common = |window: &[&str]| {
        let lines = shown.iter().zip(window);
        let words = lines.flat_map(|(one, other)| {
            let others: Vec<&str> = other.split(' ').collect();
            one.split(' ').filter(move |word| others.contains(word))
        });
        words.count()
    };
    let windows = printed.windows(shown.len()).enumerate();
    let best = windows.max_by_key(|(at, window)| (common(window), Reverse(*at)));
    best.map(|(at, _)| at)
}

/// Replaces the lines that a page shows, and that are not printed, by those most like them.
fn update(page: &mut String, shown: &[&str], printed: &[&str]) {
    let mut rest = printed;
    let parts = shown.split(|line| *line == "...");
    for part in parts.filter(|part| !part.is_empty()) {
        let Some(at) = likest(part, rest) else {
            continue;
        };
        let (now, behind) = rest[at..].split_at(part.len());
        *page = page.replace(&part.join("\n"), &now.join("\n"));
        rest = behind;
    }
}

/// Runs the commands of a page, of which there are at least so many. With `ALLANITE_PAGES=write`, the page is changed to what
/// they print now.
fn commands_print_what_is_shown(path: &str, least: usize) {
    let page = text(path);
    let mut written = page.clone();
    let writes = std::env::var_os("ALLANITE_PAGES").is_some_and(|value| value == "write");
    let examples = examples(&page);
    assert!(examples.len() >= least, "{path}: {examples:?}");
    for (command, shown) in examples {
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let printed = output(Path::new(ROOT), &arguments);
        let printed: Vec<&str> = printed.lines().map(str::trim_end).collect();
        assert!(shown.iter().filter(|line| **line != "...").count() >= 3);
        match find(&shown, &printed) {
            Err(_) if writes => update(&mut written, &shown, &printed),
            Err(missing) => panic!(
                "{path}: {command}: {missing}; write it with ALLANITE_PAGES=write\nprinted:\n{}",
                printed.join("\n")
            ),
            Ok(()) => {}
        }
    }
    if written != page {
        fs::write(Path::new(ROOT).join(path), written).expect("a page");
    }
}

#[test]
fn commands_of_the_readme_print_what_is_shown() {
    commands_print_what_is_shown(README, 1);
}

#[test]
fn commands_of_the_manual_print_what_is_shown() {
    for (page, least) in WITH_COMMANDS {
        commands_print_what_is_shown(page, least);
    }
}

#[test]
fn the_readme_has_at_most_150_lines() {
    let lines = text(README).lines().count();
    assert!((50..=150).contains(&lines), "{lines} lines");
}

#[test]
fn pictures_of_the_manual_are_those_that_plot_draws() {
    let folder = tempfile::TempDir::new().expect("a folder");
    for (axis, what, step, picture) in [
        ("gx", "deviation", "0", "adis16405-gx-0.svg"),
        ("gx", "deviation", "9", "adis16405-gx-last.svg"),
        ("gz", "spectrum", "0", "adis16405-gz-0.svg"),
        ("gz", "spectrum", "9", "adis16405-gz-last.svg"),
    ] {
        let input = "host-tests/data/adis16405.json";
        let drawn = folder.path().join(picture);
        let file = drawn.to_string_lossy().into_owned();
        let what = ["--axis", axis, "--what", what, "--step", step];
        let arguments = [&["plot", input, "--output", &file], &what[..]].concat();
        output(Path::new(ROOT), &arguments);
        let shown = text(&format!("host-tests/pictures/{picture}"));
        let drawn = fs::read_to_string(drawn).expect("a picture");
        assert!(
            shown == drawn,
            "draw it again: cargo allanite {}",
            arguments
                .join(" ")
                .replace(&file, &format!("host-tests/pictures/{picture}"))
        );
    }
}

/// The example of a firmware is compiled where it is published; the project's page shows the same.
#[test]
fn both_pages_show_the_same_example() {
    let example = |page: &str| {
        let page = text(page);
        let code = page.split("```rust\n").nth(1).expect("an example");
        code.split("```").next().expect("its end").to_owned()
    };
    assert_eq!(example(README), example(PUBLISHED));
}

#[test]
fn figures_are_those_of_the_budgets() {
    let shown = figures::readme(&budgets::committed().unwrap()).unwrap();
    assert!(shown.lines().count() > 20);
    assert!(text(FIGURES).contains(&shown), "{FIGURES} lacks:\n{shown}");
}

#[test]
fn the_cost_of_a_product_is_what_the_calculator_says() {
    let page = text(FIGURES);
    let mut commands = page
        .lines()
        .filter_map(|line| line.strip_prefix("$ cargo xtask cost "));
    let arguments = commands.next().expect("a command");
    let line = ["xtask", "cost"].into_iter().chain(arguments.split(' '));
    let product = CommandLine::try_parse_from(line)
        .expect("valid arguments")
        .product();
    let budgets = budgets::committed().unwrap();
    let table = cost::table(&product.expect("a product"), &budgets).unwrap();
    assert!(
        table.lines().count() > 8 && page.contains(&table),
        "{FIGURES} lacks:\n{table}"
    );
}

/// The number at the start of the last column of the row that begins so; a blank parts thousands.
fn shown_figure(page: &str, row: &str) -> f64 {
    let start = format!("//! | {row} | ");
    let mut rows = page.lines().filter_map(|line| line.strip_prefix(&start));
    let figure = rows
        .next()
        .unwrap_or_else(|| panic!("{CRATE_PAGE} has no row `{row}`"));
    let end = figure.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ' '));
    let number = figure[..end.unwrap_or(figure.len())].replace(' ', "");
    let number: f64 = number.parse().unwrap_or_else(|_| panic!("{figure}"));
    if figure.contains("million") {
        1e6 * number
    } else {
        number
    }
}

#[test]
fn rounded_figures_of_the_crates_page_are_near_the_budgets() {
    let page = text(CRATE_PAGE);
    let budgets = budgets::committed().unwrap();
    let budgets = &budgets[target(Precision::Single)];
    for (row, budget) in rows! {
        "a sample into an accumulator, any number of octaves", "instructions_per_sample";
        "RAM of an accumulator of 24 octaves", "ram_bytes_per_axis_24";
        "flash of accumulator, curve and fit", "flash_bytes_with_fit";
        "flash with the diagnosis and the whole catalogue", "flash_bytes_with_diagnosis";
        "flash of accumulator, curve and the fit of the five terms alone", "flash_bytes_with_five_terms";
        "that fit, of 20 octaves", "instructions_five_terms_20";
        "a fit of 20 octaves", "instructions_fit_20";
        "RAM of a spectrum, for an axis", "ram_bytes_per_axis_of_spectrum";
        "flash with diagnosis and spectrum", "flash_bytes_with_spectrum";
    } {
        let (shown, budget) = (shown_figure(&page, row), budgets[budget].as_f64().unwrap());
        assert!(
            (shown / budget - 1.0).abs() < ROUNDED,
            "{CRATE_PAGE}: {row}: {shown} is shown, the budget is {budget}"
        );
    }
}

#[test]
fn memory_that_is_promised_is_enough() {
    let promise = "fit into 131 KiB of flash and 34 KiB of RAM of a Cortex-M4F";
    assert!(text(README).contains(promise), "{README} lacks: {promise}");
    let budgets = budgets::committed().unwrap();
    for core in budgets["cores"].as_array().unwrap() {
        let ram = core["ram_bytes"].as_u64().unwrap();
        assert!(core["core"] != "Cortex-M0" || ram < 16 * 1024, "{core}");
    }
    let most = |precision, figure: &str, kibibytes: u64| {
        let bytes = budgets[target(precision)][figure].as_u64().unwrap();
        assert!(bytes <= kibibytes * 1024, "{figure}: {bytes}");
    };
    for precision in Precision::ALL {
        most(precision, "flash_bytes_accumulator", 4);
        most(precision, "stack_bytes_fit_20", 15);
    }
    most(
        Precision::Single,
        "ram_bytes_three_axes_20_with_diagnosis",
        34,
    );
    most(
        Precision::Double,
        "ram_bytes_three_axes_20_with_diagnosis",
        46,
    );
    most(Precision::Single, "flash_bytes_with_fit", 45);
    most(Precision::Single, "flash_bytes_with_diagnosis", 131);
}
