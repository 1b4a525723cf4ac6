//! Finds cycles in a graph.

use crate::import::Graph;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// A shortest cycle through each group of files that reach each other. It leads from a file back to
/// itself.
pub(crate) fn shortest(graph: &Graph) -> Vec<Vec<&str>> {
    let mut told = BTreeSet::new();
    let mut cycles = Vec::new();
    for file in graph.keys() {
        if told.contains(file.as_str()) {
            continue;
        }
        if let Some(cycle) = from(graph, file) {
            told.extend(cycle.iter().copied());
            cycles.push(cycle);
        }
    }
    cycles
}

/// A shortest path from a file back to itself.
fn from<'a>(graph: &'a Graph, start: &'a str) -> Option<Vec<&'a str>> {
    let mut before: BTreeMap<&str, &str> = BTreeMap::new();
    let mut waiting = VecDeque::from([start]);
    while let Some(file) = waiting.pop_front() {
        for next in &graph[file] {
            if next == start {
                let mut way = vec![start, file];
                while let Some(&file) = before.get(way[way.len() - 1]) {
                    way.push(file);
                }
                way.reverse();
                return Some(way);
            }
            if !before.contains_key(next.as_str()) {
                before.insert(next, file);
                waiting.push_back(next);
            }
        }
    }
    None
}
