//! Plane or space: the row of disks in plane strain, in plane stress and as plates in space, on the same cells.

use super::answers::sequence;
use super::ingredients::case;
use crate::failure::Failure;
use crate::page::{Cell, Column, Table};
use crate::reproduce::case::{PaperCase, PaperResolution, PaperScene, Runs};
use crate::reproduce::chain::Chain;
use crate::reproduce::disks::ARRANGEMENTS;
use stickslip::scene::Dimension;

/// Plane strain, plane stress, and the plate.
pub fn cases(level: PaperResolution) -> [PaperCase; 3] {
    let cells = if level == PaperResolution::Full { 48 } else { 32 };
    let plane = |dimension| {
        case((PaperScene::PLEXIGLAS_ROW, dimension), cells, &[("dimension", dimension), ("duration", "14")])
    };
    let space = case((PaperScene::PLEXIGLAS_PLATE, "space"), cells, &[("duration", "14")]);
    [plane("plane-strain"), plane("plane-stress"), space]
}

/// Waves, waits and fringes of each.
///
/// # Errors
/// Tables or pictures cannot be read.
pub fn table(level: PaperResolution, runs: &Runs) -> Result<Table, Failure> {
    let [strain, stress, space] = cases(level);
    let frames = ARRANGEMENTS[0].measured;
    let mut columns = vec![Column::text(""), Column::number("longitudinal waves [km/s]")];
    columns.extend((1..=4).map(|disk| Column::number(format!("at the centre of disk {disk}"))));
    columns.push(Column::number("from disk to disk"));
    columns.extend(frames.map(|time| Column::number(format!("most like the plates at {time}"))));
    let caption = "The row of Plexiglas disks in the plane and in space, where plates of the experiment's thickness, half of it above a mirror, have the \
                   same cells: speed of longitudinal waves of ultrasound (none is given for plates: in them long waves run as in plane stress, and \
                   only the very front as in plane strain); arrival of 0.3 of the pressure behind a plane wave, and the mean interval from disk to disk, in transits; and when the fringes are most like those of the plates at the \
                   experiment's times, with their correlation.";
    let mut table = Table::new(caption, columns);
    let plates = sequence(runs, &space)?;
    let rows = [
        ("plane strain", strain, Dimension::PlaneStrain),
        ("plane stress", stress, Dimension::PlaneStress),
        ("plates in space", space, Dimension::Space),
    ];
    for (title, case, dimension) in rows {
        let Some(results) = runs.get(&case) else { continue };
        let scene = results.scene().map_err(Failure::input)?;
        let [bulk, shear, density] = ["bulk", "shear", "density"].map(|name| scene.number(name));
        let modulus = bulk + 4.0 / 3.0 * shear;
        let stiffness = match dimension {
            Dimension::PlaneStrain => modulus,
            // M - (M - 2G)^2 / M, with no stress out of the plane.
            Dimension::PlaneStress => 4.0 * shear * (1.0 - shear / modulus),
            Dimension::Space => f64::NAN,
        };
        let speed = (stiffness / density).sqrt();
        let mut row = vec![Cell::text(title), Cell::number(speed / 1e3, 2)];
        let arrivals = Chain::new(results).map_or(Ok(Vec::new()), |chain| chain.arrivals())?;
        row.extend((0..4).map(|disk| match arrivals.get(disk).copied().flatten() {
            Some(time) => Cell::number(time, 2),
            None => Cell::text("not yet"),
        }));
        row.push(match arrivals[..] {
            [Some(first), .., Some(last)] => Cell::number((last - first) / (arrivals.len() - 1) as f64, 2),
            _ => Cell::text("not yet"),
        });
        if let (Some(run), Some(plates)) = (sequence(runs, &case)?, &plates) {
            row.extend(frames.map(|time| match run.most_like(plates, time, [0.5 * time, 2.0 * time]) {
                Some(alike) => Cell::Number(format!("{:.2}, {:.2}", alike.time, alike.correlation)),
                None => Cell::text("not yet"),
            }));
        }
        table = table.row(row);
    }
    Ok(table)
}
