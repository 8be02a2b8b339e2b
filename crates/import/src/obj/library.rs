//! Libraries that an OBJ names, with the pictures of the materials that it uses.

use super::files::{Reader, folder_of};
use super::mtl::{MtlMaterial, parse_mtl};
use crate::gltf::Warnings;
use crate::textures::picture_asset_name;
use juggler_imaging::{Limits, Raster, RasterSamples, decode_raster, raster_head};
use juggler_math::message::{MAX_QUOTE, excerpt};
use juggler_scene::Asset;
use juggler_scene::PictureReading;
use juggler_scene::model::FileError;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::sync::Arc;

/// Maximum number of bytes of a library.
const MAX_LIBRARY: usize = 64 << 20;
/// Maximum number of libraries.
const MAX_LIBRARIES: usize = 1000;
/// Maximum number of errors that are reported.
const MAX_FAULTS: usize = 200;

/// Material that an OBJ uses.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The material.
    pub mtl: MtlMaterial,
    /// Name of its library.
    pub library: String,
    /// Indices of its pictures by the words of their textures.
    pub pictures: BTreeMap<&'static str, usize>,
}

impl Loaded {
    /// Place of the material, for warnings.
    pub fn place(&self) -> String {
        format!("{}:{}", self.library, self.mtl.line)
    }
}

/// Picture of a texture.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of the file, relative to the folder of the OBJ.
    pub file: String,
    /// Name of the asset, without the prefix.
    pub asset_name: String,
    /// The file.
    pub asset: Asset,
    /// Whether the picture has an alpha channel. Known only of pictures for opacity.
    pub has_alpha: bool,
    /// Whether the picture looks like a normal map. Known only of pictures for bump maps.
    pub is_normal_map: bool,
}

/// Materials and pictures that an OBJ uses.
#[derive(Debug, Default)]
pub struct Library {
    /// Materials by name.
    pub materials: BTreeMap<String, Loaded>,
    /// Pictures in the order of their first use.
    pub pictures: Vec<Picture>,
}

impl Library {
    /// Reads the libraries of an OBJ and the pictures of the materials `used`.
    ///
    /// # Errors
    ///
    /// A library is not valid or exceeds a limit, or a picture cannot be read. Each text names the
    /// place.
    pub fn read(
        obj: &str,
        statements: &[String],
        used: &BTreeSet<Arc<str>>,
        reader: &mut Reader<'_>,
        warnings: &mut Warnings,
    ) -> Result<Self, Vec<String>> {
        let mut library = Self::default();
        let mut known = BTreeSet::new();
        for name in statements {
            for (file, bytes) in libraries(obj, name, reader, warnings).map_err(|fault| vec![fault])? {
                if !known.insert(file.clone()) {
                    continue;
                }
                if bytes.len() > MAX_LIBRARY || known.len() > MAX_LIBRARIES {
                    let text = format!("{file}: a model has at most {MAX_LIBRARIES} libraries of {MAX_LIBRARY} bytes");
                    return Err(vec![text]);
                }
                let materials = parse_mtl(&file, &bytes, warnings).map_err(|fault| vec![fault])?;
                materials.into_iter().for_each(|mtl| library.add(mtl, &file, used, warnings));
            }
        }
        library.read_pictures(reader, warnings)?;
        Ok(library)
    }

    /// Adds a material that the OBJ uses. The first of a name counts.
    fn add(&mut self, mtl: MtlMaterial, library: &str, used: &BTreeSet<Arc<str>>, warnings: &mut Warnings) {
        let place = format!("{library}:{}", mtl.line);
        if self.materials.contains_key(&mtl.name) {
            warnings.add(place, "materials are defined again; the first definition is used", 1);
        } else if used.contains(mtl.name.as_str()) {
            let loaded = Loaded { library: library.to_owned(), pictures: BTreeMap::new(), mtl };
            self.materials.insert(loaded.mtl.name.clone(), loaded);
        }
    }

    /// Reads the pictures of all materials.
    fn read_pictures(&mut self, reader: &mut Reader<'_>, warnings: &mut Warnings) -> Result<(), Vec<String>> {
        let (mut faults, mut known) = (Vec::new(), BTreeMap::<String, usize>::new());
        for loaded in self.materials.values_mut() {
            let folder = folder_of(&loaded.library).to_owned();
            for (word, map) in &loaded.mtl.maps {
                let place = format!("{}:{}", loaded.library, map.line);
                let written = (folder.clone(), map.file.clone());
                let written = format!("{}/{}", written.0, written.1);
                if let Some(index) = known.get(&written) {
                    inspect(self.pictures.get_mut(*index), word, reader.pictures());
                    loaded.pictures.insert(word, *index);
                    continue;
                }
                let found = match read_picture(reader, &folder, &map.file, &place, warnings) {
                    Ok(found) => found,
                    Err(fault) if reader.is_lenient() => {
                        warnings.add(fault, "the picture is shown gray", 1);
                        continue;
                    }
                    Err(fault) => {
                        faults.push(fault);
                        continue;
                    }
                };
                let index = add_picture(&mut self.pictures, found, &place);
                inspect(self.pictures.get_mut(index), word, reader.pictures());
                known.insert(written, index);
                loaded.pictures.insert(word, index);
            }
        }
        faults.truncate(MAX_FAULTS);
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }
}

