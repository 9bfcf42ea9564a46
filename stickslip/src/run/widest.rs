//! During and after a run: which contacts the grid resolved, from how wide the bodies touched.

use crate::check::{ContactResolution, Errors, lies_flat};
use crate::door::{ContactPatch, View};
use crate::scene::{Body, ContactLaw, Scene};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
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
    pub verdict: ContactResolution,
    /// By how much its results may be off, as far as round contacts tell: none of faces that lie flat on each other,
    /// whose width does not change with the load.
    pub off: Option<Errors>,
    /// What it bore of all contacts: its part of the force over the whole time [-].
    pub share: f64,
    /// What it bore of what the pair that bore most did: by its force over the whole time, or by its largest force,
    /// whichever says more [-].
    pub weight: f64,
}

/// A pair of bodies that touched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touched {
    /// Their widest contact, and the impulses between them.
    pub patch: ContactPatch,
    /// Largest mean of the force from one look to the next [N].
    pub force: f64,
}

/// The largest force between each pair of bodies, as seen by looks at a run.
///
/// A mean over less than the longest time between two looks counts as one over that time: the run's last look may come
/// a step after the one before, and no mean of that is a force.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct LargestForces {
    /// Time of the last look [s].
    time: f64,
    /// Longest time between two looks [s].
    longest: f64,
    /// Impulses until the last look [N s], and largest force [N], by pair.
    pairs: HashMap<[usize; 2], [f64; 2]>,
}

impl LargestForces {
    /// Takes note of what pairs bore since the last look.
    pub(super) fn look(&mut self, view: &dyn View) -> Vec<Touched> {
        self.see(&view.patches(), view.time())
    }

    fn see(&mut self, patches: &[ContactPatch], time: f64) -> Vec<Touched> {
        self.longest = self.longest.max(time - self.time);
        self.time = time;
        let mut touched = Vec::with_capacity(patches.len());
        for &patch in patches {
            let [before, force] = self.pairs.entry([patch.body_a, patch.body_b]).or_default();
            if self.longest > 0.0 {
                *force = force.max((patch.impulse - *before) / self.longest);
            }
            *before = patch.impulse;
            touched.push(Touched { patch, force: *force });
        }
        touched
    }
}

/// Whether a pair bore no more than round-off of the softer body's stress: faces that lie on each other without a load.
fn is_round_off(scene: &Scene, Touched { patch, force }: &Touched) -> bool {
    let deforming = [patch.body_a, patch.body_b].map(|body| &scene.bodies[body]).into_iter();
    let modulus =
        |body: &Body| scene.materials[body.material].law.wave_modulus_at_rest(scene.dimension.thickness());
    let moduli = deforming.filter(|body| !body.is_rigid()).map(modulus);
    moduli.reduce(f64::min).is_some_and(|softest| *force < ROUND_OFF * softest * patch.area)
}

/// Of a modulus, more than round-off of stress [-].
const ROUND_OFF: f64 = 1e-12;

/// Part of a face that touches where it lies flat.
const WHOLE_FACE: f64 = 0.7;

/// What to expect of faces that lie flat on each other, from half of their width in cells: pressure is even but for a
/// cell at the edges, and the first wave between bars of four cells is exact to 0.2 %.
fn of_face(cells: f64) -> ContactResolution {
    match cells {
        cells if cells >= 1.0 => ContactResolution::Resolved,
        cells if cells >= 0.5 => ContactResolution::Marginal,
        _ => ContactResolution::NotResolved,
    }
}

impl WidestContact {
    /// By how much its results may be off, in words.
    pub(super) fn expect(&self) -> String {
        match &self.off {
            Some(off) => off.to_string(),
            None => "a flat face so narrow bends and tips as the grid lets it".to_string(),
        }
    }
}

/// The contacts of a run, narrowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WidestContacts(pub Vec<WidestContact>);

/// Contacts that the summary names.
const NAMED: usize = 3;

/// Contacts that bear less than this of what the one bears that bears most only graze.
const GRAZING: f64 = 0.05;

