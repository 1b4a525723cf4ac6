//! The examples below the help of every command. A test parses each of them.

macro_rules! examples {
    ($($line:literal)+) => {
        concat!(
            "Examples:\n",
            $("  ", $line, "\n",)+
            "\nExit status: 0 on success; 2 for bad input, with one line on standard error for each."
        )
    };
}

pub(super) const SIMULATE: &str = examples! {
    "allanite simulate mems --duration 1h --axes 3 --output log.csv"
    "allanite simulate vg951 --rate 2.5 --duration 12h --output log.npy"
    "allanite simulate mems --effect sinusoid:frequency_hz=7.7,amplitude=0.02 --output log.npy"
};

pub(super) const MEASURE: &str = examples! {
    "allanite measure log.csv --output curve.json"
    "allanite measure log1.csv log2.csv.gz --rate 100 --scale 0.05 --output curves"
};

pub(super) const MERGE: &str = examples! {
    "allanite merge monday.json tuesday.json --output week.json"
    "allanite merge january.json february.json march.json --output year.json"
};

pub(super) const FIT: &str = examples! {
    "allanite fit log.csv --rate 100 --scale 0.05 --unit deg/s --columns gx,gy,gz"
    "allanite fit log1.csv log2.csv curve.json"
    "allanite fit --json-lines log1.csv log2.csv"
    "allanite fit curve.json --limit N=0.33°/√h --limit B=58°/h"
};

pub(super) const EXPORT: &str = examples! {
    "allanite export curve.json --format kalibr --output imu.yaml"
    "allanite export log.csv --rate 200 --format json --output model.json"
    "allanite export log.csv --rate 200 --format vins-fusion --with sinusoid --despite-unexplained"
    "allanite export log.csv --rate 200 --format px4 --overbound --output gyro.params"
    "allanite export curve.json --format c --name bmi160 --output noise.h"
};

pub(super) const COMPARE: &str = examples! {
    "allanite compare curve.json"
    "allanite compare log.csv --with sinusoid:frequency_hz=19.3 --without rate_ramp"
    "allanite compare log.csv --with low_pass:poles=2"
    "allanite compare log.csv --hold-out 0.5"
};

pub(super) const EXPLORE: &str = examples! {
    "allanite explore curve.json"
    "allanite explore before.csv after.csv --rate 100 --scale 0.05 --unit deg/s --output effects.html"
};

pub(super) const DIAGNOSE: &str = examples! {
    "allanite diagnose curve.json"
    "allanite diagnose log.csv --covariates temp_C,rate(temp_C)"
};

pub(super) const REPORT: &str = examples! {
    "allanite report curve.json --output report.html"
    "allanite report log.csv --rate 100 --scale 0.05 --unit deg/s --output report.html"
};

pub(super) const PLOT: &str = examples! {
    "allanite plot curve.json --axis gz --output curve.svg"
    "allanite plot log.csv --step 0 --output five-terms.png"
    "allanite plot log.csv --what rate,spectrum --output gyro.svg"
};

pub(super) const CERTIFY: &str = examples! {
    "allanite certify log.csv --rate 100 --scale 0.05 --device SN-0042 --output SN-0042.bin"
    "allanite certify SN-0001.csv SN-0002.json --temperature 22.5..24 --output certificates"
};

pub(super) const DECODE: &str = examples! {
    "allanite decode device1.bin device2.bin"
    "allanite decode --json snapshot.bin"
};

pub(super) const LOT: &str = examples! {
    "allanite lot --limit N=0.005 --limit B=10°/h device1.bin device2.bin"
    "allanite lot --limit N=0.3°/√h --risk 0.01 now --earlier before --json"
    "allanite lot --limit N=0.3°/√h logs SN-0042.json --output lot.csv --output lot.html"
};

pub(super) const WATCH: &str = examples! {
    "allanite watch --rate 100 --scale 0.00763 --axes gx,gy,gz --port /dev/ttyACM0 --output curve.json"
    "allanite watch --rate 100 --unit rad/s --print-every 60"
};

pub(super) const SCHEMA: &str = examples! {
    "allanite schema fit"
    "allanite schema lot"
};

pub(super) const COMPLETIONS: &str = examples! {
    "allanite completions bash"
    "allanite completions zsh"
};
