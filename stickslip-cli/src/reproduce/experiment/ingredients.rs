//! From the paper's simulation to its experiment, one change at a time, and what of the experiment is not known.

use super::place::Place;
use crate::reproduce::case::{PaperCase, PaperScene};

/// A change, on top of all before it.
pub struct Ingredient {
    /// A word for it in names of runs.
    name: &'static str,
    pub title: &'static str,
    /// What it sets: `None` is what the scene of the experiment says.
    settings: &'static [(&'static str, Option<&'static str>)],
    /// Mean interval from disk to disk of the row by finite elements with sharp contact, in crossings by the material's
    /// own longitudinal waves; where it is known.
    pub sharp: Option<f64>,
}

/// One thing that is not known, at one end of its range, all else as in the experiment.
pub struct Unknown {
    /// A word for it in names of runs.
    name: &'static str,
    /// What is not known; the ends of its range share it.
    pub quantity: &'static str,
    pub title: &'static str,
    pub settings: &'static [(&'static str, &'static str)],
    pub basis: Basis,
    /// Where it matters, one place an arrangement.
    pub places: &'static [Place],
}

/// What an end of a range rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Published measurements of the material.
    Published,
    /// Nobody says; a guess at what is likely.
    Assumed,
    /// What would have to be.
    Hypothetical,
}

/// From the paper's simulation on. The first is that simulation in the experiment's scene, by a law that differs from
/// its own by the square of the strain; its fringes are those of the other studies, s = 0.3 rho c_L V, and its camera
/// next to no exposure.
pub const INGREDIENTS: [Ingredient; 11] = [
    Ingredient {
        name: "paper",
        title: "the paper's simulation",
        settings: &[
            ("contact", Some("traction")),
            ("transfer", Some("flip")),
            ("dimension", Some("plane-strain")),
            ("diameter", Some("1 cm")),
            ("density", Some("1900 kg/m^3")),
            ("bulk", Some("102 GPa")),
            ("shear", Some("72 GPa")),
            ("transit", Some("diameter / c_L")),
            ("relaxing", Some("1e-9")),
            ("clearance", Some("0")),
            ("stress_optic", Some(SIMULATED_FRINGES)),
            ("exposure", Some("transit / 1000")),
            ("duration", Some("10")),
        ],
        sharp: None,
    },
    Ingredient {
        name: "speed",
        title: "struck as fast by the measure of waves, V/c = 0.00207",
        settings: &[("speed", Some("2.07e-3 * c_L")), ("duration", None)],
        sharp: None,
    },
    Ingredient {
        name: "transfer",
        title: "particles that keep their spin (rflip for FLIP)",
        settings: &[("transfer", None)],
        sharp: None,
    },
    Ingredient {
        name: "surfaces",
        title: "contact where surfaces touch (of the glued disks, with striker and frame)",
        settings: &[("contact", None)],
        sharp: Some(2.097),
    },
    Ingredient { name: "plane-stress", title: "plane stress", settings: &[("dimension", None)], sharp: None },
    // Of Plexiglas; the longitudinal waves are as fast as before.
    Ingredient {
        name: "poisson",
        title: "Poisson's ratio 0.319 for 0.214",
        settings: &[("bulk", Some("127.71 GPa")), ("shear", Some("52.72 GPa"))],
        sharp: Some(2.41),
    },
    Ingredient {
        name: "plexiglas",
        title: "stiffness, density and size of Plexiglas disks, c = 2.72 km/s for the 2.67 km/s of a transit",
        settings: &[
            ("diameter", None),
            ("density", None),
            ("bulk", None),
            ("shear", None),
            ("transit", None),
            ("speed", None),
        ],
        sharp: Some(2.41),
    },
    Ingredient { name: "relaxing", title: "it relaxes", settings: &[("relaxing", None)], sharp: None },
    Ingredient {
        name: "clearance",
        title: "25 µm between disks and walls",
        settings: &[("clearance", None)],
        sharp: None,
    },
    Ingredient {
        name: "exposure",
        title: "a camera's exposure of a tenth of a transit",
        settings: &[("exposure", None)],
        sharp: None,
    },
    Ingredient {
        name: "optics",
        title: "fringes of Plexiglas for s = 0.3 ρ c V",
        settings: &[("stress_optic", None)],
        sharp: None,
    },
];

/// The stress-optic coefficient by which s = 0.3 rho c_L V.
const SIMULATED_FRINGES: &str = "wavelength / (2 * pi * 0.3 * pressure * thickness)";

