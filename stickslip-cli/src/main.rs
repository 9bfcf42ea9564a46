//! The command `stickslip`.

mod drawing;
mod picture;

fn main() {}
