//! Many transparent surfaces in a row: shadow rays pass as many of them as paths do.

use super::*;
use juggler_integrator::{Direct, Path};
use juggler_world::MAX_PASS_THROUGHS;

/// A stack of `count` invisible disks above `floor`.
fn panes(count: u16, floor: &str, lights: &[&str]) -> World {
    let invisible = r#"{"mask": {"material": {"diffuse": {}}, "opacity": 0}}"#;
    let height = |pane: u16| Vec3::new(0.0, 1.0 + f32::from(pane) * 0.01, 0.0);
    let mut objects: Vec<(&str, Vec3, &str)> =
        (0..count).map(|pane| (r#"{"disk": {"radius": 9}}"#, height(pane), invisible)).collect();
    objects.push((r#"{"disk": {"radius": 9}}"#, Vec3::ZERO, floor));
    world(&objects, lights, Rgb::BLACK)
}

fn seen(world: &World, eye: Vec3, integrator: &AnyIntegrator) -> Rgb {
    pixels(world, &look(eye, Vec3::ZERO, "5", PIXEL), integrator, PIXEL, 4)[0]
}

#[test]
fn shadow_rays_pass_as_many_invisible_surfaces_as_paths() {
    let light = r#"{"point": {"position": [0, 20, 0], "intensity": 400}}"#;
    let (below, above) = (Vec3::new(0.5, 0.9, 0.0), Vec3::new(0.5, 20.0, 0.0));
    let lit = |count| seen(&panes(count, r#"{"diffuse": {}}"#, &[light]), below, &Direct::default().into());
    let followed = |count| seen(&panes(count, r#"{"emissive": {}}"#, &[]), above, &Path::default().into());
    for (name, look) in [("light-sampled", &lit as &dyn Fn(u16) -> Rgb), ("BSDF-sampled", &followed)] {
        let open = look(0);
        assert!(open.g > 0.01, "{name}: {open:?}");
        for count in [1, 63, 64, 65, MAX_PASS_THROUGHS] {
            assert!(
                near(look(count), open, 1e-4 * open.g),
                "{name} through {count}: {:?} instead of {open:?}",
                look(count)
            );
        }
        assert!(look(MAX_PASS_THROUGHS + 1).is_black(), "{name} through one more");
    }
}

#[test]
fn rays_behind_invisible_surfaces_count_as_secondary_rays() {
    let (size, samples, eye) = (UVec2::new(6, 4), 4, Vec3::new(0.5, 20.0, 0.0));
    let camera = look(eye, Vec3::ZERO, "5", size);
    let paths = u64::from(size.x * size.y * samples);
    for integrator in [AnyIntegrator::from(Path::default()), Classic::default().into()] {
        for count in [0, 1, 5] {
            let (world, control) = (panes(count, r#"{"emissive": {}}"#, &[]), Control::default());
            let work = Work::first(Rect { x: 0, y: 0, width: size.x, height: size.y }, samples);
            job(&world, &camera, &integrator, samples).render(&work, &control).unwrap();
            // Each path passes every pane and ends at the emissive floor.
            let expected = RayCounts { camera: paths, secondary: paths * u64::from(count), ..RayCounts::default() };
            assert_eq!(control.rays(), expected, "{count} panes");
        }
    }
}