const ALL: &[Place] = &Place::KNOWN;
const FLAT: &[Place] = &[Place::Flats, Place::SlidingFlats];

/// What is not known, one end of its range after the other.
pub const UNKNOWNS: [Unknown; 27] = [
    Unknown {
        name: "friction-low",
        quantity: "friction of the disks",
        title: "friction 0.4",
        settings: &[("friction", "0.4")],
        basis: Basis::Published,
        places: &[Place::Sliding],
    },
    Unknown {
        name: "friction-high",
        quantity: "friction of the disks",
        title: "friction 0.6",
        settings: &[("friction", "0.6")],
        basis: Basis::Published,
        places: &[Place::Sliding],
    },
    Unknown {
        name: "friction-falling",
        quantity: "friction of the disks",
        title: "friction that falls from 0.5 towards 0.25 as disks slide, to 0.34 at 1 m/s",
        settings: &[("kinetic_friction", "0.25"), ("decay_speed", "1 m/s")],
        basis: Basis::Assumed,
        places: &[Place::Sliding],
    },
    Unknown {
        name: "friction-least",
        quantity: "friction of the disks",
        title: "friction 0.2, as at speed it may be",
        settings: &[("friction", "0.2")],
        basis: Basis::Assumed,
        places: &[Place::Sliding],
    },
    Unknown {
        name: "frame-friction",
        quantity: "friction of the frame",
        title: "friction 0.4 on the frame, too",
        settings: &[("wall_friction", "0.4")],
        basis: Basis::Assumed,
        places: ALL,
    },
    Unknown {
        name: "no-clearance",
        quantity: "clearance",
        title: "no clearance",
        settings: &[("clearance", "0")],
        basis: Basis::Assumed,
        places: ALL,
    },
    Unknown {
        name: "more-clearance",
        quantity: "clearance",
        title: "50 µm of clearance",
        settings: &[("clearance", "50 um")],
        basis: Basis::Assumed,
        places: ALL,
    },
    Unknown {
        name: "gaps",
        quantity: "gaps between disks",
        title: "25 µm between disks",
        settings: &[("gap", "25 um")],
        basis: Basis::Assumed,
        places: &[Place::Row, Place::Sliding],
    },
    Unknown {
        name: "rise",
        quantity: "rise of the striker's speed",
        title: "a striker that takes 10 µs to come to its speed",
        settings: &[("rise", "10 us")],
        basis: Basis::Assumed,
        places: ALL,
    },
    Unknown {
        name: "sharp",
        quantity: "exposure",
        title: "pictures that are not exposed for any time",
        settings: &[("exposure", "transit / 1000")],
        basis: Basis::Assumed,
        places: ALL,
    },
    Unknown {
        name: "optics-low",
        quantity: "stress-optic coefficient",
        title: "stress-optic coefficient 3.3e-12 /Pa",
        settings: &[("stress_optic", "3.3e-12 m^2/N")],
        basis: Basis::Published,
        places: ALL,
    },
    Unknown {
        name: "optics-high",
        quantity: "stress-optic coefficient",
        title: "stress-optic coefficient 4.8e-12 /Pa",
        settings: &[("stress_optic", "4.8e-12 m^2/N")],
        basis: Basis::Published,
        places: ALL,
    },
    Unknown {
        name: "optics-simulated",
        quantity: "density of the paper's simulated fringes",
        title: "fringes as dense as in the simulation remade, s = 0.3 ρ c V",
        settings: &[("stress_optic", SIMULATED_FRINGES)],
        basis: Basis::Assumed,
        places: ALL,
    },
    Unknown {
        name: "ultrasound",
        quantity: "stiffness",
        title: "as stiff as for ultrasound at all times",
        settings: &[("relaxing", "1e-9")],
        basis: Basis::Published,
        places: ALL,
    },
    Unknown {
        name: "losses",
        quantity: "stiffness",
        title: "losses that fall as a power of the frequency to 0.012 at 1.6 MHz, as measured near there, for 0.053",
        settings: &[("losses", "0.24")],
        basis: Basis::Published,
        places: ALL,
    },
    Unknown {
        name: "slow",
        quantity: "stiffness",
        title: "as soft as in slow tests at all times, E = 3.3 GPa, ν = 0.37",
        settings: &[("relaxing", "1e-9"), ("bulk", "4.23 GPa"), ("shear", "1.204 GPa")],
        basis: Basis::Published,
        places: ALL,
    },
    Unknown {
        name: "narrow-glue",
        quantity: "width of the glue",
        title: "glue 1 mm wide",
        settings: &[("glue", "1 mm")],
        basis: Basis::Assumed,
        places: &[Place::Strips],
    },
    Unknown {
        name: "wide-glue",
        quantity: "width of the glue",
        title: "glue 6 mm wide",
        settings: &[("glue", "6 mm")],
        basis: Basis::Assumed,
        places: &[Place::Strips],
    },
    Unknown {
        name: "grid-glue",
        quantity: "width of the glue",
        title: "glue as in the paper's simulation, wherever disks share nodes",
        settings: &[],
        basis: Basis::Assumed,
        places: &[Place::Glued],
    },
    Unknown {
        name: "fast",
        quantity: "speed of the striker",
        title: "a striker twice as fast, fringes half as dense for a stress",
        settings: &[("speed", "11.2 m/s"), ("stress_optic", "2e-12 m^2/N")],
        basis: Basis::Hypothetical,
        places: ALL,
    },
    Unknown {
        name: "wide-contacts",
        quantity: "width of the contacts before the blow",
        title: "contacts 4 mm wide before the blow",
        settings: &[],
        basis: Basis::Hypothetical,
        places: FLAT,
    },
    Unknown {
        name: "wide-contacts-ultrasound",
        quantity: "width of the contacts before the blow",
        title: "the same, as stiff as for ultrasound",
        settings: &[("relaxing", "1e-9")],
        basis: Basis::Hypothetical,
        places: FLAT,
    },
    Unknown {
        name: "wide-contacts-clear",
        quantity: "width of the contacts before the blow",
        title: "the same, 50 µm of clearance",
        settings: &[("relaxing", "1e-9"), ("clearance", "50 um")],
        basis: Basis::Hypothetical,
        places: FLAT,
    },
    Unknown {
        name: "wide-contacts-slipping",
        quantity: "width of the contacts before the blow",
        title: "contacts 4 mm wide before the blow, as stiff as for ultrasound, friction 0.2",
        settings: &[("relaxing", "1e-9"), ("friction", "0.2")],
        basis: Basis::Hypothetical,
        places: &[Place::SlidingFlats],
    },
    Unknown {
        name: "wide-contacts-losses",
        quantity: "width of the contacts before the blow",
        title: "contacts 4 mm wide before the blow, losses that fall to those of ultrasound",
        settings: &[("losses", "0.24")],
        basis: Basis::Hypothetical,
        places: FLAT,
    },
    Unknown {
        name: "wide-glue-ultrasound",
        quantity: "width of the glue",
        title: "glue 6 mm wide, as stiff as for ultrasound",
        settings: &[("glue", "6 mm"), ("relaxing", "1e-9")],
        basis: Basis::Hypothetical,
        places: &[Place::Strips],
    },
    Unknown {
        name: "wide-glue-clear",
        quantity: "width of the glue",
        title: "the same, 50 µm of clearance",
        settings: &[("glue", "6 mm"), ("relaxing", "1e-9"), ("clearance", "50 um")],
        basis: Basis::Hypothetical,
        places: &[Place::Strips],
    },
];

