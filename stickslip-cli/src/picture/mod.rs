//! Pictures of particles, drawn without a display.

mod arrows;
mod band;
mod between;
mod camera;
mod carried;
mod field;
mod floor;
mod furniture;
mod grains;
mod light;
mod model;
mod outlines;
mod plane;
mod quantity;
#[cfg(test)]
mod sample;
mod setting;
mod skins;
mod smooth;
mod splat;
mod subject;
mod surface;

pub use camera::{ViewPath, Viewpoint};
pub use grains::{Quarters, quarters};
pub use outlines::Outlines;
pub use quantity::{ColorQuantity, QuantityParser, determinant};
pub use setting::{Floor, Setting, SymmetryPlane};
pub use skins::Skins;
pub use subject::Subject;

use crate::drawing::{Background, Canvas, DrawError, Rgb, SAMPLES, Scale, body_color, without_background};
use arrows::Arrows;
use camera::{Camera, Point, unit};
use clap::ValueEnum;
use field::{PixelField, Source};
use floor::Slabs;
use furniture::Pen;
use grains::Grain;
use light::{Lit, Surroundings, Tint};
use plane::{DrawnGrains, KnownShapes, PlaneView};
use skins::Mesh;
use std::sync::Arc;
use stickslip::door::ParticleSnapshot;
use stickslip::image::Image;
use stickslip::surface::model::Model;
use stickslip::tensor::Vector;

/// How a picture is to look.
#[derive(Clone, Debug)]
pub struct PictureStyle {
    /// The colours of values.
    pub scale: Scale,
    /// Where the camera stands; plane scenes are always seen from the front.
    pub view: Viewpoint,
    /// Where the other half of the scene is drawn.
    pub mirror: Option<SymmetryPlane>,
    /// Width and height in pixels; without them, the height follows the scene.
    pub size: Option<[usize; 2]>,
    /// The part of space that there is in all pictures, mirror image left out; without it, what there is in this one.
    pub bounds: Option<BoxCorners>,
    /// The part of space to show; in the plane nothing else is.
    pub window: Option<BoxCorners>,
    /// The views of all pictures, if they differ: bodies have one size in all.
    pub path: Vec<Viewpoint>,
    /// What the picture stands on.
    pub background: Background,
    /// How many lines are drawn along which the values are the same.
    pub contours: usize,
    /// Velocities are drawn as arrows, of which the longest stands for so much [m/s].
    pub fastest: Option<f64>,
    /// What is left out.
    pub hidden: Vec<PicturePart>,
    /// Surfaces of bodies in space, which are balls where there are none.
    pub skins: Option<Arc<Skins>>,
    /// Shapes of bodies in the plane, which are their particles' squares where there are none.
    pub outlines: Option<Arc<Outlines>>,
}

impl PictureStyle {
    fn shows(&self, part: PicturePart) -> bool {
        !self.hidden.contains(&part)
    }
}

/// What stands around the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PicturePart {
    /// The scene's title
    Title,
    /// The time
    Time,
    /// The axes of a plane scene, which has a scale bar then, and the directions of space
    Axes,
    /// The colours, the bodies' names and the arrow of velocities
    Legend,
    /// The length to measure with
    ScaleBar,
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
/// Space where nothing stands [pixels].
const EDGE: usize = 12;
/// Contrast of light where colours stand for values, which shadows must not falsify.
const VALUE_CONTRAST: f64 = 0.6;
/// Colour of what rests and is everywhere, in pictures of values.
const FLOOR: Rgb = [0.86; 3];
/// More bodies than this are not named.
const MOST_NAMES: usize = 12;

/// Isolines are so wide [pixels of the file].
const ISOLINE_WIDTH: f64 = 1.3;

/// Draws a snapshot.
///
/// # Errors
/// There are no particles.
pub fn draw(
    subject: &Subject,
    setting: &Setting,
    quarters: &Quarters,
    (time, look): (f64, &PictureStyle),
) -> Result<Image, DrawError> {
    let on = |color: [u8; 3]| Ok(canvas(subject, setting, quarters, (time, look, color))?.image());
    let images: Result<Vec<Image>, DrawError> = look.background.colors().into_iter().map(on).collect();
    let mut images = images?;
    Ok(match &images[..] {
        [on_white, on_black] => without_background(on_white, on_black),
        _ => images.remove(0),
    })
}

