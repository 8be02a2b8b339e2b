//! Assets: files that a scene holds in memory, by name.

use crate::description::Instances;
use crate::texel_array::TexelArray;
use crate::{instance_digest, mesh_digest};
use juggler_math::Image;
use juggler_shape::MeshData;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An asset: the content of a file in memory. It is immutable, and clones share it.
#[derive(Clone, Debug)]
pub struct Asset {
    content: Content,
    /// BLAKE3 hash of the content, computed once.
    digest: [u8; 32],
    /// Where the content is from, for messages.
    origin: Option<Arc<str>>,
}

/// Content of an asset.
#[derive(Clone, Debug)]
enum Content {
    /// Bytes of a file, or of a part of one: a mesh, a picture, a light profile.
    File(Arc<[u8]>),
    /// Pixels of a picture, linear light.
    Image(Arc<Image>),
    /// Arrays of a mesh.
    Mesh(Arc<MeshData>),
    /// Texels as given.
    Texels(Arc<TexelArray>),
    /// Arrays of instances, which clones share.
    Instances(Instances),
}

/// Assets are equal when their contents have the same hash.
impl PartialEq for Asset {
    fn eq(&self, other: &Self) -> bool {
        self.digest == other.digest
    }
}

impl Asset {
    /// Creates an asset of the bytes of a file.
    pub fn from_bytes(bytes: impl Into<Arc<[u8]>>) -> Self {
        let bytes = bytes.into();
        let digest = blake3::hash(&bytes).into();
        Self { content: Content::File(bytes), digest, origin: None }
    }

    /// Creates an asset of pixels in linear light. The pixels are not copied until a texture or
    /// background is prepared from them.
    pub fn from_image(image: impl Into<Arc<Image>>) -> Self {
        let image = image.into();
        let mut hasher = blake3::Hasher::new();
        // No file begins like this, so bytes and pixels never have the same hash.
        hasher.update(b"pixels in linear light\0");
        hasher.update(&image.width().to_le_bytes());
        for row in (0..image.height()).filter_map(|y| image.row(y)) {
            let channels = row.iter().flat_map(|pixel| pixel.to_array());
            hasher.update(&channels.flat_map(f32::to_le_bytes).collect::<Vec<u8>>());
        }
        Self { digest: hasher.finalize().into(), content: Content::Image(image), origin: None }
    }

    /// Creates an asset of the arrays of a mesh, in place of a mesh file. The arrays are neither copied
    /// nor converted. The picture is that of a PLY file of the same arrays; the fingerprint is another,
    /// since it has the hash of the arrays in place of the file's.
    ///
    /// ```
    /// use juggler_scene::{Asset, Loader};
    /// use juggler_shape::Mesh;
    ///
    /// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = Mesh::from_triangles(corners.map(Into::into), [[0, 1, 2]]);
    /// let asset = Asset::from_mesh(mesh.arrays().clone());
    /// let text = r#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "part"}}}]}"#;
    /// let scene = Loader::default().from_json_with(text, "scene.json", [("part".into(), asset)])?;
    /// assert!(scene.compile().is_ok());
    /// # Ok::<(), juggler_scene::SceneError>(())
    /// ```
    pub fn from_mesh(mesh: impl Into<Arc<MeshData>>) -> Self {
        let mesh = mesh.into();
        Self { digest: mesh_digest::digest(&mesh), content: Content::Mesh(mesh), origin: None }
    }

    /// Creates an asset of texels, in place of an image file. They are kept as they are until a texture
    /// or background is prepared from them, as from a PNG file of 8 or 16 bits or an EXR file.
    ///
    /// ```
    /// use juggler_scene::{Asset, Scene, TexelArray, TexelSamples};
    /// use juggler_texture::{ColorSpace, Image};
    ///
    /// let samples = TexelSamples::U8(vec![255, 0, 0, 0, 128, 255]);
    /// let texels = TexelArray::new([2, 1], 3, samples, ColorSpace::Auto)?;
    /// let scene = Scene::new().asset("pixels", Asset::from_texels(texels));
    /// let scene = scene.texture("wall", Image::new("pixels"));
    /// # Ok::<(), juggler_scene::InvalidTexels>(())
    /// ```
    pub fn from_texels(texels: impl Into<Arc<TexelArray>>) -> Self {
        let texels = texels.into();
        Self { digest: texels.digest(), content: Content::Texels(texels), origin: None }
    }

    /// Creates an asset of the arrays of instances, in place of a PLY file of points: the `file` of an
    /// object's `instances` may name it. The arrays are neither copied nor converted. A scene whose
    /// objects name an asset that names a file itself does not compile.
    ///
    /// ```
    /// use juggler_math::Vec3;
    /// use juggler_scene::{Asset, Instances, Loader};
    ///
    /// let asset = Asset::from_instances(Instances::at((0..1000).map(|i| Vec3::X * i as f32)));
    /// let text = r#"{"version": 1, "objects": [{"shape": "sphere", "instances": {"file": "row"}}]}"#;
    /// let scene = Loader::default().from_json_with(text, "scene.json", [("row".into(), asset)])?;
    /// assert_eq!(scene.compile()?.world.geometry_stats().shapes, 1000);
    /// # Ok::<(), juggler_scene::SceneError>(())
    /// ```
    pub fn from_instances(instances: Instances) -> Self {
        Self { digest: instance_digest::digest(&instances), content: Content::Instances(instances), origin: None }
    }

    /// Names the origin of the content, which messages about it show in place of the asset's name: for
    /// example "car.glb: /images/3 (wood)".
    #[must_use]
    pub fn with_origin(self, origin: impl Into<Arc<str>>) -> Self {
        Self { origin: Some(origin.into()), ..self }
    }

