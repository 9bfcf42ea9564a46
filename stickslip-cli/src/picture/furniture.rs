//! What stands around the bodies in a picture: title, time, colour bar, names, axes,
//! a scale and the directions of space.

use super::arrows::{Arrows, Outline, round_below};
use super::camera::{Camera, unit};
use super::plane::PlaneView;
use super::{Legend, PicturePart, Rgb, Setting};
use crate::drawing::{Background, DrawError, Ink, SAMPLES, axis_prefix, label, prefix, ticks};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// What lines and letters are drawn with.
pub struct Pen<'a> {
    ink: Ink<'a>,
    color: RGBColor,
    /// For lines that are to step back.
    faint: RGBColor,
}

impl<'a> Pen<'a> {
    /// A pen that can be seen on a background.
    pub fn new(ink: Ink<'a>, background: Background) -> Self {
        let [color, faint] = match background.is_dark() {
            false => [RGBColor(70, 74, 80), RGBColor(205, 208, 212)],
            true => [RGBColor(214, 218, 224), RGBColor(84, 88, 94)],
        };
        Pen { ink, color, faint }
    }

    fn size(&self) -> [i32; 2] {
        let (width, height) = self.ink.dim_in_pixel();
        [width as i32, height as i32]
    }

    /// Letters as a picture uses them.
    fn letters(&self, size: i32, anchor: (HPos, VPos)) -> TextStyle<'static> {
        ("sans-serif", size * PIXEL).into_font().color(&self.color).pos(Pos::new(anchor.0, anchor.1))
    }

    fn write(&self, text: &str, at: (i32, i32), style: TextStyle<'static>) -> Result<(), DrawError> {
        // The line's box has room below for letters that hang; its middle is above the middle of the digits.
        let drop = if matches!(style.pos.v_pos, VPos::Center) { 3 * PIXEL / 2 } else { 0 };
        let at = (at.0, at.1 + drop);
        self.ink.draw(&Text::new(text.to_owned(), at, style)).map_err(DrawError::ink)
    }

    fn line(&self, from: (i32, i32), to: (i32, i32), color: RGBColor) -> Result<(), DrawError> {
        let style = color.stroke_width(PIXEL as u32);
        self.ink.draw(&PathElement::new(vec![from, to], style)).map_err(DrawError::ink)
    }
}

/// Colour of lines along which a column is the same.
pub const ISOLINE: Rgb = [0.1, 0.11, 0.13];

/// Lengths of furniture are given in pixels of the file; this is one in pixels as drawn.
const PIXEL: i32 = SAMPLES as i32;

fn fill(color: Rgb) -> ShapeStyle {
    let [r, g, b] = color.map(|c| (c * 255.0 + 0.5) as u8);
    RGBColor(r, g, b).filled()
}

/// The scene's title on the left, time on the right.
pub fn heading(
    pen: &Pen,
    setting: &Setting,
    time: f64,
    shows: impl Fn(PicturePart) -> bool,
) -> Result<(), DrawError> {
    let [width, _] = pen.size();
    if shows(PicturePart::Title) {
        let bold = FontDesc::new(FontFamily::SansSerif, f64::from(17 * PIXEL), FontStyle::Bold);
        let bold = bold.color(&pen.color).pos(Pos::new(HPos::Left, VPos::Center));
        pen.write(&setting.title, (20 * PIXEL, 24 * PIXEL), bold)?;
    }
    if !shows(PicturePart::Time) {
        return Ok(());
    }
    // One unit for all pictures of a run.
    let unit = axis_prefix(setting.end, "s");
    let time = format!("t = {:.3} {}s", time / unit.factor, unit.letter);
    let style = pen.letters(16, (HPos::Right, VPos::Center));
    pen.write(&time, (width - 20 * PIXEL, 24 * PIXEL), style)
}

