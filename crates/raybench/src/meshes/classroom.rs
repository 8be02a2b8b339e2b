//! A furnished room with desks, chairs, books, lamps, radiators and blinds: many thin boxes and
//! rods of all sizes, some at odd angles, between walls of two triangles each.

use super::builder::{Builder, Placement, Random};
use super::{Mesh, MeshKind, View};
use juggler_math::{Vec3, portable, vec3};

pub const KIND: MeshKind = MeshKind {
    name: "classroom",
    about: "a furnished room of thin boxes and rods; size: desks in a row, and rows of them",
    size: 6,
    sizes: (1, 40),
    make,
};

/// Half the width, the height and half the length of the room. The teacher's end is at -z, the
/// windows are at -x.
const WIDTH: f32 = 5.5;
const HEIGHT: f32 = 3.2;
const LENGTH: f32 = 6.0;

fn make(size: u32) -> Mesh {
    let mut builder = Builder::default();
    let mut random = Random::new(71);
    room(&mut builder);
    windows(&mut builder);
    shelves(&mut builder, &mut random);
    lamps(&mut builder);
    let step = vec3(2.0 * WIDTH - 3.0, 0.0, 2.0 * LENGTH - 4.0) / size as f32;
    for row in 0..size {
        for column in 0..size {
            let at =
                vec3((column as f32 + 0.5) * step.x - WIDTH + 1.0, 0.0, (row as f32 + 0.5) * step.z - LENGTH + 3.0);
            let shift = random.cube() * vec3(0.08, 0.0, 0.08);
            desk(&mut builder, Placement { origin: at, turns: random.range(-0.01, 0.01) }, &mut random);
            chair(
                &mut builder,
                Placement { origin: at + shift + vec3(0.0, 0.0, 0.6), turns: random.range(-0.08, 0.08) },
            );
        }
    }
    builder.finish(View {
        eye: vec3(4.4, 2.1, 5.2),
        look_at: vec3(-0.6, 0.9, -0.6),
        up: Vec3::Y,
        fov_degrees: 58.0,
        light: vec3(-0.4, 2.7, 0.5),
    })
}

/// Placement of the room itself.
const ROOM: Placement = Placement { origin: Vec3::ZERO, turns: 0.0 };

fn room(builder: &mut Builder) {
    builder.cuboid(ROOM, vec3(0.0, HEIGHT / 2.0, 0.0), vec3(WIDTH, HEIGHT / 2.0, LENGTH));
    builder.cuboid(ROOM, vec3(0.0, 1.6, 0.03 - LENGTH), vec3(2.2, 0.65, 0.02));
    builder.cuboid(ROOM, vec3(0.0, 0.93, 0.08 - LENGTH), vec3(2.2, 0.01, 0.05));
    builder.cuboid(ROOM, vec3(WIDTH - 0.03, 1.05, -4.5), vec3(0.03, 1.05, 0.5));
    for board in 0..44 {
        let x = (board as f32 + 0.5) / 44.0 * 2.0 * WIDTH - WIDTH;
        builder.cuboid(ROOM, vec3(x, 0.004, 0.0), vec3(WIDTH / 44.0 - 0.003, 0.004, LENGTH - 0.01));
    }
}

/// Appends frames, half-closed blinds and a radiator for each of three windows.
fn windows(builder: &mut Builder) {
    for window in 0..3 {
        let z = window as f32 * 3.6 - 3.6;
        for bar in 0..4 {
            let along = bar as f32 - 1.5;
            builder.cuboid(ROOM, vec3(0.05 - WIDTH, 1.9, z + along * 0.9), vec3(0.03, 0.85, 0.03));
            builder.cuboid(ROOM, vec3(0.05 - WIDTH, 1.9 + along * 0.56, z), vec3(0.03, 0.03, 1.38));
        }
        for slat in 0..48 {
            let lean =
                Placement { origin: vec3(0.14 - WIDTH, 2.72 - slat as f32 * 0.033, z), turns: 0.001 * slat as f32 };
            builder.cuboid(lean, Vec3::ZERO, vec3(0.018, 0.0012, 1.38));
        }
        for rib in 0..32 {
            let foot = vec3(0.16 - WIDTH, 0.15, z - 1.25 + rib as f32 * 0.08);
            builder.rod(foot, foot + vec3(0.0, 0.65, 0.0), 0.028, 16);
        }
    }
}

/// Appends two bookcases along the back wall with books of different sizes.
fn shelves(builder: &mut Builder, random: &mut Random) {
    for case in [-2.6, 2.2] {
        for board in 0..6 {
            let y = 0.1 + board as f32 * 0.38;
            builder.cuboid(ROOM, vec3(case, y, LENGTH - 0.2), vec3(1.6, 0.012, 0.16));
            let mut x = case - 1.55;
            while board < 5 && x < case + 1.5 {
                let half = vec3(random.range(0.008, 0.03), random.range(0.1, 0.16), random.range(0.08, 0.12));
                let turns = random.range(-0.01, 0.01);
                let place = Placement { origin: vec3(x + half.x, y + 0.012 + half.y, LENGTH - 0.2), turns };
                builder.cuboid(place, Vec3::ZERO, half);
                x += 2.0 * half.x + 0.004;
            }
        }
    }
}

