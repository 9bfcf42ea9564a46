//! A chart on paper: PNG or SVG.

use super::{Chart, Curve, Panel};
use crate::drawing::{Canvas, DrawError, Prefix, axis_prefix, label, register_font, save};
use crate::files;
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

const INK: RGBColor = RGBColor(50, 54, 60);
const FAINT: RGBColor = RGBColor(226, 229, 233);
/// Lines end on whole pixels as drawn: many of them make slanted curves smooth.
const SAMPLES: usize = 4;
/// Numbers along an axis, about.
const MARKS: usize = 6;
/// Curves of so few points have them marked.
const FEW: usize = 12;

/// Draws a chart into a file of this width and height in pixels; a name that ends in `.svg` gives SVG, any other PNG.
///
/// # Errors
/// The file cannot be written, or no panel has a curve.
pub fn draw(chart: &Chart, path: &Path, size: [usize; 2]) -> Result<(), DrawError> {
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        let text = svg(chart, size)?;
        return files::write(path, files::SVG, |file| file.write_all(text.as_bytes()))
            .map_err(|source| DrawError::Write { path: path.to_path_buf(), source });
    }
    something(chart)?;
    let mut canvas = Canvas::new(size, SAMPLES);
    page(&canvas.ink(), chart, SAMPLES as i32)?;
    save(&canvas.image(), path)
}

/// A chart of this width and height as the text of an SVG file.
///
/// # Errors
/// No panel has a curve.
pub fn svg(chart: &Chart, size: [usize; 2]) -> Result<String, DrawError> {
    something(chart)?;
    register_font();
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, (size[0] as u32, size[1] as u32)).into_drawing_area();
    page(&area, chart, 1)?;
    area.present().map_err(DrawError::ink)?;
    drop(area);
    let inside = text.find('>').map_or(0, |end| end + 1);
    text.insert_str(inside, files::COMMENT);
    Ok(text)
}

/// An error if there is nothing to see in a chart.
fn something(chart: &Chart) -> Result<(), DrawError> {
    let empty = |panel: &Panel| panel.curves.iter().all(|curve| curve.points.is_empty());
    if chart.panels.iter().all(empty) { Err(DrawError::Empty("no rows match".to_owned())) } else { Ok(()) }
}

/// All of a chart, with lengths multiplied by `pixel`.
fn page<D: DrawingBackend>(area: &DrawingArea<D, Shift>, chart: &Chart, pixel: i32) -> Result<(), DrawError> {
    area.fill(&WHITE).map_err(DrawError::ink)?;
    let height = area.dim_in_pixel().1 as i32;
    let bold = FontDesc::new(FontFamily::SansSerif, f64::from(17 * pixel), FontStyle::Bold);
    let bold = bold.color(&INK).pos(Pos::new(HPos::Left, VPos::Top));
    let title = Text::new(chart.title.clone(), (20 * pixel, 14 * pixel), bold);
    area.draw(&title).map_err(DrawError::ink)?;
    let head = if chart.title.is_empty() { 0 } else { 44 * pixel };
    let lines: Vec<&str> = chart.caption.lines().collect();
    let foot = 12 * pixel + 24 * pixel * lines.len() as i32;
    for (row, line) in lines.iter().enumerate() {
        let style = letters(13, pixel).pos(Pos::new(HPos::Left, VPos::Top));
        let at = (20 * pixel, height - foot + (10 + 24 * row as i32) * pixel);
        area.draw(&Text::new(*line, at, style)).map_err(DrawError::ink)?;
    }
    let body = area.margin(head, foot, 8 * pixel, 8 * pixel);
    let columns = chart.panels.len().clamp(1, 2);
    let rows = chart.panels.len().div_ceil(columns).max(1);
    for (cell, panel) in body.split_evenly((rows, columns)).iter().zip(&chart.panels) {
        draw_panel(cell, (panel, &chart.over), pixel)?;
    }
    Ok(())
}

fn letters(size: i32, pixel: i32) -> TextStyle<'static> {
    ("sans-serif", size * pixel).into_font().color(&INK)
}

