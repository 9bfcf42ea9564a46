//! The report as a table for the terminal.

use super::contact::{ContactEstimate, ContactResolution};
use super::loads::LoadReport;
use super::report::{BodyReport, Report};
use super::rules::RuleReport;
use crate::scene::ContactLaw;
use std::fmt::{Display, Formatter, Result};

/// Rows that each list of the report takes on the screen.
const BODIES: usize = 10;
const CONTACTS: usize = 5;
/// Pairs of bodies, or rules, that are shown with their law.
const PAIRS: usize = 10;
/// Pairs without an estimate that are named.
const UNKNOWN: usize = 3;
/// Steps whose wall time is said where it is not known how many there will be.
const ROUND_STEPS: u64 = 1000;

/// A part of the wall time that is said beside it.
const NOTABLE: f64 = 0.2;

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let space = self.dimension.name();
        let cell = short(self.cell);
        let [fewest, most] =
            self.particles_per_side.map(|per_side| per_side.pow(self.dimension.axes() as u32));
        let per_cell = if fewest == most { fewest.to_string() } else { format!("{fewest} to {most}") };
        writeln!(f, "{}", self.title)?;
        writeln!(f, "{space}, cells of {cell} m, {per_cell} particles a cell\n")?;
        self.write_bodies(f)?;
        for material in self.materials.iter().take(BODIES) {
            let (longitudinal, shear) = (short(material.longitudinal_speed), short(material.shear_speed));
            writeln!(f, "waves in {}: {longitudinal} m/s longitudinal, {shear} m/s shear", material.name)?;
        }
        writeln!(f)?;
        if let Some(interior) = &self.interior {
            writeln!(f, "interior     {interior}")?;
        }
        writeln!(f, "particles    {}", self.particles)?;
        let [memory, copy] = [self.memory, self.checkpoint_memory].map(bytes);
        writeln!(f, "memory       {memory} (estimated), and {copy} more while a checkpoint is written")?;
        writeln!(
            f,
            "time step    {} s, {} steps to {} s",
            short(self.time_step),
            self.steps,
            short(self.end)
        )?;
        writeln!(f, "wall time    {} ({})", self.told_wall_time(), self.told_machine())?;
        if self.start_time() > (NOTABLE * self.wall_time).max(1.0) {
            writeln!(f, "             of which {} before the first step", duration(self.start_time()))?;
        }
        if self.rigid_contacts > 0 {
            let contacts = self.rigid_contacts;
            writeln!(
                f,
                "             with {contacts} contacts of rigid bodies: less once these rest, more where they fall"
            )?;
        }
        self.write_loads(f)?;
        self.write_rules(f)?;
        self.write_contacts(f)?;
        self.write_unknown(f)?;
        for warning in &self.warnings {
            writeln!(f, "\nwarning: {warning}")?;
        }
        Ok(())
    }
}

impl Report {
    /// The expected wall time in words: nobody knows before how many steps lead to rest.
    fn told_wall_time(&self) -> String {
        let whole = duration(self.wall_time);
        if !self.ends_at_rest || self.steps <= ROUND_STEPS {
            return whole;
        }
        let start = self.start_time();
        let round = duration(start + (self.wall_time - start) * ROUND_STEPS as f64 / self.steps as f64);
        format!("{round} for {ROUND_STEPS} steps until the bodies are at rest, {whole} if they never are")
    }

    /// The machine that the wall time is for: its rate is that of particles on the common grid.
    fn told_machine(&self) -> String {
        let (cores, rate) = (self.machine.cores, short(self.machine.particle_steps_per_second / 1e6));
        let cores = format!("{cores} core{}", if cores == 1 { "" } else { "s" });
        match self.own_grids {
            None => format!("at {rate} million particle-steps/s a core, {cores}"),
            Some(own) if own.is_all => cores,
            Some(_) => format!("at {rate} million particle-steps/s a core on the common grid, {cores}"),
        }
    }

