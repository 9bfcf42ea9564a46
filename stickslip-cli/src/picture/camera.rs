//! A camera at infinity: parallel projection, so that lengths across the view can be read off.

use super::setting::Setting;
use std::str::FromStr;
use stickslip::tensor::{Vector, cross};

/// Position or direction in space.
pub type Point = Vector<f64, 3>;

/// Where the camera stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// From the front, to the right and above, with gravity pointing down.
    Auto,
    /// On an axis: which, and on its negative side or not.
    Axis(usize, bool),
    /// Turned about the vertical and raised above the horizontal, in degrees; (0, 0) is the front.
    Angles(f64, f64),
}

/// A view that cannot be understood.
#[derive(Debug, thiserror::Error)]
#[error(
    "found `{0}`; allowed: auto, x, -x, y, -y, z, -z, or two angles in degrees such as 30,20, or several of these for a film, such as 0,20:90,20:90,60"
)]
pub struct UnknownView(String);

impl FromStr for Viewpoint {
    type Err = UnknownView;

    fn from_str(text: &str) -> Result<Self, UnknownView> {
        let axis = |name: &str| ["x", "y", "z"].iter().position(|axis| *axis == name);
        let unknown = || UnknownView(text.to_owned());
        if text == "auto" {
            return Ok(Viewpoint::Auto);
        }
        if let Some(axis) = axis(text.trim_start_matches('-')) {
            return Ok(Viewpoint::Axis(axis, text.starts_with('-')));
        }
        let (azimuth, elevation) = text.split_once(',').ok_or_else(unknown)?;
        let angle = |text: &str| text.trim().parse::<f64>().ok().filter(|angle| angle.is_finite());
        match (angle(azimuth), angle(elevation)) {
            (Some(azimuth), Some(elevation)) => Ok(Viewpoint::Angles(azimuth, elevation)),
            _ => Err(unknown()),
        }
    }
}

/// One place of the camera, or several that it passes at even pace.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewPath(pub Vec<Viewpoint>);

impl FromStr for ViewPath {
    type Err = UnknownView;

    fn from_str(text: &str) -> Result<Self, UnknownView> {
        let views: Vec<Viewpoint> = text.split(':').map(str::parse).collect::<Result<_, _>>()?;
        let turns = |view: &Viewpoint| matches!(view, Viewpoint::Angles(..));
        if views.len() > 1 && !views.iter().all(turns) {
            return Err(UnknownView(text.to_owned()));
        }
        Ok(ViewPath(views))
    }
}

impl ViewPath {
    /// The place after a share of the way, 0 to 1.
    pub fn at(&self, share: f64) -> Viewpoint {
        let way = share.clamp(0.0, 1.0) * (self.0.len() - 1) as f64;
        let leg = (way as usize).min(self.0.len().saturating_sub(2));
        match (self.0[leg], self.0.get(leg + 1)) {
            (Viewpoint::Angles(a, e), Some(&Viewpoint::Angles(b, f))) => {
                let part = way - leg as f64;
                Viewpoint::Angles(a + part * (b - a), e + part * (f - e))
            }
            (view, _) => view,
        }
    }

    /// Whether the camera moves.
    pub fn is_path(&self) -> bool {
        self.0.len() > 1
    }
}

/// Maps positions in metres to places in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Right in the image, unit length.
    pub right: Point,
    /// Up in the image, unit length.
    pub up: Point,
    /// Out of the image towards the eye, unit length.
    pub toward: Point,
    /// Pixels per metre.
    pub scale: f64,
    /// Pixel of the origin of space, from the left and from the top.
    pub origin: [f64; 2],
}

impl Camera {
    /// A camera that looks in a direction of the user's choice; [`Camera::fit`] moves it to where things are.
    pub fn new(view: Viewpoint, setting: &Setting) -> Self {
        let up = vertical(setting);
        let front = front(setting, up);
        let side = Vector(cross(up.0, front.0));
        let toward = match view {
            Viewpoint::Auto => from_angles([front, side, up], 16.0, 18.0),
            Viewpoint::Angles(azimuth, elevation) => from_angles([front, side, up], azimuth, elevation),
            Viewpoint::Axis(axis, negative) => unit(axis) * if negative { -1.0 } else { 1.0 },
        };
        Camera::facing(toward, up)
    }

    /// A camera that the direction `toward` leads to, held so that `up` points up as far as it can.
    pub fn facing(toward: Point, up: Point) -> Self {
        let fallback = if toward[1].abs() < 0.9 { unit(1) } else { unit(0) };
        let right = Vector(cross(up.0, toward.0)).direction().filter(|_| toward.dot(up).abs() < 0.999_9);
        let right = right.or_else(|| Vector(cross(fallback.0, toward.0)).direction());
        let right = right.expect("the fallback is not along the view");
        Camera { right, up: Vector(cross(toward.0, right.0)), toward, scale: 1.0, origin: [0.0; 2] }
    }

    /// The camera moved and zoomed so that these points fill a rectangle (left, top, width, height) in pixels.
    pub fn fit(mut self, points: impl IntoIterator<Item = Point>, area: [f64; 4]) -> Self {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for point in points {
            for (i, value) in [point.dot(self.right), point.dot(self.up)].into_iter().enumerate() {
                low[i] = low[i].min(value);
                high[i] = high[i].max(value);
            }
        }
        let [left, top, width, height] = area;
        let extent = |i: usize| (high[i] - low[i]).max(1e-9);
        self.scale = (width / extent(0)).min(height / extent(1));
        self.origin = [
            left + 0.5 * width - self.scale * 0.5 * (low[0] + high[0]),
            top + 0.5 * height + self.scale * 0.5 * (low[1] + high[1]),
        ];
        self
    }

