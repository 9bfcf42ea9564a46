//! What a chart shows: the quantities that the scene knows answers for, or those that the user asks for.

use super::measurements::{self, ChartTime};
use super::tables::{self, axis};
use super::{Chart, Curve, Panel};
use crate::drawing::{Rgb, body_color};
use clap::ValueEnum;
use std::collections::HashMap;
use stickslip::door::BodyState;
use stickslip::observe::{BodyRow, EnergyRow, ReadError, ReferenceCurve, Results, TableRow};
use stickslip::scene::{NamePattern, is_pattern};

/// What the user asks for; nothing at all gives what the scene is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartChoice {
    /// Names of bodies, or patterns, each of which stands for the sums of all that match it; none means all that have
    /// something to show.
    pub bodies: Vec<String>,
    /// Columns of the table; none means those with known answers, or the table's first.
    pub quantities: Vec<String>,
    /// The table; none means those that the scene asks for.
    pub table: Option<ChartTable>,
}

/// Tables that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ChartTable {
    /// Bodies through time
    Bodies,
    /// Energies of all bodies together
    Energy,
    /// Forces and places of each pair of bodies that touch
    Contacts,
    /// Supports and loads
    Loads,
    /// Joints and springs
    Joints,
    /// Forces through sections
    Sections,
    /// Forces on faces of the domain and on rigid bodies
    Reactions,
    /// Groups of bodies
    Groups,
    /// Forces between groups
    GroupContacts,
    /// Stress and fabric of packings
    Fabric,
    /// What left the domain
    Removed,
    /// Stress and velocity at probes
    Probes,
    /// How far from the first place each came when it arrived
    Arrivals,
    /// How far fronts have come
    Fronts,
}

impl ChartTable {
    /// Its columns that can be drawn, the usual one first.
    pub fn columns(self) -> Vec<&'static str> {
        let own: &[&'static str] = match self {
            ChartTable::Bodies => {
                &["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "mass", "kinetic", "strain"]
            }
            ChartTable::Energy => &[
                "total",
                "kinetic",
                "strain",
                "potential",
                "external_work",
                "friction",
                "adhesion",
                "plastic",
                "damping",
                "px",
                "py",
                "pz",
                "lx",
                "ly",
                "lz",
            ],
            ChartTable::Probes => measurements::PROBE_COLUMNS,
            ChartTable::Arrivals | ChartTable::Fronts => &["distance"],
            _ => &[],
        };
        let usual: &[&'static str] = match self {
            ChartTable::Contacts | ChartTable::GroupContacts => &["normal"],
            ChartTable::Removed => &["mass"],
            ChartTable::Fabric => &["coordination"],
            _ => &[],
        };
        let named = tables::columns(self).into_iter().filter(|column| !usual.contains(column));
        own.iter().chain(usual).copied().chain(named).collect()
    }
}

/// More curves than this in one panel cannot be told apart.
pub(super) const MOST_CURVES: usize = 8;
const EXACT: Rgb = [0.22, 0.24, 0.27];

/// The chart of a run.
///
/// # Errors
/// The tables cannot be read.
pub fn chart(results: &Results, choice: &ChartChoice) -> Result<Chart, ReadError> {
    let mut chart = match choice.table {
        Some(ChartTable::Bodies) => of_bodies(results, choice)?,
        Some(ChartTable::Energy) => {
            let panels = energy_panels(&results.energy_table()?, &choice.quantities);
            Chart { panels, ..measurements::empty(results) }
        }
        Some(table) => measurements::chart(results, (table, choice))?,
        None if choice.bodies.is_empty() && choice.quantities.is_empty() => of_everything(results)?,
        None => of_bodies(results, choice)?,
    };
    ChartTime::of(results)?.apply(&mut chart);
    Ok(chart)
}

/// What the scene knows answers for and what it measures; without either, energy and the way of the centres.
fn of_everything(results: &Results) -> Result<Chart, ReadError> {
    let nothing = ChartChoice::default();
    let mut chart = of_bodies(results, &nothing)?;
    let measured = measurements::all(results)?;
    if !measured.panels.is_empty() {
        if results.manifest().references.is_empty() {
            chart.panels.clear();
        }
        chart.panels.extend(measured.panels);
        chart.caption = [chart.caption, measured.caption].join("\n").trim().to_owned();
    }
    Ok(chart)
}