    fn write_bodies(&self, f: &mut Formatter<'_>) -> Result {
        let unit = if self.dimension.is_plane() { "mass [kg/m]" } else { "mass [kg]" };
        let width = column(self.bodies.iter().take(BODIES).map(|body| &body.name), "body");
        let material = column(self.bodies.iter().take(BODIES).map(|body| &body.material), "material");
        writeln!(
            f,
            "{:width$}  {:material$}  {:>11}  {unit:>11}  size [m]",
            "body", "material", "particles"
        )?;
        for body in self.bodies.iter().take(BODIES) {
            let BodyReport { name, material: of, particles, mass, size, .. } = body;
            let size: Vec<_> = size[..self.dimension.axes()].iter().map(|&s| short(s)).collect();
            let (particles, mass, size) = match body.size.iter().all(|side| side.is_finite()) {
                true => (particles.to_string(), short(*mass), size.join(" x ")),
                false => (format!("~{particles}"), "-".to_string(), "unbounded, near others".to_string()),
            };
            let rigid = if body.rigid { ", rigid" } else { "" };
            writeln!(f, "{name:width$}  {of:material$}  {particles:>11}  {mass:>11}  {size}{rigid}")?;
        }
        match self.bodies.len().saturating_sub(BODIES) {
            0 => writeln!(f),
            more => writeln!(f, "... and {more} more\n"),
        }
    }

    fn write_loads(&self, f: &mut Formatter<'_>) -> Result {
        if self.loads.is_empty() {
            return Ok(());
        }
        let width = column(self.loads.iter().take(BODIES).map(|load| &load.name), "support or load");
        let body = column(self.loads.iter().take(BODIES).map(|load| &load.body), "on body");
        writeln!(f, "\n{:width$}  {:body$}  part", "support or load", "on body")?;
        for LoadReport { name, body: on, points, measure, unit, .. } in self.loads.iter().take(BODIES) {
            writeln!(f, "{name:width$}  {on:body$}  {} {unit}, {points} points", short(*measure))?;
        }
        match self.loads.len().saturating_sub(BODIES) {
            0 => Ok(()),
            more => writeln!(f, "... and {more} more"),
        }
    }

    /// A line for each pair, or for each rule where there are too many.
    fn write_rules(&self, f: &mut Formatter<'_>) -> Result {
        if self.rules.is_empty() {
            return Ok(());
        }
        let count: usize = self.rules.iter().map(|rule| rule.pairs.len()).sum();
        let named = |pair: &[String; 2]| pair.join(" and ");
        let mut rows: Vec<(String, &RuleReport)> = Vec::new();
        for rule in &self.rules {
            if count <= PAIRS {
                rows.extend(rule.pairs.iter().map(|pair| (named(pair), rule)));
            } else {
                let first = named(&rule.pairs[0]);
                let others = rule.pairs.len() - 1;
                rows.push((if others == 0 { first } else { format!("{first}, {others} more pairs") }, rule));
            }
        }
        let shown = || rows.iter().take(PAIRS);
        let width = column(shown().map(|(pairs, _)| pairs), "pair");
        writeln!(f, "\n{:width$}  {:<10}  friction", "pair", "law")?;
        for (pairs, rule) in shown() {
            let law = ContactLaw::words().find(|word| word.1 == rule.law).map_or("", |word| word.0);
            writeln!(f, "{pairs:width$}  {law:<10}  {}", rule.friction())?;
        }
        match rows.len().saturating_sub(PAIRS) {
            0 => Ok(()),
            more => writeln!(f, "... and {more} more rules"),
        }
    }

    fn write_contacts(&self, f: &mut Formatter<'_>) -> Result {
        if self.contacts.is_empty() {
            return self.write_unjudged(f);
        }
        let name = |contact: &ContactEstimate| contact.bodies.join(" on ");
        let names: Vec<_> = self.contacts.iter().take(CONTACTS).map(name).collect();
        let width = column(names.iter(), "contact (Hertz)");
        writeln!(
            f,
            "\n{:width$}  {:>14}  {:>9}  {:>7}  verdict",
            "contact (Hertz)", "half-width [m]", "depth [m]", "cells"
        )?;
        for (name, contact) in names.iter().zip(&self.contacts) {
            let (radius, depth) = (short(contact.patch.radius), short(contact.patch.depth));
            let (cells, verdict) = (contact.cells, contact.verdict);
            writeln!(f, "{name:width$}  {radius:>14}  {depth:>9}  {cells:>7.2}  {verdict}")?;
        }
        if self.contacts.len() > CONTACTS {
            let of = |verdict| self.contacts.iter().filter(|contact| contact.verdict == verdict).count();
            let verdicts =
                [ContactResolution::Resolved, ContactResolution::Marginal, ContactResolution::NotResolved];
            let counts = verdicts.map(|verdict| format!("{} {verdict}", of(verdict)));
            writeln!(f, "in all {}: {}", self.contacts.len(), counts.join(", "))?;
        }
        Ok(())
    }

