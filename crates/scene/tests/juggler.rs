//! The Juggler's poses against the closed forms of "Project Amiga Juggler" (Michael Birken, 2010, step 27) and
//! numbers computed from them by hand.

#![expect(clippy::unwrap_used, reason = "a test")]

use juggler_math::{DVec3, Vec3};
use juggler_scene::Scene;
use juggler_scene::compile::{Assembly, Files, Library};
use juggler_tracer::background::AnyBackground;
use juggler_tracer::shape::AnyShape;
use juggler_tracer::world::Object;
use std::f64::consts::TAU;

const NEAR: f64 = 2e-4;

/// The spheres of a frame in the order of the scene file: centre and radius.
fn spheres(frame: f64) -> Vec<(DVec3, f64)> {
    let scene = Scene::built_in("juggler").unwrap().at_frame(frame).unwrap();
    let library = Library::default();
    let (assembly, findings) = Assembly::of(&scene.description, &[], Files { origin: None, library: &library });
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

/// What the article says about an instant.
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

    /// Ends, plane normals and bones of the limbs in the order of the file: left leg, right leg, left arm, right arm.
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

/// Where two bones meet (step 16 of the article).
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

/// Known places, for the closed forms themselves: the top of the high arc, throw and catch, the low arc's top.
#[test]
fn balls_meet_hands_and_heights() {
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

/// After 30 frames each ball stands where another was, and all else where it was itself.
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
