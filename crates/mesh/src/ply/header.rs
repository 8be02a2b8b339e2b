//! The header of a PLY: encoding of the numbers, and the elements in their order.

use crate::error::{FilePosition, MeshErrorKind, quote};
use crate::text::{Scanner, integer};
use juggler_math::suggest::closest;

/// Maximum number of elements of a file and of properties of an element. Real files have a handful;
/// Gaussian splats have about sixty properties.
const MAX_DECLARATIONS: usize = 1000;

/// The declarations of a header.
#[derive(Debug)]
pub(super) struct Header {
    /// Encoding of the numbers.
    pub encoding: Encoding,
    /// The elements that follow, in order.
    pub elements: Vec<Element>,
    /// Warning about ignored lines that are not comments.
    pub warning: Option<String>,
}

/// Encoding of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As text.
    Ascii,
    /// As bytes.
    Binary(ByteOrder),
}

/// Byte order of binary numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

/// A table of rows: `element NAME COUNT` and its properties.
#[derive(Debug)]
pub(super) struct Element {
    /// `vertex`, `face`, ...
    pub name: String,
    /// Number of rows.
    pub count: u64,
    /// Columns.
    pub properties: Vec<Property>,
    /// Line of the declaration.
    pub place: FilePosition,
}

/// A column: `property TYPE NAME` or `property list TYPE TYPE NAME`.
#[derive(Debug)]
pub(super) struct Property {
    /// `x`, `vertex_indices`, ...
    pub name: String,
    /// Type of the length of a list; `None` for a single number.
    pub length: Option<Scalar>,
    /// Type of the value, or of each value in the list.
    pub item: Scalar,
}

/// Type of a number, by its PLY names.
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

    /// Size of a value in a binary file, in bytes.
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
    /// Index of the column with this name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|property| property.name == name)
    }
}

impl Header {
    /// Reads the header up to and including the line `end_header`.
    pub fn read(scanner: &mut Scanner<'_>) -> Result<Self, MeshErrorKind> {
        let first = scanner.word();
        if first != Some(b"ply") {
            return Err(scanner.expected("'ply'", first));
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        let mut ignored = IgnoredLines::default();
        while scanner.next_line() {
            match scanner.word() {
                None | Some(b"comment" | b"obj_info") => {}
                Some(b"format") => encoding = Some(read_format(scanner)?),
                Some(b"element") => add_element(&mut elements, scanner)?,
                Some(b"property") => add_property(&mut elements, scanner)?,
                Some(b"end_header") => {
                    let place = scanner.place();
                    scanner.next_line();
                    let missing = || place.error("expected a line 'format ...' before 'end_header'");
                    let encoding = encoding.ok_or_else(missing)?;
                    return Ok(Self { encoding, elements, warning: ignored.warning() });
                }
                Some(word) => ignored.pass(word, scanner)?,
            }
        }
        Err(ignored.error.unwrap_or_else(|| scanner.expected("'end_header'", None)))
    }
}

/// Maximum number of bytes in which a comment is searched.
const MAX_SEARCHED: usize = 1 << 20;

/// Name of the picture of the surface in the header's first comment `TextureFile NAME`, as MeshLab
/// writes it; the last part of a path. `None` for other files.
pub fn texture_file(bytes: &[u8]) -> Option<String> {
    let head = bytes.get(..MAX_SEARCHED).unwrap_or(bytes);
    let mut lines = head.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    lines.next().filter(|line| *line == b"ply")?;
    let name = lines.take_while(|line| *line != b"end_header").find_map(|line| {
        let (word, name) = line.strip_prefix(b"comment")?.trim_ascii_start().split_at_checked(b"TextureFile".len())?;
        (word.eq_ignore_ascii_case(b"TextureFile") && name.first().is_some_and(u8::is_ascii_whitespace)).then_some(name)
    })?;
    let name = std::str::from_utf8(name).ok()?.rsplit(['/', '\\']).next()?.trim();
    Some(name.to_owned()).filter(|name| !name.is_empty())
}

/// Lines of a header that are neither declarations nor comments, as some exporters write them.
#[derive(Default)]
struct IgnoredLines {
    count: u64,
    /// The first such line with its line number, as shown in the warning.
    first: String,
    /// Error about the first such line, reported if the header has no end.
    error: Option<MeshErrorKind>,
}

impl IgnoredLines {
    /// Skips a line that begins with `word`, unless `word` looks like a misspelled keyword.
    fn pass(&mut self, word: &[u8], scanner: &mut Scanner<'_>) -> Result<(), MeshErrorKind> {
        const KEYWORDS: [&str; 3] = ["format", "element", "property"];
        let error = scanner.expected("'element', 'property', 'comment' or 'end_header'", Some(word));
        if str::from_utf8(word).is_ok_and(|word| closest(word, KEYWORDS).is_some()) {
            return Err(error);
        }
        self.count += 1;
        if self.error.is_none() {
            let line = [word, scanner.rest_of_line()].concat();
            self.first = format!("{}: {}", scanner.place(), quote(&line));
            self.error = Some(error);
        }
        Ok(())
    }