fn of_bodies(results: &Results, choice: &ChartChoice) -> Result<Chart, ReadError> {
    let mut rows = results.bodies_table()?;
    let mut names = results.body_names().to_vec();
    for pattern in choice.bodies.iter().filter(|name| is_pattern(name)) {
        rows.extend(sums(&rows, pattern));
        names.push(pattern.clone());
    }
    let references = &results.manifest().references;
    let shown = shown(&names, references, choice);
    let mut chart = measurements::empty(results);
    if !shown.is_empty() {
        chart.panels = panels(&rows, references, &shown);
        chart.caption = caption(&rows, references, &shown);
        return Ok(chart);
    }
    chart.panels = vec![energy_panel(&results.energy_table()?), center_panel(&rows, results.body_names())];
    Ok(chart)
}

/// A quantity of a body.
#[derive(Clone, Debug, PartialEq)]
struct Shown {
    body: String,
    /// The body's place in the scene.
    number: usize,
    quantity: String,
}

/// The quantities to show, in the order of the bodies; none for the picture of a run that nobody knows the answer to.
fn shown(names: &[String], references: &[ReferenceCurve], choice: &ChartChoice) -> Vec<Shown> {
    let wanted = |list: &[String], name: &str| list.is_empty() || list.iter().any(|entry| entry == name);
    let mut quantities = choice.quantities.clone();
    let mut shown = Vec::new();
    for (number, body) in names.iter().enumerate() {
        let known = references.iter().filter(|reference| reference.body == *body);
        let known: Vec<String> = known.map(|reference| reference.quantity.clone()).collect();
        if choice.quantities.is_empty() {
            quantities = known;
        }
        if quantities.is_empty() && !choice.bodies.is_empty() {
            quantities = ["x", "y", "z", "vx", "vy", "vz"].map(str::to_owned).to_vec();
        }
        if wanted(&choice.bodies, body) {
            let of_body =
                |quantity: &String| Shown { body: body.clone(), number, quantity: quantity.clone() };
            shown.extend(quantities.iter().map(of_body));
        }
    }
    shown
}

/// The rows of all bodies that match a pattern as those of one: masses and energies are sums, the rest means by mass, of
/// bodies without mass plain ones.
fn sums(rows: &[BodyRow], pattern: &str) -> Vec<BodyRow> {
    let matching = NamePattern::new(pattern);
    let matched: Vec<&BodyRow> = rows.iter().filter(|row| matching.matches(&row.body)).collect();
    let at_once = matched.chunk_by(|a, b| a.time == b.time);
    let sum = |each: &[&BodyRow]| {
        let states = || each.iter().map(|row| &row.state);
        let mass: f64 = states().map(|state| state.mass).sum();
        let mean = |of: fn(&BodyState) -> [f64; 3]| {
            let weight = |state: &BodyState| match mass > 0.0 {
                true => state.mass / mass,
                false => 1.0 / each.len() as f64,
            };
            std::array::from_fn(|k| states().map(|state| weight(state) * of(state)[k]).sum())
        };
        let state = BodyState {
            mass,
            position: mean(|state| state.position),
            velocity: mean(|state| state.velocity),
            spin: mean(|state| state.spin),
            kinetic: states().map(|state| state.kinetic).sum(),
            strain: states().map(|state| state.strain).sum(),
            ..BodyState::default()
        };
        BodyRow { time: each[0].time, body: pattern.to_owned(), state }
    };
    at_once.map(sum).collect()
}

fn panels(rows: &[BodyRow], references: &[ReferenceCurve], shown: &[Shown]) -> Vec<Panel> {
    let mut panels: Vec<Panel> = Vec::new();
    let rows = by_body(rows);
    for (i, each) in shown.iter().enumerate() {
        let (name, unit) = axis(&each.quantity);
        let place = panels.iter().position(|panel| panel.name == name).unwrap_or_else(|| {
            panels.push(Panel { name: name.to_owned(), unit, curves: Vec::new() });
            panels.len() - 1
        });
        let of_body = shown[..i].iter().rev().take_while(|before| before.body == each.body);
        let earlier = of_body.into_iter().any(|before| axis(&before.quantity).0 == name);
        let color = body_color(if earlier { each.number + i } else { each.number });
        let curves = &mut panels[place].curves;
        curves.push(curve(&rows, each, color));
        if let Some(reference) = reference(references, each) {
            let label = reference.label.clone();
            curves.push(Curve { label, color: EXACT, dashed: true, points: reference.points.clone() });
        }
    }
    panels
}

