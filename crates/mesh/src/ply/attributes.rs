//! Attributes of vertices and faces of a PLY: the column `attribute.NAME`, or the columns
//! `attribute.NAME.0` to at most `attribute.NAME.3` of several channels. The type of the column is
//! that of the attribute: `uchar` and `ushort` are normalized integers, all other types become
//! floats. Names have blanks, control characters and `%` as `%` and two hexadecimal digits, as in
//! URLs, and so the last point before digits.

use super::header::{Element, Property, Scalar};
use super::values::Values;
use crate::error::{FilePosition, MeshErrorKind, quote};
use crate::text::finite;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use std::collections::BTreeMap;
use std::fmt::Write;

const PREFIX: &str = "attribute.";
/// Maximum number of channels.
const CHANNELS: usize = 4;
/// Maximum number of faulty attributes that a warning names.
const NAMED: usize = 16;

/// Attributes with their names.
pub(crate) type NamedAttributes = Vec<(String, MeshAttribute)>;

/// Columns of the attributes of an element.
pub(super) struct AttributeColumns {
    attributes: Vec<Columns>,
    /// Slot of each column of the element; `None` if the column is no attribute.
    slots: Vec<Option<usize>>,
    /// Warning about faulty attributes.
    pub warning: Option<String>,
}

/// Columns of an attribute.
struct Columns {
    name: String,
    channels: usize,
    item: Scalar,
}

/// Columns with their channels; `None` is the channel of a column without a number.
type Channels = Vec<(Option<usize>, usize)>;

impl AttributeColumns {
    /// Attributes of an element. Faulty ones are left out and named in the warning.
    pub fn of(element: &Element) -> Self {
        let mut found: BTreeMap<String, Channels> = BTreeMap::new();
        for (column, property) in element.properties.iter().enumerate() {
            if let Some((name, channel)) = parse(&property.name) {
                found.entry(name).or_default().push((channel, column));
            }
        }
        let mut all = Self { attributes: Vec::new(), slots: vec![None; element.properties.len()], warning: None };
        let mut faulty = Vec::new();
        for (name, channels) in found {
            match item(&channels, element) {
                Some(item) => all.push(name, item, &channels),
                None => faulty.push(quote(name.as_bytes())),
            }
        }
        all.warning = warning(faulty, element);
        all
    }

    fn push(&mut self, name: String, item: Scalar, channels: &Channels) {
        let first = self.slots();
        for (channel, column) in channels {
            if let Some(slot) = self.slots.get_mut(*column) {
                *slot = Some(first + channel.unwrap_or(0));
            }
        }
        self.attributes.push(Columns { name, channels: channels.len(), item });
    }

    /// Number of values of a row.
    pub fn slots(&self) -> usize {
        self.attributes.iter().map(|attribute| attribute.channels).sum()
    }

    /// Slot of a column's value in a row; `None` if the column is no attribute.
    pub fn slot(&self, column: usize) -> Option<usize> {
        self.slots.get(column).copied().flatten()
    }

    /// Bytes of the attributes of a vertex or triangle in the mesh.
    pub fn bytes(&self) -> u64 {
        self.attributes.iter().map(|attribute| stored_bytes(attribute.item) * attribute.channels as u64).sum()
    }

    /// Attributes without values, with room for `count` of them.
    pub fn empty(&self, domain: AttributeDomain, count: usize) -> NamedAttributes {
        let attribute = |columns: &Columns| {
            let numbers = count.saturating_mul(columns.channels);
            let data = match columns.item {
                Scalar::U8 => AttributeData::U8(Vec::with_capacity(numbers)),
                Scalar::U16 => AttributeData::U16(Vec::with_capacity(numbers)),
                _ => AttributeData::F32(Vec::with_capacity(numbers)),
            };
            (columns.name.clone(), MeshAttribute { domain, channels: columns.channels as u32, data })
        };
        self.attributes.iter().map(attribute).collect()
    }
}

/// Reads the value of an attribute's column. Integers of 8 and 16 bits are exact.
pub(super) fn read_number(values: &mut impl Values, property: &Property) -> Result<f32, MeshErrorKind> {
    let place = values.place();
    let number = values.real(property.item, &property.name)?;
    let largest = match property.item {
        Scalar::U8 => 255.0,
        Scalar::U16 => 65535.0,
        _ => {
            finite(number, place, &property.name)?;
            return Ok(number);
        }
    };
    if number.fract() == 0.0 && (0.0..=largest).contains(&number) {
        return Ok(number);
    }
    Err(out_of_range(place, property, largest, number))
}

#[cold]
fn out_of_range(place: FilePosition, property: &Property, largest: f32, number: f32) -> MeshErrorKind {
    let name = quote(property.name.as_bytes());
    place.error(format!("expected an integer from 0 to {largest} for {name}, found {number}"))
}

