use super::*;
use crate::Options;
use ::exr::prelude::{ReadChannels, ReadLayers};

fn header(names: &[(&str, &[&str])]) -> LayeredHeader {
    let layers = names.iter().map(|(name, channels)| LayerHeader::new(name, channels));
    let mut layers: Vec<LayerHeader> = std::iter::once(half_beauty()).chain(layers).collect();
    layers[1].metadata.push(("cryptomatte/abcdefg/manifest".into(), "{}".into()));
    let metadata = vec![("Software".to_owned(), "Juggler".to_owned())];
    let header = Header { metadata, ..Header::new(5, 37) };
    LayeredHeader { compression: ExrCompression::Zip, ..LayeredHeader::new(&header, layers) }
}

/// Layer of an opaque picture in half floats.
fn half_beauty() -> LayerHeader {
    let options = Options { exr_depth: SampleDepth::Half, ..Options::default() };
    LayerHeader::beauty(&Header { options, ..Header::new(1, 1) })
}

/// Channel name and values.
type Channel = (String, Vec<f32>);

fn value(channel: usize, pixel: usize) -> f32 {
    (channel * 200 + pixel) as f32 * 0.25
}

fn written(path: &Path, header: &LayeredHeader, pieces: &[usize]) {
    let channels: usize = header.layers.iter().map(|layer| layer.channels.len()).sum();
    let mut writer = LayeredWriter::create(path, header).unwrap();
    let mut first = 0;
    for rows in pieces {
        let pixels = first * 5..(first + rows) * 5;
        let rows: Vec<Vec<f32>> = (0..channels).map(|c| pixels.clone().map(|p| value(c, p)).collect()).collect();
        writer.write_rows(&rows).unwrap();
        first += rows.first().map_or(0, Vec::len) / 5;
    }
    writer.finish().unwrap();
}

#[test]
fn multipart_exr_is_read_by_an_independent_reader() {
    let folder = tempfile::tempdir().unwrap();
    let header = header(&[("normal", &["X", "Y", "Z"]), ("depth", &["Z"]), ("uv", &["U", "V"])]);
    let (one, two) = (folder.path().join("one.exr"), folder.path().join("two.exr"));
    written(&one, &header, &[37]);
    written(&two, &header, &[1, 16, 3, 17]);
    assert_eq!(std::fs::read(&one).unwrap(), std::fs::read(&two).unwrap(), "however rows are cut");
    let reader = ::exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let image = reader.all_layers().all_attributes().non_parallel().from_file(&one).unwrap();
    let found: Vec<(String, Vec<Channel>)> = image
        .layer_data
        .iter()
        .map(|layer| {
            let channels = layer.channel_data.list.iter();
            let channel = |c: &::exr::prelude::AnyChannel<::exr::prelude::FlatSamples>| {
                (c.name.to_string(), c.sample_data.values_as_f32().collect())
            };
            (layer.attributes.layer_name.clone().unwrap().to_string(), channels.map(channel).collect())
        })
        .collect();
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["beauty", "normal", "depth", "uv"]);
    let expected = [
        ("B", 2),
        ("G", 1),
        ("R", 0),
        ("normal.X", 3),
        ("normal.Y", 4),
        ("normal.Z", 5),
        ("depth.Z", 6),
        ("uv.U", 7),
        ("uv.V", 8),
    ];
    let channels: Vec<&Channel> = found.iter().flat_map(|(_, channels)| channels).collect();
    assert_eq!(channels.len(), expected.len());
    for ((name, values), (wanted, number)) in channels.into_iter().zip(expected) {
        assert_eq!(name, wanted);
        for (pixel, found) in values.iter().enumerate() {
            assert_eq!(*found, value(number, pixel), "{name} {pixel}");
        }
    }
}

