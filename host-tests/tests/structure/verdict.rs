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
    let names = catalogue().names;
    let between = |path: &str, begin: &str, end: &str, quote: &str| {
        let text = fs::read_to_string(Path::new(HOST).join(path)).expect("a document");
        let (_, rest) = text.split_once(begin).expect("the verdict");
        let list = rest.split(end).next().expect("a list");
        let listed = list.split(quote).skip(1).step_by(2);
        listed.map(str::to_owned).collect::<BTreeSet<String>>()
    };
    // The schemas of documents list what the library lists.
    for (file, end) in [
        ("../src/diagnosis/verdict.rs", "fn name("),
        ("../src/record/integrity/reason.rs", "fn name("),
    ] {
        let listed = between(file, "const NAMES", "];", "\"");
        assert_eq!(listed, between(file, end, "\n    }\n", "\""), "{file}");
    }
    let python = "../src/python/python/allanite/_diagnosis.py";
    assert_eq!(
        between(python, "verdict : str\n", "\n", "``"),
        names,
        "{python}"
    );
}

/// A catalogue of other words than that of the project.
fn invented() -> Catalogue {
    let of = |text: &str| syn::parse_file(text).expect("a file").items;
    let sentences = "const ADEQUATE: &str = \"sound\"; const INADEQUATE: &str = \"not sound\";
        const NOT_STATIONARY: &str = \"unsteady\"; const MODEL: &str = \"a sound model\";
        fn of(terms: &str, p: &str) { f(\"the {terms} are {ADEQUATE} (p {p}): nothing is missing.\"); \
        f(\"The model{behind} is {INADEQUATE}: something else is there, `compare` shows where.\"); }";
    Catalogue::of(&of(sentences), &of("const NAME: &str = \"better\";"))
}

#[test]
fn a_verdict_in_another_file_is_found() {
    let catalogue = invented();
    let text = "/// It is sound now.\nfn f() { format!(\"the model is sound\"); g(\"nothing is missing\"); h(\"sound\") }\n\
                #[cfg(test)] mod tests { fn g() { assert_eq!(axis[\"verdict\"], \"better\") } }";
    let items = syn::parse_file(text).expect("a file").items;
    let expected = ["sound", "nothing is missing", "better"];
    assert_eq!(catalogue.in_rust(&items), expected);
    let files = [
        (
            "a.py",
            "\"\"\"It is not sound.\"\"\"\n# Nothing is missing.\nsaid = \"so nothing is missing\"",
        ),
        ("b.html", "<p>a sound model</p>"),
    ];
    let files = files.map(|(name, text)| (name.to_owned(), text.to_owned()));
    let expected = [
        "a.py: \"nothing is missing\"",
        "b.html: \"a sound model\"",
        "b.html: \"sound\"",
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
    let catalogue = invented();
    let page = |line: &str| format!("It prints\n\n```text\n{line}\n```\n");
    for right in [
        "gx: the five terms are sound (p = 0.420): nothing is missing.",
        "The model behind a filter is not sound: something else is there, `compare` shows where.",
        "gx: 3 samples, of which nothing is known.",
    ] {
        assert_eq!(catalogue.outdated(&page(right)), [""; 0]);
    }
    for wrong in [
        "gx: the five terms are adequate (p = 0.420): nothing is missing.",
        "The model behind a filter is inadequate: something else is there, `compare` shows where.",
    ] {
        assert_eq!(catalogue.outdated(&page(wrong)), [wrong]);
        assert_eq!(catalogue.outdated(wrong), [""; 0], "outside a block");
    }
}
