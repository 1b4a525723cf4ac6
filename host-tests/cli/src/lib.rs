//! The program `allanite`: what it reads from the command line, prints, draws and shows on pages.

pub mod command;