/// Appends lamps: shades with a bulb inside, each on a rod from the ceiling.
fn lamps(builder: &mut Builder) {
    for lamp in 0..8 {
        let (side, along) = ((lamp % 2) as f32 * 4.0 - 2.0, (lamp / 2) as f32 * 2.8 - 4.2);
        let hang = vec3(side, 2.35, along);
        builder.rod(hang + vec3(0.0, 0.3, 0.0), vec3(side, HEIGHT, along), 0.008, 12);
        builder.cube_sphere(hang, 8, |_| 0.07);
        builder.patch(48, 10, |turn, ring| {
            let (sin, cos) = portable::sin_cos_turns((turn % 48) as f32 / 48.0);
            let (bend, rise) = portable::sin_cos_turns(0.25 * (ring as f32 + 0.5) / 10.5);
            hang + vec3(cos * bend * 0.3, rise * 0.3, sin * bend * 0.3)
        });
    }
}

/// Appends a desk: top, tray, four legs with feet; books, sheets, pencils and a ball on it.
fn desk(builder: &mut Builder, place: Placement, random: &mut Random) {
    builder.cuboid(place, vec3(0.0, 0.74, 0.0), vec3(0.6, 0.012, 0.3));
    builder.cuboid(place, vec3(0.0, 0.62, 0.0), vec3(0.52, 0.006, 0.24));
    builder.cuboid(place, vec3(0.0, 0.5, -0.26), vec3(0.55, 0.18, 0.006));
    for (x, z) in [(-0.55, -0.26), (0.55, -0.26), (-0.55, 0.26), (0.55, 0.26)] {
        rod(builder, place, [vec3(x, 0.02, z), vec3(x, 0.73, z)], 0.018, 16);
        rod(builder, place, [vec3(x, 0.0, z), vec3(x, 0.02, z)], 0.026, 16);
    }
    let mut y = 0.752;
    for _ in 0..6 {
        let half = vec3(random.range(0.08, 0.11), random.range(0.004, 0.018), random.range(0.1, 0.14));
        let origin = place.point(vec3(-0.35, y + half.y, 0.0));
        builder.cuboid(Placement { origin, turns: place.turns + random.range(-0.06, 0.06) }, Vec3::ZERO, half);
        y += 2.0 * half.y;
    }
    for sheet in 0..4 {
        let spot = vec3(random.range(-0.1, 0.3), 0.754 + sheet as f32 * 0.001, random.range(-0.1, 0.1));
        let origin = place.point(spot);
        builder.cuboid(Placement { origin, turns: random.unit() }, Vec3::ZERO, vec3(0.105, 0.0002, 0.148));
    }
    for _ in 0..3 {
        let from = vec3(random.range(0.0, 0.5), 0.764, random.range(-0.25, 0.25));
        let (sin, cos) = portable::sin_cos_turns(random.unit());
        rod(builder, place, [from, from + vec3(cos * 0.16, 0.0, sin * 0.16)], 0.004, 8);
    }
    builder.cube_sphere(place.point(vec3(0.48, 0.80, -0.2)), 5, |_| 0.045);
}

/// Appends a chair: bent seat and back on a frame of tubes.
fn chair(builder: &mut Builder, place: Placement) {
    let sheet = |builder: &mut Builder, at: &dyn Fn(f32, f32) -> Vec3| {
        for side in [-0.006, 0.006] {
            builder
                .patch(12, 8, |i, j| place.point(at(i as f32 / 6.0 - 1.0, j as f32 / 4.0 - 1.0) + Vec3::splat(side)));
        }
    };
    sheet(builder, &|x, z| vec3(x * 0.2, 0.45 + 0.02 * x * x - 0.015 * z, z * 0.2));
    sheet(builder, &|x, y| vec3(x * 0.2, 0.76 + y * 0.13, 0.22 - 0.04 * x * x + 0.03 * y));
    for x in [-0.19, 0.19] {
        rod(builder, place, [vec3(x, 0.0, -0.2), vec3(x, 0.44, -0.17)], 0.011, 14);
        rod(builder, place, [vec3(x, 0.0, 0.26), vec3(x, 0.88, 0.22)], 0.011, 14);
        rod(builder, place, [vec3(x, 0.43, -0.17), vec3(x, 0.43, 0.24)], 0.011, 14);
        rod(builder, place, [vec3(x, 0.12, -0.19), vec3(x, 0.12, 0.25)], 0.008, 14);
    }
    rod(builder, place, [vec3(-0.19, 0.12, 0.03), vec3(0.19, 0.12, 0.03)], 0.008, 14);
}

fn rod(builder: &mut Builder, place: Placement, ends: [Vec3; 2], radius: f32, sides: u32) {
    let [from, to] = ends.map(|end| place.point(end));
    builder.rod(from, to, radius, sides);
}