impl Basis {
    /// A word for tables.
    pub fn word(self) -> &'static str {
        match self {
            Basis::Published => "published",
            Basis::Assumed => "assumed",
            Basis::Hypothetical => "hypothetical",
        }
    }
}

impl Ingredient {
    /// A place with the ingredients up to one of them.
    pub fn case(number: usize, place: Place, cells: usize) -> PaperCase {
        let mut settings: Vec<(&str, &str)> = Vec::new();
        for (key, value) in INGREDIENTS[..=number].iter().flat_map(|each| each.settings) {
            settings.retain(|(other, _)| other != key);
            settings.extend(value.map(|value| (*key, value)));
        }
        // With all of them it is the scene as it stands.
        if settings.is_empty() {
            return as_known(place, cells);
        }
        case((place.scene(), INGREDIENTS[number].name), cells, &settings)
    }
}

impl Unknown {
    /// What is run of it at a place.
    pub fn case(&self, place: Place, cells: usize) -> PaperCase {
        case((place.scene(), self.name), cells, self.settings)
    }
}

/// The experiment as it is known.
pub fn as_known(place: Place, cells: usize) -> PaperCase {
    case((place.scene(), "as-known"), cells, &[])
}

/// A scene at a number of cells across a disk with settings.
pub fn case((scene, label): (PaperScene, &str), cells: usize, settings: &[(&str, &str)]) -> PaperCase {
    let count = cells.to_string();
    let across = [("cells_per_diameter", count.as_str())];
    PaperCase::new(scene, &format!("{label}-n{cells}"), &[&across[..], settings].concat())
}
