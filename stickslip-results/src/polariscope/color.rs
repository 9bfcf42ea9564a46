//! From spectra to the colours of a screen.

/// Visible wavelengths [nm].
pub const VISIBLE: std::ops::RangeInclusive<u32> = 380..=780;

/// The CIE 1931 colour matching functions x, y, z at a wavelength [nm], within about 1 %: multi-lobe fit of Wyman,
/// Sloan and Shirley (2013), Journal of Computer Graphics Techniques 2(2), eq. (4).
pub fn color_matching(wavelength: f64) -> [f64; 3] {
    let lobe = |height: f64, center: f64, [below, above]: [f64; 2]| {
        let width = if wavelength < center { below } else { above };
        height * (-0.5 * ((wavelength - center) / width).powi(2)).exp()
    };
    [
        lobe(1.056, 599.8, [37.9, 31.0])
            + lobe(0.362, 442.0, [16.0, 26.7])
            + lobe(-0.065, 501.1, [20.4, 26.2]),
        lobe(0.821, 568.8, [46.9, 40.5]) + lobe(0.286, 530.9, [16.3, 31.1]),
        lobe(1.217, 437.0, [11.8, 36.0]) + lobe(0.681, 459.0, [26.0, 13.8]),
    ]
}

/// Linear red, green and blue of a colour X, Y, Z (IEC 61966-2-1, white D65); out of gamut where negative or over 1.
pub fn linear_srgb([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ]
}

/// The byte of a linear share of a colour, 0 to 1 (IEC 61966-2-1).
pub fn srgb_byte(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// The linear share of a colour, 0 to 1, that a byte of a picture stands for (IEC 61966-2-1).
pub fn linear_of_srgb(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// [`srgb_byte`] without its power: where each byte begins, and the byte at the start of equal parts of 0 to 1.
pub struct Screen {
    /// Byte `k + 1` begins at entry `k`.
    begins: [f64; 255],
    first: [u8; PARTS],
}

const PARTS: usize = 1024;

impl Screen {
    /// The table.
    pub fn new() -> Self {
        let begins = std::array::from_fn(|k| {
            let (mut below, mut above) = (0.0, 1.0);
            while let middle = 0.5 * (below + above)
                && below < middle
                && middle < above
            {
                if usize::from(srgb_byte(middle)) > k { above = middle } else { below = middle }
            }
            above
        });
        Screen { begins, first: std::array::from_fn(|part| srgb_byte(part as f64 / PARTS as f64)) }
    }

    /// The byte of a linear share of a colour, 0 to 1.
    pub fn byte(&self, linear: f64) -> u8 {
        let mut byte = self.first[((linear.clamp(0.0, 1.0) * PARTS as f64) as usize).min(PARTS - 1)];
        while byte < u8::MAX && linear >= self.begins[usize::from(byte)] {
            byte += 1;
        }
        byte
    }
}

/// Each visible nanometre's share of linear red, green and blue in light of equal power at all wavelengths, adapted so
/// that the sum is the screen's white.
pub fn white_light() -> Vec<(f64, [f64; 3])> {
    /// X, Y, Z of the screen's white.
    const D65: [f64; 3] = [0.9505, 1.0, 1.089];
    let matching: Vec<(f64, [f64; 3])> =
        VISIBLE.map(|nm| (f64::from(nm), color_matching(f64::from(nm)))).collect();
    let total = |i: usize| matching.iter().map(|(_, xyz)| xyz[i]).sum::<f64>();
    let adapted = [0, 1, 2].map(|i| D65[i] / total(i));
    let shares: Vec<(f64, [f64; 3])> = matching
        .iter()
        .map(|(nm, xyz)| (nm * 1e-9, linear_srgb([0, 1, 2].map(|i| xyz[i] * adapted[i]))))
        .collect();
    let sum = [0, 1, 2].map(|i| shares.iter().map(|(_, rgb)| rgb[i]).sum::<f64>());
    shares.into_iter().map(|(nm, rgb)| (nm, [0, 1, 2].map(|i| rgb[i] / sum[i]))).collect()
}

/// The brightest colour of a screen that is nearest to light of one wavelength [m], linear.
pub fn spectral_color(wavelength: f64) -> [f64; 3] {
    let rgb = linear_srgb(color_matching(wavelength * 1e9)).map(|share| share.max(0.0));
    let brightest = rgb.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    rgb.map(|share| share / brightest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE 1931 tables at 450, 550 and 600 nm.
    #[test]
    fn color_matching_is_near_the_table() {
        for (nm, table) in [
            (450.0, [0.3362, 0.0380, 1.7721]),
            (550.0, [0.4334, 0.9950, 0.0087]),
            (600.0, [1.0622, 0.6310, 0.0008]),
        ] {
            for (fit, table) in color_matching(nm).into_iter().zip(table) {
                assert!((fit - table).abs() < 0.03, "{nm} nm: {fit} {table}");
            }
        }
    }

    #[test]
    fn the_screen_has_the_bytes_of_the_equation() {
        let screen = Screen::new();
        for i in -100..200_100 {
            let linear = f64::from(i) / 200_000.0;
            assert_eq!(screen.byte(linear), srgb_byte(linear), "{linear}");
        }
        assert_eq!(screen.byte(f64::NAN), srgb_byte(f64::NAN));
    }

    #[test]
    fn wavelengths_have_their_colors() {
        let [red, green, blue] = spectral_color(650e-9);
        assert!(red == 1.0 && green < 0.1 && blue < 0.1);
        let [red, green, blue] = spectral_color(530e-9);
        assert!(green == 1.0 && red < 0.2 && blue < 0.2);
        let [red, green, blue] = spectral_color(460e-9);
        assert!(blue == 1.0 && red < 0.3 && green < 0.3);
    }
}
