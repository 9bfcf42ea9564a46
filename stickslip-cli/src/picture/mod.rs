//! Pictures of particles, drawn without a display.

mod camera;
mod furniture;
mod grains;
mod light;
mod plane;
mod quantity;
#[cfg(test)]
mod sample;
mod setting;
mod splat;
mod surface;

pub use camera::Viewpoint;
pub use grains::{Quarters, quarters};
pub use quantity::{ColorQuantity, QuantityParser, determinant};
pub use setting::{Floor, Setting, SymmetryPlane};

use crate::drawing::{Canvas, DrawError, Rgb, SAMPLES, Scale, body_color};
use camera::{Camera, Point, unit};
use grains::Grain;
use light::Lit;
use plane::{DrawnGrains, PlaneView};
use stickslip::door::ParticleSnapshot;
use stickslip::image::Image;
use stickslip::tensor::Vector;

/// How a picture is to look.
#[derive(Clone, Debug)]
pub struct PictureStyle {
    /// What colour stands for.
    pub quantity: ColorQuantity,
    /// The colours of values.
    pub scale: Scale,
    /// Where the camera stands; plane scenes are always seen from the front.
    pub view: Viewpoint,
    /// Where the other half of the scene is drawn.
    pub mirror: Option<SymmetryPlane>,
    /// Width and height in pixels; without them, the height follows the scene.
    pub size: Option<[usize; 2]>,
    /// The part of space to show, mirror image left out; without it, everything there is.
    pub bounds: Option<BoxCorners>,
}

/// A box along the axes: lower and upper corner [m].
pub type BoxCorners = [[f64; 3]; 2];

/// What the colours mean.
enum Legend {
    /// Values between two ends.
    Bar { scale: Scale, title: String, unit: String },
    /// One colour a body.
    Names(Vec<(String, Rgb)>),
}

/// Width of a picture whose size the user does not give [pixels].
const WIDTH: usize = 1280;
/// Space above the bodies, and for the legend on the right [pixels].
pub const HEADING: usize = 48;
const COLUMN: usize = 130;
/// Contrast of light where colours stand for values, which shadows must not falsify.
const VALUE_CONTRAST: f64 = 0.6;
/// Colour of what rests and is everywhere, in pictures of values.
const FLOOR: Rgb = [0.86; 3];
/// More bodies than this are not named.
const MOST_NAMES: usize = 12;

/// Draws a snapshot.
///
/// # Errors
/// There are no particles.
pub fn draw(
    particles: &ParticleSnapshot,
    setting: &Setting,
    quarters: &Quarters,
    (time, look): (f64, &PictureStyle),
) -> Result<Canvas, DrawError> {
    if particles.body.is_empty() {
        return Err(DrawError::Empty("the snapshot has no particles".to_owned()));
    }
    let mut grains = grains::grains(particles, &look.quantity, &look.scale, quarters);
    if let Some(mirror) = look.mirror {
        grains = grains::mirrored(grains, mirror);
    }
    let extent = extent(&grains, look);
    let legend = legend(particles, setting, look);
    let mut canvas = if particles.dimension == 2 {
        let shown: Vec<Grain> =
            grains.iter().filter(|grain| !setting.has_floor(grain.body)).copied().collect();
        let floors = (look.mirror.is_none() && !shown.is_empty()).then_some(&setting.floors[..]);
        let grains = if floors.is_some() { &shown } else { &grains };
        plane_picture(grains, (&extent, floors.unwrap_or_default()), look, &legend)?
    } else {
        space_picture(&grains, &extent, (look, setting), &legend)?
    };
    furniture::heading(&canvas.ink(), setting, time)?;
    Ok(canvas)
}

/// An image under the scene's title and the time.
///
/// # Errors
/// The title cannot be drawn.
pub fn headed(image: &Image, setting: &Setting, time: f64) -> Result<Image, DrawError> {
    let mut canvas = Canvas::new([image.size[0], HEADING], SAMPLES);
    furniture::heading(&canvas.ink(), setting, time)?;
    let Image { size: [width, height], mut pixels } = canvas.image();
    pixels.extend(&image.pixels);
    Ok(Image { size: [width, height + image.size[1]], pixels })
}

