//! Scenes that the program does not contain: generated files, the same on every machine.

use super::files::write_file;
use crate::failure::Failure;
use juggler::ImageExt;
use juggler::imaging::Tone;
use juggler::imaging::tone::{AnyCurve, Linear};
use juggler::math::hash::{combine, unit_f32};
use juggler::math::portable::{cos, sin, sin_cos_turns};
use juggler::math::{Image, Rgb, Vec2, Vec3, vec2, vec3};
use juggler::mesh::ply_bytes;
use juggler::shape::MeshData;
use serde_json::{Value, json};
use std::path::Path;

/// Quads of the body around its axis and from pole to pole.
const BODY: [u32; 2] = [192, 96];
/// Size of the environment map in pixels.
const ENVIRONMENT: [u32; 2] = [256, 128];
/// Width and height of the textures in pixels.
const TEXTURE: u32 = 256;

/// A body of rough gold on a diffuse ground under an environment map with a small sun, beside two
/// spheres.
pub fn mesh_env(folder: &Path) -> Result<Value, Failure> {
    write_file(&folder.join("body.ply"), &ply_bytes(&body()))?;
    environment().save(folder.join("environment.hdr"))?;
    Ok(json!({
        "version": 1,
        "render": {"integrator": {"path": {"max_depth": 8}}},
        "camera": {"perspective": {"eye": [0.5, 1.5, 4.6], "look_at": [0, 0.75, 0], "vertical_fov_degrees": 33}},
        "background": {"environment": {"file": "environment.hdr"}},
        "materials": {
            "gold": {"conductor": {"metal": "gold", "roughness": 0.4}},
            "ground": {"diffuse": {"reflectance": [0.5, 0.48, 0.45]}},
            "blue": {"diffuse": {"reflectance": [0.15, 0.3, 0.65]}},
        },
        "objects": [
            {"shape": {"rectangle": {"size": [60, 60]}}, "material": "ground"},
            {
                "shape": {"mesh": {"file": "body.ply", "crease_angle_degrees": 180}}, "material": "gold",
                "transform": [{"scale": 0.7}, {"translate": [0, 0.75, 0]}],
            },
            ball([1.25, 0.35, 0.8], 0.35, "blue"),
            ball([-1.3, 0.25, 1.0], 0.25, "gold"),
        ],
    }))
}

/// The same body under the same environment map with textures of color, roughness and normals.
pub fn textured(folder: &Path) -> Result<Value, Failure> {
    write_file(&folder.join("body.ply"), &ply_bytes(&body()))?;
    environment().save(folder.join("environment.hdr"))?;
    let levels = Tone { dither: false, ..Tone::new(AnyCurve::Linear(Linear {})) };
    texture(color).save_with_tone(folder.join("color.png"), &levels)?;
    texture(roughness).save_with_tone(folder.join("roughness.png"), &levels)?;
    texture(normal).save_with_tone(folder.join("normal.png"), &levels)?;
    let image = |name: &str, space: &str| json!({"image": {"file": format!("{name}.png"), "color_space": space}});
    Ok(json!({
        "version": 1,
        "render": {"integrator": {"path": {"max_depth": 8}}},
        "camera": {"perspective": {"eye": [0.5, 0.6, 4.6], "look_at": [0, 0, 0], "vertical_fov_degrees": 28}},
        "background": {"environment": {"file": "environment.hdr"}},
        "textures": {
            "color": image("color", "srgb"),
            "roughness": image("roughness", "linear"),
            "normal": image("normal", "linear"),
        },
        "materials": {
            "skin": {"principled": {"base_color": "color", "roughness": "roughness", "metallic": 0.3}},
            "bumpy": {"normal_map": {"texture": "normal", "material": "skin"}},
        },
        "objects": [
            {"shape": {"mesh": {"file": "body.ply", "crease_angle_degrees": 180}}, "material": "bumpy"},
        ],
    }))
}

/// Spheres of plastic, mirror and glass over a checkerboard under three point lights, in the style
/// of Turner Whitted's picture (Whitted 1980).
pub fn whitted_spheres(_folder: &Path) -> Result<Value, Failure> {
    let lights = [([-8, 12, 10], 420), ([10, 9, 4], 200), ([0, 14, -14], 300)];
    let lights: Vec<Value> = lights
        .into_iter()
        .map(|(position, intensity)| json!({"point": {"position": position, "intensity": intensity}}))
        .collect();
    let floor = json!({
        "shape": "plane",
        "material": {"phong": {"diffuse": {"checker": {
            "size": 1, "space": "local", "axes": "xz", "even": [0.75, 0.75, 0.72], "odd": [0.08, 0.08, 0.1],
        }}}},
    });
    let spheres = (0..20).flat_map(|row| (0..20).map(move |column| sphere(row, column)));
    let objects: Vec<Value> = [floor].into_iter().chain(spheres).collect();
    Ok(json!({
        "version": 1,
        "render": {"integrator": {"classic": {"max_depth": 5}}},
        "camera": {"perspective": {"eye": [2.5, 4.2, 11.5], "look_at": [0, 0.2, 0], "vertical_fov_degrees": 38}},
        "background": [0.35, 0.5, 0.8],
        "materials": {
            "red": {"phong": {"diffuse": [0.7, 0.15, 0.1], "specular": 0.4, "shininess": 60}},
            "blue": {"phong": {"diffuse": [0.12, 0.25, 0.7], "specular": 0.4, "shininess": 60}},
            "mirror": {"phong": {"diffuse": 0.05, "reflection": 0.85}},
            "glass": {"phong": {"diffuse": 0, "reflection": 1, "transparency": 1, "ior": 1.5, "fresnel": true}},
        },
        "lights": lights,
        "objects": objects,
    }))
}