/// Files that a statement `mtllib` names: one whose name may contain blanks, else one for each
/// word.
fn libraries(
    obj: &str,
    statement: &str,
    reader: &mut Reader<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let mut find = |name: &str, warnings: &mut Warnings| {
        let found = reader.find("", name, obj, warnings);
        found.map_err(|error| format!("{}: {error}", excerpt(name, MAX_QUOTE)))
    };
    if let Some(found) = find(statement.trim_matches('"'), warnings)? {
        return Ok(vec![found]);
    }
    let mut found = Vec::new();
    let several = statement.split_whitespace().count() > 1;
    for name in statement.split_whitespace().filter(|_| several).take(MAX_LIBRARIES) {
        found.extend(find(name, warnings)?);
    }
    if found.is_empty() {
        let statement = excerpt(statement, MAX_QUOTE);
        let text = format!("the library of materials `{statement}` is missing; its materials are shown gray");
        warnings.add(obj, text, 1);
    }
    Ok(found)
}

/// Reads a picture; for lenient readers, checks that it can be decoded. The error names the place.
fn read_picture(
    reader: &mut Reader<'_>,
    folder: &str,
    file: &str,
    place: &str,
    warnings: &mut Warnings,
) -> Result<(String, Vec<u8>), String> {
    let found = reader.find(folder, file, place, warnings).and_then(|found| found.ok_or(FileError::Missing));
    let (name, bytes) = found.map_err(|error| format!("{place}: {}: {error}", excerpt(file, MAX_QUOTE)))?;
    if reader.is_lenient() {
        let (file, limits) = (Cursor::new(&bytes), Limits::default());
        let checked = match reader.pictures() {
            PictureReading::Whole => decode_raster(&name, file, &limits).map(drop),
            PictureReading::Heads => raster_head(&name, file, &limits).map(drop),
        };
        checked.map_err(|error| format!("{place}: {error}"))?;
    }
    Ok((name, bytes))
}

/// Adds a file that is named at a place as a picture, or finds it.
fn add_picture(pictures: &mut Vec<Picture>, (file, bytes): (String, Vec<u8>), place: &str) -> usize {
    if let Some(index) = pictures.iter().position(|picture| picture.file == file) {
        return index;
    }
    let asset_name = picture_asset_name(pictures.len(), Some(&file), &bytes);
    let asset = Asset::from_bytes(bytes).with_origin(format!("{place}: {file}"));
    pictures.push(Picture { file, asset_name, asset, has_alpha: false, is_normal_map: false });
    pictures.len() - 1
}

/// Learns about a picture what its use for a texture needs: from its head whether it has alpha, and
/// from its pixels, if they are read, whether it is a normal map. Files that are no pictures are
/// reported when the texture is prepared.
fn inspect(picture: Option<&mut Picture>, word: &str, reading: PictureReading) {
    let Some(picture) = picture else { return };
    let bytes = Cursor::new(picture.asset.bytes().unwrap_or_default());
    if word == "map_d" {
        let head = raster_head(&picture.file, bytes, &Limits::default());
        picture.has_alpha = head.is_ok_and(|head| matches!(head.layout.channels, 2 | 4));
    } else if word == "bump" && reading == PictureReading::Whole {
        let raster = decode_raster(&picture.file, bytes, &Limits::default());
        picture.is_normal_map = raster.is_ok_and(|raster| is_normal_map(&raster));
    }
}

/// Whether a picture looks like a normal map: blue on average over 0.8, red and green about 0.5.
fn is_normal_map(raster: &Raster) -> bool {
    let channels = usize::from(raster.layout.channels);
    if channels < 3 {
        return false;
    }
    let means = match &raster.samples {
        RasterSamples::Bytes(levels) => means(levels, channels, 1.0 / 255.0),
        RasterSamples::Words(levels) => means(levels, channels, 1.0 / 65535.0),
        RasterSamples::Floats(levels) => means(levels, channels, 1.0),
    };
    let is_middle = |mean: f64| (0.3..=0.7).contains(&mean);
    matches!(means, [r, g, b] if b > 0.8 && is_middle(r) && is_middle(g))
}

/// Means of the first three channels.
fn means<T: Copy + Into<f64>>(levels: &[T], channels: usize, factor: f64) -> [f64; 3] {
    let (mut sums, mut count) = ([0.0_f64; 3], 0_u64);
    for pixel in levels.chunks_exact(channels.max(1)) {
        sums.iter_mut().zip(pixel).for_each(|(sum, level)| *sum += (*level).into());
        count += 1;
    }
    sums.map(|sum| sum * factor / count.max(1) as f64)
}
