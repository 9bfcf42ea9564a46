//! How alike the fringes of two runs are: the light in each disk, frame by frame.
//!
//! A frame is a picture of the scene's camera, whose exposure is in it. Each disk is looked at through a round window
//! that goes along with its centre of mass, at the same points in every run, so runs of disks of other sizes, or with
//! other frames around them, can be compared. Of two frames with light a_i and b_i at the points of all disks
//!
//! ```text
//! r = sum (a_i - mean a) (b_i - mean b) / sqrt(sum (a_i - mean a)^2 sum (b_i - mean b)^2)
//! ```
//!
//! is 1 where the patterns are the same but for the lamp's brightness and the film's contrast.

use crate::failure::Failure;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use stickslip::image::Image;
use stickslip::observe::{FringeRow, Results};
use stickslip::polariscope::{ImageWindow, linear_of_srgb};

/// What the camera saw of the disks of a run.
pub struct Sequence {
    /// Disks, from the striker on.
    pub disks: usize,
    frames: Vec<SeenFrame>,
}

/// A frame of a sequence.
struct SeenFrame {
    /// In transits.
    time: f64,
    picture: PathBuf,
    /// Light, 0 to 1, at the points of one disk after the other.
    light: Vec<f32>,
}

/// When the fringes of a run are most like several given frames, all times stretched by one factor: the paper matched
/// its frames so, with the times between them stretched alike.
///
/// ```text
/// t_k = offset + factor * (time of the k-th given frame),   mean of r over the frames largest
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// [-]
    pub factor: f64,
    /// In transits.
    pub offset: f64,
    /// Mean over the frames, at most 1.
    pub correlation: f64,
    /// Factors around it by which the mean correlation is less by 0.02 at most.
    pub range: [f64; 2],
}

/// When the fringes of a run are most like a given frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Likeness {
    /// In transits.
    pub time: f64,
    /// Correlation of the light in all disks then, at most 1.
    pub correlation: f64,
    /// The same time by each disk that has fringes in the given frame.
    pub by_disk: Vec<f64>,
}

/// Points across a disk.
const ACROSS: usize = 40;
/// Radius of the window over the disk's: at the rim pixels have light of what is beside it.
const WINDOW: f64 = 0.93;
/// Standard deviation of light in a disk with fringes.
const FRINGES: f64 = 0.1;
/// Factors that are tried, from the least on as far as a sequence goes, and offsets on either side of none.
const LEAST_FACTOR: f64 = 0.4;
const FACTOR_STEP: f64 = 0.01;
const OFFSETS: i32 = 5;
/// Mean correlation that a factor may have less than the best and count as good.
const PLATEAU: f64 = 0.02;

impl Sequence {
    /// What the camera of a run saw; `None` if it has none.
    ///
    /// # Errors
    /// A table or a picture cannot be read.
    pub fn new(results: &Results) -> Result<Option<Self>, Failure> {
        let scene = results.scene().map_err(Failure::input)?;
        let (Some(unit), Some(camera)) = (&scene.outputs.measurements.time_unit, &scene.outputs.fringes)
        else {
            return Ok(None);
        };
        let Some(view) = camera.view else { return Ok(None) };
        let window = ImageWindow::around(view, camera.width);
        let radius = 0.5 * scene.number("diameter");
        let mut tracks: BTreeMap<String, Vec<[f64; 3]>> = BTreeMap::new();
        for row in results.bodies_table().map_err(Failure::input)? {
            if row.body.starts_with("disk") {
                let [x, y, _] = row.state.position;
                tracks.entry(row.body).or_default().push([row.time, x, y]);
            }
        }
        let frame = |row: FringeRow| {
            let picture = results.fringe_picture(&row);
            let image = Image::read_png(&picture)
                .map_err(|error| Failure::Input(miette::miette!("{}: {error}", picture.display())))?;
            let centers = tracks.values().map(|track| at(track, row.time));
            let light = centers.flat_map(|center| through_window((&image, &window), center, radius));
            Ok(SeenFrame { time: row.time / unit.seconds, light: light.collect(), picture })
        };
        let rows = results.fringes_table().map_err(Failure::input)?;
        let frames = rows.into_par_iter().map(frame).collect::<Result<Vec<_>, Failure>>()?;
        Ok((!frames.is_empty() && !tracks.is_empty()).then_some(Sequence { disks: tracks.len(), frames }))
    }

