//! Tests of the error messages without the library, and of denoising where `JUGGLER_OIDN` gives its
//! path.

#![allow(clippy::unwrap_used, reason = "a test")]

use juggler_math::testing::skipped;
use juggler_math::{Rgb, Vec3};
use juggler_oidn::{Error, Oidn};
use std::path::Path;

/// Library at the path in `JUGGLER_OIDN`, if it is set.
fn library() -> Option<Oidn> {
    let Some(path) = std::env::var_os("JUGGLER_OIDN") else {
        skipped("Open Image Denoise: JUGGLER_OIDN does not say where it is; docs/denoising.md says where to get it");
        return None;
    };
    Some(Oidn::open(Some(Path::new(&path))).unwrap())
}

#[test]
fn missing_library_error_names_the_path() {
    let error = Oidn::open(Some(Path::new("no/such/library.so"))).unwrap_err();
    assert!(matches!(&error, Error::NotFound { tried } if tried.len() == 1));
    assert!(error.to_string().contains("no/such/library.so"), "{error}");
}

#[test]
fn folder_without_the_library_and_other_files_are_errors() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let error = Oidn::open(Some(folder)).unwrap_err();
    assert!(error.to_string().contains("OpenImageDenoise"), "{error}");
    let error = Oidn::open(Some(&folder.join("Cargo.toml"))).unwrap_err();
    assert!(matches!(error, Error::NotFound { .. }), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn other_library_is_rejected_and_the_missing_symbol_named() {
    let error = Oidn::open(Some(Path::new("libc.so.6"))).unwrap_err();
    assert!(error.to_string().contains("oidnNewDevice"), "{error}");
}

#[test]
fn the_names_of_the_system_are_tried_in_turn() {
    match Oidn::open(None) {
        Ok(library) => assert_eq!(library.version()[0], 2),
        Err(error) => assert!(juggler_oidn::NAMES.iter().all(|name| error.to_string().contains(name)), "{error}"),
    }
}

#[test]
fn denoising_reduces_variance_and_keeps_the_mean() {
    let Some(library) = library() else { return };
    let (width, height) = (96, 64);
    let mut random = juggler_math::testing::Random::new(1);
    let noisy: Vec<Rgb> = (0..width * height).map(|_| Rgb::splat(random.range(0.0, 2.0))).collect();
    let (albedo, normal) = (vec![Rgb::splat(0.5); noisy.len()], vec![Vec3::Z; noisy.len()]);
    let clean = library.denoise(width, height, &noisy, Some(&albedo), Some(&normal)).unwrap();
    assert_eq!(clean.len(), noisy.len());
    let mean = |pixels: &[Rgb]| pixels.iter().map(|c| c.g).sum::<f32>() / pixels.len() as f32;
    let variance = |pixels: &[Rgb]| pixels.iter().map(|c| (c.g - 1.0) * (c.g - 1.0)).sum::<f32>() / pixels.len() as f32;
    assert!((mean(&clean) - mean(&noisy)).abs() < 0.05, "{}", mean(&clean));
    assert!(variance(&clean) < variance(&noisy) * 0.05, "{}", variance(&clean));
    assert_eq!(library.denoise(width, height, &noisy, None, None).unwrap().len(), noisy.len());
}

#[test]
fn wrong_sizes_are_refused_before_the_library_sees_them() {
    let Some(library) = library() else { return };
    let pixels = vec![Rgb::WHITE; 12];
    assert!(library.denoise(4, 3, &pixels, None, None).is_ok());
    assert!(matches!(library.denoise(4, 4, &pixels, None, None), Err(Error::Size { image: "color", found: 12, .. })));
    let albedo = Some(&pixels[..11]);
    assert!(matches!(library.denoise(4, 3, &pixels, albedo, None), Err(Error::Size { image: "albedo", .. })));
    assert!(matches!(library.denoise(0, 0, &[], None, None), Err(Error::Size { .. })));
    assert!(matches!(library.denoise(usize::MAX, 2, &[], None, None), Err(Error::Size { .. })));
}
