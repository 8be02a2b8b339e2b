//! A closed hall: walls of two triangles each, fluted columns, a ribbed vault, slanted struts,
//! benches and statues. No ray escapes, and large and small triangles overlap everywhere.

use super::builder::{Builder, Placement};
use super::noise::fractal;
use super::{Mesh, MeshKind, View};
use juggler_math::{Vec3, portable, vec3};

pub const KIND: MeshKind = MeshKind {
    name: "hall",
    about: "a closed hall, no ray escapes; size: flutes of a column",
    size: 24,
    sizes: (2, 128),
    make,
};

/// Half the width, the height of the walls and half the length.
const WIDTH: f32 = 8.0;
const WALL: f32 = 9.0;
const LENGTH: f32 = 24.0;
/// Number of columns, benches and statues on each side.
const BAYS: u32 = 9;

fn make(size: u32) -> Mesh {
    let mut builder = Builder::default();
    shell(&mut builder, size);
    for bay in 0..BAYS {
        let z = (bay as f32 + 0.5) / BAYS as f32 * 2.0 * LENGTH - LENGTH;
        for side in [-1.0, 1.0] {
            column(&mut builder, size, vec3(side * 4.6, 0.0, z));
            strut(&mut builder, size, side, z);
            bench(&mut builder, vec3(side * 2.3, 0.0, z));
            statue(&mut builder, size, vec3(side * 6.9, 0.0, z + 1.3), bay + if side < 0.0 { 0 } else { BAYS });
        }
    }
    builder.finish(View {
        eye: vec3(-1.4, 2.2, 20.5),
        look_at: vec3(1.0, 3.0, 0.0),
        up: Vec3::Y,
        fov_degrees: 62.0,
        light: vec3(1.0, 8.2, 8.0),
    })
}

/// Appends floor, walls and vault, slightly overlapping so that no ray escapes where they meet.
fn shell(builder: &mut Builder, size: u32) {
    let past = |length: f32| length * 1.01;
    let (wide, long) = (past(WIDTH), past(LENGTH));
    for side in [-1.0, 1.0] {
        let side_wall = |y: f32, z: f32| vec3(side * WIDTH, y, z);
        let top = WALL + 0.5;
        builder.quad([side_wall(-0.1, -long), side_wall(-0.1, long), side_wall(top, long), side_wall(top, -long)]);
        let end_wall = |x: f32, y: f32| vec3(x, y, side * LENGTH);
        let top = WALL + 5.0;
        builder.quad([end_wall(-wide, -0.1), end_wall(wide, -0.1), end_wall(wide, top), end_wall(-wide, top)]);
    }
    builder.quad([vec3(-wide, 0.0, long), vec3(wide, 0.0, long), vec3(wide, 0.0, -long), vec3(-wide, 0.0, -long)]);
    let (arch, along) = (size * 3, size * 18);
    builder.patch(arch, along, |column, row| {
        let (sin, cos) = portable::sin_cos_turns(column as f32 / arch as f32 * 0.5);
        let along = row as f32 / along as f32;
        let rib = portable::sin_cos_turns(along * BAYS as f32).0;
        let radius = 1.0 - 0.05 * rib * rib * sin;
        vec3(-past(WIDTH) * cos * radius, WALL - 0.1 + 4.0 * sin * radius, (along * 2.0 - 1.0) * long)
    });
}

/// Appends a fluted column, narrower at the top, between a base and a slab.
fn column(builder: &mut Builder, size: u32, foot: Vec3) {
    let around = size * 6;
    builder.patch(around, size * 2, |side, ring| {
        let (turn, up) = ((side % around) as f32 / around as f32, ring as f32 / (size * 2) as f32);
        let (sin, cos) = portable::sin_cos_turns(turn);
        let flute = portable::sin_cos_turns(turn * size as f32 * 0.5).0;
        let radius = 0.5 - 0.1 * up - 0.05 * flute * flute;
        foot + vec3(cos * radius, 0.4 + up * 8.0, sin * radius)
    });
    let place = Placement { origin: foot, turns: 0.0 };
    builder.cuboid(place, vec3(0.0, 0.2, 0.0), vec3(0.7, 0.2, 0.7));
    builder.cuboid(place, vec3(0.0, 8.6, 0.0), vec3(0.65, 0.2, 0.65));
}

/// Appends struts from the foot of the wall up to the vault, whose boxes are mostly empty.
fn strut(builder: &mut Builder, size: u32, side: f32, z: f32) {
    builder.rod(vec3(side * 7.6, 0.3, z - 2.2), vec3(side * 1.2, 10.6, z + 1.1), 0.07, size);
    builder.rod(vec3(side * 7.6, 4.5, z + 2.0), vec3(side * 4.6, 8.9, z), 0.05, size);
}

fn bench(builder: &mut Builder, middle: Vec3) {
    let place = Placement { origin: middle, turns: 0.004 * middle.z };
    for slat in 0..5 {
        builder.cuboid(place, vec3(0.0, 0.5, slat as f32 * 0.11 - 0.22), vec3(1.2, 0.02, 0.04));
        builder.cuboid(place, vec3(0.0, 0.62 + slat as f32 * 0.1, 0.3), vec3(1.2, 0.035, 0.015));
    }
    for leg in [-1.1, -0.4, 0.4, 1.1] {
        builder.cuboid(place, vec3(leg, 0.25, 0.0), vec3(0.03, 0.25, 0.24));
    }
}

/// Appends a statue: body, head and plinth.
fn statue(builder: &mut Builder, size: u32, foot: Vec3, seed: u32) {
    let n = size + size / 3;
    let bumps = |d: Vec3, strength: f32| 1.0 + strength * fractal(d * 2.2, 4, 100 + seed);
    builder.cube_sphere(foot + vec3(0.0, 1.9, 0.0), n, |d| 0.42 * bumps(d, 0.3) * (1.0 + 1.1 * d.y * d.y));
    builder.cube_sphere(foot + vec3(0.0, 3.05, 0.0), n, |d| 0.24 * bumps(d, 0.2));
    builder.cuboid(Placement { origin: foot, turns: 0.05 }, vec3(0.0, 0.5, 0.0), vec3(0.4, 0.5, 0.4));
}
