//! The command `stickslip`.

mod bench;
mod chart;
mod commands;
mod drawing;
mod failure;
mod illustration;
mod picture;
mod progress;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::Command::parse().execute() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            failure.exit_code()
        }
    }
}
