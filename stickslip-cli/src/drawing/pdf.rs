//! Drawings as PDF files of one page: lines stay lines, and letters are letters of an embedded font.
//!
//! [`PdfPage`] is drawn on as plotters' other kinds of files are. Lengths are pixels of 1/96 inch.

use super::DrawError;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use plotters::style::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::io::Write;
use subsetter::GlyphRemapper;
use ttf_parser::Face;

/// A page that is drawn on.
pub struct PdfPage {
    size: [u32; 2],
    content: Content,
    /// Upright and bold.
    fonts: [EmbeddedFont; 2],
    /// Opacities in use, in parts of 255.
    opacities: Vec<u8>,
}

/// What of a font a page uses.
struct EmbeddedFont {
    data: &'static [u8],
    face: Face<'static>,
    /// Numbers of its glyphs in the file.
    numbers: GlyphRemapper,
    /// Letter and width in the thousandth part of the letters' size, by number in the file.
    used: BTreeMap<u16, (char, f32)>,
}

/// A page as plotters draws on it.
pub struct PdfBackend<'a>(&'a mut PdfPage);

/// Points of 1/72 inch in a pixel.
const POINT: f32 = 0.75;
/// What plotters calls the size of letters is their line's height; so the letters are as large as in SVG files.
const LINE: f64 = 1.24;
/// What part of a circle's radius the handles of a Bézier curve for a quarter of it are long.
const HANDLE: f32 = 0.552_285;
const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const INFORMATION: Ref = Ref::new(5);
const FONT_NAMES: [Name; 2] = [Name(b"F0"), Name(b"F1")];
const BASE_NAMES: [Name; 2] = [Name(b"STKSLP+DejaVuSans"), Name(b"STKSLP+DejaVuSans-Bold")];

impl PdfPage {
    /// An empty page of a width and height in pixels.
    pub fn new(size: [usize; 2]) -> Self {
        super::register_font();
        let size = size.map(|side| side as u32);
        let mut content = Content::new();
        // Lengths are in pixels, from the left and from the top.
        content.transform([POINT, 0.0, 0.0, -POINT, 0.0, size[1] as f32 * POINT]);
        content.set_line_join(LineJoinStyle::RoundJoin);
        content.set_line_cap(LineCapStyle::ButtCap);
        let fonts = super::fonts().map(EmbeddedFont::new);
        PdfPage { size, content, fonts, opacities: Vec::new() }
    }

    /// What draws on the page.
    pub fn backend(&mut self) -> PdfBackend<'_> {
        PdfBackend(self)
    }

    /// The file.
    ///
    /// # Errors
    /// A font cannot be cut down to what is used of it.
    pub fn finish(self) -> Result<Vec<u8>, DrawError> {
        let PdfPage { size, content, fonts, opacities } = self;
        let mut pdf = Pdf::new();
        pdf.document_info(INFORMATION).producer(TextStr("Stickslip"));
        pdf.catalog(CATALOG).pages(PAGES);
        pdf.pages(PAGES).kids([PAGE]).count(1);
        let mut page = pdf.page(PAGE);
        let [width, height] = size.map(|side| side as f32 * POINT);
        page.media_box(Rect::new(0.0, 0.0, width, height)).parent(PAGES).contents(CONTENT);
        let mut resources = page.resources();
        let mut names = resources.fonts();
        let first = |font: usize| Ref::new(10 + 10 * font as i32);
        for (font, name) in
            FONT_NAMES.into_iter().enumerate().filter(|(font, _)| !fonts[*font].used.is_empty())
        {
            names.pair(name, first(font));
        }
        names.finish();
        let mut states = resources.ext_g_states();
        for opacity in opacities {
            let part = f32::from(opacity) / 255.0;
            let name = opacity_name(opacity);
            let mut state =
                states.insert(Name(name.as_bytes())).start::<pdf_writer::writers::ExtGraphicsState>();
            state.non_stroking_alpha(part).stroking_alpha(part);
        }
        states.finish();
        resources.finish();
        page.finish();
        pdf.stream(CONTENT, &deflated(&content.finish())).filter(Filter::FlateDecode);
        for (i, font) in fonts.iter().enumerate().filter(|(_, font)| !font.used.is_empty()) {
            font.write(&mut pdf, first(i), BASE_NAMES[i])?;
        }
        Ok(pdf.finish())
    }

    fn set_opacity(&mut self, color: BackendColor) {
        let opacity = (color.alpha.clamp(0.0, 1.0) * 255.0).round() as u8;
        if !self.opacities.contains(&opacity) {
            self.opacities.push(opacity);
        }
        self.content.set_parameters(Name(opacity_name(opacity).as_bytes()));
    }

    fn fill_with(&mut self, color: BackendColor) {
        self.set_opacity(color);
        let (r, g, b) = color.rgb;
        let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
        self.content.set_fill_rgb(r, g, b);
    }

    fn stroke_with(&mut self, style: &impl BackendStyle) {
        let color = style.color();
        self.set_opacity(color);
        let (r, g, b) = color.rgb;
        let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
        self.content.set_stroke_rgb(r, g, b).set_line_width(style.stroke_width() as f32);
    }

    /// Begins a path through some points; false if there are none.
    fn path(&mut self, points: impl IntoIterator<Item = BackendCoord>) -> bool {
        let mut is_begun = false;
        for (x, y) in points {
            let (x, y) = (x as f32, y as f32);
            if is_begun {
                self.content.line_to(x, y)
            } else {
                self.content.move_to(x, y)
            };
            is_begun = true;
        }
        is_begun
    }
}

