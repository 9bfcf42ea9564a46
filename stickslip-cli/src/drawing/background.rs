//! What a picture stands on.

use std::str::FromStr;

/// What a picture stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// A colour: red, green and blue.
    Color([u8; 3]),
    /// Nothing: whoever shows the picture decides.
    Transparent,
}

/// A background that cannot be understood.
#[derive(Debug, thiserror::Error)]
#[error("allowed: transparent, white, black, or a colour as #RRGGBB")]
pub struct UnknownBackground;

impl FromStr for Background {
    type Err = UnknownBackground;

    fn from_str(text: &str) -> Result<Self, UnknownBackground> {
        match text {
            "transparent" => return Ok(Background::Transparent),
            "white" => return Ok(Background::Color([255; 3])),
            "black" => return Ok(Background::Color([0; 3])),
            _ => {}
        }
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6).ok_or(UnknownBackground)?;
        let number = digits.chars().all(|c| c.is_ascii_hexdigit()).then(|| u32::from_str_radix(digits, 16));
        let number = number.and_then(Result::ok).ok_or(UnknownBackground)?;
        let [_, red, green, blue] = number.to_be_bytes();
        Ok(Background::Color([red, green, blue]))
    }
}

impl Background {
    /// The colours that a picture is drawn on: of a transparent one white and black.
    pub fn colors(self) -> Vec<[u8; 3]> {
        match self {
            Background::Color(color) => vec![color],
            Background::Transparent => vec![[255; 3], [0; 3]],
        }
    }

    /// Whether lines and letters must be light to be seen on it.
    pub fn is_dark(self) -> bool {
        let Background::Color([red, green, blue]) = self else { return false };
        // Rec. 709: how bright the colours look.
        0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue) < 110.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backgrounds_read_as_they_are_written() {
        let read = |text: &str| text.parse::<Background>();
        assert_eq!(read("transparent").unwrap(), Background::Transparent);
        assert_eq!(read("#1a2B3c").unwrap(), Background::Color([0x1a, 0x2b, 0x3c]));
        assert!(read("#1a2B3c").unwrap().is_dark() && !read("white").unwrap().is_dark());
        for wrong in ["#12345", "#+12345", "grey", ""] {
            assert!(read(wrong).unwrap_err().to_string().contains("#RRGGBB"), "{wrong}");
        }
    }
}