#[test]
fn layers_are_written_to_separate_files_and_numpy_arrays() {
    let folder = tempfile::tempdir().unwrap();
    let header = header(&[("depth", &["Z"])]);
    written(&folder.path().join("a.{}.npy"), &header, &[30, 7]);
    let bytes = std::fs::read(folder.path().join("a.beauty.npy")).unwrap();
    let length = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert!(bytes.starts_with(b"\x93NUMPY\x01\x00") && length % 64 == 0 && bytes[length - 1] == b'\n');
    assert!(std::str::from_utf8(&bytes[10..length]).unwrap().contains("'shape': (37, 5, 3)"));
    let values: Vec<f32> = bytes[length..].as_chunks().0.iter().map(|four| f32::from_le_bytes(*four)).collect();
    assert_eq!(values.len(), 37 * 5 * 3);
    assert_eq!((values[0], values[1], values[3 * 184 + 2]), (value(0, 0), value(1, 0), value(2, 184)));
    assert!(folder.path().join("a.depth.npy").exists());
    for (name, layers) in [("a.npy", 2), ("a.{}.png", 1), ("a", 1)] {
        let header = LayeredHeader { layers: header.layers[..layers].to_vec(), ..header.clone() };
        assert!(matches!(LayeredWriter::create(&folder.path().join(name), &header), Err(ImageError::Layers { .. })));
    }
}

#[test]
fn only_color_layers_are_converted_to_the_primaries() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut plain = header(&[("normal", &["X", "Y", "Z"])]);
    plain.layers[0].depth = SampleDepth::Float;
    plain.layers.push(LayerHeader::color("albedo"));
    let wide = LayeredHeader { primaries: Primaries::Acescg, ..plain.clone() };
    written(&path("plain.exr"), &plain, &[37]);
    written(&path("wide.exr"), &wide, &[20, 17]);
    written(&path("{}.exr"), &wide, &[37]);
    written(&path("{}.npy"), &wide, &[37]);
    let read = |name: &str| {
        let reader = ::exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
        reader.all_layers().all_attributes().non_parallel().from_file(path(name)).unwrap()
    };
    let (plain, wide) = (read("plain.exr"), read("wide.exr"));
    assert!(plain.attributes.chromaticities.is_none());
    let found = wide.attributes.chromaticities.unwrap();
    assert_eq!((found.red.0, found.red.1), (0.713, 0.293));
    let values = |name: &str, layer: usize| -> Vec<Vec<f32>> {
        let image = read(name);
        let channels = image.layer_data[layer].channel_data.list.iter().rev();
        channels.map(|channel| channel.sample_data.values_as_f32().collect()).collect()
    };
    let matrix = Primaries::Acescg.matrix_from_srgb().unwrap();
    for layer in [0, 2] {
        let (from, to) = (values("plain.exr", layer), values("wide.exr", layer));
        for pixel in 0..185 {
            let color = |channels: &[Vec<f32>]| {
                juggler_math::Rgb::new(channels[0][pixel], channels[1][pixel], channels[2][pixel])
            };
            assert_eq!(color(&to), matrix.color(color(&from)), "{layer} {pixel}");
        }
    }
    assert_eq!(values("plain.exr", 1), values("wide.exr", 1));
    // In single-layer files only color layers state primaries; arrays cannot.
    assert!(read("normal.exr").attributes.chromaticities.is_none());
    assert!(read("albedo.exr").attributes.chromaticities.is_some());
    let array = std::fs::read(path("albedo.npy")).unwrap();
    assert!(array.ends_with(&value(8, 184).to_le_bytes()));
}

#[test]
fn layers_are_read_back_by_their_channels() {
    let folder = tempfile::tempdir().unwrap();
    let (path, plain) = (folder.path().join("a.exr"), folder.path().join("a.pfm"));
    written(&path, &header(&[("variance", &["R", "G", "B"]), ("samples", &["Y"])]), &[37]);
    let colors = read_layer(&path, &["variance.R", "variance.G", "variance.B"]).unwrap().unwrap();
    assert_eq!((colors.0, colors.1, colors.2.len()), (5, 37, 185));
    let samples = read_layer(&path, &["samples.Y"]).unwrap().unwrap().2;
    for pixel in [0, 1, 77, 184] {
        assert_eq!(colors.2[pixel], [3, 4, 5].map(|channel| value(channel, pixel)));
        assert_eq!(samples[pixel], [value(6, pixel); 3]);
    }
    for missing in [&["albedo.R"][..], &["samples.Y", "variance.R", "variance.G"], &[]] {
        assert_eq!(read_layer(&path, missing).unwrap(), None);
    }
    std::fs::write(&plain, "PF\n1 1\n-1.0\n000000000000").unwrap();
    assert_eq!(read_layer(&plain, &["samples.Y"]).unwrap(), None);
    std::fs::write(&path, &std::fs::read(&path).unwrap()[..900]).unwrap();
    assert!(read_layer(&path, &["samples.Y"]).is_err());
}
