//! What stands around the bodies in a picture: title, time, colour bar, names, axes,
//! a scale and the directions of space.

use super::camera::{Camera, unit};
use super::plane::PlaneView;
use super::{Legend, Rgb, Setting};
use crate::drawing::{DrawError, Ink, SAMPLES, axis_prefix, label, prefix, ticks};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const GREY: RGBColor = RGBColor(70, 74, 80);
const LIGHT: RGBColor = RGBColor(205, 208, 212);

/// Lengths of furniture are given in pixels of the file; this is one in pixels as drawn.
const PIXEL: i32 = SAMPLES as i32;

/// Letters as a picture uses them.
fn letters(size: i32, anchor: (HPos, VPos)) -> TextStyle<'static> {
    ("sans-serif", size * PIXEL).into_font().color(&GREY).pos(Pos::new(anchor.0, anchor.1))
}

fn write(ink: &Ink, text: &str, at: (i32, i32), style: TextStyle<'static>) -> Result<(), DrawError> {
    // The line's box has room below for letters that hang; its middle is above the middle of the digits.
    let drop = if matches!(style.pos.v_pos, VPos::Center) { 3 * PIXEL / 2 } else { 0 };
    let at = (at.0, at.1 + drop);
    ink.draw(&Text::new(text.to_owned(), at, style)).map_err(DrawError::ink)
}

fn line(ink: &Ink, from: (i32, i32), to: (i32, i32), color: RGBColor) -> Result<(), DrawError> {
    let style = color.stroke_width(PIXEL as u32);
    ink.draw(&PathElement::new(vec![from, to], style)).map_err(DrawError::ink)
}

fn fill(color: Rgb) -> ShapeStyle {
    let [r, g, b] = color.map(|c| (c * 255.0 + 0.5) as u8);
    RGBColor(r, g, b).filled()
}

/// The scene's title on the left, time on the right.
pub fn heading(ink: &Ink, setting: &Setting, time: f64) -> Result<(), DrawError> {
    let width = ink.dim_in_pixel().0 as i32;
    let bold = FontDesc::new(FontFamily::SansSerif, f64::from(17 * PIXEL), FontStyle::Bold);
    let bold = bold.color(&GREY).pos(Pos::new(HPos::Left, VPos::Center));
    write(ink, &setting.title, (20 * PIXEL, 24 * PIXEL), bold)?;
    // One unit for all pictures of a run.
    let unit = axis_prefix(setting.end, "s");
    let time = format!("t = {:.3} {}s", time / unit.factor, unit.letter);
    write(ink, &time, (width - 20 * PIXEL, 24 * PIXEL), letters(16, (HPos::Right, VPos::Center)))
}

/// The colour bar or the names of the bodies, in the column that ends at the right edge.
pub fn legend(ink: &Ink, legend: &Legend, column: i32) -> Result<(), DrawError> {
    match legend {
        Legend::Bar { scale, title, unit } => {
            let (left, top) = (column + 8 * PIXEL, 92 * PIXEL);
            let height = (ink.dim_in_pixel().1 as i32 - 170 * PIXEL).clamp(80 * PIXEL, 420 * PIXEL);
            let [low, high] = scale.range;
            for row in 0..height {
                let value = high - (high - low) * f64::from(row) / f64::from(height - 1);
                let place = [(left, top + row), (left + 16 * PIXEL, top + row + 1)];
                ink.draw(&Rectangle::new(place, fill(scale.color(value)))).map_err(DrawError::ink)?;
            }
            let size = axis_prefix(low.abs().max(high.abs()), unit);
            let shown = [low / size.factor, high / size.factor];
            for tick in ticks(shown, 6) {
                let share = (shown[1] - tick) / (shown[1] - shown[0]);
                let y = top + (share * f64::from(height - 1)).round() as i32;
                line(ink, (left + 16 * PIXEL, y), (left + 20 * PIXEL, y), GREY)?;
                let at = (left + 24 * PIXEL, y);
                write(ink, &label(tick, shown, 6), at, letters(13, (HPos::Left, VPos::Center)))?;
            }
            let small = || letters(13, (HPos::Left, VPos::Bottom));
            write(ink, title, (left, top - 26 * PIXEL), small())?;
            let unit = if unit.is_empty() { String::new() } else { format!("[{}{unit}]", size.letter) };
            write(ink, &unit, (left, top - 8 * PIXEL), small())
        }
        Legend::Names(names) => {
            for (row, (name, color)) in names.iter().enumerate() {
                let (left, top) = (column + 8 * PIXEL, (64 + 24 * row as i32) * PIXEL);
                let place = [(left, top), (left + 14 * PIXEL, top + 14 * PIXEL)];
                ink.draw(&Rectangle::new(place, fill(*color))).map_err(DrawError::ink)?;
                let at = (left + 21 * PIXEL, top + 7 * PIXEL);
                write(ink, name, at, letters(13, (HPos::Left, VPos::Center)))?;
            }
            Ok(())
        }
    }
}

