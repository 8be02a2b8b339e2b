//! Lesson 5: renders a turning vase, made of arrays, and a ball that flies around it, in four frames
//! with AOVs: `vase_0.exr`, `vase_1.exr` and so on hold color, normals, depth and the objects' ids.
//!
//! `cargo run --release --example 5_animation_and_aovs`

use juggler::prelude::*;

/// Points around the vase, and rows from its foot to its rim.
const POINTS: [u32; 2] = [240, 160];

/// A twisted vase without lid. The attribute `glaze` is a color that changes with the height.
fn vase() -> Mesh {
    let [around, rows] = POINTS;
    let cells = (0..rows).flat_map(|row| (0..around).map(move |column| (row, column)));
    let point = |(row, column): (u32, u32)| {
        let (height, angle) = (row as f32 / (rows - 1) as f32, std::f32::consts::TAU * column as f32 / around as f32);
        let radius = (0.42 + 0.2 * (5.2 * height + 0.4).sin()) * (1.0 + 0.07 * (8.0 * angle + 5.0 * height).cos());
        (vec3(radius * angle.cos(), 1.6 * height, radius * angle.sin()), height)
    };
    let (positions, heights): (Vec<Vec3>, Vec<f32>) = cells.clone().map(point).unzip();
    let triangles = cells.filter(|(row, _)| row + 1 < rows).flat_map(|(row, column)| {
        let (next, above) = ((column + 1) % around, (row + 1) * around);
        let [a, b, c, d] = [row * around + column, row * around + next, above + column, above + next];
        [[a, c, b], [b, c, d]]
    });
    let glaze = heights.iter().flat_map(|h| [0.05 + 0.85 * h, 0.22 + 0.3 * h, 0.45 - 0.35 * h]).collect();
    let mut mesh = Mesh::from_triangles(positions, triangles.collect::<Vec<_>>());
    mesh.crease_angle_degrees = Some(60.0);
    mesh.with_attribute("glaze", MeshAttribute::new(3, AttributeData::F32(glaze)))
}

fn scene() -> Result<Scene, Error> {
    // Turn the vase once in 48 frames, let the ball fly along a closed curve, and fade in the light.
    let turn = Animate::from_keys([(Frames(0.0), 0.0), (Frames(48.0), 360.0)]);
    let around = Along::new("ring", ValueSource::expression("seconds / 2"));
    let fade = Animate::from_keys([(Seconds(0.0), 4.0), (Seconds(1.0), 30.0)]);
    let light = Animated::new(Point::new([-2.0, 4.0, 3.0], 4.0)).field(|light| &mut light.intensity, fade);
    let ball = Object::new(Sphere::new(0.13)).named("ball").material(Conductor::new(0.9));
    let glaze = Principled { roughness: 0.25.into(), ..Principled::new(Input::attribute("glaze")) };
    let ring = ScenePath {
        closed: true,
        ..ScenePath::new([[1.1, 0.3, 0.0], [0.0, 0.8, -1.1], [-1.1, 1.3, 0.0], [0.0, 0.8, 1.1]])
    };
    let scene = Scene::new()
        .size(640, 360)
        .samples(64)
        .frames(48, 24.0)
        .path("ring", ring)?
        .camera("main", Perspective::new([0.0, 2.2, 4.2], [0.0, 0.75, 0.0]))
        .background([0.3, 0.34, 0.4])
        .material("glaze", glaze)
        .group("vase", [Object::new(vase()).material_named("glaze")])
        .add(Object::new(Plane::default()).named("floor").material(Diffuse::new(0.35)))
        .add_animated(Animated::new(Object::group("vase").named("vase")).rotated(Vec3::Y, turn))?
        .add_animated(Animated::new(ball).moved(around))?
        .animated_light(light)?;
    Ok(scene)
}

fn main() -> Result<(), Error> {
    let scene = scene()?;
    let settings = Settings { aovs: vec![Aov::Normal, Aov::Depth, Aov::ObjectId], ..Settings::default() };
    for (i, frame) in [0.0, 8.0, 16.0, 24.0].into_iter().enumerate() {
        juggler::render_to_file(&scene.at_frame(frame)?, &settings, format!("vase_{i}.exr"))?;
    }
    Ok(())
}
