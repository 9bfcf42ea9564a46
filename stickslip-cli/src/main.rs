//! The program `stickslip`.

use std::process::ExitCode;

fn main() -> ExitCode {
    stickslip_cli::door::main(std::env::args_os())
}