/// The colour bar, with the isolines' levels, or the names of the bodies, in the column that ends at the right edge.
pub fn legend(pen: &Pen, (legend, levels): (&Legend, &[f64]), column: i32) -> Result<(), DrawError> {
    let draw_box = |place: [(i32, i32); 2], color: Rgb| {
        pen.ink.draw(&Rectangle::new(place, fill(color))).map_err(DrawError::ink)
    };
    match legend {
        Legend::Bar { scale, title, unit } => {
            let (left, top) = (column + 8 * PIXEL, 92 * PIXEL);
            let height = (pen.size()[1] - 200 * PIXEL).clamp(80 * PIXEL, 420 * PIXEL);
            let [low, high] = scale.range;
            for row in 0..height {
                let value = high - (high - low) * f64::from(row) / f64::from(height - 1);
                let place = [(left, top + row), (left + 16 * PIXEL, top + row + 1)];
                draw_box(place, scale.color(value))?;
            }
            for level in levels {
                let y = top + ((high - level) / (high - low) * f64::from(height - 1)).round() as i32;
                draw_box([(left, y - PIXEL / 2), (left + 16 * PIXEL, y + PIXEL / 2)], ISOLINE)?;
            }
            let size = axis_prefix(low.abs().max(high.abs()), unit);
            let shown = [low / size.factor, high / size.factor];
            for tick in ticks(shown, 6) {
                let share = (shown[1] - tick) / (shown[1] - shown[0]);
                let y = top + (share * f64::from(height - 1)).round() as i32;
                pen.line((left + 16 * PIXEL, y), (left + 20 * PIXEL, y), pen.color)?;
                let at = (left + 24 * PIXEL, y);
                pen.write(&label(tick, shown, 6), at, pen.letters(13, (HPos::Left, VPos::Center)))?;
            }
            let small = || pen.letters(13, (HPos::Left, VPos::Bottom));
            pen.write(title, (left, top - 26 * PIXEL), small())?;
            let unit = if unit.is_empty() { String::new() } else { format!("[{}{unit}]", size.letter) };
            pen.write(&unit, (left, top - 8 * PIXEL), small())
        }
        Legend::Names(names) => {
            for (row, (name, color)) in names.iter().enumerate() {
                let (left, top) = (column + 8 * PIXEL, (64 + 24 * row as i32) * PIXEL);
                draw_box([(left, top), (left + 14 * PIXEL, top + 14 * PIXEL)], *color)?;
                let at = (left + 21 * PIXEL, top + 7 * PIXEL);
                pen.write(name, at, pen.letters(13, (HPos::Left, VPos::Center)))?;
            }
            Ok(())
        }
    }
}

/// Arrows of the plane, whose area has its corner at `(left, top)`.
pub fn arrows(pen: &Pen, arrows: &Arrows, (left, top): (i32, i32)) -> Result<(), DrawError> {
    for ends in &arrows.each {
        let ends = ends.map(|[x, y]| [x + f64::from(left), y + f64::from(top)]);
        arrow(pen, ends)?;
    }
    Ok(())
}

/// An arrow of a speed [m/s] and of the length that says so [drawn pixels], in the column that ends at the right edge.
pub fn arrow_legend(pen: &Pen, [speed, length]: [f64; 2], column: i32) -> Result<(), DrawError> {
    if length <= 0.0 {
        return Ok(());
    }
    let (left, y) = (column + 8 * PIXEL, pen.size()[1] - 66 * PIXEL);
    arrow(pen, [[f64::from(left), f64::from(y)], [f64::from(left) + length, f64::from(y)]])?;
    let size = prefix(speed);
    let text = format!("{} {}m/s", (speed / size.factor).round(), size.letter);
    pen.write(&text, (left, y - 8 * PIXEL), pen.letters(13, (HPos::Left, VPos::Bottom)))
}

/// A dark arrow with a pale rim, to be seen on any colour.
fn arrow(pen: &Pen, ends: [[f64; 2]; 2]) -> Result<(), DrawError> {
    let shape = Outline::new(ends, 1.8 * SAMPLES as f64).corners();
    let shape: Vec<(i32, i32)> = shape.iter().map(|[x, y]| (x.round() as i32, y.round() as i32)).collect();
    let rim = RGBColor(244, 246, 248).stroke_width(PIXEL as u32);
    let closed = shape.iter().chain(&shape[..1]).copied().collect::<Vec<_>>();
    pen.ink.draw(&PathElement::new(closed, rim)).map_err(DrawError::ink)?;
    pen.ink.draw(&Polygon::new(shape, RGBColor(24, 26, 30).filled())).map_err(DrawError::ink)
}