/// Points that the picture must hold: the corners of the user's box, or of every particle's.
fn extent(grains: &[Grain], look: &PictureStyle) -> Vec<Point> {
    let corners = |low: [f64; 3], high: [f64; 3]| {
        (0..8).map(move |i| Vector::from_fn(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] }))
    };
    let around = |grain: &Grain| {
        let half = 0.5 * grain.size();
        corners(grain.position.map(|x| x - half), grain.position.map(|x| x + half))
    };
    match look.bounds {
        Some(bounds) => {
            let [low, high] = look.mirror.map_or(bounds, |mirror| widened(bounds, mirror));
            corners(low, high).collect()
        }
        None => grains.iter().flat_map(around).collect(),
    }
}

/// Lengths of the projection of some points on a direction: lower and upper end [m].
fn span(points: &[Point], direction: Point) -> [f64; 2] {
    points.iter().fold([f64::MAX, f64::MIN], |[low, high], point| {
        let along = point.dot(direction);
        [low.min(along), high.max(along)]
    })
}

/// The smallest box around all particles with their sizes [m].
pub fn bounds(particles: &ParticleSnapshot) -> BoxCorners {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for (x, volume) in particles.position.iter().zip(&particles.volume) {
        let half = 0.5 * if particles.dimension == 2 { volume.sqrt() } else { volume.cbrt() };
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(x[axis] - half);
            bounds[1][axis] = bounds[1][axis].max(x[axis] + half);
        }
    }
    bounds
}

/// The box with its mirror image.
fn widened(mut bounds: BoxCorners, mirror: SymmetryPlane) -> BoxCorners {
    let ends = [bounds[0][mirror.axis], bounds[1][mirror.axis]];
    for end in ends {
        let image = 2.0 * mirror.position - end;
        bounds[0][mirror.axis] = bounds[0][mirror.axis].min(image);
        bounds[1][mirror.axis] = bounds[1][mirror.axis].max(image);
    }
    bounds
}

fn legend(particles: &ParticleSnapshot, setting: &Setting, look: &PictureStyle) -> Legend {
    if look.quantity != ColorQuantity::Body {
        let (title, unit) = look.quantity.label(particles);
        return Legend::Bar { scale: look.scale, title, unit };
    }
    let count = particles.body.iter().max().map_or(0, |last| *last as usize + 1);
    let shown = if count > MOST_NAMES { 0 } else { count };
    Legend::Names((0..shown).map(|body| (setting.body_name(body), body_color(body))).collect())
}

/// Pixels of the picture and of the room for the bodies in it: (left, top, right, bottom) margins go off.
fn room(look: &PictureStyle, margins: [usize; 4], aspect: f64) -> [[usize; 2]; 2] {
    let [left, top, right, bottom] = margins;
    let size = look.size.unwrap_or_else(|| {
        let height = ((WIDTH - left - right) as f64 / aspect).clamp(280.0, 800.0) as usize;
        [WIDTH, height + top + bottom]
    });
    let inner = [size[0].saturating_sub(left + right), size[1].saturating_sub(top + bottom)];
    [size, inner.map(|side| side.max(16))]
}

fn plane_picture(
    grains: &[Grain],
    (extent, floors): (&[Point], &[Floor]),
    look: &PictureStyle,
    legend: &Legend,
) -> Result<Canvas, DrawError> {
    let spans = [0, 1].map(|axis| span(extent, unit(axis)));
    let extent = spans.map(|[low, high]| (high - low).max(1e-9));
    let margins = [78, HEADING, COLUMN, 56];
    let [size, inner] = room(look, margins, extent[0] / extent[1]);
    let mut canvas = Canvas::new(size, SAMPLES);
    let inner = inner.map(|side| side * SAMPLES);
    let scale = [0, 1].map(|axis| inner[axis] as f64 / (1.04 * extent[axis]));
    let scale = scale[0].min(scale[1]);
    let half = [0, 1].map(|axis| 0.5 * inner[axis] as f64 / scale);
    let middle = spans.map(|[low, high]| 0.5 * (low + high));
    let window = PlaneView {
        low: [middle[0] - half[0], middle[1] - half[1]],
        high: [middle[0] + half[0], middle[1] + half[1]],
        size: inner,
    };
    let [left, top] = [margins[0] * SAMPLES, margins[1] * SAMPLES];
    let drawn = DrawnGrains::new(grains, &window);
    let floor = |x: usize, y: usize| {
        let place = window.place([x as f64 + 0.5, y as f64 + 0.5]);
        let body = floors.iter().find(|floor| floor.holds(place))?.body;
        Some(if look.quantity == ColorQuantity::Body { body_color(body as usize) } else { FLOOR })
    };
    canvas.paint([left, top, inner[0], inner[1]], |x, y| drawn.color(x, y).or_else(|| floor(x, y)));
    let ink = canvas.ink();
    furniture::axes(&ink, &window, (left as i32, top as i32))?;
    furniture::legend(&ink, legend, (left + inner[0]) as i32 + 8 * SAMPLES as i32)?;
    drop(ink);
    Ok(canvas)
}

