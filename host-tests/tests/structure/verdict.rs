//! Verdicts are said in the words of one file, everywhere.

use crate::{HOST, script, source, words::Catalogue};
use std::{collections::BTreeSet, fs, path::Path};

/// The words of verdicts: the sentences stand in one file, and the names in files in another one.
fn catalogue() -> Catalogue {
    let of = |folder: &str, file: &str| source::items(&Path::new(HOST).join(folder)).remove(file);
    let sentences = of("host/src", CATALOGUE).expect("the sentences");
    let names = of("../src/diagnosis", CATALOGUE).expect("the names");
    let catalogue = Catalogue::of(&sentences, &names);
    assert!(catalogue.phrases.len() > 40 && catalogue.names.len() == 7);
    catalogue
}

const CATALOGUE: &str = "verdict.rs";

/// Where programs, studies and tests may not say a verdict themselves.
const OTHERS: [&str; 16] = [
    "log/src",
    "plot/src",
    "host/src",
    "cli/src",
    "fleet/src",
    "fleet/tests",
    "../src/python/src",
    "studies/src",
    "studies/src/bin",
    "tests/cli",
    "tests/common",
    "tests/images",
    "tests/library",
    "tests/pages",
    "tests/program",
    "tests/studies",
];

#[test]
fn the_words_of_a_verdict_stand_in_one_file() {
    let catalogue = catalogue();
    let (mut files, mut elsewhere) = (0, Vec::new());
    for folder in OTHERS {
        for (name, items) in source::items(&Path::new(HOST).join(folder)) {
            files += 1;
            if (folder, name.as_str()) != ("host/src", CATALOGUE) {
                let found = catalogue.in_rust(&items).into_iter();
                elsewhere.extend(found.map(|phrase| format!("{folder}/{name}: {phrase:?}")));
            }
        }
    }
    assert!(files > 500, "{files} files");
    for (folder, end) in [
        ("../src/python", ".py"),
        ("cli/src/report", ".js"),
        ("page", ".js"),
        ("page", ".html"),
    ] {
        let files = script::files(&Path::new(HOST).join(folder), end);
        elsewhere.extend(catalogue.in_others(&files));
    }
    assert!(elsewhere.is_empty(), "{}", elsewhere.join("\n"));
}

#[test]
fn documents_list_the_names_of_all_verdicts() {
    let names: BTreeSet<String> = catalogue().names.into_iter().collect();
    let between = |path: &str, begin: &str, end: &str, quote: &str| {
        let text = fs::read_to_string(Path::new(HOST).join(path)).expect("a document");
        let (_, rest) = text.split_once(begin).expect("the verdict");
        let list = rest.split(end).next().expect("a list");
        let listed = list.split(quote).skip(1).step_by(2);
        listed.map(str::to_owned).collect::<BTreeSet<String>>()
    };
    let schema = "doc/schema/diagnose.schema.json";
    let begin = "\"verdict\": {\n          \"type\": \"string\",\n          \"enum\": [";
    assert_eq!(between(schema, begin, "]", "\""), names, "{schema}");
    let python = "../src/python/python/allanite/_diagnosis.py";
    assert_eq!(
        between(python, "verdict : str\n", "\n", "``"),
        names,
        "{python}"
    );
}

#[test]
fn a_verdict_in_another_file_is_found() {
    let catalogue = catalogue();
    let text = "/// It is adequate now.\nfn f() { format!(\"the model is adequate\"); g(\"too short to judge\"); h(\"adequate\") }\n\
                #[cfg(test)] mod tests { fn g() { assert_eq!(axis[\"verdict\"], \"improved\") } }";
    let items = syn::parse_file(text).expect("a file").items;
    assert_eq!(
        catalogue.in_rust(&items),
        ["adequate", "too short to judge", "improved"]
    );
    let files = [
        (
            "a.py",
            "\"\"\"It is not adequate.\"\"\"\n# It explains the record.\nsaid = \"no effect is missing\"",
        ),
        ("b.html", "<p>an adequate model</p>"),
    ];
    let files = files.map(|(name, text)| (name.to_owned(), text.to_owned()));
    let expected = [
        "a.py: \"no effect is missing\"",
        "b.html: \"an adequate model\"",
        "b.html: \"adequate\"",
    ];
    assert_eq!(catalogue.in_others(&files.into()), expected);
}

/// The page that explains the words, which therefore says them.
const READING: &str = "doc/reading.md";

#[test]
fn pages_quote_verdicts_as_they_are() {
    let catalogue = catalogue();
    let root = Path::new(HOST).join("..");
    let mut pages = script::files(Path::new(HOST), ".md");
    pages.extend(script::files(&root.join("src"), ".md"));
    pages.insert(
        "README.md".to_owned(),
        fs::read_to_string(root.join("README.md")).expect("a page"),
    );
    assert!(pages.len() > 35, "{} pages", pages.len());
    let mut outdated = Vec::new();
    for (name, page) in &pages {
        let lines = catalogue.outdated(page).into_iter();
        outdated.extend(lines.map(|line| format!("{name}: {line}")));
    }
    assert!(outdated.is_empty(), "{}", outdated.join("\n"));
    // In sentences, only the page that explains the word says it.
    for word in [
        format!("not {}", catalogue.word),
        format!("is {} now", catalogue.word),
    ] {
        assert!(
            pages[READING].contains(&word),
            "{READING} does not explain {word:?}"
        );
    }
}

#[test]
fn a_quoted_verdict_of_other_words_is_found() {
    let catalogue = catalogue();
    let page = |line: &str| format!("It prints\n\n```text\n{line}\n```\n");
    for right in [
        "gx: the five terms are adequate (p = 0.420): no effect is missing.",
        "gz: the five terms and what follows explain a part of the record (p = 6.2e-28)",
        "The five-term model is not adequate: the record has another effect, which distorts the coefficients. `compare` shows where, and `diagnose` looks for it.",
    ] {
        assert_eq!(catalogue.outdated(&page(right)), [""; 0]);
    }
    for wrong in [
        "gx: the five terms are sufficient (p = 0.420): no effect is missing.",
        "gz: the five terms and what follows explain most of the record (p = 6.2e-28)",
        "The five-term model is not sufficient: the record has another effect, which distorts the coefficients. `compare` shows where, and `diagnose` looks for it.",
    ] {
        assert_eq!(catalogue.outdated(&page(wrong)), [wrong]);
        assert_eq!(catalogue.outdated(wrong), [""; 0], "outside a block");
    }
}
