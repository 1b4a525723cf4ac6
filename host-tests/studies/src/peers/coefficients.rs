//! The errors of the coefficients that a peer estimates, and what it says, beside ours.

use super::{
    bootstrap::{bootstrap, mean, median, rms},
    environment::{Environment, Peer},
    record,
};
use crate::{hidden_effect::diagnose_with, theory::squares};
use allanite::{Model, diagnosis, fit};
use allanite_host::simulate::{Hidden, Preset};
use anyhow::Result;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// The number of samples of a record, 2.9 hours: the longest cluster time that two of the peers take by default is
/// 1000 s.
pub const SAMPLES: u64 = 1 << 20;

/// The coefficients of one record, by name.
type Found = BTreeMap<String, f64>;

/// The errors of one coefficient by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Its name: the symbol, and what else a peer calls it.
    pub coefficient: String,
    /// The number of records with an estimate.
    pub records: usize,
    /// The mean error relative to the truth, with its bootstrap error.
    pub bias: [f64; 2],
    /// The root-mean-square error relative to the truth, with its bootstrap error.
    pub rms: [f64; 2],
    /// `rms` divided by ours on the same records, with its bootstrap error.
    pub ratio: [f64; 2],
}

/// The records of one gyro and one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Method {
    /// The program.
    pub program: &'static str,
    /// Its coefficients.
    pub errors: Vec<Errors>,
    /// What it says, and of how many records.
    pub notes: BTreeMap<String, usize>,
}

/// The records of one gyro.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gyro {
    /// The preset.
    pub preset: String,
    /// The hidden effect.
    pub hidden: Option<&'static str>,
    /// The seeds of the records, from the first one to the last one.
    pub seeds: [u64; 2],
    /// Ours and the peers'.
    pub methods: Vec<Method>,
    /// Medians over the records of ours divided by what a user of allan_variance_ros has, with bootstrap errors.
    pub familiar: Vec<(&'static str, [f64; 2])>,
}

/// The names of ours and of theirs that a user of allan_variance_ros compares.
const FAMILIAR: [(&str, &str, &str); 4] = [
    ("N / line from 0.1 to 10 s", "N", "N"),
    ("N / line from 0.1 to 1 s", "N", "N to 1 s"),
    ("B / minimum", "B", "B"),
    ("B / (minimum / 0.664)", "B", "B / 0.664"),
];

/// The port of allan_variance_ros among the peers.
const PORT: &str = "allan-variance-analyzer";

/// Estimates the coefficients of records of a gyro with every program.
pub fn gyro(
    environment: &Environment,
    folder: &Path,
    preset: Preset,
    hidden: Option<Hidden>,
    records: u64,
) -> Result<Gyro> {
    let gyro = preset.coefficients();
    let seeds: Vec<u64> = (1..=records).collect();
    let paths: Vec<PathBuf> = seeds
        .iter()
        .map(|seed| folder.join(format!("{seed}.npy")))
        .collect();
    let ours: Vec<(Found, Vec<String>)> = seeds
        .par_iter()
        .zip(&paths)
        .map(|(&seed, path)| -> Result<_> {
            let curve = record::write(path, gyro, hidden.as_slice(), [SAMPLES, seed], |_| ())?;
            if hidden.is_some() {
                return Ok(diagnosed(preset, hidden.as_slice(), seed));
            }
            let fit = fit::fit(&curve, &Model::ieee_952(), fit::Options::default());
            let words = fit.as_ref().map_or("no fit", |fit| said(fit.is_adequate()));
            let found = fit.iter().flat_map(|fit| {
                named(&fit.coefficients.iter().map(|c| c.value).collect::<Vec<_>>())
            });
            Ok((found.collect(), vec![words.to_owned()]))
        })
        .collect::<Result<_>>()?;
    let peers: Vec<&Peer> = environment.peers.iter().filter(|peer| peer.fits).collect();
    let scale = record::scale(gyro);
    let theirs: Vec<Vec<(Found, Vec<String>)>> = peers
        .par_iter()
        .map(|peer| {
            let (lines, _) = environment.run(peer, "fit", scale, &paths)?;
            Ok(lines.iter().map(read).collect())
        })
        .collect::<Result<_>>()?;
    for path in &paths {
        fs::remove_file(path)?;
    }
    let truth = squares(gyro).map(f64::sqrt);
    let mut methods = vec![method("allanite", &ours, &ours, truth)];
    methods.extend(
        peers
            .iter()
            .zip(&theirs)
            .map(|(peer, found)| method(peer.name, found, &ours, truth)),
    );
    let port = peers.iter().position(|peer| peer.name == PORT);
    let familiar = port.into_iter().flat_map(|at| {
        let ratio = |(name, own, other): (&'static str, &str, &str)| {
            let pairs = ours.iter().zip(&theirs[at]);
            let ratios: Vec<f64> = pairs
                .filter_map(|(ours, theirs)| Some(ours.0.get(own)? / theirs.0.get(other)?))
                .collect();
            (name, bootstrap(&ratios, median))
        };
        FAMILIAR.map(ratio)
    });
    Ok(Gyro {
        preset: format!("{preset:?}").to_lowercase(),
        hidden: hidden.map(|hidden| hidden.effect.name()),
        seeds: [1, records],
        familiar: familiar.collect(),
        methods,
    })
}