/// Sphere of a jittered grid on the floor.
fn sphere(row: u32, column: u32) -> Value {
    let seed = combine(row, column);
    let random = |dimension: u32| unit_f32(combine(seed, dimension));
    let radius = 0.15 + 0.17 * random(0);
    let lift = if random(1) < 0.25 { random(2) } else { 0.001 };
    let center = [0.7 * (column as f32 - 9.5) + 0.05 * random(3), radius + lift, 0.7 * (row as f32 - 12.5)];
    let kinds = ["red", "blue", "red", "blue", "mirror", "glass"];
    let kind = kinds.get((random(4) * kinds.len() as f32) as usize).copied().unwrap_or("red");
    ball(center, radius, kind)
}

fn ball(center: [f32; 3], radius: f32, material: &str) -> Value {
    json!({"shape": {"sphere": {"radius": radius}}, "material": material, "transform": [{"translate": center}]})
}

/// A sphere of radius 1 with bumps of two sizes, with surface coordinates (u, v).
fn body() -> MeshData {
    let [columns, rows] = BODY;
    let vertices = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column)));
    let uvs: Vec<Vec2> =
        vertices.map(|(row, column)| vec2(column as f32 / columns as f32, row as f32 / rows as f32)).collect();
    let corner = |row: u32, column: u32| row * (columns + 1) + column;
    let quads = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let triangles = quads.flat_map(|(row, column)| {
        let [a, b] = [corner(row, column), corner(row, column + 1)];
        let [c, d] = [corner(row + 1, column), corner(row + 1, column + 1)];
        // The first and the last row are triangles that meet at the poles.
        let upper = (row > 0).then_some([a, b, d]);
        let lower = (row + 1 < rows).then_some([a, d, c]);
        upper.into_iter().chain(lower)
    });
    let triangles = triangles.collect();
    MeshData { positions: uvs.iter().map(|uv| bumpy(direction(*uv))).collect(), triangles, uvs, ..MeshData::default() }
}

/// Direction of the surface coordinates (u, v): u runs around the vertical axis, v down from +Y.
fn direction(uv: Vec2) -> Vec3 {
    let (sin_phi, cos_phi) = sin_cos_turns(uv.x);
    let (sin_theta, cos_theta) = sin_cos_turns(0.5 * uv.y);
    vec3(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
}

fn bumpy(d: Vec3) -> Vec3 {
    let large = sin(9.0 * d.x) * sin(11.0 * d.y) * sin(10.0 * d.z);
    let small = sin(37.0 * d.x + 3.0 * d.y) * sin(33.0 * d.y) * sin(31.0 * d.z);
    d * (1.0 + 0.08 * large + 0.02 * small)
}

/// A sky that darkens towards the zenith, a brown ground, and a sun of 4 degrees.
fn environment() -> Image {
    let sun = vec3(-0.55, 0.62, 0.56).normalize();
    let edge = cos(2.0_f32.to_radians());
    image(ENVIRONMENT, |uv| {
        let d = direction(uv);
        let height = d.y.max(0.0).sqrt();
        let sky = Rgb::new(0.85, 0.85, 0.9) * (1.0 - height) + Rgb::new(0.18, 0.34, 0.75) * height;
        let base = if d.y < 0.0 { Rgb::new(0.22, 0.2, 0.18) } else { sky };
        if d.dot(sun) > edge { Rgb::new(340.0, 300.0, 240.0) } else { base }
    })
}

fn texture(texel: fn(Vec2) -> Rgb) -> Image {
    image([TEXTURE, TEXTURE], texel)
}

/// Tiles of random colors with dark gaps.
fn color(uv: Vec2) -> Rgb {
    let [x, y] = [uv.x * 24.0, uv.y * 12.0];
    let tile = combine(x as u32, y as u32);
    let gap = x.fract() < 0.06 || y.fract() < 0.06;
    let channel = |dimension: u32| if gap { 0.1 } else { 0.25 + 0.7 * unit_f32(combine(tile, dimension)) };
    Rgb::new(channel(0), channel(1), channel(2))
}

/// Waves between smooth and rough.
fn roughness(uv: Vec2) -> Rgb {
    Rgb::splat(0.45 + 0.3 * wave(uv.x * 8.0) * wave(uv.y * 6.0))
}

/// Normals of a grid of small waves, encoded from 0 to 1.
fn normal(uv: Vec2) -> Rgb {
    let n = vec3(0.3 * wave(uv.x * 48.0), 0.3 * wave(uv.y * 24.0), 1.0).normalize();
    Rgb::new(0.5 + 0.5 * n.x, 0.5 + 0.5 * n.y, 0.5 + 0.5 * n.z)
}

fn wave(turns: f32) -> f32 {
    sin_cos_turns(turns).0
}

/// Image of a function of the surface coordinates (u, v), v down from the top.
fn image([width, height]: [u32; 2], pixel: impl Fn(Vec2) -> Rgb) -> Image {
    let mut image = Image::filled(width, height, Rgb::BLACK);
    let at = |index: usize, length: u32| (index as f32 + 0.5) / length as f32;
    for (y, row) in image.pixels_mut().chunks_mut(width as usize).enumerate() {
        for (x, color) in row.iter_mut().enumerate() {
            *color = pixel(vec2(at(x, width), at(y, height)));
        }
    }
    image
}
