//! Adds up what a product costs, from the figures that `cargo xtask bench` measured in QEMU.

use crate::firmware::{Precision, budgets};
use anyhow::{Context as _, Result, bail};
use clap::{Args, ValueEnum};
use comfy_table::{CellAlignment, Table, presets};
use serde_json::Value;

/// What a product is made of.
#[derive(Args, Clone, Debug)]
pub struct Product {
    /// Number of axes.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=12))]
    pub axes: u32,
    /// Samples of each axis per second.
    #[arg(long, value_name = "HZ", default_value_t = 1000.0, value_parser = positive)]
    pub rate: f64,
    /// Octaves of averaging time.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(2..=30))]
    pub octaves: u32,
    /// Blocks of a segment of the spectrum; 0 for no spectrum.
    #[arg(long, value_name = "BLOCKS", default_value = "64", value_parser = ["0", "32", "64", "128", "256"])]
    pub spectrum: String,
    /// Covariates, such as a temperature, that are sampled with the axes.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(0..=8))]
    pub covariates: u32,
    /// Keep every sample, spikes and motion included.
    #[arg(long)]
    pub no_gate: bool,
    /// Keep no fourth moments, which tell telegraph noise from Gauss–Markov noise.
    #[arg(long)]
    pub no_moments: bool,
    /// Keep the course over time, which tells when something happened.
    #[arg(long)]
    pub course: bool,
    /// Slots of the queue between the interrupt and the main loop.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(2..=65536))]
    pub queue: u32,
    /// Core of the microcontroller.
    #[arg(long, value_enum, default_value_t = CoreName::M4f)]
    pub core: CoreName,
    /// Instructions per second, in millions. A core takes a cycle or more for each.
    #[arg(long, value_name = "MILLION", default_value_t = 64.0, value_parser = positive)]
    pub mips: f64,
    /// Compute in double precision.
    #[arg(long)]
    pub double: bool,
    /// RAM of the microcontroller in KiB, to say whether the product fits.
    #[arg(long, value_name = "KIB", value_parser = positive)]
    pub ram: Option<f64>,
    /// Flash of the microcontroller in KiB, to say whether the product fits.
    #[arg(long, value_name = "KIB", value_parser = positive)]
    pub flash: Option<f64>,
}

/// A core for which all parts are measured.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum CoreName {
    /// Arm Cortex-M3.
    M3,
    /// Arm Cortex-M4 without a floating-point unit.
    M4,
    /// Arm Cortex-M4 with a floating-point unit.
    M4f,
    /// Arm Cortex-M7.
    M7,
    /// Arm Cortex-M33.
    M33,
    /// RISC-V RV32IMC.
    Rv32,
}

impl CoreName {
    /// The name of the core in the budgets.
    fn name(self) -> &'static str {
        match self {
            Self::M3 => "Cortex-M3",
            Self::M4 => "Cortex-M4",
            Self::M4f => "Cortex-M4F",
            Self::M7 => "Cortex-M7",
            Self::M33 => "Cortex-M33",
            Self::Rv32 => "RISC-V RV32IMC",
        }
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "not a number above zero".into())
}

/// What a product costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Instructions of a sample of all axes in the interrupt that hands it over, without the read from the sensor.
    pub interrupt: f64,
    /// Instructions of a sample of all axes in the main loop.
    pub main_loop: f64,
    /// The share of the instructions per second that the samples take.
    pub load: f64,
    /// RAM of the record in bytes.
    pub record: f64,
    /// RAM of the queue in bytes.
    pub queue: f64,
    /// Stack of a diagnosis in bytes, the diagnosis itself included.
    pub stack: f64,
    /// Flash of the whole library in bytes, without the explanations of effects. Programs that use a part take less.
    pub flash: f64,
    /// Flash of the explanations of effects in bytes.
    pub explanations: f64,
    /// Instructions of a diagnosis, with one hidden effect.
    pub diagnosis: f64,
    /// The longest time in seconds in which a diagnosis does not return.
    pub stretch_s: f64,
    /// The samples that arrive in that time.
    pub waiting: f64,
}