/// The coefficients by their symbols, from those in the order of the five terms.
fn named(values: &[f64]) -> Found {
    let symbols = ["Q", "N", "B", "K", "R"].map(str::to_owned);
    symbols.into_iter().zip(values.iter().copied()).collect()
}

/// Our diagnosis of the record of a seed, with its spectrum.
fn diagnosed(preset: Preset, hidden: &[Hidden], seed: u64) -> (Found, Vec<String>) {
    let options = diagnosis::Options::default();
    let outcome = diagnose_with(
        preset.coefficients(),
        hidden,
        SAMPLES as usize,
        seed,
        options,
    );
    let mut found = Found::new();
    for (term, coefficient) in outcome.model.terms().iter().zip(&outcome.fit.coefficients) {
        let filter = hidden
            .iter()
            .any(|one| one.replaces_white_noise() && one.effect.name() == term.effect.name());
        let symbol = match term.effect.name() {
            "angle_random_walk" => "N",
            _ if filter => "N",
            "bias_instability" => "B",
            "rate_random_walk" => "K",
            _ => continue,
        };
        found.insert(symbol.to_owned(), coefficient.value);
    }
    let names: Vec<&str> = outcome
        .added
        .iter()
        .map(|(term, _)| term.effect.name())
        .collect();
    let words = match names[..] {
        [] => "nothing is missing".to_owned(),
        _ => names.join(" and "),
    };
    (found, vec![words])
}

/// What a fit says of the five terms.
fn said(adequate: Option<bool>) -> &'static str {
    match adequate {
        Some(true) => "the five terms explain the curve",
        Some(false) => "the five terms do not explain the curve",
        None => "the five terms are not judged",
    }
}

/// The coefficients and the words that a peer prints.
fn read(line: &Value) -> (Found, Vec<String>) {
    let fields = line.as_object().into_iter().flatten();
    let numbers = fields.filter_map(|(name, value)| Some((name.clone(), value.as_f64()?)));
    let notes = line["notes"].as_array().into_iter().flatten();
    let mut notes: Vec<String> = notes
        .filter_map(|note| Some(note.as_str()?.to_owned()))
        .collect();
    notes.iter_mut().for_each(|note| {
        // Numbers would make every note another one.
        *note = note.split(" (").next().unwrap_or_default().to_owned();
    });
    (numbers.collect(), notes)
}

fn method(
    program: &'static str,
    found: &[(Found, Vec<String>)],
    ours: &[(Found, Vec<String>)],
    truth: [f64; 5],
) -> Method {
    let true_values = named(&truth);
    let names = found.iter().flat_map(|(found, _)| found.keys());
    let names: std::collections::BTreeSet<&String> = names.collect();
    let errors = names.into_iter().filter_map(|name| {
        let symbol = name.get(..1)?;
        let truth = *true_values.get(symbol).filter(|truth| **truth > 0.0)?;
        let pairs: Vec<[f64; 2]> = found
            .iter()
            .zip(ours)
            .filter_map(|((found, _), (ours, _))| {
                let error = |value: f64| value / truth - 1.0;
                Some([
                    error(*found.get(name)?),
                    ours.get(symbol).copied().map_or(f64::NAN, error),
                ])
            })
            .collect();
        let theirs: Vec<f64> = pairs.iter().map(|pair| pair[0]).collect();
        let ratio = |pairs: &[[f64; 2]]| {
            let both = pairs.iter().filter(|pair| !pair[1].is_nan());
            let [theirs, ours]: [Vec<f64>; 2] =
                [0, 1].map(|i| both.clone().map(|pair| pair[i]).collect());
            rms(&theirs) / rms(&ours)
        };
        Some(Errors {
            coefficient: name.clone(),
            records: theirs.len(),
            bias: bootstrap(&theirs, mean),
            rms: bootstrap(&theirs, rms),
            ratio: bootstrap(&pairs, ratio),
        })
    });
    let mut notes = BTreeMap::new();
    for note in found.iter().flat_map(|(_, notes)| notes) {
        *notes.entry(note.clone()).or_default() += 1;
    }
    Method {
        program,
        errors: errors.collect(),
        notes,
    }
}
