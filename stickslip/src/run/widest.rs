//! During and after a run: which contacts the grid resolved, from how wide the bodies touched.

use crate::check::{Errors, Verdict};
use crate::door::Patch;
use crate::scene::Scene;
use std::f64::consts::PI;
use std::fmt::{self, Display, Formatter};

/// How wide two bodies touched at most.
#[derive(Clone, Debug, PartialEq)]
pub struct WidestContact {
    /// Names of the bodies.
    pub bodies: [String; 2],
    /// Radius of a circle with the contact's area, in the plane half its length, with its images in mirrors [m].
    pub radius: f64,
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
        let plane = scene.dimension.axes() == 2;
        let mut contacts: Vec<_> = (patches.iter())
            .filter(|patch| patch.area > 0.0)
            .map(|patch| {
                let radius = if plane { 0.5 * patch.area } else { (patch.area / PI).sqrt() };
                let cells = radius / scene.discretization.cell;
                let bodies = [patch.body_a, patch.body_b].map(|body| scene.bodies[body].name.clone());
                WidestContact { bodies, radius, cells, verdict: Verdict::of(cells), off: Errors::of(cells) }
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
            "  contact    {}: touched within a radius of at most {}; {}",
            narrowest.verdict,
            coarse.named(),
            narrowest.off
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widest(dimension: &str, areas: &[f64]) -> WidestContacts {
        let third = if dimension == "3d" { ", 0" } else { "" };
        let bodies: String = (0..=areas.len())
            .map(|i| {
                format!(
                    "[[bodies]]\nname = 'b{i}'\nmaterial = 'clay'\nshape.ball = {{ center = [{}, 0{third}], radius = 1 }}\n",
                    4 * i
                )
            })
            .collect();
        let text = format!(
            "space = {{ dimension = '{dimension}', cell = 0.1 }}\ntime.end = 1\n\
             materials.clay = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0 }} }}\n{bodies}"
        );
        let scene = crate::scene::parse("widest.toml", &text, &[]).expect("a scene").scene;
        let patches: Vec<_> =
            areas.iter().enumerate().map(|(i, &area)| Patch { body_a: i, body_b: i + 1, area }).collect();
        WidestContacts::new(&scene, &patches)
    }

    #[test]
    fn the_area_tells_the_radius_in_cells() {
        let plane = widest("plane-strain", &[0.5]);
        assert!((plane.0[0].cells - 2.5).abs() < 1e-12 && plane.0[0].verdict == Verdict::Marginal);
        let space = widest("3d", &[PI * 0.09, PI * 0.25]);
        let cells: Vec<_> = space.0.iter().map(|contact| contact.cells).collect();
        assert!((cells[0] - 3.0).abs() < 1e-12 && (cells[1] - 5.0).abs() < 1e-12, "{cells:?}");
    }

    #[test]
    fn only_contacts_that_the_grid_does_not_resolve_are_named() {
        assert_eq!(widest("plane-strain", &[2.0]).to_string(), "");
        let text = widest("plane-strain", &[2.0, 0.1, 0.3, 0.2, 0.4, 0.5]).to_string();
        assert!(
            text.contains("b1 and b2 0.50 cells, b3 and b4 1.00 cells, b2 and b3 1.50 cells and 2 more"),
            "{text}"
        );
    }
}
