//! Memory of many equal objects, such as the points of a cloud, and the attributes of each.

use super::*;
use crate::instance_attributes::ObjectAttributes;
use juggler_math::Motion;

/// Objects of one shape, turned alike, as `instances` of a scene place them: successive motions share
/// their linear part.
fn points(shape: &Arc<AnyShape>, count: usize, random: &mut Random) -> Vec<Object> {
    let turn = random.rotation();
    let mut objects: Vec<Object> = Vec::new();
    for _ in 0..count {
        let motion = Motion::from(turn.with_translation(random.point(20.0)));
        let motion = objects.last().map_or(motion.clone(), |previous| motion.sharing(&previous.motion));
        let content = Content::Shape(Arc::clone(shape));
        objects.push(Object { content, motion, material: Some(MaterialId(0)), attributes: None });
    }
    objects
}

fn prepared(shape: impl Into<AnyShape>) -> Arc<AnyShape> {
    let mut shape = shape.into();
    shape.prepare().unwrap();
    Arc::new(shape)
}

/// The built world holds a point in 80 bytes beside the hierarchy, and its share of the hierarchy in at
/// most as many, even if no boxes overlap.
#[test]
fn points_take_eighty_bytes_each() {
    let count = 20_000;
    let mut random = Random::new(25);
    for shape in
        [prepared(Sphere { radius: 0.01 }), prepared(juggler_shape::Disk { radius: 0.01, ..Default::default() })]
    {
        let mut objects = points(&shape, count, &mut random);
        let list = Arc::new(AttributeList::default());
        for (index, object) in (0..).zip(&mut objects) {
            object.attributes = Some(InstanceAttributes { list: Arc::clone(&list), index });
        }
        let stats = world_of(objects).geometry_stats();
        let each = [stats.geometry_bytes, stats.bvh_bytes].map(|bytes| bytes as f32 / count as f32);
        assert!(each[0] < 80.1 && each[1] < 80.0, "{each:?} bytes each");
    }
}

/// What objects do not share is counted, too.
#[test]
fn turned_objects_have_transforms_of_their_own() {
    let mut random = Random::new(26);
    let count = 1000;
    let sphere = |_| Object::new(Sphere { radius: 1.0 }.into(), random.rotation(), MaterialId(0));
    let bytes = world_of((0..count).map(sphere).collect()).geometry_stats().geometry_bytes;
    assert!(bytes > count * (size_of::<Transform>() + size_of::<AnyShape>()), "{bytes}");
}

#[test]
fn attributes_of_all_objects_are_found() {
    let mut random = Random::new(27);
    let mut objects = points(&prepared(Sphere { radius: 1.0 }), 500, &mut random);
    let lists = [Arc::new(AttributeList::default()), Arc::new(AttributeList::default())];
    let mut index = 0;
    for object in &mut objects {
        // Runs begin and end by chance, and the instances jump.
        index += if random.below(8) == 0 { 3 } else { 1 };
        let chosen = &lists[usize::from(index / 40 % 2 == 0)];
        let attributes = InstanceAttributes { list: Arc::clone(chosen), index };
        object.attributes = (random.below(10) > 0).then_some(attributes);
    }
    let found = ObjectAttributes::new(&objects);
    for (index, object) in (0..).zip(&objects) {
        let (found, expected) = (found.of_object(index), &object.attributes);
        let key = |attributes: &InstanceAttributes| (Arc::as_ptr(&attributes.list), attributes.index);
        assert_eq!(found.as_ref().map(key), expected.as_ref().map(key), "{index}");
    }
    assert!(found.of_object(500).is_none() && ObjectAttributes::new(&[]).of_object(0).is_none());
}
