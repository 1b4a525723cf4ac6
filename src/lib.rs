//! Noise coefficients of a gyro, computed on its own microcontroller: from raw counts to the overlapping Allan
//! deviation (NIST SP 1065) and the power spectral density (PSD, Welch), to a fit of the terms of IEEE Std 952 with
//! confidence intervals, and to the effect that is missing where these terms do not explain the record.
//!
//! A data sheet's angle random walk (ARW) or rate noise density is the coefficient N, and its in-run bias stability is
//! the minimum of the Allan deviation, 0.664 B where bias instability dominates it. Of an accelerometer, N is the
//! velocity random walk (VRW).
//!
//! # Example
//!
//! ```
//! use allanite::{Axis, Model, Scale, fit::{Options, State, fit}};
//!
//! // One axis of 20 octaves: averaging times from one sample to 2^19 samples.
//! let mut gyro = Axis::<20>::new();
//! # let mut random = 1_u32;
//! # let mut read_gyro = || {
//! #     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
//! #     (random >> 24) as i32
//! # };
//! for _ in 0..100_000 {
//!     gyro.push(read_gyro()); // counts of the driver, in integers only
//! }
//!
//! // 131 counts per °/s, 100 samples per second.
//! let record = gyro.record(0, Scale::new(1.0 / 131.0, 100.0)?)?;
//! assert_eq!(record.invalid, None); // the gyro was at rest, and its counts are not stuck
//! let fit = fit(&record, &Model::ieee_952(), Options::default())?;
//! let white = &fit.coefficients[1];
//! assert_eq!((white.name, white.state), ("angle_random_walk", State::Measured));
//! assert!(white.lower < white.value && white.value < white.upper); // 95 %, in °/s/√Hz
//! assert_eq!(fit.is_adequate(), Some(true)); // the five terms explain this record
//! # Ok::<(), allanite::Error>(())
//! ```
//!
//! # Main types
//!
//! * [`Axes`] keeps everything of a record of three axes behind one `push`, and [`Axis`] does so for one axis.
//!   [`Accumulator`] is the least that makes a curve.
//! * [`spectrum::Spectrum`] is the one-sided power spectral density (PSD) of the same record by Welch's method. It
//!   distinguishes a line from a resonance and from a filter. A diagnosis uses both.
//! * [`Curve`] is the Allan curve: at most 30 points, an octave apart. Nothing behind it needs a sample again.
//! * [`Record`] holds all that is stored of one axis: the curve, the spectrum, the course (block history) and other sums.
//! * [`Model`] is a list of effects, such as the five terms of IEEE Std 952.
//! * [`fit::fit`] fits a model to a curve in one call. [`fit::Fitting`] does the same in pieces, for a main loop
//!   that has to feed a watchdog.
//! * [`ieee_952::fit`] fits the five terms of IEEE Std 952 alone, in a third of the flash and a tenth of the time.
//! * [`Comparison`] says where the model fails, octave by octave and in words.
//! * [`diagnosis::Diagnosis`] finds the effects that are missing, and calls a pause between two pieces of work.
//! * [`detection::Detection`] says from which size on a record would have shown an effect.
//! * [`self_test::SelfTest`] compares coefficients with limits, and decides as soon as the record allows it.
//! * [`effect::Effect`] is a physical effect. [`effect::CATALOGUE`] lists the known ones, and
//!   [one of your own](#an-effect-of-your-own) joins them.
//!
//! # The way of the data
//!
//! ```text
//! counts (i32) ─► octave accumulator ─► Allan curve ─► fit(model) ─► comparison ─► diagnosis
//!  gap(), merge()    integers only       ≤ 30 points    covariance     z, χ², p      what is missing
//!       │                                                   ▲
//!       └────────► spectrum (optional) ─► densities ─────────┘
//! ```
//!
//! | module | what it does |
//! |---|---|
//! | [`sensor`] | reads an IMU on SPI or I²C through embedded-hal 1.0: 14 sensors are described, 5 of them with their FIFO |
//! | [`queue`] | hands samples from an interrupt to the main loop, and loses none silently |
//! | [`axis`] | rejects stuck or saturated samples (at a rail), spikes and motion, and records all others |
//! | [`octave`] | is the accumulator: overlapping differences of adjacent clusters, a quarter apart, exact in 158 bits |
//! | [`spectrum`] | measures power spectral densities, and computes those of each effect |
//! | [`integrity`] | decides whether the record is one of a gyro at rest; `Screen` does so in 2 KB of flash |
//! | [`motion`] | recognises a gyro that was held, carried or swung for the whole record |
//! | [`faults`] | detects faults of the logger: repeated samples, stuck values, saturation (clipping), a dead band |
//! | [`kurtosis`], [`covariate`] | detect jumps of the rate, and its dependence on a temperature, with its lag |
//! | [`course`] | finds changes of the noise, bursts, steps and warm-ups in the block history |
//! | [`curve`] | holds τ, averaging factor, variance and number of differences of each octave |
//! | [`effect`], [`model`] | the components of a curve, one file for each effect, and lists of effects |
//! | [`fit`] | estimates the coefficients, with intervals and a goodness of fit |
//! | [`ieee_952`] | does so for the five terms alone, for small cores |
//! | [`comparison`] | compares model and measurement |
//! | [`diagnosis`] | looks for the missing effect |
//! | [`detection`] | computes limits of detection: the size from which an effect would have been found |
//! | [`self_test`] | gives a verdict against limits |
//! | [`storage`] | keeps what outlives the power, as checked bytes |
//!
//! Every effect is one function, the generalised covariance of the angle. Its Allan variance follows from this
//! function, and so does the covariance of the octaves, finite record and overlap included
//! ([`fit::curve_covariance`]); it takes the place of tables of equivalent degrees of freedom (EDF). The weights of the
//! fit, the intervals and χ² follow in turn. A coefficient is
//! *measured*, with a 95 % interval; or it has an *upper bound*; or it is *not observable*, and then the result
//! gives the length of the record that would measure it ([`fit::State`]).
//!
//! The method started from Lv, Liu, Lai & Huang, *Allan variance method for gyro noise analysis using weighted
//! least square algorithm*, Optik 2015, whose weighting is [`fit::Method::RelativeAccuracy`]. The default is
//! [`fit::Method::Covariance`].
//!
//! The folder `src/bin` of the repository holds programs to start from. `product.rs` does all that a product does: three axes and
//! a temperature, self-test, snapshot, diagnosis. `interrupt` hands samples from an interrupt to the main loop.
//! `hidden_effect.rs` names what is hidden in its gyro, and a test compares it with the host, to the bit.
//!
//! # Cost
//!
//! These are rounded figures of a Cortex-M4F in single precision, built for size. `cargo xtask bench` in the
//! repository measures them. It counts instructions in QEMU, not cycles. Its `host-tests/doc/firmware.md` has the
//! exact figures of 7 cores in both precisions.
//!
//! | what | about |
//! |---|---|
//! | a sample into an accumulator, any number of octaves | 144 instructions |
//! | RAM of an accumulator of 24 octaves | 2480 bytes |
//! | flash of accumulator, curve and the fit of the five terms alone | 14 000 bytes |
//! | that fit, of 20 octaves | 0.74 million instructions, 3 400 bytes of stack |
//! | flash of accumulator, curve and fit | 44 300 bytes |
//! | flash with the diagnosis and the whole catalogue | 131 700 bytes |
//! | a fit of 20 octaves | 16 million instructions |
//! | RAM of a spectrum, for an axis | 3928 bytes |
//! | a sample into a spectrum | 25 instructions in the interrupt, 215 in the main loop |
//! | flash with diagnosis and spectrum | 144 500 bytes |
//! | a diagnosis with a spectrum | 272 million instructions, 53 000 bytes of stack |
//!
//! A sample always takes a bounded number of instructions, whatever the input and however long the record. The
//! library does not allocate and has no `unsafe` code, and no input makes it panic. [`Axes`] names its own cost,
//! which is higher, because it keeps more.
//!
//! # Features
//!
//! No feature is on by default.
//!
//! | feature | what it adds |
//! |---|---|
//! | `async` | reads sensors through `embedded-hal-async` as well |
//! | `storage` | snapshots of a record and factory certificates, as checked bytes |
//! | `flash` | snapshots in any flash that implements `embedded-storage-async`; includes `storage` |
//! | `overlap` | intervals that count the samples which levels of a spectrum and octaves share; see [`fit`] |
//! | `defmt` | `defmt::Format` on public values; the library itself never logs |
//! | `double` | double precision instead of single, for final programs on a workstation only |
//!
//! The library computes in single precision unless the program asks for `double`. Single precision needs two
//! thirds of the flash. On a core that computes it in hardware, a fit takes a third of the time and a diagnosis a
//! fifth. The results agree to a thousandth of their standard errors. Of 4000 simulated gyros, 1000 with each of
//! three hidden effects and 1000 with none, 3999 get the same diagnosis as in double precision. The other one
//! gets the second of two effects that are called ambiguous (`cargo xtask study precision`).
//!
//! A library must not ask for `double`: it changes the type of public numbers for every other crate in the build.
//! Code that compiles in both precisions writes [`Real`].
//!
//! A core without atomic instructions, such as RV32IMC, needs [`portable-atomic`] for the [`queue`]. The program
//! turns on its feature `unsafe-assume-single-core` or `critical-section`.
//!
//! [`portable-atomic`]: https://docs.rs/portable-atomic
//!
//! # Samples were lost
//!
//! [`Axes::gap`] marks the place. No difference spans the gap, and everything before it stays. If the number of lost
//! samples is known, [`Axes::lost`] fills up to 64 of them with a mean of those before (gap filling): octaves of short
//! clusters drop the differences that touch them, and the bias of the filled values is subtracted from long octaves and
//! from the spectrum. [`Axes::merge`] adds another record of the same sensor, as if a gap lay between the two. [`Accumulator`] has
//! `gap`, `lost` and `merge` too.
//!
//! # The power may fail
//!
//! With the feature `storage`, [`Axes::snapshot`] writes everything that is kept to a buffer, running self-tests
//! included, and [`Axes::restore`] reads it back. It refuses bytes that have changed. A snapshot of an
//! [`Accumulator`] alone takes some 250 bytes. With the feature `flash`, a [`storage::SnapshotStore`] keeps
//! snapshots of any length in flash: a power cut in the middle of a write leaves the one before.
//! [`storage::SnapshotInterval`] says when the next one is due.
//!
//! A [`storage::Certificate`] is a factory calibration in some 600 bytes: device, conditions, coefficients and
//! verdict. `cargo allanite decode FILE…` prints certificates and snapshots on a workstation.
//!
//! The formats are documented byte by byte: [`storage::envelope`] surrounds everything that is stored,
//! [`storage::snapshot`] and [`storage::axes`] are the versions of a snapshot, and
//! [`storage::certificate`] is the factory calibration.
//!
//! # An effect of your own
//!
//! An effect is a description and a kernel, the generalised covariance of the angle. It takes one file, and one
//! line in the list of effects that a diagnosis tries. [`effect::check`] in its unit test finds the most frequent
//! mistakes.
//!
//! ```
//! use allanite::{Accumulator, Model, Real, Scale};
//! use allanite::diagnosis::{Addition, Diagnosis, Options, Step, Verdict};
//! use allanite::effect::{
//!     CATALOGUE, Description, Distribution, Effect, FIRST_OWN_CODE, SampledShape,
//! };
//! use core::ops::ControlFlow;
//!
//! struct MainsHum;
//!
//! impl Effect for MainsHum {
//!     fn description(&self) -> &'static Description {
//!         &Description {
//!             name: "mains_hum",
//!             symbol: "H",
//!             coefficient: "amplitude",
//!             half_seconds: 0, // the unit of the coefficient is that of the rate
//!             reference_s: None,
//!             parameters: &[],
//!             code: FIRST_OWN_CODE, // the number in stored records
//!             replaces: None,
//!             mirror: None,
//!             special_case: None,
//!             distribution: Distribution::Gaussian,
//!         }
//!     }
//!
//!     fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
//!         // −G″ is the autocovariance of a sinusoid of random phase, cos(ωt)/2.
//!         let omega = 2.0 * std::f64::consts::PI as Real * 50.0;
//!         // Without std, take the cosine from `libm`.
//!         (omega * lag * shape.interval_s).cos() / (2.0 * omega * omega)
//!     }
//! }
//!
//! // White noise, and hum of 50 Hz, sampled at 1 kHz.
//! let (mut gyro, mut random) = (Accumulator::<16>::new(), 1_u32);
//! for n in 0..1 << 16 {
//!     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
//!     let hum = 40.0 * (2.0 * std::f64::consts::PI * 0.05 * f64::from(n)).sin();
//!     gyro.push((random >> 24) as i32 + hum as i32);
//! }
//! let curve = gyro.curve(Scale::new(0.01, 1000.0)?);
//! let effects: [&dyn Effect; 2] = [&MainsHum, CATALOGUE[0]]; // or all of the catalogue
//! let (model, options) = (Model::ieee_952(), Options::default());
//! let mut diagnosis = Diagnosis::new(&curve, &model, &effects, options);
//! let report = |step: &Step<16>| match step.added {
//!     Some(Addition::Effect(term)) => assert_eq!(term.effect.name(), "mains_hum"),
//!     _ => assert_eq!(step.fit.is_adequate(), Some(true)),
//! };
//! let mut pause = || ControlFlow::Continue(()); // feed the watchdog, take the next samples
//! assert_eq!(diagnosis.run(report, &mut pause)?, Some(Verdict::Improved));
//! # Ok::<(), allanite::Error>(())
//! ```