    /// The camera zoomed so that so many metres across the view fill a rectangle (left, top, width, height) in pixels,
    /// whose middle stays where it is.
    pub fn scaled(mut self, [wide, high]: [f64; 2], [left, top, width, height]: [f64; 4]) -> Self {
        let middle = [left + 0.5 * width, top + 0.5 * height];
        let scale = (width / wide).min(height / high);
        let factor = scale / self.scale;
        self.origin = [0, 1].map(|i| middle[i] + factor * (self.origin[i] - middle[i]));
        self.scale = scale;
        self
    }

    /// Pixels from the left and from the top, and metres towards the eye.
    pub fn project(&self, point: Point) -> [f64; 3] {
        [
            self.origin[0] + self.scale * point.dot(self.right),
            self.origin[1] - self.scale * point.dot(self.up),
            point.dot(self.toward),
        ]
    }

    /// The point that [`Camera::project`] puts there.
    pub fn unproject(&self, [x, y, depth]: [f64; 3]) -> Point {
        self.right * ((x - self.origin[0]) / self.scale)
            + self.up * ((self.origin[1] - y) / self.scale)
            + self.toward * depth
    }
}

/// The unit vector along an axis.
pub fn unit(axis: usize) -> Point {
    Vector::from_fn(|i| f64::from(u8::from(i == axis)))
}

/// Against gravity; z without gravity.
fn vertical(setting: &Setting) -> Point {
    (-Vector(setting.gravity)).direction().unwrap_or(unit(2))
}

/// The horizontal direction in which the viewer stands: across the axis that is a mirror,
/// else against y (against z if y is up).
fn front(setting: &Setting, up: Point) -> Point {
    let across = |axis: usize| (unit(axis) - up * up[axis]).direction();
    let mirror = setting.only_mirror().and_then(|mirror| across(mirror.axis));
    let sideways = if up[1].abs() > 0.8 { unit(2) } else { -unit(1) };
    let sideways = (sideways - up * up.dot(sideways)).direction();
    let front = mirror.or(sideways).unwrap_or(unit(0));
    // Axis x runs from left to right where it can.
    let right = cross(up.0, front.0);
    if right[0] < -1e-9 { -front } else { front }
}

/// The direction at an azimuth and an elevation [degrees] from the front.
fn from_angles([front, side, up]: [Point; 3], azimuth: f64, elevation: f64) -> Point {
    let (azimuth, elevation) = (azimuth.to_radians(), elevation.to_radians());
    (front * azimuth.cos() + side * azimuth.sin()) * elevation.cos() + up * elevation.sin()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_read_as_they_are_written() {
        assert_eq!("-y".parse::<Viewpoint>().unwrap(), Viewpoint::Axis(1, true));
        assert_eq!("30,-5".parse::<Viewpoint>().unwrap(), Viewpoint::Angles(30.0, -5.0));
        assert!("above".parse::<Viewpoint>().unwrap_err().to_string().contains("`above`"));
        assert!("1,inf".parse::<Viewpoint>().is_err());
    }

    #[test]
    fn a_path_is_passed_at_even_pace() {
        let path: ViewPath = "0,20:90,20:90,60".parse().unwrap();
        let at = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| path.at(share));
        let angles = [(0.0, 20.0), (45.0, 20.0), (90.0, 20.0), (90.0, 40.0), (90.0, 60.0)];
        assert_eq!(at, angles.map(|(azimuth, elevation)| Viewpoint::Angles(azimuth, elevation)));
        let still: ViewPath = "-x".parse().unwrap();
        assert_eq!((still.at(0.7), still.is_path()), (Viewpoint::Axis(0, true), false));
        assert!("auto:30,20".parse::<ViewPath>().is_err() && "30,20:".parse::<ViewPath>().is_err());
    }

    #[test]
    fn a_zoom_keeps_the_middle() {
        let camera = Camera::new(Viewpoint::Auto, &Setting::default());
        let area = [10.0, 20.0, 300.0, 200.0];
        let camera = camera.fit([unit(0), unit(1), -unit(2)], area);
        let middle = camera.unproject([160.0, 120.0, 0.0]);
        let zoomed = camera.scaled([6.0, 1.0], area);
        assert!((zoomed.scale - 50.0).abs() < 1e-9);
        let [x, y, _] = zoomed.project(middle);
        assert!((x - 160.0).abs() < 1e-9 && (y - 120.0).abs() < 1e-9);
    }

    #[test]
    fn unproject_undoes_project() {
        let setting = Setting { gravity: [7.0, 0.0, -7.0], ..Setting::default() };
        let camera = Camera::new(Viewpoint::Auto, &setting);
        let camera = camera.fit([unit(0), unit(1), -unit(2)], [10.0, 20.0, 300.0, 200.0]);
        let point = Vector([0.3, -0.2, 0.9]);
        assert!((camera.unproject(camera.project(point)) - point).norm() < 1e-12);
    }

    #[test]
    fn every_axis_can_be_looked_along() {
        for axis in 0..3 {
            let camera = Camera::new(Viewpoint::Axis(axis, false), &Setting::default());
            assert!((camera.right.norm() - 1.0).abs() < 1e-12);
            assert!((Vector(cross(camera.right.0, camera.up.0)) - camera.toward).norm() < 1e-12);
        }
    }

    #[test]
    fn x_runs_to_the_right() {
        let setting = Setting { gravity: [7.0, 0.0, -7.0], ..Setting::default() };
        assert!(Camera::new(Viewpoint::Auto, &setting).right[0] > 0.0);
    }
}
