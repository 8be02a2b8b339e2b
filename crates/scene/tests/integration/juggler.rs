//! The Juggler's poses compared with the closed forms of "Project Amiga Juggler" (Michael Birken,
//! 2010, step 27) and with numbers computed from them by hand.

use juggler_light::background::AnyBackground;
use juggler_math::{BuildControl, DVec3, Vec3};
use juggler_scene::compile::{Assembly, AssetCache, Files};
use juggler_scene::document::Sources;
use juggler_scene::{Scene, Tracks};
use juggler_shape::AnyShape;
use juggler_world::Object;
use std::f64::consts::TAU;

const NEAR: f64 = 2e-4;

/// Center and radius of the spheres of a frame, in the order of the scene file.
fn spheres(frame: f64) -> Vec<(DVec3, f64)> {
    let scene = Scene::built_in("juggler").unwrap().at_frame(frame).unwrap();
    let asset_cache = AssetCache::default();
    let (sources, control) = (Sources::default(), BuildControl::new());
    let files = Files { scene: &scene.description, sources: &sources, asset_cache: &asset_cache, control: &control };
    let (assembly, findings) = Assembly::from_scene(&scene.description, &Tracks::default(), files);
    assert!(findings.is_empty(), "{findings:?}");
    let shape = |object: &Object| object.content.as_shape().unwrap().as_ref().clone();
    let ground = assembly.objects.iter().filter(|object| matches!(shape(object), AnyShape::Plane(_))).count();
    assert_eq!((assembly.objects.len(), ground), (85, 1));
    assert!(matches!(&assembly.background, AnyBackground::Dome(sky) if sky.radius == 1e6));
    let sphere = |object: &Object| match shape(object) {
        AnyShape::Sphere(sphere) => Some(f64::from(sphere.radius)),
        _ => None,
    };
    let placed = assembly
        .objects
        .iter()
        .filter_map(|object| Some((object.motion.at(0.0).point(Vec3::ZERO).as_dvec3(), sphere(object)?)));
    placed.collect()
}

/// Pose at an instant by the article's formulas.
struct Pose {
    origin: DVec3,
    up: DVec3,
    side: DVec3,
    hand: DVec3,
    t: f64,
}

impl Pose {
    fn at(t: f64) -> Self {
        let angle = TAU * t / 30.0;
        let high = (1.0 + angle.cos()) / 2.0;
        let up = DVec3::new(0.0, 70.0, -4.0 * angle.sin()).normalize();
        let swing = -0.35 * high;
        Self {
            origin: DVec3::new(151.0, 81.0 + 4.0 * high, -151.0),
            up,
            side: DVec3::new(0.0, up.z, -up.y),
            hand: DVec3::new(69.0 + 41.0 * swing.cos(), 60.0 - 41.0 * swing.sin(), 0.0),
            t,
        }
    }

    fn local(&self, y: f64, z: f64) -> DVec3 {
        self.origin + self.up * y + self.side * z
    }

    fn balls(&self) -> [DVec3; 3] {
        let (gravity, high, low) = (0.64 / 3.0, 6.4, 3.2);
        let fall = |speed: f64, t: f64| 88.0 + speed * t - gravity / 2.0 * t * t;
        let above = |t: f64| DVec3::new(110.0, fall(high, t), -108.0 - 74.0 / 60.0 * t);
        let below = |t: f64| DVec3::new(110.0, fall(low, t), -182.0 + 74.0 / 30.0 * t);
        [above(30.0 + self.t), above(self.t), below(self.t)]
    }

    /// Ends, plane normal and bone lengths of the limbs in the order of the file: left leg, right
    /// leg, left arm, right arm.
    fn limbs(&self) -> [(DVec3, DVec3, DVec3, [f64; 2]); 4] {
        let (leg, arm) = ([42.58, 34.07], [44.294, 46.098]);
        let hand = |z| DVec3 { z, ..self.hand };
        let (left, right) = (self.local(45.0, -19.0), self.local(45.0, 19.0));
        [
            (DVec3::new(159.0, 2.5, -133.0), self.local(-9.0, -16.0), self.side, leg),
            (DVec3::new(139.0, 2.5, -164.0), self.local(-9.0, 16.0), self.side, leg),
            (hand(-108.0), left, self.local(45.41217, -19.91111) - left, arm),
            (hand(-182.0), right, right - self.local(45.41217, 19.91111), arm),
        ]
    }
}