fn opacity_name(opacity: u8) -> String {
    format!("O{opacity}")
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory takes all bytes")
}

impl EmbeddedFont {
    fn new(data: &'static [u8]) -> Self {
        let face = Face::parse(data, 0).expect("the embedded font is a valid font");
        EmbeddedFont { data, face, numbers: GlyphRemapper::new(), used: BTreeMap::new() }
    }

    /// A text in the numbers of the font's glyphs, two bytes each, and its width over the letters' size.
    fn encode(&mut self, text: &str) -> (Vec<u8>, f32) {
        let (mut bytes, mut width) = (Vec::new(), 0.0);
        let unit = f32::from(self.face.units_per_em());
        for letter in text.chars() {
            let glyph = self.face.glyph_index(letter).unwrap_or_default();
            let wide = f32::from(self.face.glyph_hor_advance(glyph).unwrap_or_default()) / unit;
            let number = self.numbers.remap(glyph.0);
            self.used.insert(number, (letter, 1000.0 * wide));
            bytes.extend(number.to_be_bytes());
            width += wide;
        }
        (bytes, width)
    }

    fn write(&self, pdf: &mut Pdf, first: Ref, name: Name) -> Result<(), DrawError> {
        let [descendant, descriptor, letters, file] = [1, 2, 3, 4].map(|k| Ref::new(first.get() + k));
        let mut font = pdf.type0_font(first);
        font.base_font(name).encoding_predefined(Name(b"Identity-H"));
        font.descendant_font(descendant).to_unicode(letters);
        font.finish();
        let system = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
        let mut font = pdf.cid_font(descendant);
        font.subtype(CidFontType::Type2).base_font(name).system_info(system).font_descriptor(descriptor);
        font.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = font.widths();
        for (number, (_, width)) in &self.used {
            widths.same(*number, *number, *width);
        }
        widths.finish();
        font.finish();
        let thousandths = |length: i16| 1000.0 * f32::from(length) / f32::from(self.face.units_per_em());
        let bounds = self.face.global_bounding_box();
        let [low_x, low_y, high_x, high_y] =
            [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(thousandths);
        let mut about = pdf.font_descriptor(descriptor);
        about.name(name).flags(FontFlags::NON_SYMBOLIC).bbox(Rect::new(low_x, low_y, high_x, high_y));
        about.italic_angle(0.0).ascent(thousandths(self.face.ascender()));
        about.descent(thousandths(self.face.descender())).stem_v(80.0).font_file2(file);
        about.cap_height(thousandths(self.face.capital_height().unwrap_or_default()));
        about.finish();
        let mut map = UnicodeCmap::<u16>::new(Name(b"Letters"), system);
        self.used.iter().for_each(|(number, (letter, _))| map.pair(*number, *letter));
        pdf.stream(letters, &deflated(&map.finish())).filter(Filter::FlateDecode);
        let subset = subsetter::subset(self.data, 0, &self.numbers).map_err(DrawError::ink)?;
        let length = subset.len() as i32;
        pdf.stream(file, &deflated(&subset)).filter(Filter::FlateDecode).pair(Name(b"Length1"), length);
        Ok(())
    }
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for PdfBackend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        let [width, height] = self.0.size;
        (width, height)
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.draw_rect((x, y), (x + 1, y + 1), &color, true)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        if fill {
            self.fill_polygon(corners, style)
        } else {
            self.draw_path(corners.into_iter().chain([(left, top)]), style)
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        if style.color().alpha > 0.0 && style.stroke_width() > 0 {
            self.0.stroke_with(style);
            if self.0.path(path) {
                self.0.content.stroke();
            }
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        if style.color().alpha == 0.0 {
            return Ok(());
        }
        if fill {
            self.0.fill_with(style.color())
        } else {
            self.0.stroke_with(style)
        };
        let (x, y, r) = (x as f32, y as f32, radius as f32);
        let content = &mut self.0.content;
        content.move_to(x + r, y);
        for [c, s, next_c, next_s] in
            [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, -1.0, 0.0], [-1.0, 0.0, 0.0, -1.0], [0.0, -1.0, 1.0, 0.0]]
        {
            let first = [x + r * (c - HANDLE * s), y + r * (s + HANDLE * c)];
            let second = [x + r * (next_c + HANDLE * next_s), y + r * (next_s - HANDLE * next_c)];
            content.cubic_to(first[0], first[1], second[0], second[1], x + r * next_c, y + r * next_s);
        }
        content.close_path();
        if fill {
            content.fill_nonzero()
        } else {
            content.stroke()
        };
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        if style.color().alpha > 0.0 {
            self.0.fill_with(style.color());
            if self.0.path(corners) {
                self.0.content.close_path().fill_nonzero();
            }
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Drawn {
        if style.color().alpha == 0.0 {
            return Ok(());
        }
        let font = usize::from(matches!(style.style(), FontStyle::Bold));
        let size = (style.size() / LINE) as f32;
        let (bytes, width) = self.0.fonts[font].encode(text);
        let along = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5 * width * size,
            HPos::Right => -width * size,
        };
        // Half of a small letter's height is 0.27 of the size.
        let down = size
            * match style.anchor().v_pos {
                VPos::Top => 0.76,
                VPos::Center => 0.27,
                VPos::Bottom => -0.27,
            };
        // Directions along and down of the text, on a page whose second axis points down.
        let [[ax, ay], [dx, dy]]: [[f32; 2]; 2] = match style.transform() {
            FontTransform::Rotate90 => [[0.0, 1.0], [-1.0, 0.0]],
            FontTransform::Rotate180 => [[-1.0, 0.0], [0.0, -1.0]],
            FontTransform::Rotate270 => [[0.0, -1.0], [1.0, 0.0]],
            _ => [[1.0, 0.0], [0.0, 1.0]],
        };
        let start = [x as f32 + along * ax + down * dx, y as f32 + along * ay + down * dy];
        self.0.fill_with(style.color());
        let content = &mut self.0.content;
        content.begin_text().set_font(FONT_NAMES[font], size);
        content.set_text_matrix([ax, ay, -dx, -dy, start[0], start[1]]).show(Str(&bytes)).end_text();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::prelude::{Circle, Color, IntoDrawingArea, IntoFont, RGBColor, Text};

    #[test]
    fn a_page_has_its_letters_and_their_font() {
        let mut page = PdfPage::new([200, 100]);
        let area = page.backend().into_drawing_area();
        let style = ("sans-serif", 20).into_font().color(&RGBColor(10, 20, 30));
        area.draw(&Text::new("\u{b5}s \u{2212}1", (10, 10), style)).unwrap();
        area.draw(&Circle::new((50, 50), 5, RGBColor(1, 2, 3).mix(0.5).filled())).unwrap();
        area.present().unwrap();
        drop(area);
        let used: String = page.fonts[0].used.values().map(|(letter, _)| *letter).collect();
        assert_eq!(used.chars().count(), 5);
        assert!(used.contains('\u{2212}') && used.contains('\u{b5}'));
        let file = page.finish().unwrap();
        assert!(file.starts_with(b"%PDF-") && file.len() < 20_000, "{}", file.len());
        let has = |words: &str| file.windows(words.len()).any(|part| part == words.as_bytes());
        assert!(has("DejaVuSans") && !has("Bold") && has("150 75"), "a page of 200 x 100 pixels");
    }
}
