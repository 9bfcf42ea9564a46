//! What a sweep came to, over the first of its parameters that is a number.

use super::record::{Sweep, SweepRow};
use crate::chart::{Chart, Curve, Panel};
use crate::drawing::body_color;

/// Panels: how the columns begin that belong in it, its name and its unit.
const PANELS: &[(&str, &str, &str)] = &[
    ("arrival ", "arrival", "s"),
    ("speed ", "speed of front", "m/s"),
    ("ratio ", "value over the exact value", ""),
    ("energy_drift", "energy drift, relative", ""),
];

/// More curves than this in one panel cannot be told apart.
const MOST_CURVES: usize = 8;

/// The chart of a sweep; without panels if no parameter is a number or nothing was measured.
pub fn chart(sweep: &Sweep) -> Chart {
    let number = |row: &SweepRow, i: usize| row.parameters[i].parse::<f64>().ok();
    let over =
        (0..sweep.record.parameters.len()).find(|&i| sweep.rows.iter().all(|row| number(row, i).is_some()));
    let panels = PANELS.iter().filter_map(|(start, name, unit)| {
        let curves = curves(sweep, over?, start);
        (!curves.is_empty()).then(|| Panel { name: (*name).to_owned(), unit, curves })
    });
    let mut panels: Vec<Panel> = panels.collect();
    if panels.len() > 1 {
        // The drift is of interest where there is nothing better to see.
        panels.retain(|panel| !panel.name.starts_with("energy"));
    }
    Chart {
        title: sweep.record.title.clone(),
        over: over.map_or(String::new(), |i| sweep.record.parameters[i].clone()),
        panels,
        caption: String::new(),
    }
}

/// A curve for each column and each combination of the other parameters.
fn curves(sweep: &Sweep, over: usize, start: &str) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in &sweep.rows {
        let others = row.parameters.iter().zip(&sweep.record.parameters).enumerate();
        let others: String = others
            .filter(|(i, _)| *i != over)
            .map(|(_, (value, name))| format!(", {name} {value}"))
            .collect();
        let Ok(x) = row.parameters[over].parse::<f64>() else { continue };
        for (name, value) in row.figures.iter().filter(|(name, _)| name.starts_with(start)) {
            let label = format!(
                "{}{others}",
                name.strip_prefix(start).filter(|rest| !rest.is_empty()).unwrap_or(name)
            );
            match curves.iter_mut().find(|curve| curve.label == label) {
                Some(curve) => curve.points.push([x, *value]),
                None => {
                    let color = body_color(curves.len());
                    curves.push(Curve { label, color, dashed: false, points: vec![[x, *value]] });
                }
            }
        }
    }
    curves.truncate(MOST_CURVES);
    for curve in &mut curves {
        curve.points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::record::SweepRecord;

    #[test]
    fn figures_are_drawn_over_the_first_number_for_each_value_of_the_others() {
        let row = |law: &str, nu: &str, speed: f64| SweepRow {
            parameters: vec![law.to_owned(), nu.to_owned()],
            figures: vec![("speed fringe".to_owned(), speed), ("energy_drift".to_owned(), 0.0)],
            ..SweepRow::default()
        };
        let rows = vec![row("gap", "0.3", 2.0), row("gap", "0.2", 3.0), row("glued", "0.2", 5.0)];
        let record = SweepRecord::new("waves", vec!["law".to_owned(), "nu".to_owned()]);
        let chart = chart(&Sweep { record, rows });
        assert_eq!((chart.over.as_str(), chart.panels.len()), ("nu", 1));
        let [gap, glued] = &chart.panels[0].curves[..] else { panic!("{chart:?}") };
        assert_eq!((gap.label.as_str(), glued.label.as_str()), ("fringe, law gap", "fringe, law glued"));
        assert_eq!(gap.points, [[0.2, 3.0], [0.3, 2.0]]);
    }
}