/// Joint of two bones (step 16 of the article).
fn joint(p: DVec3, q: DVec3, normal: DVec3, [a, b]: [f64; 2]) -> DVec3 {
    let distance = p.distance(q);
    let v = (q - p) / distance;
    let u = v.cross(normal.normalize());
    let y = (a * a - b * b + distance * distance) / (2.0 * distance);
    p + u * (a * a - y * y).sqrt() + v * y
}

#[track_caller]
fn assert_near((center, radius): (DVec3, f64), expected: DVec3, expected_radius: f64) {
    assert!((center - expected).length() < NEAR, "{center} is not at {expected}");
    assert!((radius - expected_radius).abs() < 1e-5, "{radius} is not {expected_radius}");
}

fn check(frame: f64) {
    let (spheres, pose) = (spheres(frame), Pose::at(frame));
    assert_eq!(spheres.len(), 84);
    let (balls, trunk, limbs) = (&spheres[..3], &spheres[3..16], &spheres[16..]);
    pose.balls().into_iter().zip(balls).for_each(|(expected, ball)| assert_near(*ball, expected, 14.0));

    for (k, sphere) in trunk[..8].iter().enumerate() {
        let step = k as f64 / 7.0;
        assert_near(*sphere, pose.local(32.0 * step, 0.0), 16.0 + 4.0 * step);
    }
    let beside = |y: f64, z: f64, x: f64| DVec3 { x, ..pose.local(y, z) };
    assert_near(trunk[8], pose.local(55.0, 0.0), 5.0);
    assert_near(trunk[9], pose.local(70.0, 0.0), 14.0);
    assert_near(trunk[10], beside(71.0, 0.0, 152.0), 14.0);
    assert_near(trunk[11], beside(69.0, -7.0, 142.0), 4.0);
    assert_near(trunk[12], beside(69.0, 7.0, 142.0), 4.0);

    for ((from, to, normal, lengths), limb) in pose.limbs().into_iter().zip(limbs.chunks(17)) {
        let joint = joint(from, to, normal, lengths);
        for k in 0..8 {
            let step = k as f64 / 8.0;
            assert_near(limb[k], from.lerp(joint, step), 2.5 + 2.5 * k as f64 / 7.0);
            assert_near(limb[9 + k], to.lerp(joint, step), 5.0);
        }
        assert_near(limb[8], joint, 5.0);
    }
}

#[test]
fn every_sphere_is_where_the_article_puts_it() {
    [0.0, 7.0, 7.5, 15.0, 22.0, 29.96875].into_iter().for_each(check);
}

/// Knees and elbows at four instants, in the order of [`Pose::limbs`].
const JOINTS: [(f64, [[f64; 3]; 4]); 4] = [
    (
        0.0,
        [
            [144.5902, 42.5511, -134.1192],
            [136.9423, 44.9957, -165.6761],
            [149.2561, 87.7826, -113.5741],
            [149.8943, 86.0366, -183.0248],
        ],
    ),
    (
        7.5,
        [
            [142.8030, 41.8692, -133.7754],
            [132.4461, 44.5442, -165.5156],
            [148.1377, 87.1125, -115.6404],
            [150.7983, 82.1297, -182.7888],
        ],
    ),
    (
        15.0,
        [
            [139.0631, 40.1044, -134.1332],
            [131.1907, 44.3186, -165.6963],
            [146.9833, 83.1235, -115.6043],
            [148.4163, 81.5350, -180.9510],
        ],
    ),
    (
        22.5,
        [
            [140.4190, 40.7591, -134.5249],
            [135.1236, 44.8479, -165.8536],
            [150.1208, 83.5770, -113.5857],
            [149.4342, 85.3222, -181.1202],
        ],
    ),
];