impl WidestContacts {
    /// Glued bodies are one: how wide they touch says nothing.
    pub(super) fn new(scene: &Scene, touched: &[Touched]) -> Self {
        let glued = |touched: &Touched| {
            let rule = scene.contact_rule_between(touched.patch.body_a, touched.patch.body_b);
            rule.is_some_and(|rule| scene.contact[rule].law == ContactLaw::Glued)
        };
        let largest = |of: fn(&Touched) -> f64| touched.iter().map(of).fold(0.0, f64::max);
        let most = [largest(|touched| touched.patch.impulse), largest(|touched| touched.force)];
        let all: f64 = touched.iter().map(|touched| touched.patch.impulse).sum();
        let part = |of: f64, whole: f64| if whole > 0.0 { of / whole } else { 1.0 };
        let mut contacts: Vec<_> = (touched.iter())
            .filter(|touched| touched.patch.area > 0.0 && !glued(touched) && !is_round_off(scene, touched))
            .map(|Touched { patch, force }| {
                let half_width = patch.half_width;
                let cells = half_width / scene.discretization.cell;
                let pair = [patch.body_a, patch.body_b];
                // One that stands on an edge is narrower than the face, and judged as a round one is.
                let face = lies_flat(scene, pair).filter(|&face| half_width >= WHOLE_FACE * face);
                WidestContact {
                    bodies: pair.map(|body| scene.bodies[body].name.clone()),
                    half_width,
                    cells,
                    verdict: match face {
                        Some(_) => of_face(cells),
                        None => ContactResolution::of(cells),
                    },
                    off: face.is_none().then(|| Errors::of(cells)),
                    share: part(patch.impulse, all),
                    weight: part(patch.impulse, most[0]).max(part(*force, most[1])),
                }
            })
            .collect();
        contacts.sort_by(|a, b| a.cells.total_cmp(&b.cells));
        WidestContacts(contacts)
    }

    /// Those that a verdict is worth: all but the grazing ones.
    pub(super) fn bearing(mut self) -> Self {
        self.0.retain(|contact| contact.weight >= GRAZING);
        self
    }