    /// Why there is no verdict, where bodies could touch.
    fn write_unjudged(&self, f: &mut Formatter<'_>) -> Result {
        let deforms = self.bodies.iter().any(|body| !body.rigid);
        let may_push = self.rules.is_empty() || self.rules.iter().any(RuleReport::rubs);
        if self.bodies.len() < 2 || !deforms || !may_push || !self.contacts_unknown.is_empty() {
            return Ok(());
        }
        writeln!(
            f,
            "\ncontact (Hertz): not judged, as no bodies within a cell of each other are pressed together at the start; \
             a contact rule whose `between` names two bodies that approach has them judged however far apart"
        )
    }

    fn write_unknown(&self, f: &mut Formatter<'_>) -> Result {
        let unknown = &self.contacts_unknown;
        if unknown.is_empty() {
            return Ok(());
        }
        let names: Vec<_> = unknown.iter().take(UNKNOWN).map(|pair| pair.join(" on ")).collect();
        let more = unknown.len().saturating_sub(UNKNOWN);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let plural = if unknown.len() == 1 { "" } else { "s" };
        writeln!(
            f,
            "\nno estimate for {} contact{plural}, {}{more}: the shapes tell none; the summary of the run says how wide bodies touched",
            unknown.len(),
            names.join(", ")
        )
    }
}

impl Display for ContactResolution {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(match self {
            ContactResolution::Resolved => "resolved",
            ContactResolution::Marginal => "marginal",
            ContactResolution::NotResolved => "not resolved",
        })
    }
}

fn column<'a>(entries: impl Iterator<Item = &'a String>, head: &str) -> usize {
    entries.map(|entry| entry.chars().count()).max().unwrap_or(0).max(head.len())
}

/// Four digits, without trailing zeros.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = value.abs().log10().floor() as i32;
    if !(-3..6).contains(&digits) {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.*}", (3 - digits).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

