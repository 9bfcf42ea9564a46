//! Pictures of photoelastic fringes from a folder of results.

use crate::failure::Failure;
use crate::illustration::Pictures;
use crate::illustration::needs_whole_snapshots;
use crate::picture::{self, Setting};
use miette::miette;
use std::f64::consts::PI;
use stickslip::door::ParticleSnapshot;
use stickslip::image::Image;
use stickslip::observe::{ContactRow, Frame, RecordedBody, RecordedScene, Results};
use stickslip::polariscope::{self, ImageWindow, OpticalBench, Push, Stage};
use stickslip::scene::{Fringes, Light, Overlay, Polariscope, PolariscopeField, Sensitivity};

/// What the user wants of fringes; what is missing is as in the scene's `outputs.fringes`, or else usual.
#[derive(Clone, Debug, Default)]
pub struct FringeChoice {
    /// How much stress makes a fringe; without it and without a scene's, four fringes are in sight.
    pub sensitivity: Option<Sensitivity>,
    /// Wavelength [m].
    pub wavelength: Option<f64>,
    /// What unloaded bodies look like; dark.
    pub field: Option<PolariscopeField>,
    /// The light; grey.
    pub light: Option<Light>,
    /// Angle of the polariser [rad]; a circular polariscope.
    pub polarizer: Option<f64>,
    /// Snapshots in this time from each one's own on are averaged [s]; an instant.
    pub exposure: Option<f64>,
    /// Names of the birefringent bodies; all that are not rigid.
    pub bodies: Option<Vec<String>>,
    /// What is drawn over the fringes; nothing.
    pub overlay: Option<Overlay>,
    /// Width and height in pixels; the height follows what there is to see.
    pub size: Option<[usize; 2]>,
}

/// The fringes of a run, ready to be drawn: with one window and one scale for all pictures.
pub struct FramePictures {
    results: Results,
    setting: Setting,
    bench: OpticalBench,
    polariscope: Polariscope,
    exposure: f64,
    contacts: Vec<ContactRow>,
    /// Largest normal force of the run [N].
    largest: f64,
}

/// Width of a picture whose size the user does not give [pixels].
const WIDTH: usize = 1280;
/// Fringes in sight where nothing says how much stress makes one: in all but a hundredth of what the bodies cover.
const FRINGES: f64 = 4.0;
/// Snapshots that are looked at to find out.
const LOOKS: usize = 8;

impl FramePictures {
    /// Gets ready for pictures of some snapshots of a run.
    ///
    /// # Errors
    /// There are no snapshots or they cannot be read, or the user names a body that is not there.
    pub fn open(results: &Results, frames: &[Frame], choice: &FringeChoice) -> Result<Self, Failure> {
        needs_whole_snapshots(results)?;
        let scene = results.scene().map_err(Failure::input)?;
        let camera = scene.outputs.fringes.as_ref();
        let specimens = specimens(&scene, choice)?;
        // A run has hundreds of snapshots; a few show where the bodies are and how much they are loaded.
        let looks: Vec<&Frame> =
            frames.iter().step_by(frames.len().div_ceil(LOOKS).max(1)).chain(frames.last()).collect();
        let snapshots = looks.iter().map(|frame| results.particles(frame).map_err(Failure::input));
        let snapshots: Vec<ParticleSnapshot> = snapshots.collect::<Result<_, _>>()?;
        let view = camera.and_then(|camera| camera.view);
        let window = window(view, &snapshots, (&specimens, choice.size))?;
        let stage = Stage { window, specimens };
        let overlay = choice.overlay.or(camera.map(|camera| camera.overlay));
        let contacts = match overlay {
            Some(Overlay::ForceChains) => results.contacts_table().map_err(Failure::input)?,
            _ => Vec::new(),
        };
        let polariscope = polariscope(choice, camera, (&snapshots, &stage));
        Ok(FramePictures {
            results: results.clone(),
            setting: Setting::of(&scene),
            bench: OpticalBench::new(&polariscope, stage),
            polariscope,
            exposure: choice.exposure.or(camera.map(|camera| camera.exposure)).unwrap_or(0.0),
            largest: contacts.iter().fold(0.0, |largest, row| largest.max(row.mean.normal)),
            contacts,
        })
    }

    /// How much stress makes a fringe, for the user to read.
    pub fn scale(&self) -> String {
        match self.polariscope.sensitivity {
            Sensitivity::StressPerFringe(stress) => {
                format!("a fringe is {stress:.4e} Pa (stress parameter {:.4e} Pa)", stress / (2.0 * PI))
            }
            Sensitivity::StressThicknessPerFringe(fringe) => format!("a fringe is {fringe:.4e} Pa m"),
        }
    }

    /// Who presses on whom in the row of `contacts.csv` whose mean holds a time [s].
    fn pushes(&self, time: f64) -> Vec<Push> {
        let later = self.contacts.iter().map(|row| row.time).find(|row| *row >= time);
        let names = self.results.body_names();
        let body = |name: &str| names.iter().position(|known| known == name);
        let rows = self.contacts.iter().filter(|row| Some(row.time) == later);
        rows.filter_map(|row| {
            Some(Push { bodies: [body(&row.body_a)?, body(&row.body_b)?], force: row.mean.normal })
        })
        .collect()
    }
}

