//! The header of a PLY: how the numbers are written, and which rows of what follow in which order.

use super::super::error::{Fault, Place, quote};
use super::super::text::{Scanner, integer};
use crate::suggest::closest;

/// The most elements of a file and properties of an element; real files have a handful, point clouds of
/// Gaussians some sixty properties.
const MAX_DECLARATIONS: usize = 1000;

/// What the header promises.
#[derive(Debug)]
pub(super) struct Header {
    /// How numbers are written.
    pub encoding: Encoding,
    /// What follows, in order.
    pub elements: Vec<Element>,
    /// Lines that are passed over although they are no comments, in words.
    pub warning: Option<String>,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As text.
    Ascii,
    /// As bytes.
    Binary(ByteOrder),
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    /// The least significant.
    Little,
    /// The most significant.
    Big,
}

/// A table: `element NAME COUNT`, and its columns.
#[derive(Debug)]
pub(super) struct Element {
    /// `vertex`, `face`, ...
    pub name: String,
    /// Rows.
    pub count: u64,
    /// Columns.
    pub properties: Vec<Property>,
    /// Its line in the header.
    pub place: Place,
}

/// A column: `property TYPE NAME` or `property list TYPE TYPE NAME`.
#[derive(Debug)]
pub(super) struct Property {
    /// `x`, `vertex_indices`, ...
    pub name: String,
    /// For a list, the type of its length.
    pub length: Option<Scalar>,
    /// Type of the value, or of each value in the list.
    pub item: Scalar,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    /// `char`, `int8`
    I8,
    /// `uchar`, `uint8`
    U8,
    /// `short`, `int16`
    I16,
    /// `ushort`, `uint16`
    U16,
    /// `int`, `int32`
    I32,
    /// `uint`, `uint32`
    U32,
    /// `float`, `float32`
    F32,
    /// `double`, `float64`
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of one in a binary file.
    pub fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl Element {
    /// Number of this column, if there is one.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|property| property.name == name)
    }
}

impl Header {
    /// Reads up to and with the line `end_header`.
    pub fn read(scanner: &mut Scanner<'_>) -> Result<Self, Fault> {
        let first = scanner.word();
        if first != Some(b"ply") {
            return Err(scanner.expected("'ply'", first));
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        let mut strays = Strays::default();
        while scanner.next_line() {
            match scanner.word() {
                None | Some(b"comment" | b"obj_info") => {}
                Some(b"format") => encoding = Some(read_format(scanner)?),
                Some(b"element") => add_element(&mut elements, scanner)?,
                Some(b"property") => add_property(&mut elements, scanner)?,
                Some(b"end_header") => {
                    let place = scanner.place();
                    scanner.next_line();
                    let missing = || place.fault("expected a line 'format ...' before 'end_header'");
                    let encoding = encoding.ok_or_else(missing)?;
                    return Ok(Self { encoding, elements, warning: strays.warning() });
                }
                Some(word) => strays.pass(word, scanner)?,
            }
        }
        Err(strays.fault.unwrap_or_else(|| scanner.expected("'end_header'", None)))
    }
}

/// Lines of a header that are neither declarations nor comments, as some exporters write them.
#[derive(Default)]
struct Strays {
    count: u64,
    /// The first such line as it may be shown.
    first: String,
    /// What is wrong with the first such line if the header has no end.
    fault: Option<Fault>,
}

impl Strays {
    /// Passes over a line that begins with `word`, unless `word` looks like a misspelt keyword.
    fn pass(&mut self, word: &[u8], scanner: &mut Scanner<'_>) -> Result<(), Fault> {
        const KEYWORDS: [&str; 3] = ["format", "element", "property"];
        let fault = scanner.expected("'element', 'property', 'comment' or 'end_header'", Some(word));
        if str::from_utf8(word).is_ok_and(|word| closest(word, KEYWORDS).is_some()) {
            return Err(fault);
        }
        self.count += 1;
        if self.fault.is_none() {
            let line = [word, scanner.rest_of_line()].concat();
            self.first = format!("{}: {}", scanner.place(), quote(&line));
            self.fault = Some(fault);
        }
        Ok(())
    }

    fn warning(&self) -> Option<String> {
        match self.count {
            0 => None,
            1 => Some(format!("ignored a line of the header that is no comment: {}", self.first)),
            more => Some(format!("ignored {more} lines of the header that are no comments, the first {}", self.first)),
        }
    }
}

fn read_format(scanner: &mut Scanner<'_>) -> Result<Encoding, Fault> {
    let encoding = match scanner.word() {
        Some(b"ascii") => Encoding::Ascii,
        Some(b"binary_little_endian") => Encoding::Binary(ByteOrder::Little),
        Some(b"binary_big_endian") => Encoding::Binary(ByteOrder::Big),
        word => return Err(scanner.expected("'ascii', 'binary_little_endian' or 'binary_big_endian'", word)),
    };
    match scanner.word() {
        Some(b"1.0") => Ok(encoding),
        word => Err(scanner.expected("version '1.0'", word)),
    }
}

fn add_element(elements: &mut Vec<Element>, scanner: &mut Scanner<'_>) -> Result<(), Fault> {
    let name = name(scanner, "the element's name")?;
    let word = scanner.word();
    let count = word.and_then(integer).and_then(|count| u64::try_from(count).ok());
    let count = count.ok_or_else(|| scanner.expected("the number of rows", word))?;
    if elements.iter().any(|element| element.name == name) {
        return Err(scanner.place().fault(format!("element {} is declared twice", quote(name.as_bytes()))));
    }
    if elements.len() == MAX_DECLARATIONS {
        return Err(scanner.place().fault(format!("more than {MAX_DECLARATIONS} elements")));
    }
    elements.push(Element { name, count, properties: Vec::new(), place: scanner.place() });
    Ok(())
}

fn add_property(elements: &mut [Element], scanner: &mut Scanner<'_>) -> Result<(), Fault> {
    let Some(element) = elements.last_mut() else {
        return Err(scanner.place().fault("expected 'element' before the first 'property'"));
    };
    let first = scanner.word();
    let (length, item) = if first == Some(b"list") {
        (Some(scalar(scanner, None)?), scalar(scanner, None)?)
    } else {
        (None, scalar(scanner, first)?)
    };
    let name = name(scanner, "the property's name")?;
    if element.column(&name).is_some() {
        return Err(scanner.place().fault(format!("property {} is declared twice", quote(name.as_bytes()))));
    }
    if element.properties.len() == MAX_DECLARATIONS {
        return Err(scanner.place().fault(format!("more than {MAX_DECLARATIONS} properties of one element")));
    }
    element.properties.push(Property { name, length, item });
    Ok(())
}

/// The type that this word names, or the next word.
fn scalar(scanner: &mut Scanner<'_>, word: Option<&[u8]>) -> Result<Scalar, Fault> {
    let word = word.or_else(|| scanner.word());
    word.and_then(Scalar::named).ok_or_else(|| scanner.expected("a type (char, uchar, ..., float, double)", word))
}

fn name(scanner: &mut Scanner<'_>, what: &str) -> Result<String, Fault> {
    let word = scanner.word().ok_or_else(|| scanner.expected(what, None))?;
    Ok(String::from_utf8_lossy(word).into_owned())
}