    /// The picture nearest to a time in transits, as PNG, and its time.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn picture(&self, time: f64) -> Result<(f64, Vec<u8>), Failure> {
        let frame = self.nearest(time);
        let png = std::fs::read(&frame.picture)
            .map_err(|error| Failure::Input(miette::miette!("{}: {error}", frame.picture.display())))?;
        Ok((frame.time, png))
    }

    fn nearest(&self, time: f64) -> &SeenFrame {
        let off = |frame: &&SeenFrame| (frame.time - time).abs();
        let nearest = self.frames.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.expect("a sequence has frames")
    }

    /// Light at a time in transits, between the frames around it.
    fn light(&self, time: f64) -> Vec<f32> {
        let after = self.frames.partition_point(|frame| frame.time < time).min(self.frames.len() - 1);
        let [before, after] = [&self.frames[after.saturating_sub(1)], &self.frames[after]];
        let way = after.time - before.time;
        let share = if way > 0.0 { ((time - before.time) / way).clamp(0.0, 1.0) as f32 } else { 0.0 };
        before.light.iter().zip(&after.light).map(|(a, b)| a + share * (b - a)).collect()
    }

    /// When this sequence is most like another one at each of some times in transits, all times stretched by one factor
    /// and shifted by at most `clock`; `None` if it is never like it, it may still become more alike when it ends, or
    /// the disks are not as many.
    pub fn stretch(&self, other: &Sequence, times: &[f64], clock: f64) -> Option<Stretch> {
        if self.disks != other.disks {
            return None;
        }
        let alike: Vec<Vec<f64>> = times
            .iter()
            .map(|&time| {
                let given = other.light(time);
                self.frames.iter().map(|frame| correlation(&given, &frame.light)).collect()
            })
            .collect();
        let offsets = (-OFFSETS..=OFFSETS).map(|k| clock * f64::from(k) / f64::from(OFFSETS));
        let offsets: Vec<f64> = offsets.collect();
        // For each factor the best offset and the mean correlation by it, as far as the sequence goes.
        let mut found: Vec<Stretch> = Vec::new();
        for step in 0.. {
            let factor = LEAST_FACTOR + step as f64 * FACTOR_STEP;
            let mean = |offset: f64| {
                let each =
                    times.iter().zip(&alike).map(|(time, alike)| self.at(alike, offset + factor * time));
                Some(each.collect::<Option<Vec<f64>>>()?.iter().sum::<f64>() / times.len() as f64)
            };
            let best = offsets
                .iter()
                .filter_map(|&offset| {
                    Some(Stretch { factor, offset, correlation: mean(offset)?, range: [factor; 2] })
                })
                .max_by(|a, b| a.correlation.total_cmp(&b.correlation));
            match best {
                Some(best) => found.push(best),
                None if found.is_empty() && factor < 1.0 => {}
                None => break,
            }
        }
        let best = (0..found.len()).max_by(|&a, &b| found[a].correlation.total_cmp(&found[b].correlation))?;
        if best == 0 || best + 1 == found.len() || found[best].correlation <= 0.0 {
            return None;
        }
        let near = |stretch: &&Stretch| stretch.correlation >= found[best].correlation - PLATEAU;
        let low = found[..best].iter().rev().take_while(near).last().unwrap_or(&found[best]).factor;
        let high = found[best..].iter().take_while(near).last().unwrap_or(&found[best]).factor;
        Some(Stretch { range: [low, high], ..found[best].clone() })
    }

    /// A value of each frame at a time between frames; `None` beyond the first and the last.
    fn at(&self, values: &[f64], time: f64) -> Option<f64> {
        let after = self.frames.partition_point(|frame| frame.time < time);
        let (before, after) = (after.checked_sub(1)?, after);
        let [from, to] = [self.frames.get(before)?.time, self.frames.get(after)?.time];
        Some(values[before] + (time - from) / (to - from) * (values[after] - values[before]))
    }

    /// When this sequence is most like another one at a time in transits, between two times; `None` if that is at one
    /// of them, it was never like it at all, or the disks are not as many.
    pub fn most_like(&self, other: &Sequence, time: f64, within: [f64; 2]) -> Option<Likeness> {
        if self.disks != other.disks {
            return None;
        }
        let given = other.light(time);
        let whole = self.peak(&given, 0..given.len(), within)?;
        let points = given.len() / self.disks;
        let by_disk = (0..self.disks)
            .map(|disk| disk * points..(disk + 1) * points)
            .filter(|range| deviation(&given[range.clone()]) >= FRINGES)
            .filter_map(|range| self.peak(&given, range, within))
            .map(|[time, _]| time)
            .collect();
        Some(Likeness { time: whole[0], correlation: whole[1], by_disk })
    }

    /// Time and height of the highest correlation of some points with given light, between two times; the parabola
    /// through the frame and its neighbours says where between frames.
    fn peak(&self, given: &[f32], range: std::ops::Range<usize>, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
        let alike: Vec<[f64; 2]> = self
            .frames
            .iter()
            .filter(|frame| (from..=to).contains(&frame.time))
            .map(|frame| [frame.time, correlation(&given[range.clone()], &frame.light[range.clone()])])
            .collect();
        let best = (0..alike.len()).max_by(|&a, &b| alike[a][1].total_cmp(&alike[b][1]))?;
        if best == 0 || best + 1 == alike.len() || alike[best][1] <= 0.0 {
            return None;
        }
        let [before, [time, height], after] = [alike[best - 1], alike[best], alike[best + 1]];
        let bend = before[1] - 2.0 * height + after[1];
        let shift = if bend < 0.0 { 0.5 * (before[1] - after[1]) / bend } else { 0.0 };
        Some([time + shift * 0.5 * (after[0] - before[0]), height])
    }
}