impl Pictures for FramePictures {
    fn picture(&self, frame: &Frame) -> Result<Image, Failure> {
        let mut film = self.bench.film();
        let particles = self.results.particles(frame).map_err(Failure::input)?;
        self.bench.expose(&particles, &mut film);
        let open = |other: &&Frame| other.time > frame.time && other.time <= frame.time + self.exposure;
        for other in self.results.frames().iter().filter(open) {
            self.bench.expose(&self.results.particles(other).map_err(Failure::input)?, &mut film);
        }
        let mut image = film.develop();
        let Stage { window, specimens } = self.bench.stage();
        let links = polariscope::links(&particles, &self.pushes(frame.time), specimens);
        polariscope::draw_links(&mut image, window, (&links, self.largest));
        Ok(picture::headed(&image, &self.setting, frame.time)?)
    }
}

/// Indices of the birefringent bodies.
fn specimens(scene: &RecordedScene, choice: &FringeChoice) -> Result<Vec<usize>, Failure> {
    let names: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    if let Some(wanted) = &choice.bodies {
        let find = |name: &String| {
            let missing = || miette!("--bodies: found `{name}`; allowed: {}", names.join(", "));
            names.iter().position(|known| known == name).ok_or_else(|| Failure::Input(missing()))
        };
        return wanted.iter().map(find).collect();
    }
    let birefringent = |body: &RecordedBody| match &scene.outputs.fringes {
        Some(camera) => camera.bodies.contains(&body.name),
        None => !body.is_rigid(),
    };
    Ok((0..names.len()).filter(|&i| birefringent(&scene.bodies[i])).collect())
}

/// What the pictures show: the scene's own view, or the birefringent bodies wherever they go.
fn window(
    view: Option<[[f64; 2]; 2]>,
    snapshots: &[ParticleSnapshot],
    (specimens, size): (&[usize], Option<[usize; 2]>),
) -> Result<ImageWindow, Failure> {
    let seen = snapshots.iter().filter_map(|particles| polariscope::bounds(particles, specimens));
    let bounds = view.or_else(|| seen.reduce(polariscope::joined));
    let nothing =
        || Failure::Input(miette!("there is nothing to draw: the snapshots hold no birefringent body"));
    let bounds = bounds.ok_or_else(nothing)?;
    let Some([width, height]) = size else { return Ok(ImageWindow::around(bounds, WIDTH)) };
    let height = height.saturating_sub(picture::HEADING).max(16);
    Ok(ImageWindow::fitted_into(bounds, [width, height]))
}

fn polariscope(
    choice: &FringeChoice,
    camera: Option<&Fringes>,
    (snapshots, stage): (&[ParticleSnapshot], &Stage),
) -> Polariscope {
    let own = camera.map(|camera| camera.polariscope);
    let sensitivity = choice.sensitivity.or(own.map(|own| own.sensitivity));
    Polariscope {
        sensitivity: sensitivity.unwrap_or_else(|| few_fringes(snapshots, stage)),
        wavelength: choice.wavelength.or(own.map(|own| own.wavelength)).unwrap_or(Polariscope::MERCURY_GREEN),
        field: choice.field.or(own.map(|own| own.field)).unwrap_or(PolariscopeField::Dark),
        light: choice.light.or(own.map(|own| own.light)).unwrap_or(Light::Grey),
        polarizer: choice.polarizer.or(own.and_then(|own| own.polarizer)),
    }
}

/// The sensitivity at which [`FRINGES`] are in sight.
fn few_fringes(snapshots: &[ParticleSnapshot], stage: &Stage) -> Sensitivity {
    let mut differences: Vec<f64> = Vec::new();
    for particles in snapshots {
        let maps = polariscope::stress_maps(particles, &stage.window);
        for map in maps.iter().filter(|map| stage.specimens.contains(&map.body)) {
            let rays = map.rays.iter().filter(|ray| ray.coverage > 0.5);
            differences.extend(rays.map(polariscope::Ray::principal_difference));
        }
    }
    differences.sort_unstable_by(f64::total_cmp);
    let high = differences.get(differences.len() * 99 / 100).copied().unwrap_or(0.0);
    Sensitivity::StressPerFringe(if high > 0.0 { high / FRINGES } else { 1.0 })
}

/// The sensitivity that the constants of an experiment give in a scene of so many dimensions: those of
/// `--stress-optic-coefficient` [1/Pa] and `--thickness` [m].
///
/// # Errors
/// A plane scene needs a thickness, one in space has its own.
pub fn material_sensitivity(
    [coefficient, wavelength]: [f64; 2],
    thickness: Option<f64>,
    dimension: usize,
) -> Result<Sensitivity, Failure> {
    let fringe = wavelength / coefficient;
    match thickness {
        Some(thickness) if dimension == 2 => Ok(Sensitivity::StressPerFringe(fringe / thickness)),
        None if dimension == 3 => Ok(Sensitivity::StressThicknessPerFringe(fringe)),
        Some(_) => Err(Failure::Input(miette!(
            "--thickness: the scene is 3d, where light crosses the bodies as thick as they are; leave it out"
        ))),
        None => Err(Failure::Input(miette!(
            "--stress-optic-coefficient: the scene is plane; give the thickness of the bodies with --thickness"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plane_scenes_need_a_thickness_and_others_have_one() {
        let constants = [5e-12, 500e-9];
        let plane = material_sensitivity(constants, Some(0.01), 2).unwrap();
        assert_eq!(plane, Sensitivity::StressPerFringe(500e-9 / 5e-12 / 0.01));
        let space = material_sensitivity(constants, None, 3).unwrap();
        assert_eq!(space, Sensitivity::StressThicknessPerFringe(500e-9 / 5e-12));
        assert!(material_sensitivity(constants, None, 2).is_err());
        assert!(material_sensitivity(constants, Some(0.01), 3).is_err());
    }
}
