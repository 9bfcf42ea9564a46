//! What a chart shows of forces, probes, arrivals and fronts.

use super::contents::{ChartChoice, ChartTable, MOST_CURVES};
use super::{Chart, Curve, Panel, tables};
use crate::drawing::body_color;
use stickslip::observe::{ArrivalRow, FrontSpeedRow, ProbeRow, ReadError, Results, TableRow};
use stickslip::scene::{NamePattern, TimeUnit};

/// Columns of `probes.csv` that can be drawn.
pub const PROBE_COLUMNS: &[&str] = &[
    "stress_difference",
    "pressure",
    "von_mises",
    "xx",
    "yy",
    "zz",
    "xy",
    "yz",
    "xz",
    "vx",
    "vy",
    "vz",
    "x",
    "y",
    "z",
];

/// The time that a chart is drawn over: seconds, or the scene's own unit.
pub struct ChartTime {
    unit: f64,
    name: String,
}

impl ChartTime {
    /// The unit of a run.
    ///
    /// # Errors
    /// The record of its scene cannot be read.
    pub fn of(results: &Results) -> Result<Self, ReadError> {
        Ok(match results.scene()?.outputs.measurements.time_unit {
            Some(TimeUnit { seconds, name }) => ChartTime { unit: seconds, name: format!("time / ({name})") },
            None => ChartTime { unit: 1.0, name: "time [s]".to_owned() },
        })
    }

    /// Draws a chart that is in seconds over this time.
    pub fn apply(&self, chart: &mut Chart) {
        chart.over.clone_from(&self.name);
        let curves = chart.panels.iter_mut().flat_map(|panel| &mut panel.curves);
        curves.flat_map(|curve| &mut curve.points).for_each(|point| point[0] /= self.unit);
    }
}

/// A chart of a run without panels.
pub fn empty(results: &Results) -> Chart {
    let title = results.manifest().title.clone();
    Chart { title, over: String::new(), panels: Vec::new(), caption: String::new() }
}

/// The chart of a table other than that of the bodies.
///
/// # Errors
/// The table cannot be read.
pub fn chart(results: &Results, (table, choice): (ChartTable, &ChartChoice)) -> Result<Chart, ReadError> {
    let mut chart = empty(results);
    let usual = [table.columns()[0].to_owned()];
    let columns = if choice.quantities.is_empty() { &usual } else { &choice.quantities[..] };
    let patterns: Vec<NamePattern> = choice.bodies.iter().map(|body| NamePattern::new(body)).collect();
    let wanted = |name: &str| patterns.is_empty() || patterns.iter().any(|pattern| pattern.matches(name));
    match table {
        ChartTable::Bodies | ChartTable::Energy => {}
        ChartTable::Loads
        | ChartTable::Joints
        | ChartTable::Sections
        | ChartTable::Reactions
        | ChartTable::Groups
        | ChartTable::GroupContacts
        | ChartTable::Fabric
        | ChartTable::Removed
        | ChartTable::Contacts => {
            let mut rows = tables::rows(results, table)?;
            rows.retain(|row| row.name.split(", ").any(&wanted));
            let touch = matches!(table, ChartTable::Contacts | ChartTable::GroupContacts);
            let energy = if touch { results.energy_table()? } else { Vec::new() };
            let times: Vec<f64> = energy.iter().map(|row| row.time).collect();
            chart.panels = tables::panels(&rows, columns, (MOST_CURVES, &times));
        }
        ChartTable::Probes => {
            let mut rows = results.probes_table()?;
            rows.retain(|row| wanted(&row.probe));
            chart.panels = probes(&rows, columns);
        }
        ChartTable::Arrivals => {
            let mut rows = results.arrivals_table()?;
            rows.retain(|row| wanted(&row.place));
            chart.panels.extend(arrivals(&rows));
        }
        ChartTable::Fronts => {
            let mut speeds = results.front_speeds_table()?;
            speeds.retain(|row| wanted(&row.front));
            let mut fronts =
                named(results.fronts_table()?.iter().map(|row| (&row.front, [row.time, row.distance])));
            fronts.retain(|curve| wanted(&curve.label));
            chart.panels.extend(panel("distance of front", "m", fronts));
            chart.caption = speed_caption(&speeds);
        }
    }
    Ok(chart)
}

