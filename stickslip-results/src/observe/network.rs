//! The contacts of one time as a graph: bodies are its nodes, forces its edges.
//!
//! Written as GraphML (Brandes et al. 2002), which NetworkX, igraph and Gephi read.

use super::bodies::BodyRow;
use super::contacts::ContactRow;
use super::file::ReadError;
use super::results::Results;
use super::table::TableRow;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::collections::BTreeSet;
use std::io::{self, Write};

/// Who presses on whom, averaged from the row of the tables before to the one at `time`.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// Simulated time [s].
    pub time: f64,
    /// All bodies, in the order of the scene.
    pub bodies: Vec<BodyRow>,
    /// The pairs that touched.
    pub contacts: Vec<ContactRow>,
}

/// Attributes of a body in the graph, its name and columns of its table, and of a contact.
const OF_BODY: [&str; 5] = ["name", "x", "y", "z", "mass"];
const OF_CONTACT: [&str; 12] =
    ["fx", "fy", "fz", "normal", "tangential", "x", "y", "z", "area", "gap", "slip", "friction"];

impl Network {
    /// The network at the recorded time nearest to `time` [s], the last one for `None`, of the bodies that have rows in
    /// `bodies.csv` then.
    ///
    /// # Errors
    /// `bodies.csv` or `contacts.csv` is missing or damaged.
    pub fn read(results: &Results, time: Option<f64>) -> Result<Self, ReadError> {
        let bodies = results.bodies_table()?;
        let contacts = results.contacts_table()?;
        let distance = |row: &BodyRow| time.map_or(-row.time, |time| (row.time - time).abs());
        let nearest =
            bodies.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(0.0, |row| row.time);
        let bodies: Vec<_> = bodies.into_iter().filter(|row| row.time == nearest).collect();
        let known: BTreeSet<&str> = bodies.iter().map(|row| row.body.as_str()).collect();
        let is_between = |row: &ContactRow| {
            row.time == nearest && [&row.body_a, &row.body_b].iter().all(|name| known.contains(name.as_str()))
        };
        let contacts = contacts.into_iter().filter(is_between).collect();
        Ok(Network { time: nearest, bodies, contacts })
    }

    /// Mean number of contacts of a body that has any: the coordination number without rattlers [-].
    pub fn coordination(&self) -> f64 {
        let touching: BTreeSet<&str> =
            self.contacts.iter().flat_map(|row| [row.body_a.as_str(), row.body_b.as_str()]).collect();
        if touching.is_empty() { 0.0 } else { 2.0 * self.contacts.len() as f64 / touching.len() as f64 }
    }

    /// Writes the graph as GraphML.
    ///
    /// # Errors
    /// What the sink says.
    pub fn write(&self, sink: impl Write) -> io::Result<()> {
        let mut xml = Writer::new_with_indent(sink, b' ', 1);
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        xml.write_event(Event::Comment(BytesText::new(" Stickslip ")))?;
        let root =
            xml.create_element("graphml").with_attribute(("xmlns", "http://graphml.graphdrawing.org/xmlns"));
        root.write_inner_content(|xml| {
            for (kind, names) in [("node", &OF_BODY[..]), ("edge", &OF_CONTACT[..])] {
                for name in names {
                    let (id, of) =
                        (format!("{kind}_{name}"), if *name == "name" { "string" } else { "double" });
                    xml.create_element("key")
                        .with_attributes([
                            ("id", id.as_str()),
                            ("for", kind),
                            ("attr.name", *name),
                            ("attr.type", of),
                        ])
                        .write_empty()?;
                }
            }
            let time = format!("t = {} s", self.time);
            xml.create_element("graph")
                .with_attributes([("id", time.as_str()), ("edgedefault", "directed")])
                .write_inner_content(|xml| {
                    for row in &self.bodies {
                        let value = |column: &str| row.number(column).map(|number| number.to_string());
                        let values = OF_BODY.map(|column| value(column).unwrap_or_else(|| row.body.clone()));
                        xml.create_element("node")
                            .with_attribute(("id", row.body.as_str()))
                            .write_inner_content(|xml| data(xml, "node", &OF_BODY, &values))?;
                    }
                    for row in &self.contacts {
                        let value =
                            |column: &str| row.number(column).expect("a column of numbers").to_string();
                        let ends = [("source", row.body_a.as_str()), ("target", row.body_b.as_str())];
                        xml.create_element("edge").with_attributes(ends).write_inner_content(|xml| {
                            data(xml, "edge", &OF_CONTACT, &OF_CONTACT.map(value))
                        })?;
                    }
                    Ok(())
                })?;
            Ok(())
        })?;
        xml.into_inner().write_all(b"\n")
    }
}

/// The attributes of one body or contact.
fn data<W: Write>(xml: &mut Writer<W>, kind: &str, names: &[&str], values: &[String]) -> io::Result<()> {
    for (name, value) in names.iter().zip(values) {
        xml.create_element("data")
            .with_attribute(("key", format!("{kind}_{name}").as_str()))
            .write_text_content(BytesText::new(value))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::door::{BodyState, ContactMean};

    fn network() -> Network {
        let body = |name: &str| BodyRow {
            body: name.into(),
            state: BodyState { mass: 2.0, ..BodyState::default() },
            ..BodyRow::default()
        };
        let contact = |a: &str, b: &str| ContactRow {
            body_a: a.into(),
            body_b: b.into(),
            mean: ContactMean { normal: 7.5, ..ContactMean::default() },
            ..ContactRow::default()
        };
        Network {
            time: 0.25,
            bodies: ["a", "b <&>", "c", "rattler"].map(body).to_vec(),
            contacts: vec![contact("a", "b <&>"), contact("b <&>", "c")],
        }
    }

    #[test]
    fn rattlers_do_not_count() {
        assert!((network().coordination() - 4.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn the_graph_has_every_body_and_every_contact() {
        let mut text = Vec::new();
        network().write(&mut text).expect("a vector takes everything");
        let text = String::from_utf8(text).expect("XML is UTF-8");
        let mut reader = quick_xml::Reader::from_str(&text);
        let (mut nodes, mut edges, mut keys) = (0, 0, 0);
        loop {
            match reader.read_event().expect("sound XML") {
                Event::Start(tag) => match tag.name().0 {
                    "node" => nodes += 1,
                    "edge" => edges += 1,
                    _ => {}
                },
                Event::Empty(_) => keys += 1,
                Event::Eof => break,
                _ => {}
            }
        }
        assert_eq!((nodes, edges, keys), (4, 2, OF_BODY.len() + OF_CONTACT.len()), "{text}");
        assert!(text.contains("<data key=\"edge_normal\">7.5</data>"), "{text}");
    }
}
