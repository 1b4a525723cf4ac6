#!/usr/bin/env bash
# One would guess: a formula means what it means in mathematics, all the more as the manual of fasteval lists powers as what binds
# first. `exp`-like bells such as e()^(-f^2/2) fall to both sides, and what is compiled gives what is interpreted.
# What happens: the sign binds before the power, -f^2 is (-f)^2, so that the bell grows: 7.39 instead of 0.135 at f = 2. Beside
# that, a formula changes when it is compiled: 0/0 becomes 1, and constants are multiplied with each other first, so that
# f*1e200*1e200*1e-300 is infinite where the interpreter says 2e100. No error is returned.
# Versions: fasteval 0.2.4, and fasteval3 3.0.1, which goes on from it.
# Why it matters: a noise density or a covariance as a formula is the usual way to add an effect to a model. A Gaussian correlation
# becomes one that no noise has, and the fit that follows is of that.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
cargo init -q --vcs none --name probe .
cargo add -q fasteval@=0.2.4 fasteval3@=3.0.1
cat >src/main.rs <<'RUST'
use std::collections::BTreeMap;

fn interpreted(formula: &str, f: f64) -> [f64; 2] {
    let mut names = BTreeMap::from([("f".to_owned(), f)]);
    [fasteval::ez_eval(formula, &mut names).unwrap(), fasteval3::ez_eval(formula, &mut names).unwrap()]
}

fn compiled(formula: &str, f: f64) -> [f64; 2] {
    let mut names = BTreeMap::from([("f".to_owned(), f)]);
    let old = {
        use fasteval::{Compiler, Evaler, Parser, Slab};
        let mut slab = Slab::new();
        let read = Parser::new().parse(formula, &mut slab.ps).unwrap();
        let compiled = read.from(&slab.ps).compile(&slab.ps, &mut slab.cs);
        compiled.eval(&slab, &mut names).unwrap()
    };
    let new = {
        use fasteval3::{Compiler, EmptyNamespace, Evaler, Parser, Slab};
        let mut slab = Slab::new();
        let read = Parser::new().parse(formula, &mut slab.ps).unwrap();
        let compiled = read.from(&slab.ps).compile(&slab.ps, &mut slab.cs, &mut EmptyNamespace);
        compiled.eval(&slab, &mut names).unwrap()
    };
    [old, new]
}

fn main() {
    let bell = "e()^(-f^2/2)";
    let [old, new] = interpreted(bell, 2.0);
    println!("guess: a bell falls: {bell} at 2 is 0.135; fasteval {old:.3}, fasteval3 {new:.3}");
    assert!(old > 7.0 && new > 7.0, "the bell falls now");
    let [zeros, product] = ["0/0", "f*1e200*1e200*1e-300"].map(|formula| (interpreted(formula, 2e0), compiled(formula, 2e0)));
    println!("guess: compiled as interpreted: 0/0 is {:?}, compiled {:?}", zeros.0, zeros.1);
    println!("guess: compiled as interpreted: f*1e200*1e200*1e-300 is {:?}, compiled {:?}", product.0, product.1);
    assert!(zeros.0.iter().all(|x| x.is_nan()) && zeros.1 == [1.0; 2], "0/0 is no number now");
    assert!(product.0.iter().all(|x| x.is_infinite() || *x < 1e101));
    println!("SURPRISE: a formula of a bell grows from 1 to {old:.2} at f = 2, and 0/0 is 1 once it is compiled");
}
RUST
cargo run -q --release