/// Everything that a run measured; nothing at all if its scene has neither probes nor arrivals nor fronts.
///
/// # Errors
/// A table cannot be read.
pub fn all(results: &Results) -> Result<Chart, ReadError> {
    let mut all = empty(results);
    let choice = ChartChoice::default();
    for table in [ChartTable::Probes, ChartTable::Fronts, ChartTable::Arrivals] {
        let Chart { panels, caption, .. } = chart(results, (table, &choice))?;
        all.panels.extend(panels);
        all.caption += &caption;
    }
    if !all.panels.is_empty() {
        let forces = chart(results, (ChartTable::Contacts, &choice))?;
        all.panels.extend(forces.panels);
    }
    Ok(all)
}

/// A panel, if it has curves.
fn panel(name: &str, unit: &'static str, mut curves: Vec<Curve>) -> Option<Panel> {
    curves.truncate(MOST_CURVES);
    (!curves.is_empty()).then(|| Panel { name: name.to_owned(), unit, curves })
}

/// A curve for each name, in the order in which names first occur.
fn named<'a>(points: impl Iterator<Item = (&'a String, [f64; 2])>) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for (name, point) in points {
        match curves.iter_mut().find(|curve| curve.label == *name) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve {
                label: name.clone(),
                color: body_color(curves.len()),
                dashed: false,
                points: vec![point],
            }),
        }
    }
    curves
}

fn probes<'a>(rows: &'a [ProbeRow], columns: &[String]) -> Vec<Panel> {
    let panels = columns.iter().filter_map(|column| {
        let point = |row: &'a ProbeRow| Some((&row.probe, [row.time, row.number(column)?]));
        let curves = named(rows.iter().filter_map(point));
        let unit = match column.as_str() {
            "x" | "y" | "z" => "m",
            "vx" | "vy" | "vz" => "m/s",
            _ => "Pa",
        };
        panel(&column.replace('_', " "), unit, curves)
    });
    panels.collect()
}

/// Distance from the place where each threshold was first passed, against time.
fn arrivals(rows: &[ArrivalRow]) -> Option<Panel> {
    let series: Vec<(String, &ArrivalRow)> = rows
        .iter()
        .map(|row| (format!("{} {:.3e}, {}", row.quantity, row.threshold, row.reading), row))
        .collect();
    let point = |(name, row): &(String, &ArrivalRow)| {
        let first = series.iter().find(|(other, _)| other == name).map_or(*row, |(_, first)| first);
        let way = [0, 1, 2].map(|axis| row.position[axis] - first.position[axis]);
        [row.time, way.iter().map(|x| x * x).sum::<f64>().sqrt()]
    };
    panel("distance of arrival", "m", named(series.iter().map(|each| (&each.0, point(each)))))
}

fn speed_caption(speeds: &[FrontSpeedRow]) -> String {
    let each: Vec<String> = speeds.iter().map(|row| format!("{} {:.1} m/s", row.front, row.speed)).collect();
    if each.is_empty() { String::new() } else { format!("Speed by fit: {}", each.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrivals_are_drawn_by_their_distance_from_the_first() {
        let row = |time: f64, x: f64| ArrivalRow {
            time,
            position: [x, 0.0, 0.0],
            quantity: "vx".to_owned(),
            ..ArrivalRow::default()
        };
        let panel = arrivals(&[row(1.0, 5.0), row(3.0, 2.0)]).unwrap();
        assert_eq!(panel.curves[0].points, [[1.0, 0.0], [3.0, 3.0]]);
        assert_eq!(arrivals(&[]), None);
    }

    #[test]
    fn every_column_of_probes_is_a_number() {
        assert!(PROBE_COLUMNS.iter().all(|column| ProbeRow::default().number(column).is_some()));
    }
}
