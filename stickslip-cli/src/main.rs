//! The command `stickslip`.

mod chart;
mod commands;
mod drawing;
mod failure;
mod illustration;
#[allow(dead_code, unused_imports, reason = "reports are written over it")]
mod page;
mod picture;
mod progress;
mod sweep;
mod validation;

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