/// The bins of a spectrum for each block of a segment, with five levels: those of a record of up to 17 million samples.
const BINS_PER_BLOCK: f64 = 5.0 * 7.0 / 16.0;
/// The bins of the diagnosis that was measured.
const MEASURED_BINS: f64 = 112.0;

impl Product {
    /// The blocks of a segment of the spectrum; 0 for none.
    fn blocks(&self) -> f64 {
        self.spectrum.parse().unwrap_or(0.0)
    }

    /// Adds up the cost by the measured figures.
    ///
    /// # Errors
    /// Fails if a figure is missing.
    pub fn cost(&self, budgets: &Value) -> Result<Cost> {
        let precision = if self.double {
            Precision::Double
        } else {
            Precision::Single
        };
        let cores = budgets["cores"].as_array().context("no cores")?;
        let mut cores = cores.iter();
        let core = cores
            .find(|core| core["core"] == self.core.name() && core["precision"] == precision.name());
        let core = Figures(core.context("the core was not measured")?);
        let m4f = Figures(&budgets[budgets::target(precision)]);
        let (axes, octaves) = (f64::from(self.axes), f64::from(self.octaves));
        let between_axes = |one: f64, three: f64| one + (three - one) * (axes - 1.0) / 2.0;
        let instructions = |part: &str| -> Result<f64> {
            let of = |axes| core.part(part, &format!("instructions_{axes}"));
            Ok(between_axes(of(1)?, of(3)?))
        };
        let bytes = |part: &str| -> Result<f64> {
            let of = |axes| -> Result<f64> {
                let of = |octaves| core.part(part, &format!("bytes_{axes}_{octaves}"));
                Ok(of(10)? + (of(30)? - of(10)?) * (octaves - 10.0) / 20.0)
            };
            Ok(between_axes(of(1)?, of(3)?))
        };
        let spectrum = format!("spectrum_{}", self.spectrum);
        let parts = [
            (f64::from(u8::from(!self.no_gate)), "gate"),
            (f64::from(u8::from(!self.no_moments)), "moments"),
            (f64::from(u8::from(self.course)), "course"),
            (f64::from(self.covariates), "covariate"),
            (f64::from(u8::from(self.blocks() > 0.0)), &*spectrum),
        ];
        let (bare_instructions, bare_bytes) = (instructions("bare")?, bytes("bare")?);
        let (mut main_loop, mut record) = (bare_instructions, bare_bytes);
        for (times, part) in parts.into_iter().filter(|(times, _)| *times > 0.0) {
            main_loop += times * (instructions(part)? - bare_instructions);
            record += times * (bytes(part)? - bare_bytes);
        }
        main_loop += instructions("receive")?;
        let interrupt = instructions("send")?;
        let slot = |axes| core.part("slot", &format!("bytes_{axes}"));
        let slot = between_axes(slot(1)?, slot(3)?) + 4.0 * (f64::from(self.covariates) - 1.0);
        let per_s = 1e6 * self.mips;
        let load = (interrupt + main_loop) * self.rate / per_s;

        // What was measured on a Cortex-M4F only is scaled by what was measured on both.
        let of_m4f = |figure: &str, like: &str, there: &str| -> Result<f64> {
            Ok(m4f.of(figure)? * core.of(like)? / m4f.of(there)?)
        };
        let with_spectrum = self.blocks() > 0.0;
        let bins = self.blocks() * BINS_PER_BLOCK;
        let deep = m4f.of("stack_of_diagnosis_30")? - m4f.of("stack_bytes_diagnosis_20")?;
        let beside =
            m4f.of("stack_of_diagnosis_with_spectrum")? - m4f.of("stack_bytes_diagnosis_20")?;
        let stack = core.of("stack_bytes")?
            + deep * (octaves - 20.0) / 10.0
            + beside * bins / MEASURED_BINS;
        let (diagnosis, stretch) = if with_spectrum {
            (
                "instructions_of_diagnosis_with_spectrum",
                "instructions_stretch_diagnosis_with_spectrum",
            )
        } else {
            (
                "instructions_diagnosis_20",
                "instructions_stretch_diagnosis_20",
            )
        };
        let like = ("instructions_diagnosis", "instructions_diagnosis_20");
        let diagnosis = of_m4f(diagnosis, like.0, like.1)?;
        let stretch = of_m4f(stretch, like.0, like.1)?;
        let interrupts = interrupt * self.rate / per_s;
        let stretch_s = stretch / per_s / (1.0 - interrupts).max(1e-3);
        let like = ("flash_bytes", "flash_bytes_with_fit");
        let flash = of_m4f("flash_bytes_with_everything", like.0, like.1)?;
        let explanations =
            m4f.of("flash_bytes_with_explanations")? - m4f.of("flash_bytes_with_diagnosis")?;
        Ok(Cost {
            interrupt,
            main_loop,
            load,
            record,
            queue: slot * f64::from(self.queue),
            stack,
            flash,
            explanations,
            diagnosis,
            stretch_s,
            waiting: stretch_s * self.rate,
        })
    }

