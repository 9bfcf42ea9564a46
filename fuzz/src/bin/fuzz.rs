//! One target, chosen by the variable `TARGET`, under libFuzzer; `STICKSLIP_SEEDS` has the seeds of all written to a folder
//! instead.

#![no_main]

use libfuzzer_sys::fuzz_target;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;
use stickslip_fuzz::{TARGETS, Target, named, prepare};

static CHOSEN: OnceLock<&Target> = OnceLock::new();

fn chosen() -> &'static Target {
    let name = std::env::var("TARGET").unwrap_or_default();
    named(&name).unwrap_or_else(|| panic!("TARGET={name}: no such target"))
}

fn write_seeds(folder: &Path) -> std::io::Result<()> {
    for target in TARGETS {
        let folder = folder.join(target.name);
        fs::create_dir_all(&folder)?;
        for (i, seed) in (target.seeds)().iter().enumerate() {
            fs::write(folder.join(format!("seed{i}")), seed)?;
        }
    }
    Ok(())
}

fuzz_target!(
    init: {
        if let Some(folder) = std::env::var_os("STICKSLIP_SEEDS") {
            write_seeds(Path::new(&folder)).expect("the disk takes them");
            std::process::exit(0);
        }
        prepare();
    },
    |bytes: &[u8]| (CHOSEN.get_or_init(chosen).run)(bytes)
);
