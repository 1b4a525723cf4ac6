//! Which file names the items of which others.

use crate::source::{Crate, Module, ModulePath};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use syn::{
    ItemMod, ItemUse, Macro, MetaList, Path,
    visit::{self, Visit},
};

/// Files, and those that each names.
pub type Graph = BTreeMap<String, BTreeSet<String>>;

/// A path through more re-exports than this leads nowhere.
const LONGEST_WAY: usize = 16;

/// The graph of a crate. Signposts have no edges.
pub fn graph(of: &Crate) -> Graph {
    let mut graph = Graph::new();
    for (name, file) in &of.files {
        let mut imported = BTreeSet::new();
        if !file.is_signpost {
            let mut paths = Paths {
                module: file.path.clone(),
                found: Vec::new(),
                globs: Vec::new(),
            };
            for item in &file.items {
                paths.visit_item(item);
            }
            for (module, path) in paths.found {
                match leads_to(of, &module, &path, LONGEST_WAY) {
                    Some(Place::Item(file)) => {
                        imported.insert(file);
                    }
                    // What is named in the module counts, where it is named.
                    Some(Place::Module(_)) => {}
                    None => assert!(!is_own(&path[0]), "{name}: {path:?} leads nowhere"),
                }
            }
            for (module, glob) in paths.globs {
                if let Some(Place::Module(file)) = leads_to(of, &module, &glob, LONGEST_WAY) {
                    let is_signpost = of.files[&file].is_signpost;
                    assert!(!is_signpost, "{name}: {glob:?} hides what is imported");
                    imported.insert(file);
                }
            }
            imported.remove(name);
        }
        graph.insert(name.clone(), imported);
    }
    graph
}

/// Paths of several names, and the modules in which they stand.
struct Paths {
    module: ModulePath,
    found: Vec<(ModulePath, ModulePath)>,
    globs: Vec<(ModulePath, ModulePath)>,
}

impl Paths {
    fn add(&mut self, path: ModulePath) {
        if path.len() > 1 {
            self.found.push((self.module.clone(), path));
        }
    }

    /// A macro's arguments are words: paths among them are names between double colons.
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
        let mut module = Module::default();
        module.import(&import.tree, &mut ModulePath::new());
        let here = |path| (self.module.clone(), path);
        let names = module.imports.into_values().map(here);
        let globs = module.globs.into_iter().map(here);
        let (names, globs): (Vec<_>, Vec<_>) = (names.collect(), globs.collect());
        self.found.extend(names);
        self.globs.extend(globs);
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

/// Whether a path that begins so stays in the crate.
fn is_own(first: &str) -> bool {
    ["crate", "self", "super"].contains(&first)
}

/// What a path names.
enum Place {
    /// An item that this file defines.
    Item(String),
    /// A module of this file.
    Module(String),
}

/// What a path names, seen from a module; nothing if that is another crate's.
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

/// The same of a path that begins in this module.
fn below(of: &Crate, module: &[String], path: &[String], ways: usize) -> Option<Place> {
    let here = of.modules.get(module)?;
    let Some((first, rest)) = path.split_first() else {
        return Some(Place::Module(here.file.clone()));
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
        // Another crate's name that is passed on belongs to the file that does so.
        return leads_to(of, module, &[way, rest].concat(), ways).or_else(|| Some(item()));
    }
    let by_glob = here.globs.iter().find_map(|glob| {
        let way = [glob, path].concat();
        leads_to(of, module, &way, ways)
    });
    by_glob.or_else(|| here.calls_macros.then(item))
}
