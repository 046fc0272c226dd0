//! Entry point of the program.

use clap::Parser;
use hysteron::cli::{Arguments, perform};
use std::process::ExitCode;

fn main() -> ExitCode {
    perform(&Arguments::parse())
}
