//! A program with the prelude alone makes kinds of all families by their constructors.

use juggler::prelude::*;

/// Scene with every texture, each on a diffuse sphere.
fn with_textures(scene: Scene) -> Scene {
    let stops = [texture::Stop::new(0.0, Rgb::BLACK), texture::Stop::new(1.0, [0.9, 0.5, 0.1])];
    let textures: [(&str, AnyTexture); 18] = [
        ("attribute", texture::Attribute::new("color").into()),
        ("brick", texture::Brick::new([0.4, 0.1, 0.1], 0.6).into()),
        ("checker", texture::Checker { size: 0.1, ..texture::Checker::new(0.8, "marble") }.into()),
        ("constant", texture::Constant::new(0.5).into()),
        ("direction", texture::Direction::new("noise").into()),
        ("dots", texture::Dots::new(0.9, 0.1).into()),
        ("fbm", texture::Fbm::new(0.0, 1.0).into()),
        ("gradient", texture::Gradient::new(stops.clone()).into()),
        ("image", texture::Image::new("pixel").into()),
        ("marble", texture::Marble::new(0.8, 0.2).into()),
        ("mix", texture::Mix::new("marble", "wood", 0.5).into()),
        ("noise", texture::Noise::new(0.0, 1.0).into()),
        ("ramp", texture::Ramp::new("noise", stops).into()),
        ("triplanar", texture::Triplanar::new("noise").into()),
        ("turbulence", texture::Turbulence::new(0.0, 1.0).into()),
        ("voronoi", texture::Voronoi::new(0.0, 1.0).into()),
        ("wave", texture::Wave::new(0.0, 1.0).into()),
        ("wood", texture::Wood::new([0.5, 0.3, 0.1], 0.1).into()),
    ];
    let scene = scene.image("pixel", Image::filled(1, 1, Rgb::splat(0.5)));
    textures.into_iter().fold(scene, |scene, (name, texture)| {
        scene.texture(name, texture).add(Object::new(Sphere::new(0.1)).material(Diffuse::new(name)))
    })
}

/// Scene with a sphere of every material but the classic one.
fn with_materials(scene: Scene) -> Scene {
    let fog = Medium { scattering: Rgb::splat(0.5), ..Medium::default() };
    let materials: [AnyMaterial; 16] = [
        Boundary::new(fog).into(),
        BumpMap { distance: 0.01, ..BumpMap::new("noise", "paint") }.into(),
        Checkerboard::new("paint", Diffuse::new(0.1)).into(),
        Conductor { roughness: 0.3.into(), ..Conductor::new([0.9, 0.8, 0.5]) }.into(),
        Conductor::from_metal(MetalName::Gold).into(),
        Dielectric::new(1.5).into(),
        Emissive { sides: Sides::Both, ..Emissive::new(2.0) }.into(),
        Mask::new("dots", "paint").into(),
        Mix::new("paint", Velvet::new(0.5), 0.5).into(),
        NormalMap::new("image", "paint").into(),
        Plastic::new("wood").into(),
        Principled { clearcoat_normal: Some("image".into()), ..Principled::new("wood") }.into(),
        Translucent::new(0.4, 0.4).into(),
        Unlit::new("checker").into(),
        Velvet::new(0.5).into(),
        Diffuse { sides: SurfaceSides::Front, ..Diffuse::new(0.5) }.into(),
    ];
    let scene = scene.material("paint", Diffuse::new([0.1, 0.2, 0.8]));
    materials.into_iter().fold(scene, |scene, material| scene.add(Object::new(Sphere::new(0.2)).material(material)))
}

