//! Tables whose rows are about something named: columns over time, with the axes that they belong on.

use super::{ChartTable, Curve, Panel};
use crate::drawing::body_color;
use stickslip::observe::{
    CellValue, ContactRow, FabricRow, GroupContactRow, GroupRow, JointRow, LoadRow, ReactionRow, ReadError,
    RemovedRow, Results, SectionRow, TableRow,
};

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedRow {
    /// What it is about: the names in it.
    pub name: String,
    /// Time [s].
    pub time: f64,
    /// The other columns of numbers, in SI units.
    pub numbers: Vec<(&'static str, f64)>,
}

/// The rows of a table; none of those that are not such a one.
///
/// # Errors
/// The table cannot be read.
pub fn rows(results: &Results, table: ChartTable) -> Result<Vec<NamedRow>, ReadError> {
    Ok(match table {
        ChartTable::Contacts => named(results.contacts_table()?),
        ChartTable::Loads => named(results.loads_table()?),
        ChartTable::Joints => named(results.joints_table()?),
        ChartTable::Sections => named(results.sections_table()?),
        ChartTable::Reactions => named(results.reactions_table()?),
        ChartTable::Groups => named(results.groups_table()?),
        ChartTable::GroupContacts => named(results.group_contacts_table()?),
        ChartTable::Fabric => named(results.fabric_table()?),
        ChartTable::Removed => named(results.removed_table()?),
        _ => Vec::new(),
    })
}

/// The rows of any table.
///
/// # Errors
/// The table cannot be read.
pub fn rows_of_any(results: &Results, table: ChartTable) -> Result<Vec<NamedRow>, ReadError> {
    match table {
        ChartTable::Bodies => results.bodies_table().map(named),
        ChartTable::Energy => results.energy_table().map(named),
        ChartTable::Probes => results.probes_table().map(named),
        ChartTable::Arrivals => results.arrivals_table().map(named),
        ChartTable::Fronts => results.fronts_table().map(named),
        _ => rows(results, table),
    }
}

/// Columns of numbers of such a table, without the time.
pub fn columns(table: ChartTable) -> Vec<&'static str> {
    match table {
        ChartTable::Contacts => numbers_of::<ContactRow>(),
        ChartTable::Loads => numbers_of::<LoadRow>(),
        ChartTable::Joints => numbers_of::<JointRow>(),
        ChartTable::Sections => numbers_of::<SectionRow>(),
        ChartTable::Reactions => numbers_of::<ReactionRow>(),
        ChartTable::Groups => numbers_of::<GroupRow>(),
        ChartTable::GroupContacts => numbers_of::<GroupContactRow>(),
        ChartTable::Fabric => numbers_of::<FabricRow>(),
        ChartTable::Removed => numbers_of::<RemovedRow>(),
        _ => Vec::new(),
    }
}

fn numbers_of<R: TableRow>() -> Vec<&'static str> {
    named(vec![R::default()]).iter().flat_map(|row| row.numbers.iter().map(|(name, _)| *name)).collect()
}

fn named<R: TableRow>(rows: Vec<R>) -> Vec<NamedRow> {
    let each = |mut row: R| {
        let (mut names, mut time, mut numbers) = (Vec::new(), 0.0, Vec::new());
        for (column, cell) in row.columns() {
            match cell {
                CellValue::Number(number) if column == "time" => time = *number,
                CellValue::Number(number) => numbers.push((column, *number)),
                CellValue::Count(count) => numbers.push((column, *count as f64)),
                CellValue::Name(name) if name.is_empty() => {}
                CellValue::Name(name) => names.push(name.clone()),
            }
        }
        NamedRow { name: names.join(", "), time, numbers }
    };
    rows.into_iter().map(each).collect()
}

/// Name and unit of the axis that a column belongs on.
pub fn axis(column: &str) -> (&'static str, &'static str) {
    match column {
        "x" | "y" | "z" => ("position", "m"),
        "vx" | "vy" | "vz" => ("velocity", "m/s"),
        "wx" | "wy" | "wz" => ("angular velocity", "rad/s"),
        "ux" | "uy" | "uz" => ("displacement", "m"),
        "fx" | "fy" | "fz" | "normal" | "tangential" => ("force", "N"),
        "mx" | "my" | "mz" => ("moment", "N m"),
        "px" | "py" | "pz" => ("momentum", "kg m/s"),
        "lx" | "ly" | "lz" => ("angular momentum", "kg m\u{b2}/s"),
        "mass" => ("mass", "kg"),
        "kinetic" | "strain" | "energy" | "work" | "friction" => ("energy", "J"),
        "gap" => ("gap", "m"),
        "slip" => ("slip", "m"),
        // In the plane a length.
        "area" => ("area", ""),
        "way" => ("way", ""),
        "rate" => ("rate", ""),
        "nodes" | "bodies" | "particles" | "contacts" | "coordination" | "mechanical" => ("number", ""),
        "xx" | "yy" | "zz" | "xy" | "yz" | "xz" => ("stress", "Pa"),
        "solid" => ("share of solid", ""),
        column if column.starts_with("fabric_") => ("fabric", ""),
        _ => ("value", ""),
    }
}

