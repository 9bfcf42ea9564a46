//! What a sweep came to, over the first of its parameters that is a number.

use super::record::{Sweep, SweepRow};
use crate::chart::{Chart, Curve, Panel};
use crate::drawing::body_color;

/// What is drawn: how the names of the columns begin that belong in a panel, its name and its unit.
type Kind = (&'static str, &'static str, &'static str);

/// What scenes know answers for or measure.
const MEASURED: &[Kind] = &[
    ("arrival ", "arrival", "s"),
    ("speed ", "speed of front", "m/s"),
    ("ratio ", "value over the exact value", ""),
];
/// What is drawn of scenes that do neither, as far as it differs between the runs.
const USUAL: &[Kind] = &[
    ("kinetic_energy", "kinetic energy at the end", "J"),
    ("strain_energy", "strain energy at the end", "J"),
    ("friction_heat", "work of friction", "J"),
    ("largest_push", "largest push of a pair", "N"),
];
/// What else has a unit, if it is asked for.
const OTHERS: &[Kind] = &[
    ("time", "simulated time", "s"),
    ("wall_time", "wall time", "s"),
    ("external_work", "external work", "J"),
    ("energy_drift", "energy drift, relative", ""),
    ("first_contact", "first contact", "s"),
];

/// More curves than this in one panel cannot be told apart.
const MOST_CURVES: usize = 8;

/// The chart of a sweep: of some columns of its table, or without any of what was measured, else of energies and
/// forces. It has no panels if no parameter is a number.
pub fn chart(sweep: &Sweep, columns: &[String]) -> Chart {
    let number = |row: &SweepRow, i: usize| row.parameters[i].parse::<f64>().ok();
    let over =
        (0..sweep.record.parameters.len()).find(|&i| sweep.rows.iter().all(|row| number(row, i).is_some()));
    let panel = |(start, name, unit): &Kind| {
        let curves = curves(sweep, over?, |column| column.strip_prefix(*start));
        (!curves.is_empty()).then(|| Panel { name: (*name).to_owned(), unit, curves })
    };
    let mut panels: Vec<Panel> = match columns {
        [] => MEASURED.iter().filter_map(panel).collect(),
        chosen => chosen.iter().filter_map(|column| of_column(sweep, over?, column)).collect(),
    };
    if panels.is_empty() && columns.is_empty() {
        panels = USUAL.iter().filter(|kind| differs(sweep, kind.0)).filter_map(panel).collect();
    }
    Chart {
        title: sweep.record.title.clone(),
        over: over.map_or(String::new(), |i| sweep.record.parameters[i].clone()),
        panels,
        caption: String::new(),
    }
}

/// The panel of one column.
fn of_column(sweep: &Sweep, over: usize, column: &str) -> Option<Panel> {
    let kinds = || USUAL.iter().chain(OTHERS);
    let (name, unit) = match kinds().find(|kind| kind.0 == column) {
        Some((_, name, unit)) => (*name, *unit),
        None => {
            let measured = MEASURED.iter().find(|kind| column.starts_with(kind.0));
            (column, measured.map_or("", |kind| kind.2))
        }
    };
    let curves = curves(sweep, over, |other| (other == column).then_some(""));
    (!curves.is_empty()).then(|| Panel { name: name.to_owned(), unit, curves })
}

/// Whether a column is not the same in all runs that have it.
fn differs(sweep: &Sweep, column: &str) -> bool {
    let mut values = sweep.rows.iter().flat_map(|row| &row.figures).filter(|figure| figure.0 == column);
    let first = values.next();
    values.any(|figure| Some(figure) != first)
}

/// A curve for each combination of the other parameters and each column that belongs here: `rest` is what of its name
/// tells it from the others.
fn curves(sweep: &Sweep, over: usize, rest: impl Fn(&str) -> Option<&str>) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in &sweep.rows {
        let others = row.parameters.iter().zip(&sweep.record.parameters).enumerate();
        let others: Vec<String> =
            others.filter(|(i, _)| *i != over).map(|(_, (value, name))| format!("{name} {value}")).collect();
        let Ok(x) = row.parameters[over].parse::<f64>() else { continue };
        for (name, value) in &row.figures {
            let Some(rest) = rest(name) else { continue };
            let own = [rest.to_owned()].into_iter().filter(|rest| !rest.is_empty());
            let parts: Vec<String> = own.chain(others.iter().cloned()).collect();
            let label = if parts.is_empty() { name.clone() } else { parts.join(", ") };
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
    use crate::sweep::plan::Plan;
    use crate::sweep::record::SweepRecord;

    #[test]
    fn figures_are_drawn_over_the_first_number_for_each_value_of_the_others() {
        let row = |law: &str, nu: &str, speed: f64| SweepRow {
            parameters: vec![law.to_owned(), nu.to_owned()],
            figures: vec![("speed fringe".to_owned(), speed), ("energy_drift".to_owned(), 0.0)],
            ..SweepRow::default()
        };
        let rows = vec![row("gap", "0.3", 2.0), row("gap", "0.2", 3.0), row("glued", "0.2", 5.0)];
        let record = SweepRecord::new("waves", vec!["law".to_owned(), "nu".to_owned()], Plan::default());
        let chart = chart(&Sweep { record, rows }, &[]);
        assert_eq!((chart.over.as_str(), chart.panels.len()), ("nu", 1));
        let [gap, glued] = &chart.panels[0].curves[..] else { panic!("{chart:?}") };
        assert_eq!((gap.label.as_str(), glued.label.as_str()), ("fringe, law gap", "fringe, law glued"));
        assert_eq!(gap.points, [[0.2, 3.0], [0.3, 2.0]]);
    }

    /// Energies and pushes that differ, and no drift, which says nothing of the scene.
    #[test]
    fn scenes_without_answers_have_charts_of_energies_and_pushes() {
        let row = |friction: &str, energies: [f64; 3]| {
            let names = ["kinetic_energy", "friction_heat", "largest_push"];
            let mut figures: Vec<_> = names.map(str::to_owned).into_iter().zip(energies).collect();
            figures.extend([("strain_energy".to_owned(), 0.0), ("energy_drift".to_owned(), energies[0])]);
            SweepRow { parameters: vec![friction.to_owned()], figures, ..SweepRow::default() }
        };
        let record = SweepRecord::new("blocks", vec!["friction".to_owned()], Plan::default());
        let sweep = Sweep { record, rows: vec![row("0.3", [1.0, 2.0, 30.0]), row("0", [3.0, 0.0, 31.0])] };
        let names = |chart: &Chart| -> Vec<String> {
            chart.panels.iter().map(|panel| format!("{} [{}]", panel.name, panel.unit)).collect()
        };
        let usual = chart(&sweep, &[]);
        assert_eq!(
            names(&usual),
            ["kinetic energy at the end [J]", "work of friction [J]", "largest push of a pair [N]"]
        );
        assert_eq!(usual.panels[0].curves[0].points, [[0.0, 3.0], [0.3, 1.0]]);
        assert_eq!(usual.panels[0].curves[0].label, "kinetic_energy");
        let chosen = chart(&sweep, &["energy_drift".to_owned(), "strain_energy".to_owned()]);
        assert_eq!(names(&chosen), ["energy drift, relative []", "strain energy at the end [J]"]);
    }
}
