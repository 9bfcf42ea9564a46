//! A sweep as a job array of SLURM: one script, of which the scheduler runs a copy for each run.

use crate::failure::Failure;
use miette::{IntoDiagnostic, miette};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use stickslip::observe::replace;

const SCRIPT: &str = "array.sh";

/// Writes `array.sh` of a sweep of so many runs into its folder: its path.
///
/// # Errors
/// It cannot be written.
pub fn write_script(folder: &Path, runs: usize) -> Result<PathBuf, Failure> {
    let program = crate::program().into_diagnostic().map_err(Failure::Run)?;
    let text = script(&program, runs);
    let path = folder.join(SCRIPT);
    replace(&path, |file| file.write_all(text.as_bytes()))
        .map_err(|error| Failure::Run(miette!("cannot write {}: {}", path.display(), error.source)))?;
    Ok(path)
}

/// What a user types to run some of the runs of a sweep, by number: by SLURM where the folder has a script, else here.
pub fn submit(folder: &Path, runs: &[usize]) -> String {
    let script = folder.join(SCRIPT);
    if script.exists() {
        format!("sbatch --array={} {}", ranges(runs), quoted(&script))
    } else {
        format!("stickslip sweep {}", quoted(folder))
    }
}

fn script(program: &[OsString], runs: usize) -> String {
    let program = program.iter().map(|word| quoted(Path::new(word))).collect::<Vec<_>>().join(" ");
    let all = ranges(&(0..runs).collect::<Vec<_>>());
    format!(
        r#"#!/bin/sh
# A sweep as a job array: `sbatch array.sh` runs all; options of sbatch go before the script, such as --time=8:00:00
# --mem=4G. Once no job is left, `stickslip sweep DIR --gather` makes the table and names what has to be run again.
#SBATCH --job-name=stickslip
#SBATCH --array={all}
#SBATCH --cpus-per-task=1
# Early enough for a last checkpoint, from which the run goes on when it is submitted again.
#SBATCH --signal=B:TERM@120
# The sweep is that of the folder where this script lies: SLURM runs a copy of it, and knows where that came from.
for script in "$0" "$(scontrol show job "$SLURM_JOB_ID" 2>/dev/null | sed -n '/^ *Command=/{{s///p;q;}}')"; do
    folder=$(dirname "$script")
    if [ -n "$script" ] && [ -f "$folder/sweep.json" ]; then
        exec {program} sweep "$folder" --only "$SLURM_ARRAY_TASK_ID" --threads "${{SLURM_CPUS_PER_TASK:-1}}"
    fi
done
echo "array.sh: found no sweep.json beside $0 or the script that was submitted" >&2
exit 2
"#
    )
}

/// A path as one word of a shell.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', r"'\''"))
}

/// Numbers in increasing order as SLURM has them: `0-3,7`.
fn ranges(numbers: &[usize]) -> String {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for &number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => ranges.push([number, number]),
        }
    }
    let word = |[first, last]: &[usize; 2]| {
        if first == last { first.to_string() } else { format!("{first}-{last}") }
    };
    ranges.iter().map(word).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_follow_each_other_are_a_range() {
        assert_eq!(ranges(&[0, 1, 2, 3, 7]), "0-3,7");
        assert_eq!(ranges(&[4]), "4");
        assert_eq!(ranges(&[1, 3, 4]), "1,3-4");
    }

    #[test]
    fn a_path_is_one_word() {
        assert_eq!(quoted(Path::new("it's here")), r"'it'\''s here'");
    }
}