/// Draws a snapshot on a background of one colour.
fn canvas(
    subject: &Subject,
    setting: &Setting,
    quarters: &Quarters,
    (time, look, background): (f64, &PictureStyle, [u8; 3]),
) -> Result<Canvas, DrawError> {
    let particles = subject.particles;
    if particles.body.is_empty() {
        return Err(DrawError::Empty("the snapshot has no particles".to_owned()));
    }
    let colors = match subject.quantity {
        ColorQuantity::Body => grains::quartered(particles, quarters),
        _ => subject.values.iter().map(|value| look.scale.color(*value)).collect(),
    };
    let mut grains = grains::grains(particles, &colors);
    let mut floors = setting.floors.clone();
    if let Some(mirror) = look.mirror {
        grains = grains::mirrored(grains, mirror);
        floors.extend(setting.floors.iter().map(|floor| floor.mirrored(mirror)));
    }
    let extent = extent(&grains, look);
    let legend = legend(subject, setting, look);
    // Particles of half-spaces are only where other bodies are.
    let has_others = grains.iter().any(|grain| !setting.has_floor(grain.body));
    if !has_others {
        floors.clear();
    }
    let scene = Scene { subject, setting, look, background, legend };
    let mut canvas = if particles.dimension == 2 {
        scene.plane_picture(&grains, &extent, &floors)?
    } else {
        scene.space_picture(&grains, extent, &floors)?
    };
    let pen = Pen::new(canvas.ink(), look.background);
    furniture::heading(&pen, setting, time, |part| look.shows(part))?;
    drop(pen);
    Ok(canvas)
}