impl Likeness {
    /// Standard deviation of the disks' times [transits]; not a number for fewer than two.
    pub fn spread(&self) -> f64 {
        let count = self.by_disk.len() as f64;
        let mean = self.by_disk.iter().sum::<f64>() / count;
        (self.by_disk.iter().map(|time| (time - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt()
    }
}

/// Place of a body at a time, between the rows of its track: time and place.
fn at(track: &[[f64; 3]], time: f64) -> [f64; 2] {
    let after = track.partition_point(|row| row[0] < time).clamp(1, track.len().max(2) - 1);
    let (Some([t0, x0, y0]), last) = (track.get(after - 1), track.get(after)) else { return [f64::NAN; 2] };
    let [t1, x1, y1] = last.unwrap_or(&track[after - 1]);
    let share = if t1 > t0 { ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
    [x0 + share * (x1 - x0), y0 + share * (y1 - y0)]
}

/// Light at points of a disk, between the four pixels around each.
fn through_window((image, window): (&Image, &ImageWindow), center: [f64; 2], radius: f64) -> Vec<f32> {
    let mut light = Vec::new();
    for row in 0..ACROSS {
        for column in 0..ACROSS {
            let [u, v] = [column, row].map(|k| (2.0 * k as f64 + 1.0) / ACROSS as f64 - 1.0);
            if u.hypot(v) <= 1.0 {
                let place = [center[0] + WINDOW * radius * u, center[1] + WINDOW * radius * v];
                light.push(light_at(image, window.pixel(place)) as f32);
            }
        }
    }
    light
}

fn light_at(image: &Image, pixel: [f64; 2]) -> f64 {
    let size = image.size;
    let low = [0, 1].map(|axis| (pixel[axis] - 0.5).clamp(0.0, size[axis] as f64 - 1.001));
    let first = low.map(|x| x as usize);
    let share = [low[0].fract(), low[1].fract()];
    let of = |x: usize, y: usize| linear_of_srgb(image.color(x.min(size[0] - 1), y.min(size[1] - 1))[1]);
    let along = |y: usize| (1.0 - share[0]) * of(first[0], y) + share[0] * of(first[0] + 1, y);
    (1.0 - share[1]) * along(first[1]) + share[1] * along(first[1] + 1)
}

fn mean(light: &[f32]) -> f64 {
    light.iter().map(|&x| f64::from(x)).sum::<f64>() / light.len() as f64
}

fn deviation(light: &[f32]) -> f64 {
    let mean = mean(light);
    (light.iter().map(|&x| (f64::from(x) - mean).powi(2)).sum::<f64>() / light.len() as f64).sqrt()
}

/// r; 0 where one of both has no pattern.
fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let means = [mean(a), mean(b)];
    let product: f64 =
        a.iter().zip(b).map(|(&x, &y)| (f64::from(x) - means[0]) * (f64::from(y) - means[1])).sum();
    let both = deviation(a) * deviation(b) * a.len() as f64;
    if both > 0.0 { product / both } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALWAYS: [f64; 2] = [0.0, f64::INFINITY];

    /// Two disks with rings that become more and narrower, at a speed; `lamp` is the brightness.
    fn rings(speed: f64, lamp: f32) -> Sequence {
        let window = ImageWindow::around([[0.0, 0.0], [2.0, 1.0]], 200);
        let frames = (0..80).map(|frame| {
            let time = 0.1 * f64::from(frame);
            let mut light = Vec::new();
            for center in [[0.5, 0.5], [1.5, 0.5]] {
                let mut image = Image::new(window.size, [0; 3]);
                for y in 0..window.size[1] {
                    for x in 0..window.size[0] {
                        let place = window.position(x, y);
                        let far = (place[0] - center[0]).hypot(place[1] - center[1]);
                        let grey = 255.0 * (0.5 + 0.5 * (8.0 * (1.0 + speed * time) * far).cos());
                        let first = 3 * (y * window.size[0] + x);
                        image.pixels[first..first + 3].fill(grey as u8);
                    }
                }
                light.extend(through_window((&image, &window), center, 0.5).iter().map(|x| lamp * x));
            }
            SeenFrame { time, picture: PathBuf::new(), light }
        });
        Sequence { disks: 2, frames: frames.collect() }
    }

    #[test]
    fn the_same_pattern_is_found_when_it_comes_later_and_in_other_light() {
        let (fast, slow) = (rings(1.0, 1.0), rings(0.8, 0.5));
        let alike = slow.most_like(&fast, 1.0, ALWAYS).expect("it is there");
        assert!((alike.time - 1.25).abs() < 0.01 && alike.correlation > 0.98, "{alike:?}");
        assert!(alike.by_disk.len() == 2 && alike.spread() < 1e-9, "{alike:?}");
        let itself = fast.most_like(&fast, 1.0, ALWAYS).expect("it is there");
        assert!((itself.time - 1.0).abs() < 0.02 && (itself.correlation - 1.0).abs() < 1e-12, "{itself:?}");
    }

    #[test]
    fn several_frames_have_one_stretch_of_time() {
        let (fast, slow) = (rings(1.0, 1.0), rings(0.8, 0.5));
        let stretch = slow.stretch(&fast, &[0.5, 1.5, 3.0], 0.0).expect("it is there");
        assert!((stretch.factor - 1.25).abs() < 0.011 && stretch.offset == 0.0, "{stretch:?}");
        assert!(
            stretch.range[0] <= 1.25 && stretch.range[1] >= 1.24 && stretch.correlation > 0.97,
            "{stretch:?}"
        );
        // The same a little later.
        let mut late = rings(0.8, 1.0);
        late.frames.iter_mut().for_each(|frame| frame.time += 0.3);
        let stretch = late.stretch(&fast, &[0.5, 1.5, 3.0], 0.5).expect("it is there");
        assert!((stretch.factor - 1.25).abs() < 0.02 && (stretch.offset - 0.3).abs() < 0.06, "{stretch:?}");
    }

    #[test]
    fn what_is_still_to_come_has_no_time() {
        let (fast, slow) = (rings(1.0, 1.0), rings(0.1, 1.0));
        assert_eq!(slow.most_like(&fast, 1.5, ALWAYS), None);
    }

    #[test]
    fn a_body_is_between_the_rows_of_its_track() {
        let track = [[0.0, 1.0, 2.0], [1.0, 3.0, 2.0], [2.0, 3.0, 4.0]];
        assert_eq!(at(&track, 0.5), [2.0, 2.0]);
        assert_eq!(at(&track, 1.5), [3.0, 3.0]);
        assert_eq!(at(&track, 9.0), [3.0, 4.0]);
        assert_eq!(at(&track[..1], 0.5), [1.0, 2.0]);
    }
}
