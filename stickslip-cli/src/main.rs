//! The program `stickslip`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(stickslip_cli::execute(std::env::args_os()))
}