#[test]
fn joints_bend_the_right_way() {
    for (frame, joints) in JOINTS {
        let spheres = spheres(frame);
        for (expected, limb) in joints.into_iter().zip(spheres[16..].chunks(17)) {
            assert_near(limb[8], DVec3::from(expected), 5.0);
        }
    }
}

/// Known positions that test the closed forms: the top of the high arc, throw and catch, the top of
/// the low arc.
#[test]
fn ball_positions_match_closed_forms() {
    let at = |frame: f64| -> Vec<DVec3> { spheres(frame)[..3].iter().map(|ball| ball.0).collect() };
    let near = |a: DVec3, b: [f64; 3]| assert!((a - DVec3::from(b)).length() < NEAR, "{a} is not at {b:?}");
    for (frame, balls) in [
        (0.0, [[110.0, 184.0, -145.0], [110.0, 88.0, -108.0], [110.0, 88.0, -182.0]]),
        (7.5, [[110.0, 178.0, -154.25], [110.0, 130.0, -117.25], [110.0, 106.0, -163.5]]),
        (15.0, [[110.0, 160.0, -163.5], [110.0, 160.0, -126.5], [110.0, 112.0, -145.0]]),
        (22.5, [[110.0, 130.0, -172.75], [110.0, 178.0, -135.75], [110.0, 106.0, -126.5]]),
    ] {
        at(frame).into_iter().zip(balls).for_each(|(ball, expected)| near(ball, expected));
    }
}

/// After 30 frames each ball is in the position of another, and all else is in its own.
#[test]
fn the_animation_repeats_without_a_seam() {
    let (first, last) = (spheres(0.0), spheres(30.0));
    for (ball, successor) in [(0, 2), (1, 0), (2, 1)] {
        assert_near(last[ball], first[successor].0, 14.0);
    }
    for (end, start) in last[3..].iter().zip(&first[3..]) {
        assert_near(*end, start.0, start.1);
    }
}

