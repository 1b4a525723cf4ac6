//! Finds which file names the items of which others.

use crate::source::{Crate, File, Module, ModulePath};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use syn::{
    ItemMod, ItemUse, Macro, MetaList, Path, Visibility,
    visit::{self, Visit},
};

/// The files, and for each of them the files whose items it names.
pub(crate) type Graph = BTreeMap<String, BTreeSet<String>>;

/// The largest number of re-exports that a path is followed through.
const LONGEST_WAY: usize = 16;

/// The graph of a crate.
pub(crate) fn graph(of: &Crate) -> Graph {
    let files = of.files.iter();
    files
        .map(|(name, file)| (name.clone(), imported(of, name, file)))
        .collect()
}

/// The other files whose items a file names.
fn imported(of: &Crate, name: &str, file: &File) -> BTreeSet<String> {
    let mut paths = Paths {
        module: file.path.clone(),
        found: Vec::new(),
    };
    for item in &file.items {
        paths.visit_item(item);
    }
    let mut imported = BTreeSet::new();
    for Found { module, path, glob } in paths.found {
        match leads_to(of, &module, &path, LONGEST_WAY) {
            Some(Place::Item(file)) => {
                imported.insert(file);
            }
            // The items in a module count where they are named.
            Some(Place::Module) => assert!(!glob, "{name}: {path:?}::* hides what is imported"),
            None => assert!(!is_own(&path[0]), "{name}: {path:?} leads nowhere"),
        }
    }
    imported.remove(name);
    imported
}

/// A path and the module that contains it.
struct Found {
    module: ModulePath,
    path: ModulePath,
    /// Whether `::*` follows the path.
    glob: bool,
}

/// Collects every path in a file.
struct Paths {
    module: ModulePath,
    found: Vec<Found>,
}

impl Paths {
    fn add(&mut self, path: ModulePath) {
        if !path.is_empty() {
            self.found.push(Found {
                module: self.module.clone(),
                path,
                glob: false,
            });
        }
    }

    /// The arguments of a macro are tokens. Paths among them are names between double colons.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let mut path = ModulePath::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(word) => {
                    if colons != 2 {
                        self.add(std::mem::take(&mut path));
                    }
                    path.push(word.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                other => {
                    self.add(std::mem::take(&mut path));
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.add_tokens(group.stream());
                    }
                }
            }
        }
        self.add(path);
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        self.module.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.module.pop();
    }

    fn visit_item_use(&mut self, import: &'ast ItemUse) {
        // A re-export is not an import. If this file also uses the name, that use is found
        // separately.
        if !matches!(import.vis, Visibility::Inherited) {
            return;
        }
        let mut module = Module::default();
        module.import(&import.tree, &mut ModulePath::new());
        for path in module.imports.into_values() {
            self.add(path);
        }
        let globs = module.globs.into_iter().map(|path| Found {
            module: self.module.clone(),
            path,
            glob: true,
        });
        self.found.extend(globs);
    }

    fn visit_path(&mut self, path: &'ast Path) {
        let names = path.segments.iter();
        self.add(names.map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_meta_list(&mut self, attribute: &'ast MetaList) {
        self.add_tokens(attribute.tokens.clone());
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        self.add_tokens(called.tokens.clone());
        visit::visit_macro(self, called);
    }
}

/// Whether a path that begins with this name stays in the crate.
fn is_own(first: &str) -> bool {
    ["crate", "self", "super"].contains(&first)
}

/// The target of a path.
enum Place {
    /// An item that this file defines.
    Item(String),
    /// A module.
    Module,
}

/// The target of a path, seen from a module. Returns `None` if it belongs to another crate.
fn leads_to(of: &Crate, module: &[String], path: &[String], ways: usize) -> Option<Place> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => below(of, &[], rest, ways),
        "self" => below(of, module, rest, ways),
        "super" => {
            let (_, parent) = module.split_last()?;
            let is_further = rest.first().is_some_and(|name| name == "super");
            if is_further {
                leads_to(of, parent, rest, ways)
            } else {
                below(of, parent, rest, ways)
            }
        }
        _ => {
            let is_child = of.modules.contains_key(&[module, &path[..1]].concat());
            let is_imported = of.modules.get(module)?.imports.contains_key(first);
            let is_here = is_child || is_imported;
            is_here.then(|| below(of, module, path, ways)).flatten()
        }
    }
}

/// The target of a path that begins in this module.
fn below(of: &Crate, module: &[String], path: &[String], ways: usize) -> Option<Place> {
    let here = of.modules.get(module)?;
    let Some((first, rest)) = path.split_first() else {
        return Some(Place::Module);
    };
    let child = [module, &path[..1]].concat();
    if of.modules.contains_key(&child) {
        return below(of, &child, rest, ways);
    }
    let item = || Place::Item(here.file.clone());
    if here.defined.contains(first) {
        return Some(item());
    }
    let ways = ways.checked_sub(1)?;
    if let Some(way) = here.imports.get(first) {
        // If the name of another crate is re-exported, it belongs to the file that does so.
        return leads_to(of, module, &[way, rest].concat(), ways).or_else(|| Some(item()));
    }
    let by_glob = here.globs.iter().find_map(|glob| {
        let way = [glob, path].concat();
        leads_to(of, module, &way, ways)
    });
    by_glob.or_else(|| here.calls_macros.then(item))
}