fn space_picture(
    grains: &[Grain],
    extent: &[Point],
    (look, setting): (&PictureStyle, &Setting),
    legend: &Legend,
) -> Result<Canvas, DrawError> {
    let camera = Camera::new(look.view, setting);
    let [width, height] = [camera.right, camera.up].map(|direction| {
        let [low, high] = span(extent, direction);
        (high - low).max(1e-9)
    });
    let margins = [24, HEADING, COLUMN, 24];
    let [size, inner] = room(look, margins, width / height);
    let mut canvas = Canvas::new(size, SAMPLES);
    let area = [margins[0], margins[1], inner[0], inner[1]].map(|length| (length * SAMPLES) as f64);
    let camera = camera.fit(extent.iter().copied(), area);
    let balls = surface::surface(grains);
    let contrast = if look.quantity == ColorQuantity::Body { 1.0 } else { VALUE_CONTRAST };
    let lit = Lit::new(grains, &balls, camera, canvas.size, contrast);
    let [width, height] = canvas.size;
    canvas.paint([0, 0, width, height], |x, y| lit.color(x, y));
    let ink = canvas.ink();
    furniture::legend(&ink, legend, (width - COLUMN * SAMPLES) as i32)?;
    furniture::triad(&ink, &camera)?;
    furniture::scale_bar(&ink, &camera)?;
    drop(ink);
    Ok(canvas)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::save;

    fn look(quantity: ColorQuantity, particles: &ParticleSnapshot) -> PictureStyle {
        let count = particles.body.len();
        let values: Vec<f64> = (0..count).map(|i| quantity.value(particles, i)).collect();
        PictureStyle {
            scale: quantity.scale(&values),
            quantity,
            view: Viewpoint::Auto,
            mirror: None,
            size: None,
            bounds: None,
        }
    }

    fn setting(gravity: [f64; 3], center: [f64; 3]) -> Setting {
        Setting {
            title: "A sphere rolls down a slab".to_owned(),
            end: 2.0,
            gravity,
            bodies: vec!["sphere".to_owned(), "slab".to_owned()],
            round: vec![Some(center), None],
            mirrors: vec![SymmetryPlane { axis: 1, position: -2.0 }],
            floors: Vec::new(),
        }
    }

    /// Colours that cover over a hundredth of the drawn pixels, other than white.
    fn inked_share(canvas: &Canvas) -> f64 {
        let inked = canvas.pixels.chunks(3).filter(|rgb| rgb.iter().any(|c| *c < 250)).count();
        inked as f64 / (canvas.pixels.len() / 3) as f64
    }

    #[test]
    fn every_quantity_has_a_picture_in_the_plane_and_in_space() {
        let folder = tempfile::tempdir().unwrap();
        let keep = std::env::var_os("STICKSLIP_TEST_PICTURES").map(std::path::PathBuf::from);
        for dimension in [2, 3] {
            let particles = sample::ball_on_slab(dimension, if dimension == 2 { 0.05 } else { 0.1 });
            let mut gravity = [5.0, 0.0, 0.0];
            gravity[dimension - 1] = -8.0;
            let mut center = [-1.0, 0.0, 0.0];
            center[dimension - 1] = 1.0;
            let setting = setting(gravity, center);
            let quarters = quarters(&particles, &setting);
            for quantity in [ColorQuantity::Body, ColorQuantity::Velocity, ColorQuantity::Pressure] {
                let look = look(quantity.clone(), &particles);
                let canvas = draw(&particles, &setting, &quarters, (0.5, &look)).unwrap();
                let share = inked_share(&canvas);
                assert!(share > 0.15 && share < 0.95, "{dimension} {quantity:?} {share}");
                let path = keep.as_deref().unwrap_or(folder.path());
                save(&canvas.image(), &path.join(format!("{dimension}_{quantity:?}.png"))).unwrap();
            }
        }
    }

    #[test]
    fn a_snapshot_without_particles_is_an_error() {
        let nothing = ParticleSnapshot { dimension: 3, ..ParticleSnapshot::default() };
        let look = look(ColorQuantity::Body, &nothing);
        let drawn = draw(&nothing, &Setting::default(), &Quarters::default(), (0.0, &look));
        assert!(matches!(drawn, Err(DrawError::Empty(_))));
    }
}