    fn warning(&self) -> Option<String> {
        match self.count {
            0 => None,
            1 => Some(format!("ignored an unknown line of the header: {}", self.first)),
            more => Some(format!("ignored {more} unknown lines of the header, the first {}", self.first)),
        }
    }
}

fn read_format(scanner: &mut Scanner<'_>) -> Result<Encoding, MeshErrorKind> {
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

fn add_element(elements: &mut Vec<Element>, scanner: &mut Scanner<'_>) -> Result<(), MeshErrorKind> {
    let name = name(scanner, "the element's name")?;
    let word = scanner.word();
    let count = word.and_then(integer).and_then(|count| u64::try_from(count).ok());
    let count = count.ok_or_else(|| scanner.expected("the number of elements", word))?;
    if elements.iter().any(|element| element.name == name) {
        return Err(scanner.place().error(format!("element {} is declared twice", quote(name.as_bytes()))));
    }
    if elements.len() == MAX_DECLARATIONS {
        return Err(scanner.place().error(format!("more than {MAX_DECLARATIONS} elements")));
    }
    elements.push(Element { name, count, properties: Vec::new(), place: scanner.place() });
    Ok(())
}

fn add_property(elements: &mut [Element], scanner: &mut Scanner<'_>) -> Result<(), MeshErrorKind> {
    let Some(element) = elements.last_mut() else {
        return Err(scanner.place().error("expected 'element' before the first 'property'"));
    };
    let first = scanner.word();
    let (length, item) = if first == Some(b"list") {
        (Some(scalar(scanner, None)?), scalar(scanner, None)?)
    } else {
        (None, scalar(scanner, first)?)
    };
    let name = name(scanner, "the property's name")?;
    if element.column(&name).is_some() {
        return Err(scanner.place().error(format!("property {} is declared twice", quote(name.as_bytes()))));
    }
    if element.properties.len() == MAX_DECLARATIONS {
        return Err(scanner.place().error(format!("more than {MAX_DECLARATIONS} properties of one element")));
    }
    element.properties.push(Property { name, length, item });
    Ok(())
}

/// Parses `word`, or the next word if it is `None`, as a type.
fn scalar(scanner: &mut Scanner<'_>, word: Option<&[u8]>) -> Result<Scalar, MeshErrorKind> {
    let word = word.or_else(|| scanner.word());
    word.and_then(Scalar::named).ok_or_else(|| scanner.expected("a type (char, uchar, ..., float, double)", word))
}

fn name(scanner: &mut Scanner<'_>, what: &str) -> Result<String, MeshErrorKind> {
    let word = scanner.word().ok_or_else(|| scanner.expected(what, None))?;
    Ok(String::from_utf8_lossy(word).into_owned())
}
