//! Viewpoint of an image: its matrices project positions to their pixels.

use juggler::camera::film::Rect;
use juggler::imaging::{Matrix4, Options};
use juggler::math::Vec3;
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Aov, Picture, Settings};

const CAMERAS: [&str; 3] = [
    r#"{"perspective": {"eye": [3, 2.5, 6], "look_at": [0.2, 0.4, 0], "roll_degrees": 17, "vertical_fov_degrees": 35}}"#,
    r#"{"orthographic": {"eye": [3, 2.5, 6], "look_at": [0.2, 0.4, 0], "yaw_degrees": 3, "height": 4}}"#,
    r#"{"thin_lens": {"eye": [3, 2.5, 6], "look_at": [0.2, 0.4, 0], "lens_radius": 0, "focus_distance": 3}}"#,
];

fn picture(camera: &str, settings: &Settings) -> Picture {
    let text = format!(
        r#"{{"version": 1, "render": {{"size": [60, 44], "samples": 16, "integrator": "path", "filter": "box"}},
            "camera": {camera}, "lights": [{{"point": {{"position": [4, 6, 4]}}}}],
            "objects": [{{"shape": "plane"}}, {{"shape": "sphere", "transform": [{{"translate": [0, 1, 0]}}]}}]}}"#
    );
    Picture::new(&Scene::from_json(text, "test").unwrap(), settings).unwrap()
}

/// Multiplies a point as a row vector with a matrix.
fn times(point: Vec3, matrix: &Matrix4) -> [f32; 3] {
    let row = [point.x, point.y, point.z, 1.0];
    let [x, y, z, w] = [0, 1, 2, 3].map(|column| (0..4).map(|i| row[i] * matrix[i][column]).sum::<f32>());
    [x / w, y / w, z / w]
}

#[test]
fn projection_of_the_position_aov_is_its_pixel() {
    let crop = Some(Rect { x: 7, y: 5, width: 40, height: 30 });
    for (camera, crop) in CAMERAS.iter().flat_map(|camera| [(camera, None), (camera, crop)]) {
        let aovs = vec![Aov::Position, Aov::Alpha];
        let picture = picture(camera, &Settings { aovs, crop, ..Settings::default() });
        let film = picture.film();
        picture.render_film(&film, &Control::default()).unwrap();
        let tiles: Vec<_> = film.tiles().map(|(_, tile)| tile).collect();
        let [alpha, x, y, z] = picture.aovs().band_values(&picture.region(), &tiles, None).try_into().unwrap();
        let viewpoint = picture.header(Options::default()).viewpoint.unwrap();
        let ([width, _], [full_width, full_height]) = (picture.size(), picture.frame_size());
        let corner = [picture.region().x, picture.region().y];
        let mut covered = 0;
        for pixel in (0..alpha.len()).filter(|pixel| alpha[*pixel] > 0.0) {
            let [u, v, _] = times(Vec3::new(x[pixel], y[pixel], z[pixel]), &viewpoint.world_to_ndc);
            let (column, row) = (pixel as u32 % width + corner[0], pixel as u32 / width + corner[1]);
            let off = [u * full_width as f32 - column as f32 - 0.5, v * full_height as f32 - row as f32 - 0.5];
            // At grazing angles far away, positions are exact to a hundredth of a pixel.
            assert!(off.iter().all(|off| off.abs() < 0.51), "{camera} {column} {row}: {off:?}");
            covered += 1;
        }
        assert!(covered * 2 > alpha.len(), "{camera}: {covered}");
    }
}

#[test]
fn camera_matrices_map_known_points() {
    for camera in CAMERAS {
        let viewpoint = picture(camera, &Settings::default()).viewpoint().unwrap();
        let center = times(Vec3::new(0.2, 0.4, 0.0), &viewpoint.world_to_ndc);
        let ahead = times(Vec3::new(0.2, 0.4, 0.0), &viewpoint.world_to_camera);
        let eye = times(Vec3::new(3.0, 2.5, 6.0), &viewpoint.world_to_camera);
        assert!(eye.iter().all(|number| number.abs() < 1e-5), "{camera}: {eye:?}");
        // The `look_at` projects to the center, except for the camera with a yaw.
        if camera.contains("yaw") {
            assert!(ahead[0] < -0.3 && ahead[1].abs() < 1e-5 && center[0] < 0.45, "{ahead:?} {center:?}");
        } else {
            let distance = (Vec3::new(2.8, 2.1, 6.0)).length();
            assert!(ahead[0].abs() < 1e-5 && ahead[1].abs() < 1e-5 && (ahead[2] - distance).abs() < 1e-4, "{ahead:?}");
            assert!((center[0] - 0.5).abs() < 1e-5 && (center[1] - 0.5).abs() < 1e-5, "{camera}: {center:?}");
        }
    }
}
