//! From located values to the tables of a scene file.

use crate::scene::document_node::{DocumentNode, Value, joined};
use crate::scene::error::Fault;
use crate::scene::suggestion::did_you_mean;

/// Something that a key of a scene file can hold.
pub trait Read: Sized {
    /// What is allowed, for messages.
    fn wanted() -> String;

    /// From the value of the key.
    ///
    /// # Errors
    /// Values of another type, unknown and missing keys.
    fn read(node: &DocumentNode) -> Result<Self, Fault>;

    /// What it is when `table` does not have the key `name`.
    ///
    /// # Errors
    /// Whatever must be there.
    fn absent(table: &DocumentNode, name: &str) -> Result<Self, Fault> {
        Err(Fault::new(&joined(&table.key(), name), "nothing, the key is missing", Self::wanted()))
    }
}

impl<T: Read> Read for Option<T> {
    fn wanted() -> String {
        T::wanted()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        T::read(node).map(Some)
    }

    fn absent(_table: &DocumentNode, _name: &str) -> Result<Self, Fault> {
        Ok(None)
    }
}

impl<T: Read> Read for Box<T> {
    fn wanted() -> String {
        T::wanted()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        T::read(node).map(Box::new)
    }
}

impl<T: Read> Read for Vec<T> {
    fn wanted() -> String {
        format!("a list [...] of {}", T::wanted())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::List(items) => items.iter().map(T::read).collect(),
            Value::Table(_) => {
                let help = format!("tables in a list have two brackets: [[{}]]", node.key());
                Err(node.fault(Self::wanted()).help(Some(help)))
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

/// The value of `name` in the table `node`.
pub fn field<T: Read>(node: &DocumentNode, name: &str) -> Result<T, Fault> {
    match node.children().iter().find(|child| child.name() == name) {
        Some(child) => T::read(child),
        None => T::absent(node, name),
    }
}

/// Refuses a value that is no table, and keys that are not among `known`.
pub fn check_keys(node: &DocumentNode, known: &[&str]) -> Result<(), Fault> {
    let Value::Table(children) = &node.value else {
        return Err(node.fault(format!("a table with the keys {}", known.join(", "))));
    };
    match children.iter().find(|child| !known.contains(&child.name())) {
        Some(child) => Err(unknown_key(child, known)),
        None => Ok(()),
    }
}

/// The fault of a key that is not among `known`.
pub fn unknown_key(child: &DocumentNode, known: &[&str]) -> Fault {
    let name = child.name();
    let help = did_you_mean(name, known.iter().copied()).or_else(|| {
        let above = super::File::KEYS.contains(&name) && child.key() != name;
        above.then(|| format!("`{name}` belongs to the top of the file, above the first [table]"))
    });
    Fault::new(&child.key(), format!("unknown key `{name}`"), known.join(", "))
        .help(help)
        .at(child.name_span())
}

/// Declares a table of the scene file: its keys are the fields, their documentation is the schema's.
macro_rules! table {
    ($(#[$about:meta])* $name:ident { $($(#[$field_about:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(schemars::JsonSchema)]
        #[schemars(deny_unknown_fields)]
        pub struct $name {
            $($(#[$field_about])* pub $field: $type,)*
        }

        impl $name {
            /// The keys of the table.
            pub const KEYS: &'static [&'static str] = &[$(stringify!($field)),*];
        }

        impl $crate::scene::file::read::Read for $name {
            fn wanted() -> String {
                format!("a table with the keys {}", Self::KEYS.join(", "))
            }

            fn read(
                node: &$crate::scene::document_node::DocumentNode,
            ) -> Result<Self, $crate::scene::error::Fault> {
                $crate::scene::file::read::check_keys(node, Self::KEYS)?;
                Ok($name { $($field: $crate::scene::file::read::field(node, stringify!($field))?,)* })
            }
        }
    };
}
pub(super) use table;