/// Columns over time, those that share an axis in one panel, and of many curves the `most` with the largest values;
/// where pairs have rows only while they touch, `times` are those of all rows.
pub fn panels(rows: &[NamedRow], columns: &[String], (most, times): (usize, &[f64])) -> Vec<Panel> {
    let mut panels: Vec<Panel> = Vec::new();
    for column in columns {
        let (name, unit) = axis(column);
        let place = panels.iter().position(|panel| panel.name == name).unwrap_or_else(|| {
            panels.push(Panel { name: name.to_owned(), unit, curves: Vec::new() });
            panels.len() - 1
        });
        let mut curves: Vec<Curve> = Vec::new();
        for row in rows {
            let number = row.numbers.iter().find(|(name, _)| name == column);
            let Some(&(_, number)) = number else { continue };
            let label = format!("{} {column}", row.name);
            let point = [row.time, number];
            match curves.iter_mut().find(|curve| curve.label == label) {
                Some(curve) => curve.points.push(point),
                None => curves.push(Curve { label, color: [0.0; 3], dashed: false, points: vec![point] }),
            }
        }
        // Pairs that do not touch have no row: no force, and no place.
        let nothing = if matches!(name, "force" | "number" | "area" | "energy") { 0.0 } else { f64::NAN };
        curves.iter_mut().for_each(|curve| fill(&mut curve.points, (times, nothing)));
        panels[place].curves.extend(curves);
    }
    for panel in &mut panels {
        // A number that is none is never the larger one.
        let size = |curve: &Curve| curve.points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
        panel.curves.sort_by(|a, b| size(b).total_cmp(&size(a)));
        panel.curves.truncate(most);
        panel.curves.iter_mut().enumerate().for_each(|(i, curve)| curve.color = body_color(i));
    }
    panels.retain(|panel| !panel.curves.is_empty());
    panels
}

/// Points at all times, with a number where there is none.
fn fill(points: &mut Vec<[f64; 2]>, (times, nothing): (&[f64], f64)) {
    if times.is_empty() {
        return;
    }
    let known = std::mem::take(points);
    let mut next = known.iter().peekable();
    let at = |&time: &f64| next.next_if(|point| point[0] == time).copied().unwrap_or([time, nothing]);
    *points = times.iter().map(at).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_that_do_not_touch_have_no_force() {
        let row = |time: f64, name: &str, normal: f64| NamedRow {
            name: name.to_owned(),
            time,
            numbers: vec![("normal", normal), ("gap", -normal)],
        };
        let rows = [row(1.0, "disk, wall", 2.0), row(2.0, "disk, wall", 3.0), row(2.0, "disk, striker", 9.0)];
        let times = [0.0, 1.0, 2.0, 3.0];
        let panels = panels(&rows, &["normal".to_owned(), "gap".to_owned()], (8, &times));
        assert_eq!(
            panels.iter().map(|panel| (&*panel.name, panel.unit)).collect::<Vec<_>>(),
            [("force", "N"), ("gap", "m")]
        );
        let [striker, wall] = &panels[0].curves[..] else { panic!("{panels:?}") };
        assert_eq!(striker.label, "disk, striker normal", "the largest force first");
        assert_eq!(wall.points, [[0.0, 0.0], [1.0, 2.0], [2.0, 3.0], [3.0, 0.0]]);
        let [(begin, before), (end, after)] =
            [0, 3].map(|i| (panels[1].curves[1].points[i][0], panels[1].curves[1].points[i][1]));
        assert!(before.is_nan() && after.is_nan(), "there is no gap where nothing touches");
        assert_eq!((begin, panels[1].curves[1].points[1], end), (0.0, [1.0, -2.0], 3.0));
    }

    #[test]
    fn every_column_of_numbers_has_an_axis() {
        use ChartTable::{
            Contacts, Fabric, GroupContacts, Groups, Joints, Loads, Reactions, Removed, Sections,
        };
        for table in [Contacts, Loads, Joints, Sections, Reactions, Groups, GroupContacts, Fabric, Removed] {
            let columns = columns(table);
            assert!(columns.len() >= 6 && !columns.contains(&"time"), "{columns:?}");
            assert!(columns.iter().all(|column| axis(column).0 != "value"), "{columns:?}");
        }
    }
}