fn draw_panel<D: DrawingBackend>(
    area: &DrawingArea<D, Shift>,
    (panel, over): (&Panel, &str),
    pixel: i32,
) -> Result<(), DrawError> {
    let [times, values] = [0, 1].map(|axis| range(&panel.curves, axis));
    let (over, pace) = over_axis(over, times[0].abs().max(times[1].abs()));
    let times = times.map(|time| time / pace);
    let largest = values[0].abs().max(values[1].abs());
    let size = axis_prefix(largest, panel.unit);
    let values = values.map(|value| value / size.factor);
    // Above the curves there is room for their names.
    let plot = f64::from(area.dim_in_pixel().1 as i32 - 50 * pixel).max(1.0);
    let names = (f64::from((18 + 20 * panel.curves.len() as i32) * pixel) / plot).min(0.45);
    let room = 1.05 * names / (1.0 - names);
    let pad = values[1] - values[0];
    let values = [values[0] - 0.05 * pad, values[1] + room * pad];
    let mut chart = ChartBuilder::on(area)
        .margin_right(18 * pixel)
        .margin_top(6 * pixel)
        .x_label_area_size(44 * pixel)
        .y_label_area_size(64 * pixel)
        .build_cartesian_2d(times[0]..times[1], values[0]..values[1])
        .map_err(DrawError::ink)?;
    chart
        .configure_mesh()
        .x_labels(MARKS)
        .y_labels(MARKS)
        .max_light_lines(0)
        .bold_line_style(FAINT.stroke_width(pixel as u32))
        .axis_style(INK.stroke_width(pixel as u32))
        .label_style(letters(13, pixel))
        .axis_desc_style(letters(14, pixel))
        .set_all_tick_mark_size(4 * pixel)
        .x_label_formatter(&|time| label(*time, times, MARKS))
        .y_label_formatter(&|value| label(*value, values, MARKS))
        .x_desc(over)
        .y_desc(axis_name(panel, size))
        .draw()
        .map_err(DrawError::ink)?;
    for curve in &panel.curves {
        let style = stroke(curve, pixel);
        let dashes = curve.dashed;
        // A line ends where there is no value.
        for (number, part) in curve.points.split(|point| !point[1].is_finite()).enumerate() {
            let points = part.iter().map(|[time, value]| (time / pace, value / size.factor));
            // A single point makes no line.
            if part.len() == 1 || (curve.points.len() <= FEW && !dashes) {
                let mark = |point| Circle::new(point, 3 * pixel, style.filled());
                chart.draw_series(points.clone().map(mark)).map_err(DrawError::ink)?;
            }
            let series = if dashes {
                chart.draw_series(DashedLineSeries::new(points, 7 * pixel, 5 * pixel, style))
            } else {
                chart.draw_series(LineSeries::new(points, style))
            };
            let series = series.map_err(DrawError::ink)?;
            if number > 0 {
                continue;
            }
            series.label(&curve.label).legend(move |(x, y)| {
                let ends = [(x, y), (x + 22 * pixel, y)];
                if dashes {
                    DashedPathElement::new(ends, 7 * pixel, 5 * pixel, style).into_dyn()
                } else {
                    PathElement::new(ends, style).into_dyn()
                }
            });
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .margin(10 * pixel)
        .legend_area_size(30 * pixel)
        .background_style(WHITE.mix(0.85))
        .border_style(FAINT.stroke_width(pixel as u32))
        .label_font(letters(13, pixel))
        .draw()
        .map_err(DrawError::ink)
}

/// Name of the axis of what is drawn over, in seconds with the prefix that its numbers read well with, and by what they
/// are divided.
fn over_axis(over: &str, largest: f64) -> (String, f64) {
    match over.strip_suffix(" [s]") {
        Some(name) => {
            let Prefix { letter, factor } = axis_prefix(largest, "s");
            (format!("{name} [{letter}s]"), factor)
        }
        None => (over.to_owned(), 1.0),
    }
}

fn axis_name(panel: &Panel, size: Prefix) -> String {
    if panel.unit.is_empty() {
        panel.name.clone()
    } else {
        format!("{} [{}{}]", panel.name, size.letter, panel.unit)
    }
}

fn stroke(curve: &Curve, pixel: i32) -> ShapeStyle {
    let [r, g, b] = curve.color.map(|c| (c * 255.0 + 0.5) as u8);
    RGBColor(r, g, b).stroke_width((2 * pixel) as u32)
}

/// Smallest and largest of the times (axis 0) or values (axis 1) of some curves, never equal.
fn range(curves: &[Curve], axis: usize) -> [f64; 2] {
    let values = curves.iter().flat_map(|curve| &curve.points).map(|point| point[axis]);
    let values = values.filter(|value| value.is_finite());
    let [low, high] = values
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if low > high {
        return [0.0, 1.0];
    }
    // A quantity that stays as it is gets an axis on which rounding does not show.
    let least = 1e-9 * low.abs().max(high.abs()).max(1e-12);
    if high - low > least {
        [low, high]
    } else {
        [low - 0.5 * low.abs().max(1.0), high + 0.5 * high.abs().max(1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        let times = (0..100).map(|i| f64::from(i) * 0.02);
        let curve = |label: &str, dashed: bool, factor: f64| Curve {
            label: label.to_owned(),
            color: if dashed { [0.2, 0.2, 0.2] } else { crate::drawing::body_color(0) },
            dashed,
            points: times.clone().map(|t| [t, factor * t * t]).collect(),
        };
        let panel = |name: &str, unit| Panel {
            name: name.to_owned(),
            unit,
            curves: vec![curve("sphere x", false, 2.45), curve("rigid sphere, paper eq. (23)", true, 2.525)],
        };
        Chart {
            title: "A sphere rolls down a plane".to_owned(),
            over: "time [s]".to_owned(),
            panels: vec![panel("position", "m"), panel("velocity", "m/s")],
            caption: "at t = 2 s: sphere x is 0.970 of exact".to_owned(),
        }
    }

    #[test]
    fn a_chart_becomes_png_and_svg() {
        let folder = tempfile::tempdir().unwrap();
        let keep = std::env::var_os("STICKSLIP_TEST_PICTURES").map(std::path::PathBuf::from);
        let folder = keep.as_deref().unwrap_or(folder.path());
        draw(&chart(), &folder.join("chart.png"), [1280, 560]).unwrap();
        draw(&chart(), &folder.join("chart.SVG"), [1280, 560]).unwrap();
        let svg = std::fs::read_to_string(folder.join("chart.SVG")).unwrap();
        assert!(svg.contains("velocity [m/s]") && svg.contains("</svg>"));
        let png = std::fs::read(folder.join("chart.png")).unwrap();
        assert_eq!(&png[1..4], b"PNG");
        for name in ["chart.png", "chart.SVG"] {
            draw(&chart(), &folder.join(name), [1280, 560]).expect("its own it replaces");
        }
    }

    #[test]
    fn a_chart_of_nothing_is_an_error() {
        let nothing =
            Chart { title: String::new(), over: String::new(), panels: Vec::new(), caption: String::new() };
        assert!(matches!(draw(&nothing, Path::new("x.png"), [64, 64]), Err(DrawError::Empty(_))));
    }

    #[test]
    fn a_point_that_has_no_neighbours_is_marked() {
        let gap = f64::NAN;
        // Of many rows one, as of a pair that touches once, and of a known answer one.
        let alone: Vec<[f64; 2]> = (0..30).map(|i| [f64::from(i), if i == 7 { 2.0 } else { gap }]).collect();
        for (dashed, points) in [(false, alone), (true, vec![[0.0, 5.0]])] {
            let curve = Curve { label: "gap".to_owned(), color: [0.0; 3], dashed, points };
            let panel = Panel { name: "gap".to_owned(), unit: "m", curves: vec![curve] };
            let chart = Chart { panels: vec![panel], ..chart() };
            assert_eq!(svg(&chart, [640, 560]).unwrap().matches("<circle").count(), 1);
        }
        assert!(!svg(&chart(), [1280, 560]).unwrap().contains("<circle"), "lines have no marks");
    }

    #[test]
    fn short_times_have_a_prefix() {
        assert_eq!(over_axis("time [s]", 2e-5), ("time [\u{b5}s]".to_owned(), 1e-6));
        assert_eq!(over_axis("time [s]", 2.0), ("time [s]".to_owned(), 1.0));
        assert_eq!(over_axis("time / (d/c)", 2e-5), ("time / (d/c)".to_owned(), 1.0));
    }

    #[test]
    fn a_constant_still_has_a_range() {
        let curve = Curve {
            label: String::new(),
            color: [0.0; 3],
            dashed: false,
            points: vec![[0.0, 5.0], [1.0, 5.0]],
        };
        let [low, high] = range(&[curve], 1);
        assert!(low < 5.0 && high > 5.0);
    }
}