/// The rows of each body, in their order.
fn by_body(rows: &[BodyRow]) -> HashMap<&str, Vec<&BodyRow>> {
    let mut by_body: HashMap<&str, Vec<&BodyRow>> = HashMap::new();
    rows.iter().for_each(|row| by_body.entry(&row.body).or_default().push(row));
    by_body
}

fn curve(rows: &HashMap<&str, Vec<&BodyRow>>, shown: &Shown, color: Rgb) -> Curve {
    let rows = rows.get(&*shown.body).into_iter().flatten();
    let points = rows.filter_map(|row| Some([row.time, row.number(&shown.quantity)?]));
    Curve {
        label: format!("{} {}", shown.body, shown.quantity),
        color,
        dashed: false,
        points: points.collect(),
    }
}

fn reference<'a>(references: &'a [ReferenceCurve], shown: &Shown) -> Option<&'a ReferenceCurve> {
    references.iter().find(|reference| reference.body == shown.body && reference.quantity == shown.quantity)
}

/// One line a body: the last recorded values over the exact ones.
fn caption(rows: &[BodyRow], references: &[ReferenceCurve], shown: &[Shown]) -> String {
    let ratio = |each: &Shown| {
        let exact = reference(references, each)?;
        let row = rows.iter().rfind(|row| row.body == each.body)?;
        let ratio = row.number(&each.quantity)? / interpolated(&exact.points, row.time)?;
        ratio.is_finite().then(|| (row.time, format!("{} {} {ratio:.3}", each.body, each.quantity)))
    };
    let ratios: Vec<(f64, String)> = shown.iter().filter_map(ratio).collect();
    match ratios.last() {
        None => String::new(),
        Some((time, _)) => {
            let list: Vec<&str> = ratios.iter().map(|(_, text)| text.as_str()).collect();
            format!("At t = {time:.3} s, over the exact value: {}", list.join(", "))
        }
    }
}

/// The value between two points of a curve; `None` outside it.
fn interpolated(points: &[[f64; 2]], time: f64) -> Option<f64> {
    let after = points.iter().position(|point| point[0] >= time * (1.0 - 1e-9))?;
    let [t1, v1] = points[after];
    let [t0, v0] = points[after.saturating_sub(1)];
    Some(if t1 > t0 { v0 + (v1 - v0) * (time - t0) / (t1 - t0) } else { v1 })
}

/// Terms of the ledger that add up to the total, each with its colour, and whether it is taken off.
const TERMS: &[(&str, usize, bool)] = &[
    ("kinetic", 0, false),
    ("strain", 2, false),
    ("potential, from the start", 1, false),
    ("friction", 3, false),
    ("plastic", 4, false),
    ("damping", 5, false),
    ("adhesion", 6, false),
    ("external_work", 7, true),
];

/// All that adds up to the total energy; what there is none of has no curve. Potential energy counts from the start:
/// where it is zero means nothing, and would hide the rest.
fn energy_panel(rows: &[EnergyRow]) -> Panel {
    let zero = rows.first().map_or(0.0, |row| row.ledger.potential);
    let mut rows = rows.to_vec();
    for row in &mut rows {
        row.ledger.potential -= zero;
        row.ledger.total -= zero;
    }
    let rows = &rows[..];
    let curve = |(name, color, taken_off): &(&str, usize, bool)| {
        let sign = if *taken_off { -1.0 } else { 1.0 };
        let label = match taken_off {
            true => format!("\u{2212} {}", name.replace('_', " ")),
            false => (*name).to_owned(),
        };
        let name = name.split(',').next().unwrap_or_default();
        Curve { label, color: body_color(*color), dashed: false, points: column(rows, name, sign) }
    };
    let total = Curve {
        label: "total, their sum".to_owned(),
        color: EXACT,
        dashed: true,
        points: column(rows, "total", 1.0),
    };
    let is_there = |curve: &Curve| curve.points.iter().any(|point| point[1] != 0.0);
    let curves = TERMS.iter().map(curve).filter(is_there).chain([total]).collect();
    Panel { name: "energy".to_owned(), unit: "J", curves }
}

