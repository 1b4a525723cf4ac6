//! Reads the files of a crate as modules: what each defines, and what it imports under which name.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};
use syn::{Attribute, Item, UseTree};

/// The names on the path from the root of the crate to a module.
pub(crate) type ModulePath = Vec<String>;

/// The files of a crate by their names, and its modules by their paths.
#[derive(Default)]
pub(crate) struct Crate {
    pub files: BTreeMap<String, File>,
    pub modules: BTreeMap<ModulePath, Module>,
}

/// A source file without its test modules.
pub(crate) struct File {
    pub path: ModulePath,
    pub items: Vec<Item>,
}

/// A module: a file, or a part of one between braces.
#[derive(Default)]
pub(crate) struct Module {
    pub file: String,
    /// The names of the items that the module defines.
    pub defined: BTreeSet<String>,
    /// Whether the module calls macros, which may define more items.
    pub calls_macros: bool,
    /// The imports of `use` declarations: the name in this module, and the path of the item.
    pub imports: BTreeMap<String, ModulePath>,
    /// The modules of which everything is imported.
    pub globs: Vec<ModulePath>,
}

impl Crate {
    /// Reads the crate whose root is in this folder. Programs are separate crates and are left out.
    pub(crate) fn read(root: &Path) -> Self {
        let mut files = Vec::new();
        collect(root, root, &mut files);
        Self::of(files.iter().map(|(name, text)| (&**name, &**text)))
    }

    /// The crate that consists of these files.
    pub(crate) fn of<'a>(files: impl Iterator<Item = (&'a str, &'a str)>) -> Self {
        let mut of = Self::default();
        let parsed: Vec<_> = files
            .map(|(name, text)| {
                let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{name}: {error}"));
                (name, module_path(name), file.items)
            })
            .collect();
        let tests: Vec<ModulePath> = parsed
            .iter()
            .flat_map(|(_, path, items)| test_files(path, items))
            .collect();
        for (name, path, items) in parsed {
            // A file of tests may import whatever it tests.
            if tests.iter().any(|test| path.starts_with(test)) {
                continue;
            }
            let items = without_tests(items);
            of.declare(name, &path, &items);
            of.files.insert(name.to_owned(), File { path, items });
        }
        of
    }

    fn declare(&mut self, file: &str, path: &ModulePath, items: &[Item]) {
        let mut module = Module {
            file: file.to_owned(),
            ..Module::default()
        };
        for item in items {
            match item {
                Item::Use(import) => module.import(&import.tree, &mut Vec::new()),
                Item::Macro(_) => module.calls_macros = true,
                // What lies elsewhere belongs to the file that brings it in.
                Item::Mod(inner) if inner.attrs.iter().any(|one| one.path().is_ident("path")) => {
                    module.defined.insert(inner.ident.to_string());
                }
                Item::Mod(inner) => {
                    if let Some((_, items)) = &inner.content {
                        let path = [&path[..], &[inner.ident.to_string()]].concat();
                        self.declare(file, &path, items);
                    }
                }
                other => module.defined.extend(defined_name(other)),
            }
        }
        self.modules.insert(path.clone(), module);
    }
}

impl Module {
    /// Records the names that a `use` declaration imports.
    pub(crate) fn import(&mut self, tree: &UseTree, before: &mut ModulePath) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.import(&path.tree, before);
                before.pop();
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(tree, before);
                }
            }
            UseTree::Glob(_) => self.globs.push(before.clone()),
            UseTree::Name(name) => self.import_as(before, &name.ident.to_string(), None),
            UseTree::Rename(rename) => {
                let alias = rename.rename.to_string();
                self.import_as(before, &rename.ident.to_string(), Some(alias));
            }
        }
    }

    fn import_as(&mut self, before: &ModulePath, name: &str, alias: Option<String>) {
        let mut path = before.clone();
        if name != "self" {
            path.push(name.to_owned());
        }
        let alias = match alias {
            // Several imports as `_` do not replace each other.
            Some(alias) if alias == "_" => path.join("::"),
            Some(alias) => alias,
            None => path.last().cloned().unwrap_or_default(),
        };
        self.imports.insert(alias, path);
    }
}

/// The files of Rust below a folder with their items, those of tests included.
pub(crate) fn items(root: &Path) -> BTreeMap<String, Vec<Item>> {
    let mut files = Vec::new();
    collect(root, root, &mut files);
    let parsed = files.into_iter().map(|(name, text)| {
        let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, file.items)
    });
    parsed.collect()
}

fn collect(root: &Path, folder: &Path, files: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.strip_prefix(root).expect("below the root");
        let name = name.to_str().expect("UTF-8").to_owned();
        if path.is_dir() {
            // A folder with a manifest is a package of its own.
            if name != "bin" && !path.join("Cargo.toml").exists() {
                collect(root, &path, files);
            }
        } else if name.ends_with(".rs") {
            files.push((name, fs::read_to_string(&path).expect("a source file")));
        }
    }
}

/// The path of the module in a file: `["log", "record"]` for `log/record.rs`, `["log"]` for
/// `log/mod.rs`.
fn module_path(file: &str) -> ModulePath {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let mut path: ModulePath = stem.split('/').map(str::to_owned).collect();
    if matches!(path.last().map(String::as_str), Some("mod" | "lib")) {
        path.pop();
    }
    path
}

/// The modules of a file that are compiled only for tests and have files of their own.
fn test_files(path: &ModulePath, items: &[Item]) -> Vec<ModulePath> {
    let modules = items.iter().filter(|item| is_test(item));
    modules
        .filter_map(|item| match item {
            Item::Mod(inner) if inner.content.is_none() => {
                Some([&path[..], &[inner.ident.to_string()]].concat())
            }
            _ => None,
        })
        .collect()
}

fn without_tests(items: Vec<Item>) -> Vec<Item> {
    let mut kept: Vec<Item> = items.into_iter().filter(|item| !is_test(item)).collect();
    for item in &mut kept {
        if let Item::Mod(inner) = item
            && let Some((_, items)) = &mut inner.content
        {
            *items = without_tests(std::mem::take(items));
        }
    }
    kept
}

fn is_test(item: &Item) -> bool {
    let attributes: &[Attribute] = match item {
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        _ => return false,
    };
    attributes.iter().any(|attribute| {
        let argument = attribute.parse_args::<syn::Ident>();
        attribute.path().is_ident("cfg") && argument.is_ok_and(|word| word == "test")
    })
}

fn defined_name(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}