/// Values halfway through each frame: y and z of balls C, B and A, height of the hips, y and z of
/// the trunk's direction, x and y of the hands, to the digits given.
const FRAMES: [[f64; 11]; 30] = [
    [89.573, -180.767, 91.173, -108.617, 183.973, -145.617, 84.9890, 0.99998, -0.00597, 107.5277, 74.0219],
    [92.560, -178.300, 97.360, -109.850, 183.760, -146.850, 84.9021, 0.99984, -0.01766, 107.6333, 73.7284],
    [95.333, -175.833, 103.333, -111.083, 183.333, -148.083, 84.7321, 0.99959, -0.02856, 107.8333, 73.1520],
    [97.893, -173.367, 109.093, -112.317, 182.693, -149.317, 84.4863, 0.99927, -0.03821, 108.1071, 72.3140],
    [100.240, -170.900, 114.640, -113.550, 181.840, -150.550, 84.1756, 0.99893, -0.04618, 108.4274, 71.2463],
    [102.373, -168.433, 119.973, -114.783, 180.773, -151.783, 83.8135, 0.99864, -0.05213, 108.7639, 69.9917],
    [104.293, -165.967, 125.093, -116.017, 179.493, -153.017, 83.4158, 0.99844, -0.05581, 109.0874, 68.6024],
    [106.000, -163.500, 130.000, -117.250, 178.000, -154.250, 83.0000, 0.99837, -0.05705, 109.3738, 67.1384],
    [107.493, -161.033, 134.693, -118.483, 176.293, -155.483, 82.5842, 0.99844, -0.05581, 109.6067, 65.6651],
    [108.773, -158.567, 139.173, -119.717, 174.373, -156.717, 82.1865, 0.99864, -0.05213, 109.7792, 64.2490],
    [109.840, -156.100, 143.440, -120.950, 172.240, -157.950, 81.8244, 0.99893, -0.04618, 109.8934, 62.9551],
    [110.693, -153.633, 147.493, -122.183, 169.893, -159.183, 81.5137, 0.99927, -0.03821, 109.9586, 61.8423],
    [111.333, -151.167, 151.333, -123.417, 167.333, -160.417, 81.2679, 0.99959, -0.02856, 109.9887, 60.9612],
    [111.760, -148.700, 154.960, -124.650, 164.560, -161.650, 81.0979, 0.99984, -0.01766, 109.9985, 60.3512],
    [111.973, -146.233, 158.373, -125.883, 161.573, -162.883, 81.0110, 0.99998, -0.00597, 110.0000, 60.0393],
    [111.973, -143.767, 161.573, -127.117, 158.373, -164.117, 81.0110, 0.99998, 0.00597, 110.0000, 60.0393],
    [111.760, -141.300, 164.560, -128.350, 154.960, -165.350, 81.0979, 0.99984, 0.01766, 109.9985, 60.3512],
    [111.333, -138.833, 167.333, -129.583, 151.333, -166.583, 81.2679, 0.99959, 0.02856, 109.9887, 60.9612],
    [110.693, -136.367, 169.893, -130.817, 147.493, -167.817, 81.5137, 0.99927, 0.03821, 109.9586, 61.8423],
    [109.840, -133.900, 172.240, -132.050, 143.440, -169.050, 81.8244, 0.99893, 0.04618, 109.8934, 62.9551],
    [108.773, -131.433, 174.373, -133.283, 139.173, -170.283, 82.1865, 0.99864, 0.05213, 109.7792, 64.2490],
    [107.493, -128.967, 176.293, -134.517, 134.693, -171.517, 82.5842, 0.99844, 0.05581, 109.6067, 65.6651],
    [106.000, -126.500, 178.000, -135.750, 130.000, -172.750, 83.0000, 0.99837, 0.05705, 109.3738, 67.1384],
    [104.293, -124.033, 179.493, -136.983, 125.093, -173.983, 83.4158, 0.99844, 0.05581, 109.0874, 68.6024],
    [102.373, -121.567, 180.773, -138.217, 119.973, -175.217, 83.8135, 0.99864, 0.05213, 108.7639, 69.9917],
    [100.240, -119.100, 181.840, -139.450, 114.640, -176.450, 84.1756, 0.99893, 0.04618, 108.4274, 71.2463],
    [97.893, -116.633, 182.693, -140.683, 109.093, -177.683, 84.4863, 0.99927, 0.03821, 108.1071, 72.3140],
    [95.333, -114.167, 183.333, -141.917, 103.333, -178.917, 84.7321, 0.99959, 0.02856, 107.8333, 73.1520],
    [92.560, -111.700, 183.760, -143.150, 97.360, -180.150, 84.9021, 0.99984, 0.01766, 107.6333, 73.7284],
    [89.573, -109.233, 183.973, -144.383, 91.173, -181.383, 84.9890, 0.99998, 0.00597, 107.5277, 74.0219],
];

#[test]
fn all_thirty_frames_match_the_reference_table() {
    const DIGITS: [i32; 11] = [3, 3, 3, 3, 3, 3, 4, 5, 5, 4, 4];
    for (frame, expected) in (0..30).zip(FRAMES) {
        let spheres = spheres(f64::from(frame) + 0.5);
        let [ball_a, ball_b, ball_c, hips, neck] = [0, 1, 2, 3, 11].map(|number: usize| spheres[number].0);
        let (left, right) = (spheres[16 + 2 * 17].0, spheres[16 + 3 * 17].0);
        let up = (neck - hips) / 55.0;
        assert!([ball_a, ball_b, ball_c].iter().all(|ball| ball.x == 110.0) && left.truncate() == right.truncate());
        let places = [ball_c.y, ball_c.z, ball_b.y, ball_b.z, ball_a.y, ball_a.z, hips.y, up.y, up.z, left.x, left.y];
        for ((place, expected), digits) in places.into_iter().zip(expected).zip(DIGITS) {
            // Half a unit of the last digit, plus the error of single precision.
            let tolerance = 0.5 * 10_f64.powi(-digits) + 1.2e-5;
            assert!((place - expected).abs() <= tolerance, "frame {frame}: {place} for {expected}");
        }
    }
}