/// A column of energy.csv times a number.
fn column(rows: &[EnergyRow], name: &str, times: f64) -> Vec<[f64; 2]> {
    rows.iter().filter_map(|row| Some([row.time, times * row.number(name)?])).collect()
}

/// The columns of energy.csv that are asked for, energies and momenta apart; none means all energies.
fn energy_panels(rows: &[EnergyRow], columns: &[String]) -> Vec<Panel> {
    if columns.is_empty() {
        return vec![energy_panel(rows)];
    }
    let axis = |name: &str| match name.chars().next() {
        _ if name.len() > 2 => ("energy", "J"),
        Some('p') => ("momentum", "kg m/s"),
        _ => ("angular momentum", "kg m\u{b2}/s"),
    };
    let mut panels: Vec<Panel> = Vec::new();
    for (i, name) in columns.iter().enumerate() {
        let (title, unit) = axis(name);
        let place = panels.iter().position(|panel| panel.name == title).unwrap_or_else(|| {
            panels.push(Panel { name: title.to_owned(), unit, curves: Vec::new() });
            panels.len() - 1
        });
        let (color, points) = (body_color(i), column(rows, name, 1.0));
        panels[place].curves.push(Curve { label: name.clone(), color, dashed: false, points });
    }
    panels
}

/// The coordinates of the bodies' centres that change most, as the way they went.
fn center_panel(rows: &[BodyRow], bodies: &[String]) -> Panel {
    let rows = by_body(rows);
    let way = |(number, body): (usize, &String), quantity: &str| {
        let shown = Shown { body: body.clone(), number, quantity: quantity.to_owned() };
        let mut curve = curve(&rows, &shown, body_color(number));
        let start = curve.points.first().map_or(0.0, |point| point[1]);
        curve.points.iter_mut().for_each(|point| point[1] -= start);
        let most = curve.points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
        (most, curve)
    };
    let each = bodies.iter().enumerate().flat_map(|body| ["x", "y", "z"].map(|axis| way(body, axis)));
    let mut ways: Vec<(f64, Curve)> = each.collect();
    ways.sort_by(|a, b| b.0.total_cmp(&a.0));
    let most = ways.first().map_or(0.0, |(most, _)| *most);
    ways.retain(|(way, _)| *way > 1e-3 * most);
    let mut curves: Vec<Curve> = ways.into_iter().map(|(_, curve)| curve).collect();
    if curves.len() > MOST_CURVES {
        curves = ["x", "y", "z"].iter().flat_map(|axis| typical(&curves, axis)).collect();
    }
    curves.iter_mut().enumerate().for_each(|(i, curve)| curve.color = body_color(i));
    Panel { name: "displacement of centres".to_owned(), unit: "m", curves }
}