    /// BLAKE3 hash of the content.
    pub fn digest(&self) -> [u8; 32] {
        self.digest
    }

    /// Bytes of a file, if the asset is one.
    pub fn bytes(&self) -> Option<&[u8]> {
        match &self.content {
            Content::File(bytes) => Some(bytes),
            _ => None,
        }
    }

    /// Pixels in linear light, if the asset is an image.
    pub fn image(&self) -> Option<&Image> {
        match &self.content {
            Content::Image(image) => Some(image),
            _ => None,
        }
    }

    /// Arrays of a mesh, if the asset is one.
    pub fn mesh(&self) -> Option<&Arc<MeshData>> {
        match &self.content {
            Content::Mesh(mesh) => Some(mesh),
            _ => None,
        }
    }

    /// Texels, if the asset consists of them.
    pub fn texels(&self) -> Option<&Arc<TexelArray>> {
        match &self.content {
            Content::Texels(texels) => Some(texels),
            _ => None,
        }
    }

    /// Arrays of instances, if the asset consists of them.
    pub fn instances(&self) -> Option<&Instances> {
        match &self.content {
            Content::Instances(instances) => Some(instances),
            _ => None,
        }
    }

    /// Content in words, for messages.
    pub(crate) fn content_name(&self) -> &'static str {
        match &self.content {
            Content::File(_) => "the bytes of a file",
            Content::Image(_) => "pixels",
            Content::Mesh(_) => "a mesh",
            Content::Texels(_) => "texels",
            Content::Instances(_) => "instances",
        }
    }
}

/// Name of a file for messages: that of the asset, if the path stands for one, otherwise the path.
pub(crate) fn display_name(path: &Path) -> String {
    let asset = path.to_str().and_then(|path| path.strip_prefix("asset ")?.split_once('/'));
    asset.map_or_else(|| path.display().to_string(), |(_, name)| name.to_owned())
}

/// Assets of a scene by name. Clones share them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Assets(Arc<BTreeMap<String, Asset>>);

impl Assets {
    /// Adds an asset under a name, or replaces the asset of that name.
    pub fn insert(&mut self, name: String, asset: Asset) {
        Arc::make_mut(&mut self.0).insert(name, asset);
    }

    /// Assets with their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Asset)> {
        self.0.iter().map(|(name, asset)| (name.as_str(), asset))
    }

    /// Path that stands for an asset, by which caches of loaded files know it: its content's hash
    /// as a folder, and its name.
    pub fn path_of(&self, name: &str) -> Option<PathBuf> {
        let digest = blake3::Hash::from_bytes(self.0.get(name)?.digest);
        Some(format!("asset {}/{name}", &digest.to_hex()[..32]).into())
    }

    /// Asset of a path that [`path_of`](Self::path_of) has given.
    pub fn at(&self, path: &Path) -> Option<&Asset> {
        let (_, name) = path.to_str()?.strip_prefix("asset ")?.split_once('/')?;
        self.0.get(name).filter(|_| self.path_of(name).is_some_and(|own| own == path))
    }

    /// Origin of a file for messages: that of the asset, if the path stands for one that has an origin,
    /// otherwise the name.
    pub fn origin(&self, path: &Path) -> String {
        let origin = self.at(path).and_then(|asset| asset.origin.as_deref());
        origin.map_or_else(|| display_name(path), str::to_owned)
    }

    /// Texels of a path that [`path_of`](Self::path_of) has given, and their hash.
    pub fn texels_at(&self, path: &Path) -> Option<(&TexelArray, [u8; 32])> {
        let asset = self.at(path)?;
        Some((asset.texels()?, asset.digest))
    }

    /// Pixels of the image of a path that [`path_of`](Self::path_of) has given, and their hash.
    pub fn image_at(&self, path: &Path) -> Option<(&Image, [u8; 32])> {
        let asset = self.at(path)?;
        Some((asset.image()?, asset.digest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Rgb;

    #[test]
    fn asset_paths_resolve_only_to_the_same_content() {
        let mut assets = Assets::default();
        assets.insert("car.glb#images/3".into(), Asset::from_bytes(*b"png"));
        let path = assets.path_of("car.glb#images/3").unwrap();
        assert_eq!(assets.at(&path), Some(&Asset::from_bytes(*b"png")));
        assert_eq!(assets.origin(&path), "car.glb#images/3");
        assert_eq!(assets.origin(Path::new("a/b.png")), "a/b.png");
        let named = Asset::from_bytes(*b"png").with_origin("car.glb: /images/3 (wood)");
        assert_eq!(named, Asset::from_bytes(*b"png"), "the same content");
        assets.insert("car.glb#images/3".into(), named);
        assert_eq!(assets.origin(&path), "car.glb: /images/3 (wood)");
        assets.insert("car.glb#images/3".into(), Asset::from_bytes(*b"other"));
        assert_eq!(assets.at(&path), None, "the name has another content now");
        assets.insert("/of the root".into(), Asset::from_bytes(*b"root"));
        assert_eq!(assets.at(&assets.path_of("/of the root").unwrap()), Some(&Asset::from_bytes(*b"root")));
        assert_eq!(assets.path_of("none"), None);
        assert_eq!(assets.at(Path::new("models/car.glb")), None);
    }

    #[test]
    fn image_identity_includes_size_and_every_pixel() {
        let image = |width, height, color| Asset::from_image(Image::filled(width, height, color));
        let plain = image(2, 3, Rgb::WHITE);
        assert_eq!(plain, image(2, 3, Rgb::WHITE));
        assert_ne!(plain, image(3, 2, Rgb::WHITE));
        assert_ne!(plain, image(2, 3, Rgb::new(1.0, 1.0, 1.0f32.next_up())));
        assert_ne!(plain, Asset::from_bytes(*b""));
    }
}
