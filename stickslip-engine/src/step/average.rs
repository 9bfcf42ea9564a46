//! Bodies that keep their volume: particles take means of the dilatation rate and of the pressure.
//!
//! Each particle asks for a volume of its own, which is more than the nodes can give, so nearly incompressible bodies
//! lock. Here they ask for one volume around each node, in the manner of averages over elements (B-bar: Hughes 1980,
//! Int. J. Numer. Methods Eng. 15) and around nodes (Bonet and Burton 1998, Commun. Numer. Methods Eng. 14):
//!
//! ```text
//! d_p = tr L_p                     d_i = sum_p S_ip m_p d_p / m_i          L_p <- L_p + (sum_i S_ip d_i - d_p) I/D
//! q_p = V_p tr_D(sigma_p) / D      q_i = sum_p S_ip q_p / m_i              V_p sigma_p <- V_p sigma_p
//!                                                                                     + (m_p sum_i S_ip q_i - q_p) I
//! ```
//! D: dimensions, in which traces and I are taken. The second line is the transpose of the first: forces do the work
//! that the strain takes, and the energy is that of F. Without it a ball that bounces gains energy without end. A
//! uniform dilatation and a uniform pressure stay as they are.

use super::Engine;
use crate::grid::Node;
use crate::lanes::Laned;
use crate::pass::Verbs;
use crate::transfer::Share;
use std::time::Instant;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// d_i, from the velocities that strain; nothing where no material wants it.
    pub(super) fn average_dilatation(&mut self, dt: T) {
        if self.settings.averages_volume {
            self.average(Share::Dilatation, dt);
        }
    }

    /// q_i
    pub(super) fn average_mean_stress(&mut self) {
        self.average(Share::MeanStress, T::ZERO);
    }

    /// Sums in the place of the mass, and then over the mass.
    fn average(&mut self, share: Share, dt: T) {
        let start = Instant::now();
        self.workspace.field.each_mean(Node::lend_mass);
        self.watch.lap("grid", start);
        self.run_pass("P2G", Verbs { scatter: Some(share), ..Verbs::default() }, dt)
            .expect("a scatter changes no particle");
        self.workspace.field.each_mean(Node::take_mass_back);
        self.workspace.boundary.repeat_values(&mut self.workspace.field.means);
    }
}