/// Of many curves of a coordinate those that end lowest, in the middle and highest.
fn typical(curves: &[Curve], axis: &str) -> Vec<Curve> {
    let end = |curve: &Curve| curve.points.last().map_or(0.0, |point| point[1]);
    let mut along: Vec<&Curve> =
        curves.iter().filter(|curve| curve.label.ends_with(&format!(" {axis}"))).collect();
    along.sort_by(|a, b| end(a).total_cmp(&end(b)));
    let count = along.len();
    if count <= 3 {
        return along.into_iter().cloned().collect();
    }
    let named = |(what, place): (&str, usize)| {
        let label = format!("{}, {what} of {count}", along[place].label);
        Curve { label, ..along[place].clone() }
    };
    [("lowest", 0), ("median", count / 2), ("highest", count - 1)].map(named).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::door::Ledger;

    fn row(time: f64, x: f64) -> BodyRow {
        let state = BodyState { position: [x, 0.0, 0.0], ..BodyState::default() };
        BodyRow { time, body: "sphere".to_owned(), state }
    }

    fn shown(quantity: &str) -> Shown {
        Shown { body: "sphere".to_owned(), number: 0, quantity: quantity.to_owned() }
    }

    fn exact() -> Vec<ReferenceCurve> {
        vec![ReferenceCurve {
            body: "sphere".to_owned(),
            quantity: "x".to_owned(),
            label: "rigid".to_owned(),
            points: vec![[0.0, 0.0], [1.0, 4.0], [2.0, 8.0]],
        }]
    }

    #[test]
    fn the_caption_gives_the_ratio_at_the_last_row() {
        let rows = [row(0.0, 0.0), row(1.5, 5.7)];
        let caption = caption(&rows, &exact(), &[shown("x"), shown("vx")]);
        assert_eq!(caption, "At t = 1.500 s, over the exact value: sphere x 0.950");
    }

    #[test]
    fn positions_and_velocities_get_panels_of_their_own() {
        let panels = panels(&[row(0.0, 0.0)], &exact(), &[shown("x"), shown("vx"), shown("y")]);
        assert_eq!(panels.len(), 2);
        assert_eq!((panels[0].unit, panels[1].unit), ("m", "m/s"));
        let labels: Vec<&str> = panels[0].curves.iter().map(|curve| curve.label.as_str()).collect();
        assert_eq!(labels, ["sphere x", "rigid", "sphere y"]);
        assert_ne!(panels[0].curves[0].color, panels[0].curves[2].color);
    }

    #[test]
    fn energies_of_a_chart_add_up_to_the_total() {
        let ledger = Ledger {
            kinetic: 1.0,
            plastic: 5.0,
            friction: 0.5,
            external_work: 6.0,
            total: 0.5,
            ..Ledger::default()
        };
        let rows = [EnergyRow { time: 0.0, ledger }];
        let panel = energy_panel(&rows);
        let labels: Vec<&str> = panel.curves.iter().map(|curve| curve.label.as_str()).collect();
        assert_eq!(labels, ["kinetic", "friction", "plastic", "\u{2212} external work", "total, their sum"]);
        let (terms, total) = panel.curves.split_at(4);
        assert_eq!(terms.iter().map(|curve| curve.points[0][1]).sum::<f64>(), total[0].points[0][1]);
        let asked = energy_panels(&rows, &["px".to_owned(), "plastic".to_owned(), "total".to_owned()]);
        let names: Vec<_> = asked.iter().map(|panel| (panel.name.as_str(), panel.curves.len())).collect();
        assert_eq!(names, [("momentum", 1), ("energy", 2)]);
    }

    #[test]
    fn of_many_bodies_the_ways_are_drawn_that_lie_apart() {
        let curve = |i: usize| Curve {
            label: format!("grain {i} y"),
            color: EXACT,
            dashed: false,
            points: vec![[0.0, 0.0], [1.0, i as f64]],
        };
        let curves: Vec<Curve> = (0..200).map(curve).collect();
        let labels: Vec<String> = typical(&curves, "y").into_iter().map(|curve| curve.label).collect();
        assert_eq!(
            labels,
            ["grain 0 y, lowest of 200", "grain 100 y, median of 200", "grain 199 y, highest of 200"]
        );
    }

    #[test]
    fn a_pattern_is_the_sum_of_its_bodies() {
        let of = |time: f64, body: &str, mass: f64, x: f64| BodyRow {
            time,
            body: body.to_owned(),
            state: BodyState { mass, position: [x, 0.0, 0.0], kinetic: mass * x, ..BodyState::default() },
        };
        let rows = [
            of(0.0, "grain 1", 1.0, 0.0),
            of(0.0, "wall", 0.0, 9.0),
            of(0.0, "grain 2", 3.0, 4.0),
            of(1.0, "grain 1", 1.0, 2.0),
            of(1.0, "grain 2", 3.0, 6.0),
        ];
        let sums = sums(&rows, "grain *");
        let told: Vec<_> = sums
            .iter()
            .map(|row| (row.time, &*row.body, row.state.mass, row.state.position[0], row.state.kinetic))
            .collect();
        assert_eq!(told, [(0.0, "grain *", 4.0, 3.0, 12.0), (1.0, "grain *", 4.0, 5.0, 20.0)]);
    }

    #[test]
    fn bodies_that_rest_are_not_drawn() {
        let rows = [row(0.0, 1.0), row(1.0, 3.0)];
        let panel = center_panel(&rows, &["sphere".to_owned()]);
        assert_eq!(panel.curves.len(), 1);
        assert_eq!(panel.curves[0].points, vec![[0.0, 0.0], [1.0, 2.0]]);
    }
}
