//! The program: what is asked for, done, and said.

use clap::Parser;
use hysteron::cli::{Arguments, perform};
use std::process::ExitCode;

fn main() -> ExitCode {
    perform(&Arguments::parse())
}