// The page names what the features `storage` and `flash` add. Without them there is nothing to link to.
#![cfg_attr(not(feature = "flash"), allow(rustdoc::broken_intra_doc_links))]
// On docs.rs, whose compiler has it, each item that needs a feature says so.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]
#![forbid(unsafe_code)]

pub mod comparison;
pub mod course;
pub mod curve;
pub mod detection;
pub mod diagnosis;
mod error;
mod evidence;
#[cfg(test)]
mod extremes;
pub mod fit;
pub mod ieee_952;
mod limits;
mod list;
mod numerics;
mod pause;
mod record;
pub mod self_test;
pub mod sensor;
pub mod spectrum;
#[cfg(feature = "storage")]
pub mod storage;
mod theory;

pub use comparison::Comparison;
pub use curve::{Curve, Scale};
pub use error::Error;
pub use evidence::{
    axis::{self, Axes, Axis},
    covariate, faults, kurtosis, motion,
    record::Record,
};
pub use fit::coefficient::Coefficient;
pub use heapless;
pub use numerics::real::Real;
pub use record::{
    integrity,
    octave::{self, Accumulator},
    queue,
};
pub use theory::{
    effect,
    model::{self, Model, Term},
};

/// The example of the published page, so that it is compiled. The README of the repository shows the same.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;