/// Appends the values of a row to the attributes.
pub(super) fn push_row(attributes: &mut NamedAttributes, row: &[f32]) {
    let mut rest = row;
    for (_, attribute) in attributes {
        let Some((numbers, following)) = rest.split_at_checked(attribute.channels as usize) else { return };
        rest = following;
        match &mut attribute.data {
            AttributeData::U8(values) => values.extend(numbers.iter().map(|number| *number as u8)),
            AttributeData::U16(values) => values.extend(numbers.iter().map(|number| *number as u16)),
            AttributeData::F32(values) => values.extend(numbers),
        }
    }
}

/// Appends the values of the next piece of the file, which has the same attributes.
pub(super) fn append(attributes: &mut NamedAttributes, piece: NamedAttributes) {
    for ((_, attribute), (_, next)) in attributes.iter_mut().zip(piece) {
        match (&mut attribute.data, next.data) {
            (AttributeData::U8(values), AttributeData::U8(next)) => values.extend(next),
            (AttributeData::U16(values), AttributeData::U16(next)) => values.extend(next),
            (AttributeData::F32(values), AttributeData::F32(next)) => values.extend(next),
            _ => {}
        }
    }
}

/// Type of an attribute's columns. `None` if a channel is missing, given twice, a list, of another
/// type, or one too many.
fn item(channels: &Channels, element: &Element) -> Option<Scalar> {
    let is_given = |wanted: usize| channels.iter().any(|(channel, _)| channel.unwrap_or(0) == wanted);
    let is_complete = channels.len() <= CHANNELS && (0..channels.len()).all(is_given);
    let mut properties = channels.iter().filter_map(|(_, column)| element.properties.get(*column));
    let first = properties.next().filter(|first| is_complete && first.length.is_none())?;
    properties.all(|other| other.length.is_none() && other.item == first.item).then_some(first.item)
}

fn warning(mut faulty: Vec<String>, element: &Element) -> Option<String> {
    let more = faulty.len().saturating_sub(NAMED);
    faulty.truncate(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let (names, element) = (faulty.join(", "), quote(element.name.as_bytes()));
    let rule = "channels of an attribute are numbered from 0 to at most 3 and have one type";
    (!names.is_empty()).then(|| format!("ignored attributes of {element}: {names}{more}; {rule}"))
}

/// Bytes of a number in the mesh.
fn stored_bytes(item: Scalar) -> u64 {
    match item {
        Scalar::U8 => 1,
        Scalar::U16 => 2,
        _ => 4,
    }
}

/// Whether a column belongs to an attribute, faulty or not.
pub(super) fn is_attribute(column: &str) -> bool {
    column.starts_with(PREFIX)
}

/// Name and channel of an attribute's column; `None` for other columns.
fn parse(column: &str) -> Option<(String, Option<usize>)> {
    let rest = column.strip_prefix(PREFIX)?;
    let numbered = rest.rsplit_once('.').filter(|(_, digits)| is_digits(digits));
    let Some((name, digits)) = numbered else { return Some((decoded(rest), None)) };
    // A number that is too large is a channel too many.
    Some((decoded(name), Some(digits.parse().unwrap_or(usize::MAX))))
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Names of an attribute's columns, one a channel.
pub(super) fn column_names(name: &str, channels: usize) -> Vec<String> {
    let name = encoded(name);
    if channels == 1 {
        return vec![format!("{PREFIX}{name}")];
    }
    (0..channels).map(|channel| format!("{PREFIX}{name}.{channel}")).collect()
}

/// A name as it stands in a header.
fn encoded(name: &str) -> String {
    let number = name.rsplit_once('.').filter(|(_, digits)| is_digits(digits)).map(|(before, _)| before.len());
    let mut text = String::new();
    for (at, character) in name.char_indices() {
        if character.is_whitespace() || character.is_control() || character == '%' || Some(at) == number {
            let mut bytes = [0; 4];
            for byte in character.encode_utf8(&mut bytes).bytes() {
                // Writing to a string cannot fail.
                let _ = write!(text, "%{byte:02X}");
            }
        } else {
            text.push(character);
        }
    }
    text
}

/// The name that a header's text stands for. A `%` without two digits stands for itself.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
        let escape = after.split_first_chunk::<2>().filter(|_| *first == b'%');
        let escape = escape.and_then(|([high, low], after)| Some((digit(*high)? * 16 + digit(*low)?, after)));
        let (byte, after) = escape.unwrap_or((*first, after));
        bytes.push(byte);
        rest = after;
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
#[path = "attributes_tests.rs"]
mod tests;
