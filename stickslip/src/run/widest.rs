//! During and after a run: which contacts the grid resolved, from how wide the bodies touched.

use crate::check::{Errors, Verdict};
use crate::door::Patch;
use crate::scene::Scene;
use std::fmt::{self, Display, Formatter};

/// How wide two bodies touched at most.
#[derive(Clone, Debug, PartialEq)]
pub struct WidestContact {
    /// Names of the bodies.
    pub bodies: [String; 2],
    /// Half of the contact's shorter side, a circle's radius, with its images in mirrors [m].
    pub half_width: f64,
    /// The same over the cell size [-].
    pub cells: f64,
    /// What to expect of the contact.
    pub verdict: Verdict,
    /// By how much its results may be off.
    pub off: Errors,
}

/// The contacts of a run, narrowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WidestContacts(pub Vec<WidestContact>);

/// Contacts that the summary names.
const NAMED: usize = 3;

impl WidestContacts {
    pub(super) fn new(scene: &Scene, patches: &[Patch]) -> Self {
        let mut contacts: Vec<_> = (patches.iter())
            .filter(|patch| patch.area > 0.0)
            .map(|patch| {
                let half_width = patch.half_width;
                let cells = half_width / scene.discretization.cell;
                let bodies = [patch.body_a, patch.body_b].map(|body| scene.bodies[body].name.clone());
                WidestContact {
                    bodies,
                    half_width,
                    cells,
                    verdict: Verdict::of(cells),
                    off: Errors::of(cells),
                }
            })
            .collect();
        contacts.sort_by(|a, b| a.cells.total_cmp(&b.cells));
        WidestContacts(contacts)
    }

    /// The narrowest with their cells, and how many there are more.
    pub(super) fn named(&self) -> String {
        let named: Vec<_> = (self.0.iter().take(NAMED))
            .map(|contact| {
                format!("{} and {} {:.2} cells", contact.bodies[0], contact.bodies[1], contact.cells)
            })
            .collect();
        let others = self.0.len().saturating_sub(NAMED);
        let more = if others > 0 { format!(" and {others} more") } else { String::new() };
        named.join(", ") + &more
    }
}

impl Display for WidestContacts {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let coarse = self.0.iter().filter(|contact| contact.verdict != Verdict::Resolved).cloned();
        let coarse = WidestContacts(coarse.collect());
        let Some(narrowest) = coarse.0.first() else { return Ok(()) };
        writeln!(
            f,
            "  contact    {}: touched over a half-width of at most {}; {}",
            narrowest.verdict,
            coarse.named(),
            narrowest.off
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widest(half_widths: &[f64]) -> WidestContacts {
        let bodies: String = (0..=half_widths.len())
            .map(|i| {
                format!(
                    "[[bodies]]\nname = 'b{i}'\nmaterial = 'clay'\nshape.ball = {{ center = [{}, 0], radius = 1 }}\n",
                    4 * i
                )
            })
            .collect();
        let text = format!(
            "space = {{ dimension = 'plane-strain', cell = 0.1 }}\ntime.end = 1\n\
             materials.clay = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}\n{bodies}"
        );
        let scene = crate::scene::parse("widest.toml", &text, &[]).expect("a scene").scene;
        let patch = |(i, &half_width): (usize, &f64)| Patch {
            body_a: i,
            body_b: i + 1,
            area: 2.0 * half_width,
            half_width,
        };
        let patches: Vec<_> = half_widths.iter().enumerate().map(patch).collect();
        WidestContacts::new(&scene, &patches)
    }

    #[test]
    fn the_half_width_in_cells_gives_the_verdict() {
        let found = widest(&[0.5, 0.25, 0.05]);
        let cells: Vec<_> = found.0.iter().map(|contact| contact.cells).collect();
        assert!((0..3).all(|i| (cells[i] - [0.5, 2.5, 5.0][i]).abs() < 1e-12), "{cells:?}");
        let verdicts: Vec<_> = found.0.iter().map(|contact| contact.verdict).collect();
        assert_eq!(verdicts, [Verdict::NotResolved, Verdict::Marginal, Verdict::Resolved]);
    }

    #[test]
    fn only_contacts_that_the_grid_does_not_resolve_are_named() {
        assert_eq!(widest(&[1.0]).to_string(), "");
        let text = widest(&[1.0, 0.05, 0.15, 0.1, 0.2, 0.25]).to_string();
        assert!(
            text.contains("b1 and b2 0.50 cells, b3 and b4 1.00 cells, b2 and b3 1.50 cells and 2 more"),
            "{text}"
        );
    }
}