    /// What they bear of the force between all bodies: "bearing 80 % of the contact force". Of short blows the largest.
    pub(super) fn borne(&self) -> String {
        let share: f64 = self.0.iter().map(|contact| contact.share).sum();
        let weight = self.0.iter().map(|contact| contact.weight).fold(0.0, f64::max);
        match [share, weight].map(|part| 100.0 * part) {
            [share, weight] if share < GRAZING * 100.0 => {
                format!("bearing {share:.1} % of the contact force, at one time {weight:.0} % of the largest")
            }
            [share, _] => format!("bearing {share:.0} % of the contact force"),
        }
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
        let coarse = self.0.iter().filter(|contact| contact.verdict != ContactResolution::Resolved).cloned();
        let (bearing, grazing): (Vec<_>, Vec<_>) = coarse.partition(|contact| contact.weight >= GRAZING);
        let bearing = WidestContacts(bearing);
        let Some(narrowest) = bearing.0.first() else { return Ok(()) };
        let (verdict, named, borne) = (narrowest.verdict, bearing.named(), bearing.borne());
        write!(
            f,
            "  contact    {verdict}: touched over a half-width of at most {named}, {borne}; {}",
            narrowest.expect()
        )?;
        match grazing.len() {
            0 => writeln!(f),
            count => writeln!(
                f,
                "; not named: {count} that only graze{}, bearing less than {:.0} % of what the one bears \
                 that bears most",
                if count == 1 { "s" } else { "" },
                100.0 * GRAZING
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts with these half-widths on cells of 0.1 m, and what each bears.
    fn widest(contacts: &[(f64, f64)]) -> WidestContacts {
        let bodies: String = (0..=contacts.len())
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
        let touched = |(i, &(half_width, impulse)): (usize, &(f64, f64))| Touched {
            patch: patch(i, half_width, impulse),
            force: impulse,
        };
        let touched: Vec<_> = contacts.iter().enumerate().map(touched).collect();
        WidestContacts::new(&scene, &touched)
    }

    fn patch(body_a: usize, half_width: f64, impulse: f64) -> ContactPatch {
        ContactPatch { body_a, body_b: body_a + 1, area: 2.0 * half_width, half_width, impulse }
    }

    fn equal(half_widths: &[f64]) -> WidestContacts {
        widest(&half_widths.iter().map(|&half_width| (half_width, 1.0)).collect::<Vec<_>>())
    }

    #[test]
    fn the_half_width_in_cells_gives_the_verdict() {
        let found = equal(&[0.5, 0.25, 0.05]);
        let cells: Vec<_> = found.0.iter().map(|contact| contact.cells).collect();
        assert!((0..3).all(|i| (cells[i] - [0.5, 2.5, 5.0][i]).abs() < 1e-12), "{cells:?}");
        let verdicts: Vec<_> = found.0.iter().map(|contact| contact.verdict).collect();
        assert_eq!(
            verdicts,
            [ContactResolution::NotResolved, ContactResolution::Marginal, ContactResolution::Resolved]
        );
    }

    #[test]
    fn only_contacts_that_the_grid_does_not_resolve_are_named() {
        assert_eq!(equal(&[1.0]).to_string(), "");
        let text = equal(&[1.0, 0.05, 0.15, 0.1, 0.2, 0.25]).to_string();
        assert!(
            text.contains(
                "b1 and b2 0.50 cells, b3 and b4 1.00 cells, b2 and b3 1.50 cells and 2 more, \
                 bearing 83 % of the contact force"
            ),
            "{text}"
        );
    }

    /// A wide contact that bears 100, one of half a cell that bears 25, and two narrower ones that graze.
    #[test]
    fn contacts_that_only_graze_are_counted_and_not_named() {
        let text = widest(&[(0.5, 100.0), (0.01, 0.1), (0.05, 25.0), (0.02, 4.9)]).to_string();
        assert!(text.contains(
            "not resolved: touched over a half-width of at most b2 and b3 0.50 cells, bearing 19 %"
        ));
        assert!(text.contains("; not named: 2 that only graze, bearing less than 5 % of"), "{text}");
        assert_eq!(widest(&[(0.5, 100.0), (0.01, 0.1)]).to_string(), "");
    }

    /// Of clay with a modulus of 1 Pa, 1e-13 of it is round-off and 1e-11 is a load.
    #[test]
    fn contacts_that_bear_round_off_are_not_judged() {
        assert_eq!(widest(&[(0.05, 1e-14)]).0, []);
        assert_eq!(widest(&[(0.05, 1e-12)]).0.len(), 1);
    }

    /// It bore little over the whole time, but much at once.
    #[test]
    fn a_blow_at_the_end_counts_by_its_largest_force() {
        let mut patches = [(0, 0.5, 100.0, 10.0), (1, 0.05, 1.0, 30.0)]
            .map(|(body_a, half_width, impulse, force)| Touched {
                patch: patch(body_a, half_width, impulse),
                force,
            })
            .to_vec();
        let scene = || {
            let text = include_str!("../../../stickslip-scene/tests/scenes/rolling.toml");
            let mut scene = crate::scene::parse("rolling.toml", text, &[]).expect("a scene").scene;
            let again = scene.bodies[0].clone();
            scene.bodies.push(again);
            scene
        };
        let mut both = WidestContacts::new(&scene(), &patches).bearing();
        assert_eq!(both.0.len(), 2);
        both.0.retain(|contact| contact.cells < 1.0);
        assert_eq!(both.borne(), "bearing 1.0 % of the contact force, at one time 100 % of the largest");
        patches[1].force = 0.1;
        assert_eq!(WidestContacts::new(&scene(), &patches).bearing().0.len(), 1);
    }

    /// Two looks of 1 s with impulses of 1 and 3 N s, and one of a hundredth of that with one more.
    #[test]
    fn a_pair_has_borne_its_largest_mean_force() {
        let mut forces = LargestForces::default();
        let mut see = |impulse: f64, time: f64| forces.see(&[patch(0, 1.0, impulse)], time)[0].force;
        assert_eq!(see(1.0, 1.0), 1.0);
        assert_eq!(see(4.0, 2.0), 3.0);
        assert_eq!([see(5.0, 2.01), see(5.0, 2.01)], [3.0; 2]);
    }
}