/// Scene with every shape, and the composite objects.
fn with_shapes(scene: Scene) -> Scene {
    let corners = [vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
    let shapes: [AnyShape; 10] = [
        Cuboid::new([0.0; 3], [1.0, 2.0, 3.0]).into(),
        Cylinder::new(0.5, 0.0, 2.0).into(),
        Disk { inner_radius: 0.5, ..Disk::new(1.0) }.into(),
        Mesh::from_triangles(corners, [[0, 1, 2]]).into(),
        Plane::default().into(),
        Polygon::new(corners).into(),
        Rectangle::new([2.0, 1.0]).into(),
        Sphere::new(1.0).into(),
        Triangle::new(corners).into(),
        Tube::new(0.1).into(),
    ];
    let scene = shapes.into_iter().fold(scene, |scene, shape| scene.add(Object::new(shape)));
    let ends = [ControlSphere::new([0.0; 3], 0.1), ControlSphere::new([0.0, 1.0, 0.0], 0.2)];
    let limb = Limb::new([0.0; 3], [0.0, 1.0, 0.0], [0.6, 0.6], [0.0, 0.0, 1.0], [0.1, 0.1, 0.1]);
    scene
        .add(Object::chain(Chain::new(ends[0], ends[1], 3)))
        .add(Object::limb(limb).transformed(TransformStep::LookAt(LookAt::new([0.0, 1.0, 0.0], [1.0, 1.0, 1.0]))))
        .add(Object::new(Sphere::new(0.1)).instances(Instances::at([Vec3::X, Vec3::Z])))
        .add(Object::new(Sphere::new(0.1)).transformed(TransformStep::Rotate(Rotate::new(Vec3::Y, 30.0).into())))
}

fn with_lights(scene: Scene) -> Scene {
    let lights: [AnyLight; 5] = [
        Ambient::new(0.1).into(),
        Area::new(AreaShape::Disk { radius: 0.5 }, [0.0, 5.0, 0.0], 10.0).into(),
        Directional { angle_degrees: 0.5, ..Directional::new([0.0, -1.0, -1.0], 2.0) }.into(),
        Point { attenuation: Attenuation::new(1.0, 0.0, 1.0), ..Point::new([4.0, 6.0, 4.0], 60.0) }.into(),
        Spot { falloff: SpotFalloff::SmoothCosine, ..Spot::new([0.0, 5.0, 5.0], [0.0, -1.0, -1.0], 60.0) }.into(),
    ];
    lights.into_iter().fold(scene, Scene::light)
}

fn scene() -> Scene {
    let scene = Scene::new()
        .size(8, 6)
        .samples(1)
        .frames(2, 24.0)
        .integrator(integrator::Path { max_depth: 3, ..integrator::Path::default() })
        .sampler(sampler::Stratified { side: 2 })
        .filter(film::Gaussian::new(1.5, 0.5))
        .tone(Tone { white_balance: Some(WhiteBalance::new(5000.0)), ..Tone::default() })
        .background(background::Sky::new(30.0, 90.0));
    with_lights(with_shapes(with_materials(with_textures(scene))))
        .camera("pinhole", Perspective::new([0.0, 2.0, 6.0], [0.0, 1.0, 0.0]))
        .camera("lens", ThinLens::new([0.0, 2.0, 6.0], [0.0, 1.0, 0.0], 0.05, 6.0))
        .camera("plan", Orthographic::new([0.0, 9.0, 0.1], Vec3::ZERO, 5.0))
}

#[test]
fn the_prelude_makes_kinds_of_all_families() {
    let scene = scene();
    for camera in ["pinhole", "lens", "plan"] {
        let settings = Settings { camera: Some(camera.into()), ..Settings::default() };
        let image = Picture::new(&scene, &settings).unwrap().render_image(&Control::default()).unwrap();
        assert!(image.pixels().iter().all(|pixel| pixel.is_finite()), "{camera}");
    }
    let backgrounds: [AnyBackground; 3] = [
        background::Solid::new([0.1, 0.2, 0.3]).into(),
        background::Gradient::new([1.0; 3], [0.2, 0.4, 1.0]).into(),
        background::Dome::new(1e4, [0.5; 3], [0.1; 3]).into(),
    ];
    for background in backgrounds {
        Picture::new(&scene.clone().background(background), &Settings::default()).unwrap();
    }
}

#[test]
fn the_prelude_animates() {
    let keys = Animate::from_keys([(Seconds(0.0), 0.1), (Seconds(1.0), 0.2)]);
    let keys = Animate { interpolation: Interpolation::Smooth, ..keys };
    let ball = Animated::new(Sphere::new(0.1)).field(|sphere| &mut sphere.radius, keys).map(Object::new);
    let scene = Scene::new()
        .frames(2, 24.0)
        .path("arc", ScenePath::new([[0.0; 3], [1.0, 0.0, 0.0]]))
        .and_then(|scene| scene.add_animated(ball.moved(Along::new("arc", 0.5))));
    let moved = scene.and_then(|scene| scene.at_frame(24.0)).unwrap();
    let expected = Object::new(Sphere::new(0.2)).at(0.5, 0.0, 0.0);
    assert_eq!(*moved.description.objects[0], expected);
}
