//! What the page can ask for: a fixed list, in which no address is a path of the disk.

use std::fmt;
use std::str::FromStr;

/// Something that the page can ask for. Frames and bodies are numbers, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Route {
    /// The page itself.
    Page,
    /// What there is: times, bodies, quantities.
    Index,
    /// How far the run is: short, asked for each second.
    Pulse,
    /// Energy and momentum through time.
    Energy,
    /// Places of the particles of a frame.
    Frame(usize),
    /// Values of a quantity at the particles of a frame.
    Column(usize, String),
    /// Triangles of the bodies' surfaces.
    Skins,
    /// Places of their corners in a frame.
    SkinsIn(usize),
    /// Values of a quantity at their corners in a frame.
    SkinColumn(usize, String),
    /// Forces between bodies at the time of a frame.
    Contacts(usize),
    /// A frame in polarised light.
    Fringes(usize),
    /// A body through time.
    Body(usize),
    /// A quantity at a particle of a body through the frames: body, number in it, quantity.
    Particle(usize, u32, String),
}

impl FromStr for Route {
    type Err = ();

    fn from_str(path: &str) -> Result<Self, ()> {
        let parts: Vec<&str> = path.strip_prefix('/').ok_or(())?.split('/').collect();
        let number = |text: &str| text.parse::<usize>().map_err(drop);
        Ok(match parts[..] {
            [""] => Route::Page,
            ["index"] => Route::Index,
            ["pulse"] => Route::Pulse,
            ["energy"] => Route::Energy,
            ["frame", frame] => Route::Frame(number(frame)?),
            ["column", frame, quantity] => Route::Column(number(frame)?, quantity.to_owned()),
            ["skins"] => Route::Skins,
            ["skins", frame] => Route::SkinsIn(number(frame)?),
            ["skins", frame, quantity] => Route::SkinColumn(number(frame)?, quantity.to_owned()),
            ["contacts", frame] => Route::Contacts(number(frame)?),
            ["fringes", frame] => Route::Fringes(number(frame)?),
            ["body", body] => Route::Body(number(body)?),
            ["particle", body, particle, quantity] => {
                Route::Particle(number(body)?, particle.parse().map_err(drop)?, quantity.to_owned())
            }
            _ => return Err(()),
        })
    }
}

impl fmt::Display for Route {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Route::Page => f.write_str("/"),
            Route::Index => f.write_str("/index"),
            Route::Pulse => f.write_str("/pulse"),
            Route::Energy => f.write_str("/energy"),
            Route::Frame(frame) => write!(f, "/frame/{frame}"),
            Route::Column(frame, quantity) => write!(f, "/column/{frame}/{quantity}"),
            Route::Skins => f.write_str("/skins"),
            Route::SkinsIn(frame) => write!(f, "/skins/{frame}"),
            Route::SkinColumn(frame, quantity) => write!(f, "/skins/{frame}/{quantity}"),
            Route::Contacts(frame) => write!(f, "/contacts/{frame}"),
            Route::Fringes(frame) => write!(f, "/fringes/{frame}"),
            Route::Body(body) => write!(f, "/body/{body}"),
            Route::Particle(body, particle, quantity) => write!(f, "/particle/{body}/{particle}/{quantity}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn routes_read_as_they_are_written() {
        for route in [
            Route::Page,
            Route::Index,
            Route::Pulse,
            Route::Energy,
            Route::Frame(3),
            Route::Column(0, "stress.xy".to_owned()),
            Route::Contacts(12),
            Route::Skins,
            Route::SkinsIn(2),
            Route::SkinColumn(2, "damage".to_owned()),
            Route::Fringes(1),
            Route::Body(7),
            Route::Particle(2, 90, "pressure".to_owned()),
        ] {
            assert_eq!(route.to_string().parse(), Ok(route));
        }
    }

    #[test]
    fn no_address_is_a_path_of_the_disk() {
        for address in [
            "",
            "/..",
            "/../run.json",
            "/run.json",
            "/frame/../1",
            "/frame/-1",
            "/frame/1/",
            "//",
            "/body/1e3",
        ] {
            assert_eq!(address.parse::<Route>(), Err(()), "{address}");
        }
    }
}