    /// Why the product does not fit; nothing if it does.
    fn complaints(&self, cost: &Cost) -> Vec<String> {
        let mut complaints = Vec::new();
        if cost.load >= 1.0 {
            complaints.push(format!(
                "the samples take {:.0} % of all instructions: lower the rate or leave parts out",
                100.0 * cost.load
            ));
        }
        // One slot of the queue always stays free.
        let room = f64::from(self.queue - 1);
        if cost.waiting > room {
            complaints.push(format!(
                "the queue overflows while a diagnosis works: it needs {:.0} slots, or the samples need a task above the \
                 diagnosis",
                cost.waiting.ceil() + 1.0
            ));
        }
        let ram = cost.record + cost.queue + cost.stack;
        let flash = cost.flash + cost.explanations;
        for (name, limit, needed) in [("RAM", self.ram, ram), ("flash", self.flash, flash)] {
            if let Some(limit) = limit.filter(|limit| needed > 1024.0 * limit) {
                complaints.push(format!(
                    "{name}: {:.1} KiB are needed, {limit} KiB are there",
                    needed / 1024.0
                ));
            }
        }
        complaints
    }
}

/// A core's figures.
struct Figures<'a>(&'a Value);

impl Figures<'_> {
    fn of(&self, name: &str) -> Result<f64> {
        let value = self.0[name].as_f64();
        value.with_context(|| format!("{name} was not measured"))
    }

    fn part(&self, part: &str, figure: &str) -> Result<f64> {
        let value = self.0["parts"][part][figure].as_f64();
        value.with_context(|| format!("{figure} of {part} was not measured"))
    }
}