/// Axes in metres around the window of a plane scene, whose corner stands at `(left, top)`.
pub fn axes(ink: &Ink, window: &PlaneView, (left, top): (i32, i32)) -> Result<(), DrawError> {
    let [width, height] = window.size.map(|side| side as i32);
    let (right, bottom) = (left + width, top + height);
    for (from, to) in [
        ((left, top), (right, top)),
        ((right, top), (right, bottom)),
        ((left, bottom), (right, bottom)),
        ((left, top), (left, bottom)),
    ] {
        line(ink, from, to, LIGHT)?;
    }
    let count = |length: i32| (length / (90 * PIXEL)).clamp(2, 10) as usize;
    let (range, marks) = ([window.low[0], window.high[0]], count(width));
    for tick in ticks(range, marks) {
        let x = left + window.pixel([tick, window.low[1]])[0].round() as i32;
        line(ink, (x, bottom), (x, bottom + 5 * PIXEL), GREY)?;
        let at = (x, bottom + 8 * PIXEL);
        write(ink, &label(tick, range, marks), at, letters(13, (HPos::Center, VPos::Top)))?;
    }
    let (range, marks) = ([window.low[1], window.high[1]], count(height));
    for tick in ticks(range, marks) {
        let y = top + window.pixel([window.low[0], tick])[1].round() as i32;
        line(ink, (left - 5 * PIXEL, y), (left, y), GREY)?;
        let at = (left - 8 * PIXEL, y);
        write(ink, &label(tick, range, marks), at, letters(13, (HPos::Right, VPos::Center)))?;
    }
    let at = ((left + right) / 2, bottom + 28 * PIXEL);
    write(ink, "x [m]", at, letters(14, (HPos::Center, VPos::Top)))?;
    let turned = ("sans-serif", 14 * PIXEL).into_font().transform(FontTransform::Rotate270).color(&GREY);
    let turned = turned.pos(Pos::new(HPos::Center, VPos::Center));
    write(ink, "y [m]", (left - 48 * PIXEL, (top + bottom) / 2), turned)
}

/// A length to measure with, at the lower right.
pub fn scale_bar(ink: &Ink, camera: &Camera) -> Result<(), DrawError> {
    let (width, height) = ink.dim_in_pixel();
    let wanted = 0.16 * f64::from(width) / camera.scale;
    let power = 10f64.powf(wanted.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().find(|round| round * power <= wanted).unwrap_or(1.0);
    let length = round * power;
    let pixels = (length * camera.scale).round() as i32;
    let (right, y) = (width as i32 - 24 * PIXEL, height as i32 - 24 * PIXEL);
    let bar = [(right - pixels, y - 2 * PIXEL), (right, y + 2 * PIXEL)];
    ink.draw(&Rectangle::new(bar, GREY.filled())).map_err(DrawError::ink)?;
    let size = prefix(length);
    let text = format!("{} {}m", (length / size.factor).round(), size.letter);
    let at = (right - pixels / 2, y - 6 * PIXEL);
    write(ink, &text, at, letters(13, (HPos::Center, VPos::Bottom)))
}

/// The directions of space, at the lower left.
pub fn triad(ink: &Ink, camera: &Camera) -> Result<(), DrawError> {
    let colors = [RGBColor(200, 60, 60), RGBColor(60, 150, 70), RGBColor(60, 90, 200)];
    let length = f64::from(34 * PIXEL);
    let center = (56 * PIXEL, ink.dim_in_pixel().1 as i32 - 56 * PIXEL);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| unit(a).dot(camera.toward).total_cmp(&unit(b).dot(camera.toward)));
    for axis in order {
        let direction = unit(axis);
        let tip = |reach: f64| {
            let (x, y) = (direction.dot(camera.right), direction.dot(camera.up));
            (center.0 + (reach * x).round() as i32, center.1 - (reach * y).round() as i32)
        };
        let style = colors[axis].stroke_width(2 * PIXEL as u32);
        ink.draw(&PathElement::new(vec![center, tip(length)], style)).map_err(DrawError::ink)?;
        let flat = direction.dot(camera.toward).abs() > 0.98;
        if !flat {
            let style = ("sans-serif", 14 * PIXEL).into_font().color(&colors[axis]);
            let style = style.pos(Pos::new(HPos::Center, VPos::Center));
            write(ink, ["x", "y", "z"][axis], tip(length * 1.32), style)?;
        }
    }
    Ok(())
}
