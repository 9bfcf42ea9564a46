//! Has the linker take the names out of the program: cargo keeps those of a package whose profile is its own.

use std::env;
use std::path::Path;
use std::process::{Command, Stdio};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // A profile with debug information is for whoever looks for names, and Windows has them in files beside the
    // program.
    let is_release = of_cargo("PROFILE") == "release" && of_cargo("DEBUG") == "false";
    if is_release && of_cargo("CARGO_CFG_TARGET_ENV") != "msvc" {
        // As a compiler takes it that links, and as a linker does.
        let strip = ["-Wl,--strip-all", "--strip-all"].into_iter().find(|argument| links(argument));
        strip.into_iter().for_each(|argument| println!("cargo::rustc-link-arg-bins={argument}"));
    }
}

fn of_cargo(name: &str) -> String {
    env::var(name).expect("cargo says it")
}

/// Whether a program links with an argument.
fn links(argument: &str) -> bool {
    let folder = of_cargo("OUT_DIR");
    let [source, program] = ["probe.rs", "probe"].map(|name| Path::new(&folder).join(name));
    std::fs::write(&source, "fn main() {}").expect("cargo has made the folder");
    let mut compiler = Command::new(of_cargo("RUSTC"));
    compiler.arg(source).arg("-o").arg(program).args(["--target", &of_cargo("TARGET")]);
    if let Ok(linker) = env::var("RUSTC_LINKER") {
        compiler.arg(format!("-Clinker={linker}"));
    }
    compiler.arg(format!("-Clink-arg={argument}")).stdout(Stdio::null()).stderr(Stdio::null());
    compiler.status().is_ok_and(|status| status.success())
}