/// The table of what a product costs.
///
/// # Errors
/// Fails if a figure is missing.
pub fn table(product: &Product, budgets: &Value) -> Result<String> {
    let cost = product.cost(budgets)?;
    let kib = |bytes: f64| format!("{:.1} KiB", bytes / 1024.0);
    let instructions = |count: f64| format!("{count:.0} instructions");
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for (what, figure) in [
        (
            "interrupt, a sample of all axes",
            instructions(cost.interrupt),
        ),
        (
            "main loop, a sample of all axes",
            instructions(cost.main_loop),
        ),
        ("load by the samples", format!("{:.1} %", 100.0 * cost.load)),
        ("RAM of the record", kib(cost.record)),
        ("RAM of the queue", kib(cost.queue)),
        ("stack of a diagnosis", kib(cost.stack)),
        ("RAM together", kib(cost.record + cost.queue + cost.stack)),
        ("flash of the whole library", kib(cost.flash)),
        (
            "the same with explanations",
            kib(cost.flash + cost.explanations),
        ),
        (
            "a diagnosis",
            format!("{:.0} million instructions", cost.diagnosis / 1e6),
        ),
        (
            "the longest piece of it",
            format!(
                "{:.1} ms, {:.0} samples",
                1e3 * cost.stretch_s,
                cost.waiting.ceil()
            ),
        ),
    ] {
        table.add_row([what, &figure]);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    if let Some(column) = table.column_mut(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    Ok(table.trim_fmt())
}

pub(crate) fn run(product: &Product) -> Result<()> {
    let budgets = budgets::committed()?;
    println!(
        "{} axes at {} Hz on a {} with {} million instructions a second",
        product.axes,
        product.rate,
        product.core.name(),
        product.mips
    );
    println!("\n{}\n", table(product, &budgets)?);
    let complaints = product.complaints(&product.cost(&budgets)?);
    if !complaints.is_empty() {
        bail!("it does not fit\n  {}", complaints.join("\n  "));
    }
    println!("it fits");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(spectrum: &str, course: bool) -> Product {
        Product {
            axes: 3,
            rate: 8000.0,
            octaves: 20,
            spectrum: spectrum.into(),
            covariates: 1,
            no_gate: false,
            no_moments: false,
            course,
            queue: 32,
            core: CoreName::M4f,
            mips: 64.0,
            double: false,
            ram: None,
            flash: None,
        }
    }

    fn assert_near(found: f64, measured: &Value) {
        let measured = measured.as_f64().unwrap();
        assert!(
            (found / measured - 1.0).abs() < 0.05,
            "{found}, measured {measured}"
        );
    }

    #[test]
    fn sums_of_parts_are_near_what_was_measured_together() {
        let budgets = budgets::committed().unwrap();
        let target = &budgets["target"];
        for (spectrum, course, name) in [
            ("0", false, ""),
            ("64", false, "_with_spectrum"),
            ("64", true, "_with_spectrum_and_course"),
        ] {
            let cost = product(spectrum, course).cost(&budgets).unwrap();
            let receive = budgets["cores"][3]["parts"]["receive"]["instructions_3"].as_f64();
            let together = &target[format!("instructions_per_sample_three_axes{name}")];
            assert_near(cost.main_loop - receive.unwrap(), together);
        }
        let record = product("0", false).cost(&budgets).unwrap().record;
        assert_near(
            record / 3.0,
            &target["ram_bytes_per_axis_20_with_all_parts"],
        );
    }

    #[test]
    fn what_does_not_fit_is_told_with_its_remedy() {
        let budgets = budgets::committed().unwrap();
        let mut big = product("64", true);
        (big.ram, big.flash) = (Some(32.0), Some(64.0));
        let complaints = big.complaints(&big.cost(&budgets).unwrap());
        let begins = |start: &str| complaints.iter().any(|line| line.starts_with(start));
        assert!(begins("RAM: ") && begins("flash: ") && begins("the queue overflows"));
        assert!(!begins("the samples take"));
        big.rate = 1e6;
        let complaints = big.complaints(&big.cost(&budgets).unwrap());
        assert!(
            complaints[0].starts_with("the samples take"),
            "{complaints:?}"
        );
    }

    #[test]
    fn less_costs_less() {
        let budgets = budgets::committed().unwrap();
        let all = product("64", true).cost(&budgets).unwrap();
        let mut little = product("0", false);
        (little.no_gate, little.no_moments, little.covariates) = (true, true, 0);
        (little.axes, little.octaves) = (1, 12);
        let little = little.cost(&budgets).unwrap();
        assert!(little.main_loop < 0.2 * all.main_loop && little.record < 0.1 * all.record);
        assert!(little.interrupt < all.interrupt && little.stack < all.stack);
    }
}