/// An image under the scene's title and the time.
///
/// # Errors
/// The title cannot be drawn.
pub fn headed(image: &Image, setting: &Setting, time: f64) -> Result<Image, DrawError> {
    let mut canvas = Canvas::new([image.size[0], HEADING], SAMPLES);
    let pen = Pen::new(canvas.ink(), Background::Color([255; 3]));
    furniture::heading(&pen, setting, time, |_| true)?;
    drop(pen);
    let Image { size: [width, height], mut pixels, .. } = canvas.image();
    pixels.extend(&image.pixels);
    Ok(Image::opaque([width, height + image.size[1]], pixels))
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
    match look.window.map(|window| (window, None)).or(look.bounds.map(|bounds| (bounds, look.mirror))) {
        Some((bounds, mirror)) => {
            let [low, high] = mirror.map_or(bounds, |mirror| widened(bounds, mirror));
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

fn legend(subject: &Subject, setting: &Setting, look: &PictureStyle) -> Legend {
    let particles = subject.particles;
    if *subject.quantity != ColorQuantity::Body {
        let (title, unit) = subject.quantity.label(particles);
        return Legend::Bar { scale: look.scale, title, unit };
    }
    let count = particles.body.iter().max().map_or(0, |last| *last as usize + 1);
    let shown = if count > MOST_NAMES { 0 } else { count };
    Legend::Names((0..shown).map(|body| (setting.body_name(body), body_color(body))).collect())
}

/// A snapshot and how it is to be drawn.
struct Scene<'a> {
    subject: &'a Subject<'a>,
    setting: &'a Setting,
    look: &'a PictureStyle,
    background: [u8; 3],
    legend: Legend,
}

impl Scene<'_> {
    /// Width of the furniture: left, top, right, bottom [pixels].
    fn margins(&self) -> [usize; 4] {
        let shows = |part| self.look.shows(part);
        let heading = shows(PicturePart::Title) || shows(PicturePart::Time);
        let top = if heading { HEADING } else { EDGE };
        let right = if shows(PicturePart::Legend) { COLUMN } else { EDGE };
        if self.subject.particles.dimension == 3 {
            return [24, top, right, 24];
        }
        let [left, bottom] = if shows(PicturePart::Axes) { [78, 56] } else { [EDGE; 2] };
        [left, top, right, bottom]
    }

    /// Pixels of the picture and of the room for the bodies in it.
    fn room(&self, margins: [usize; 4], aspect: f64) -> [[usize; 2]; 2] {
        let [left, top, right, bottom] = margins;
        let is_window = self.look.window.is_some() && self.subject.particles.dimension == 2;
        // Nothing beside a window is shown.
        let fitted = |[width, height]: [usize; 2]| {
            let wide = (height as f64 * aspect).round() as usize;
            let high = (width as f64 / aspect).round() as usize;
            if wide < width { [wide.max(16), height] } else { [width, high.max(16)] }
        };
        let [size, inner] = match self.look.size {
            Some(size) => {
                let inner = [size[0].saturating_sub(left + right), size[1].saturating_sub(top + bottom)];
                let inner = inner.map(|side| side.max(16));
                [size, if is_window { fitted(inner) } else { inner }]
            }
            None => {
                let width = WIDTH - left - right;
                let height = ((width as f64 / aspect).clamp(280.0, 800.0)) as usize;
                let inner = if is_window { fitted([width, height]) } else { [width, height] };
                [[inner[0] + left + right, inner[1] + top + bottom], inner]
            }
        };
        [size, inner]
    }

    fn plane_picture(
        &self,
        grains: &[Grain],
        extent: &[Point],
        floors: &[Floor],
    ) -> Result<Canvas, DrawError> {
        let Scene { subject, look, .. } = self;
        let spans = [0, 1].map(|axis| span(extent, unit(axis)));
        let extent = spans.map(|[low, high]| (high - low).max(1e-9));
        let margins = self.margins();
        let [size, inner] = self.room(margins, extent[0] / extent[1]);
        let mut canvas = Canvas::colored(size, SAMPLES, self.background);
        let inner = inner.map(|side| side * SAMPLES);
        let spare = if look.window.is_some() { 1.0 } else { 1.04 };
        let scale = [0, 1].map(|axis| inner[axis] as f64 / (spare * extent[axis]));
        let scale = scale[0].min(scale[1]);
        let half = [0, 1].map(|axis| 0.5 * inner[axis] as f64 / scale);
        let middle = spans.map(|[low, high]| 0.5 * (low + high));
        let window = PlaneView {
            low: [middle[0] - half[0], middle[1] - half[1]],
            high: [middle[0] + half[0], middle[1] + half[1]],
            size: inner,
        };
        let [left, top] = [margins[0] * SAMPLES, margins[1] * SAMPLES];
        let outlines = look.outlines.as_ref();
        let known = KnownShapes {
            posed: outlines.map_or_else(Vec::new, |all| all.posed(subject.particles, look.mirror)),
            carried: outlines.map_or_else(Vec::new, |all| all.carried(subject.particles, look.mirror)),
            hidden: floors.iter().map(|floor| floor.body).collect(),
        };
        let drawn = DrawnGrains::new(grains, &window, &known);
        let own = if look.contours > 0 && subject.smoother().is_none() {
            Some(subject::smoother(subject.particles, subject.quantity))
        } else {
            None
        };
        let velocities = look.fastest.map(|fastest| (fastest, subject::velocities(subject.particles)));
        let count = drawn.count(look.mirror.is_some());
        let source = |smoother| Source { smoother, quantity: subject.quantity, count, mirror: look.mirror };
        let field = subject.smoother().or(own.as_ref());
        let field = field.map(|smoother| PixelField::new(&drawn, &window, &source(smoother)));
        let shaded = field.as_ref().filter(|_| subject.smoother().is_some());
        let color = |grain: &Grain, pixel: [usize; 2]| {
            let value = shaded.and_then(|field| field.value(grain.body, pixel));
            value.map_or(grain.color, |value| look.scale.color(value))
        };
        let floor = |x: usize, y: usize| {
            let place = window.place([x as f64 + 0.5, y as f64 + 0.5]);
            let body = floors.iter().find(|floor| floor.holds(place))?.body;
            Some(if *subject.quantity == ColorQuantity::Body { body_color(body as usize) } else { FLOOR })
        };
        canvas.paint([left, top, inner[0], inner[1]], |x, y| {
            drawn.color(x, y, |grain| color(grain, [x, y])).or_else(|| floor(x, y))
        });
        let levels = field::levels(look.scale.range, look.contours);
        if let Some(field) = &field {
            isolines(&mut canvas, (field, &levels), [left, top]);
        }
        let arrows = velocities.as_ref().map_or_else(Arrows::default, |(fastest, smoother)| {
            arrows::arrows(&drawn, &window, &source(smoother), *fastest)
        });
        let pen = Pen::new(canvas.ink(), look.background);
        let corner = (left as i32, top as i32);
        furniture::arrows(&pen, &arrows, corner)?;
        let column = (left + inner[0]) as i32 + 8 * SAMPLES as i32;
        if look.shows(PicturePart::Axes) {
            furniture::axes(&pen, &window, corner)?;
        } else if look.shows(PicturePart::ScaleBar) {
            let end = [inner[0] + left, inner[1] + top].map(|side| side as i32 - 12 * SAMPLES as i32);
            furniture::scale_bar(&pen, window.scale(), (end[0], end[1]))?;
        }
        if look.shows(PicturePart::Legend) {
            furniture::legend(&pen, (&self.legend, &levels), column)?;
            furniture::arrow_legend(&pen, arrows.legend, column)?;
        }
        drop(pen);
        Ok(canvas)
    }

    fn space_picture(
        &self,
        grains: &[Grain],
        mut extent: Vec<Point>,
        floors: &[Floor],
    ) -> Result<Canvas, DrawError> {
        let Scene { subject, setting, look, .. } = self;
        let camera = Camera::new(look.view, setting);
        let around = self.around(grains);
        let slabs = Slabs::new(floors, &camera, around);
        if look.window.is_none() {
            let others =
                look.path.iter().map(|view| Slabs::new(floors, &Camera::new(*view, setting), around));
            let corners: Vec<Point> =
                others.flat_map(|slabs| slabs.corners()).chain(slabs.corners()).collect();
            extent.extend(corners);
        }
        let reach = |camera: &Camera| {
            [camera.right, camera.up].map(|direction| {
                let [low, high] = span(&extent, direction);
                (high - low).max(1e-9)
            })
        };
        let all = look.path.iter().map(|view| reach(&Camera::new(*view, setting)));
        let [width, height] = all.fold(reach(&camera), |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let margins = self.margins();
        let [size, inner] = self.room(margins, width / height);
        let mut canvas = Canvas::colored(size, SAMPLES, self.background);
        let area = [margins[0], margins[1], inner[0], inner[1]].map(|length| length * SAMPLES);
        let mut camera = camera.fit(extent.iter().copied(), area.map(|length| length as f64));
        if !look.path.is_empty() {
            camera = camera.scaled([width, height], area.map(|length| length as f64));
        }
        let radius = surface::COVERING * grains.iter().map(Grain::size).sum::<f64>() / grains.len() as f64;
        let mesh = mesh(subject, look);
        let surfaces = mesh.bodies();
        let is_ball = |grain: &&Grain| {
            !surfaces.contains(&grain.body) && (floors.is_empty() || !setting.has_floor(grain.body))
        };
        let grains: Vec<Grain> = grains.iter().filter(is_ball).copied().collect();
        let grains = &grains[..];
        let balls = surface::surface(grains);
        let is_body = *subject.quantity == ColorQuantity::Body;
        let tint = if is_body { Tint::Bodies(setting.round.clone()) } else { Tint::Values(look.scale) };
        let surroundings = Surroundings {
            mesh,
            tint,
            radius,
            slabs,
            slab_color: (!is_body).then_some(FLOOR),
            contrast: if is_body { 1.0 } else { VALUE_CONTRAST },
            mirrored: look.mirror.is_some(),
        };
        let lit = Lit::new(grains, &balls, camera, canvas.size, surroundings);
        let [width, height] = canvas.size;
        let shown = if look.window.is_some() { area } else { [0, 0, width, height] };
        canvas.paint(shown, |x, y| lit.color(x + shown[0], y + shown[1]));
        let levels = field::levels(look.scale.range, look.contours);
        let own = (look.contours > 0 && subject.smoother().is_none())
            .then(|| subject::smoother(subject.particles, subject.quantity));
        let count = if look.mirror.is_some() { grains.len() / 2 } else { grains.len() };
        let source = |smoother| Source { smoother, quantity: subject.quantity, count, mirror: look.mirror };
        if let Some(smoother) = subject.smoother().or(own.as_ref()).filter(|_| look.contours > 0) {
            let field = PixelField::of_surfaces(&lit, shown, &source(smoother));
            isolines(&mut canvas, (&field, &levels), [0, 0]);
        }
        if let Some(fastest) = look.fastest {
            let velocities = subject::velocities(subject.particles);
            let arrows = arrows::space_arrows((&lit, &camera), shown, &source(&velocities), fastest);
            arrows::draw_space_arrows(&mut canvas, &arrows, &lit);
        }
        let pen = Pen::new(canvas.ink(), look.background);
        if look.shows(PicturePart::Legend) {
            let column = (width - COLUMN * SAMPLES) as i32;
            furniture::legend(&pen, (&self.legend, &levels), column)?;
            furniture::arrow_legend(&pen, arrows::legend(look.fastest.unwrap_or_default()), column)?;
        }
        if look.shows(PicturePart::Axes) {
            furniture::triad(&pen, &camera)?;
        }
        if look.shows(PicturePart::ScaleBar) {
            let edge = 24 * SAMPLES as i32;
            furniture::scale_bar(&pen, camera.scale, (width as i32 - edge, height as i32 - edge))?;
        }
        drop(pen);
        Ok(canvas)
    }

    /// The box around all that there is, whatever of it the picture shows.
    fn around(&self, grains: &[Grain]) -> [Point; 2] {
        let whole = PictureStyle { window: None, ..self.look.clone() };
        let points = extent(grains, &whole);
        let spans = [0, 1, 2].map(|axis| span(&points, unit(axis)));
        [0, 1].map(|end| Vector(spans.map(|span| span[end])))
    }
}

/// Draws the lines along which a field has some values, in an area whose corner stands at `(left, top)`.
fn isolines(canvas: &mut Canvas, (field, levels): (&PixelField, &[f64]), [left, top]: [usize; 2]) {
    for [from, to] in levels.iter().flat_map(|level| field.isolines(*level)) {
        // Close enough to run into one another.
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let steps = (2.0 * dx.hypot(dy)).ceil().max(1.0) as usize;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let at = [from[0] + share * dx + left as f64, from[1] + share * dy + top as f64];
            canvas.dot(at, 0.5 * ISOLINE_WIDTH * SAMPLES as f64, furniture::ISOLINE);
        }
    }
}

/// The surfaces of bodies, with mirror images where the user wants them.
fn mesh(subject: &Subject, look: &PictureStyle) -> Mesh {
    let Some(skins) = &look.skins else { return Mesh::default() };
    let Subject { particles, quantity, values, .. } = subject;
    let fitted = |body: u32, place: [f64; 3]| {
        subject.smoother().and_then(|smoother| smoother.at(body, place)).map(|parts| quantity.value_of(parts))
    };
    let mesh = skins.mesh(particles, values, fitted);
    match look.mirror {
        Some(mirror) => mesh.mirrored(mirror),
        None => mesh,
    }
}

/// The surfaces of bodies in a snapshot in space at a time [s].
pub fn model(subject: &Subject, setting: &Setting, (time, look): (f64, &PictureStyle)) -> Model {
    model::model(&mesh(subject, look), (subject, setting), (time, look))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::save;

    pub fn look(subject: &Subject) -> PictureStyle {
        PictureStyle {
            scale: subject.quantity.scale(&subject.values),
            view: Viewpoint::Auto,
            mirror: None,
            size: None,
            bounds: None,
            window: None,
            path: Vec::new(),
            background: Background::Color([255; 3]),
            contours: 0,
            fastest: None,
            hidden: Vec::new(),
            skins: None,
            outlines: None,
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
    fn inked_share(image: &Image) -> f64 {
        let inked = image.pixels.chunks(3).filter(|rgb| rgb.iter().any(|c| *c < 250)).count();
        inked as f64 / (image.pixels.len() / 3) as f64
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
                let subject = Subject::new(&particles, &quantity, true);
                let look = look(&subject);
                let image = draw(&subject, &setting, &quarters, (0.5, &look)).unwrap();
                let share = inked_share(&image);
                assert!(share > 0.15 && share < 0.95, "{dimension} {quantity:?} {share}");
                let path = keep.as_deref().unwrap_or(folder.path());
                save(&image, &path.join(format!("{dimension}_{quantity:?}.png"))).unwrap();
            }
        }
    }

    /// Pixels, column and row, in which two pictures differ.
    fn differing(a: &Image, b: &Image) -> Vec<[usize; 2]> {
        let [width, height] = a.size;
        let all = (0..width * height).map(|place| [place % width, place / width]);
        all.filter(|&[x, y]| a.color(x, y) != b.color(x, y)).collect()
    }

    /// A ball of radius 1 that rolls on a slab, from the side, where its vx is 2 m/s (1 + height over its centre), as
    /// balls and by its surface.
    #[test]
    fn isolines_and_arrows_lie_on_what_the_camera_sees() {
        let particles = sample::ball_on_slab(3, 0.1);
        let setting = Setting { round: vec![None; 2], ..setting([0.0, 0.0, -9.81], [-1.0, 0.0, 1.0]) };
        let quantity = ColorQuantity::Vx;
        let text = r#"
            space = { dimension = "3d", interior = "grid", cell = 0.2 }
            time.end = 1
            materials.rubber = { density = 1, neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 } }
            bodies = [{ name = "ball", material = "rubber", shape.ball = { center = [-1, 0, 1], radius = 1 } },
                { name = "slab", material = "rubber", shape.box = { min = [-3, -2, -0.5], max = [3, 2, 0] } }]
        "#;
        let scene =
            stickslip::scene::parse("a.toml", text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
        let skins = Some(Arc::new(Skins::new(&scene, &particles)));
        for skins in [None, skins] {
            let subject = Subject::new(&particles, &quantity, false);
            let plain = PictureStyle {
                scale: quantity.scale_between([0.0, 4.0]),
                view: Viewpoint::Axis(1, true),
                size: Some([700, 400]),
                hidden: PicturePart::value_variants().to_vec(),
                skins,
                ..look(&subject)
            };
            let picture =
                |look: &PictureStyle| draw(&subject, &setting, &Quarters::default(), (0.5, look)).unwrap();
            let (bare, lines) = (picture(&plain), picture(&PictureStyle { contours: 3, ..plain.clone() }));
            let different = differing(&bare, &lines);
            // The ball is left of the middle; it ends at height 2.
            let is_ball = |x: usize, y: usize| bare.color(x, y) != [255; 3];
            let top = (0..400).find(|&y| (0..700).any(|x| is_ball(x, y))).unwrap();
            let middle: Vec<usize> = (0..700).filter(|&x| is_ball(x, top + 1)).collect();
            let middle = middle[middle.len() / 2];
            let rows: Vec<usize> = different.iter().filter(|[x, _]| *x == middle).map(|[_, y]| *y).collect();
            let groups: Vec<&[usize]> = rows.chunk_by(|a, b| b - a <= 2).collect();
            let heights: Vec<f64> =
                groups.iter().map(|rows| rows.iter().sum::<usize>() as f64 / rows.len() as f64).collect();
            let [first, second, third] = heights[..] else { panic!("three lines: {heights:?}") };
            let half = (third - first) / 2.0;
            assert!((second - first - half).abs() < 2.0, "vx of 3, 2 and 1 m/s: {heights:?}");
            assert!((first - top as f64 - half).abs() < 0.1 * half, "{top} {heights:?}");

            let arrows = picture(&PictureStyle { fastest: Some(1.0), ..plain.clone() });
            let different = differing(&bare, &arrows);
            assert!(different.len() > 1000, "{}", different.len());
            // The slab is at rest, and in front of arrows that point down behind it.
            let slab = top as f64 + 4.0 * half;
            assert!(different.iter().all(|[_, y]| (*y as f64) < slab + 2.0));
            // Without it they are seen: they reach below the ball.
            let ball = particles.only(|body, _| body == 0);
            let alone = Subject::new(&ball, &quantity, false);
            let around = PictureStyle { bounds: Some(bounds(&particles)), ..plain };
            let picture =
                |look: &PictureStyle| draw(&alone, &setting, &Quarters::default(), (0.5, look)).unwrap();
            let bare = picture(&around);
            let different = differing(&bare, &picture(&PictureStyle { fastest: Some(1.0), ..around }));
            assert!(different.iter().any(|[_, y]| *y as f64 > slab + 4.0));
        }
    }

    #[test]
    fn a_snapshot_without_particles_is_an_error() {
        let nothing = ParticleSnapshot { dimension: 3, ..ParticleSnapshot::default() };
        let subject = Subject::new(&nothing, &ColorQuantity::Body, true);
        let look = look(&subject);
        let drawn = draw(&subject, &Setting::default(), &Quarters::default(), (0.0, &look));
        assert!(matches!(drawn, Err(DrawError::Empty(_))));
    }
}
