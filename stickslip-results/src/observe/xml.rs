//! Attributes of the XML that a run writes.

use super::file::ReadProblem;
use crate::scene::steers_terminal;
use quick_xml::events::BytesStart;
use std::str::FromStr;

/// The value of an attribute that must be there, without control characters, and must be of this kind.
pub(super) fn attribute<T: FromStr>(tag: &BytesStart, name: &str) -> Result<T, ReadProblem> {
    let found = tag.try_get_attribute(name).map_err(quick_xml::Error::from)?;
    let found = found.as_ref().filter(|attribute| !attribute.value.contains(steers_terminal));
    let value = found.and_then(|attribute| attribute.value.parse().ok());
    value.ok_or_else(|| ReadProblem::Layout(format!("no readable `{name}` in <{}>", tag.name().0)))
}
