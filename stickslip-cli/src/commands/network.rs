//! `stickslip network DIR`: who presses on whom, as a graph.

use super::{open, recorded, say};
use crate::failure::Failure;
use crate::files;
use clap::Args;
use std::path::PathBuf;
use stickslip::observe::Network;

/// Write the contact network of a run at one time as GraphML, which NetworkX, igraph and Gephi read.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results.
    folder: PathBuf,

    /// The recorded time nearest to this one [s]; the last without this.
    #[arg(long, allow_negative_numbers = true)]
    time: Option<f64>,

    /// The graph; DIR/network.graphml without this.
    #[arg(long)]
    out: Option<PathBuf>,
}

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let results = open(&self.folder)?;
        if let Some(time) = self.time {
            recorded(time, results.bodies_table().map_err(Failure::input)?.iter().map(|row| row.time))?;
        }
        let network = Network::read(&results, self.time).map_err(Failure::input)?;
        let out = self.out.unwrap_or_else(|| self.folder.join("network.graphml"));
        files::write(&out, files::GRAPHML, |file| network.write(file))
            .map_err(|error| Failure::unwritten(&out, &error))?;
        say(&format!(
            "{} is written: {} bodies, {} contacts, {:.2} on a body that touches, t = {} s",
            out.display(),
            network.bodies.len(),
            network.contacts.len(),
            network.coordination(),
            network.time
        ))
    }
}
