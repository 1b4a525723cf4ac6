//! The program `allanite`, as its users call it: what it reads, prints, draws and refuses.

#[path = "../common/browser.rs"]
mod browser;
#[path = "../common/drawing.rs"]
mod drawing;
#[path = "../common/factory.rs"]
mod factory;
#[path = "../common/page.rs"]
mod page;
#[path = "../../library/common/sealed.rs"]
mod sealed;
#[path = "../common/whole_page.rs"]
mod whole_page;

use allanite::{diagnosis::Verdict, integrity::Reason};

/// The verdict on an axis that is not valid, whatever the reason is.
const INVALID: Verdict = Verdict::Invalid(Reason::Spiked {
    spikes: 0,
    percent: 0,
});

mod attributes;
mod bad_input;
mod certify;
mod chain;
mod command_line;
mod compare;
mod curve_file;
mod cuts;
mod databases;
mod decode;
mod diagnose;
mod doors;
mod drawings;
mod dropped;
mod dropped_hostile;
mod evidence;
mod explore;
mod explore_figures;
mod explore_time;
mod export;
mod export_model;
mod export_tables;
mod faults;
mod formats;
mod help;
mod known_filter;
mod lag;
mod layouts;
mod limits;
mod log;
mod lost_rows;
mod lot;
mod many;
mod merge;
mod overbound;
mod own_effect;
mod plot;
mod readme;
mod record_over_time;
mod rejoin;
mod report;
mod report_figures;
mod report_layout;
mod report_view;
mod simulate;
mod thorough;
mod untrusted;
mod views;
mod watch;
#[cfg(unix)]
mod watch_ends;