/// Axes around the window of a plane scene, whose corner stands at `(left, top)`.
pub fn axes(pen: &Pen, window: &PlaneView, (left, top): (i32, i32)) -> Result<(), DrawError> {
    let [width, height] = window.size.map(|side| side as i32);
    let (right, bottom) = (left + width, top + height);
    for (from, to) in [
        ((left, top), (right, top)),
        ((right, top), (right, bottom)),
        ((left, bottom), (right, bottom)),
        ((left, top), (left, bottom)),
    ] {
        pen.line(from, to, pen.faint)?;
    }
    let count = |length: i32| (length / (90 * PIXEL)).clamp(2, 10) as usize;
    let ends = [window.low, window.high].concat();
    let size = axis_prefix(ends.iter().fold(0.0, |largest, end| end.abs().max(largest)), "m");
    let range = |axis: usize| [window.low[axis] / size.factor, window.high[axis] / size.factor];
    let (range_x, marks) = (range(0), count(width));
    for tick in ticks(range_x, marks) {
        let x = left + window.pixel([tick * size.factor, window.low[1]])[0].round() as i32;
        pen.line((x, bottom), (x, bottom + 5 * PIXEL), pen.color)?;
        let at = (x, bottom + 8 * PIXEL);
        pen.write(&label(tick, range_x, marks), at, pen.letters(13, (HPos::Center, VPos::Top)))?;
    }
    let (range_y, marks) = (range(1), count(height));
    for tick in ticks(range_y, marks) {
        let y = top + window.pixel([window.low[0], tick * size.factor])[1].round() as i32;
        pen.line((left - 5 * PIXEL, y), (left, y), pen.color)?;
        let at = (left - 8 * PIXEL, y);
        pen.write(&label(tick, range_y, marks), at, pen.letters(13, (HPos::Right, VPos::Center)))?;
    }
    let at = ((left + right) / 2, bottom + 28 * PIXEL);
    let unit = size.letter;
    pen.write(&format!("x [{unit}m]"), at, pen.letters(14, (HPos::Center, VPos::Top)))?;
    let turned = ("sans-serif", 14 * PIXEL).into_font().transform(FontTransform::Rotate270);
    let turned = turned.color(&pen.color).pos(Pos::new(HPos::Center, VPos::Center));
    pen.write(&format!("y [{unit}m]"), (left - 48 * PIXEL, (top + bottom) / 2), turned)
}

/// A length to measure with, whose right end is given; `scale` is in drawn pixels a metre.
pub fn scale_bar(pen: &Pen, scale: f64, (right, y): (i32, i32)) -> Result<(), DrawError> {
    let length = round_below(0.16 * f64::from(pen.size()[0]) / scale);
    let pixels = (length * scale).round() as i32;
    let bar = [(right - pixels, y - 2 * PIXEL), (right, y + 2 * PIXEL)];
    pen.ink.draw(&Rectangle::new(bar, pen.color.filled())).map_err(DrawError::ink)?;
    let size = prefix(length);
    let text = format!("{} {}m", (length / size.factor).round(), size.letter);
    let at = (right - pixels / 2, y - 6 * PIXEL);
    pen.write(&text, at, pen.letters(13, (HPos::Center, VPos::Bottom)))
}

/// The directions of space, at the lower left.
pub fn triad(pen: &Pen, camera: &Camera) -> Result<(), DrawError> {
    let colors = [RGBColor(200, 60, 60), RGBColor(60, 150, 70), RGBColor(60, 90, 200)];
    let length = f64::from(34 * PIXEL);
    let center = (56 * PIXEL, pen.size()[1] - 56 * PIXEL);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| unit(a).dot(camera.toward).total_cmp(&unit(b).dot(camera.toward)));
    for axis in order {
        let direction = unit(axis);
        let tip = |reach: f64| {
            let (x, y) = (direction.dot(camera.right), direction.dot(camera.up));
            (center.0 + (reach * x).round() as i32, center.1 - (reach * y).round() as i32)
        };
        let style = colors[axis].stroke_width(2 * PIXEL as u32);
        pen.ink.draw(&PathElement::new(vec![center, tip(length)], style)).map_err(DrawError::ink)?;
        let flat = direction.dot(camera.toward).abs() > 0.98;
        if !flat {
            let style = ("sans-serif", 14 * PIXEL).into_font().color(&colors[axis]);
            let style = style.pos(Pos::new(HPos::Center, VPos::Center));
            pen.write(["x", "y", "z"][axis], tip(length * 1.32), style)?;
        }
    }
    Ok(())
}