pub(super) fn bytes(value: f64) -> String {
    match value {
        v if v >= 1e9 => format!("{:.1} GB", v / 1e9),
        v if v >= 1e6 => format!("{:.0} MB", v / 1e6),
        v => format!("{:.0} kB", v / 1e3),
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "less than a second".into(),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::MachineSpeed;
    use crate::check::tests::{at_rest, free, incline, report, scene};
    use crate::geometry::Shape;
    use crate::scene::{Body, ContactRule, Dimension, FrictionMemory, Interior};

    #[test]
    fn the_incline_reads_like_this() {
        let machine = MachineSpeed { particle_steps_per_second: 1e6, cores: 2 };
        let text = report(&incline(4.0)).expect("no problem").on(machine).to_string();
        let rows: Vec<_> =
            text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        for row in [
            "space, cells of 0.4 m, 8 particles a cell",
            "plane stiff 13312 1.065e6 20.8 x 3.2 x 1.6",
            "time step 0.0016 s, 1250 steps to 2 s",
            "wall time 9 s (at 1 million particle-steps/s a core, 2 cores)",
            "sphere on plane 0.2671 0.0446 0.67 not resolved",
        ] {
            assert!(
                rows.iter().any(|found| found == row),
                "{row}
{text}"
            );
        }
    }

    /// Cylinders on end.
    #[test]
    fn contacts_without_an_estimate_are_counted_and_the_first_named() {
        let pillar = |i: usize| {
            let x = i as f64;
            let [start, end] = [0.0, 1.0].map(|z| [x, 0.0, z]);
            free(&format!("pillar {i}"), 0, Shape::Cylinder { start, end, radius: 0.3 })
        };
        let text = |pillars: usize| {
            let floor = at_rest("floor", Shape::HalfSpace { point: [0.0; 3], normal: [0.0, 0.0, 1.0] });
            let bodies = (0..pillars).map(pillar).chain([floor]).collect();
            report(&scene(Dimension::Space, 0.1, bodies)).expect("no problem").to_string()
        };
        assert!(text(1).contains("\nno estimate for 1 contact, pillar 0 on floor: "), "{}", text(1));
        let four = "\nno estimate for 4 contacts, pillar 0 on floor, pillar 1 on floor, pillar 2 on floor and 1 more: ";
        assert!(text(4).contains(four), "{}", text(4));
    }

    #[test]
    fn contacts_that_are_not_judged_are_said_to_be_so() {
        let disks = |gap: f64, law: ContactLaw| {
            let disk = |i: usize| {
                let center = [i as f64 * (1.0 + gap), 0.0, 0.0];
                free(&format!("disk {i}"), 0, Shape::Ball { center, radius: 0.5 })
            };
            let mut scene = scene(Dimension::PlaneStrain, 0.05, (0..2).map(disk).collect());
            scene.contact = vec![ContactRule { law, ..Default::default() }];
            report(&scene).expect("no problem").to_string()
        };
        let said = disks(1.0, ContactLaw::Surface);
        assert!(said.contains("\ncontact (Hertz): not judged, as no bodies within a cell"), "{said}");
        let alone = disks(1.0, ContactLaw::None);
        assert!(!alone.contains("Hertz"), "{alone}");
    }

    /// Each pair by itself where there are few, by rules where there are many.
    #[test]
    fn every_pair_has_its_law_and_friction() {
        let said = |disks: usize| {
            let disk = |i: usize| {
                free(&format!("disk {i}"), 0, Shape::Ball { center: [i as f64, 0.0, 0.0], radius: 0.5 })
            };
            let mut scene = scene(Dimension::PlaneStrain, 0.05, (0..disks).map(disk).collect());
            let between = [Some("disk 0".to_string()), Some("disk 1".to_string())];
            scene.contact = vec![ContactRule {
                between,
                friction: 0.3,
                kinetic_friction: 0.3,
                friction_given: true,
                ..Default::default()
            }];
            report(&scene).expect("no problem").to_string()
        };
        let few = said(3);
        for row in [
            "\ndisk 0 and disk 1  surface     0.3, by contact[0]\n",
            "\ndisk 0 and disk 2  surface     0, as no rule names the pair: the default rule holds\n",
        ] {
            assert!(few.contains(row), "{row}{few}");
        }
        let many = said(20);
        assert!(many.contains("\ndisk 1 and disk 2, 17 more pairs  surface     0, as no rule"), "{many}");
    }

    #[test]
    fn a_memory_of_friction_stands_in_the_row_of_its_rule() {
        let disk = |i: usize| {
            let shape = Shape::Ball { center: [i as f64, 0.0, 0.0], radius: 0.5 };
            Body { interior: Some(Interior::Reference), ..free(&format!("disk {i}"), 0, shape) }
        };
        let mut scene = scene(Dimension::PlaneStrain, 0.05, (0..2).map(disk).collect());
        let friction_memory = Some(FrictionMemory { length: 1e-4, speed: 0.01 });
        scene.contact = vec![ContactRule { friction_memory, ..ContactRule::default().with_friction(0.3) }];
        let text = report(&scene).expect("no problem").to_string();
        let row =
            "\ndisk 0 and disk 1  surface     0.3, with a memory of 1.000e-4 m and 0.01 m/s, by contact[0]\n";
        assert!(text.contains(row), "{text}");
        scene.contact[0].friction_memory = None;
        let text = report(&scene).expect("no problem").to_string();
        let row =
            "\ndisk 0 and disk 1  surface     0.3, with a memory of five transits of a wave, by contact[0]\n";
        assert!(text.contains(row), "{text}");
    }

    #[test]
    fn thousands_of_bodies_fit_on_a_screen() {
        let disk = |i: usize| {
            let center = [(i % 32) as f64, (i / 32) as f64, 0.0];
            free(&format!("disk {i}"), 0, Shape::Ball { center, radius: 0.5 })
        };
        let mut scene = scene(Dimension::PlaneStrain, 0.2, (0..1024).map(disk).collect());
        scene.gravity = [0.0, -10.0, 0.0].into();
        let text = report(&scene).expect("no problem").to_string();
        assert!(text.lines().count() <= 40, "{text}");
        assert!(text.contains("... and 1014 more") && text.contains("in all 992: "), "{text}");
    }

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.4, "0.4"),
            (1234.56, "1235"),
            (123_456.0, "123456"),
            (1.065e6, "1.065e6"),
            (2.5e-5, "2.500e-5"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
        assert_eq!([duration(90.0), duration(3600.0), duration(1e6)], ["90 s", "60 min", "11.6 days"]);
        assert_eq!([bytes(5e3), bytes(5e6), bytes(5e10)], ["5 kB", "5 MB", "50.0 GB"]);
    }
}
