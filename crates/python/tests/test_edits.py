"""Edits of arrays of a renderer."""

import unittest

import juggler as jg
from juggler import Instances, Object, Scene, cameras, materials, shapes, textures
from support import needs_numpy, numpy as np

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]
HEAT = (0.25, 0.5, 0.75, 1)


@needs_numpy
class Arrays(unittest.TestCase):
    def scene(self, scale=1, heat=HEAT, places=1, level=0.5, **fields):
        corners, faces = np.array(CORNERS, "f4"), np.array(FACES)
        mesh = shapes.Mesh(positions=corners * scale, triangles=faces, attributes={"heat": np.array(heat)})
        many = Instances(positions=corners * places, scales=np.full(4, 0.25))
        return Scene(
            textures={"photo": textures.Image(array=np.full((2, 2, 3), level), color_space="linear")},
            materials={"warm": materials.Diffuse(reflectance=textures.Attribute("heat"))},
            background="#c0c0c0",
            camera=cameras.Perspective(eye=(0.5, 0.5, 4), look_at=(0.5, 0.5, 0), vertical_fov_degrees=40),
            objects=[
                Object(mesh.replace(**fields), material="warm"),
                Object(shapes.Sphere(), instances=many, material={"diffuse": {"reflectance": "photo"}}),
            ],
        )

    def hash(self, scene):
        return jg.render(scene, size=(16, 16), samples=1).hash

    def edited(self, path, value, scene=None):
        renderer = jg.Renderer(self.scene() if scene is None else scene, size=(16, 16), samples=1)
        renderer.render()
        renderer[path] = value
        return renderer.render().hash

    def test_arrays_of_parts_are_set(self):
        corners = np.array(CORNERS, "f4")
        normals = np.array([(0, 0.1, 1), (0.2, 0, 1), (0, 0, 1), (0, -0.1, 1)], "f4")
        heat = np.array(HEAT) / 2
        texels = np.full((2, 2, 3), 0.75)
        for path, value, expected in (
            ("objects[0].shape.mesh.positions", corners * 0.5, self.scene(scale=0.5)),
            ("objects[0].shape.mesh.positions", (corners * 0.5).tolist(), self.scene(scale=0.5)),
            ("/objects/0/shape/mesh/positions", corners * 0.5, self.scene(scale=0.5)),
            ("objects[0].shape.mesh.normals", normals, self.scene(normals=normals)),
            ("objects[0].shape.mesh.attributes", {"heat": heat}, self.scene(heat=heat)),
            ("objects[0].shape.mesh.attributes.heat", heat, self.scene(heat=heat)),
            ('objects[0].shape.mesh.attributes["heat"]', heat, self.scene(heat=heat)),
            ("objects[1].instances.positions", corners * 0.5, self.scene(places=0.5)),
            ("textures.photo.image.array", texels, self.scene(level=0.75)),
        ):
            with self.subTest(path):
                self.assertEqual(self.edited(path, value), self.hash(expected))
                self.assertNotEqual(self.hash(expected), self.hash(self.scene()))

    def test_arrays_are_removed(self):
        normals = np.array([(0, 0.1, 1), (0.2, 0, 1), (0, 0, 1), (0, -0.1, 1)], "f4")
        renderer = jg.Renderer(self.scene(normals=normals), size=(16, 16), samples=1)
        del renderer["objects[0].shape.mesh.normals"]
        self.assertEqual(renderer.render().hash, self.hash(self.scene()))

    def test_mistakes_are_named(self):
        with self.assertRaisesRegex(jg.SceneError, r"objects\[0\].shape.mesh.* each of the 2 positions"):
            self.edited("objects[0].shape.mesh.positions", np.array(CORNERS[:2]))
        with self.assertRaisesRegex(jg.SceneError, r"shape \(n, 3\)"):
            self.edited("objects[0].shape.mesh.positions", np.zeros((4, 2)))


class Kinds(unittest.TestCase):
    def setUp(self):
        material = materials.Diffuse(reflectance=0.5)
        self.scene = Scene(
            materials={"diffuse": material}, objects=[Object(shapes.Sphere(), material="diffuse")]
        )
        self.renderer = jg.Renderer(self.scene, size=(8, 8), samples=1)

    def test_parts_are_set_at_the_path_of_their_kind(self):
        self.renderer["objects[0].shape.sphere"] = shapes.Sphere(radius=0.5)
        self.assertEqual(self.renderer["objects[0].shape"], {"sphere": {"radius": 0.5}})
        if np:
            self.renderer["objects[0].shape"] = mesh = shapes.Mesh(
                positions=np.array(CORNERS), triangles=FACES
            )
            before = self.renderer.render().hash
            self.renderer["objects[0].shape.mesh"] = mesh.replace(positions=np.array(CORNERS) * (3, 1, 1))
            self.assertNotEqual(self.renderer.render().hash, before)
            self.renderer["objects[0].shape.mesh"] = mesh
            self.assertEqual(self.renderer.render().hash, before)

    def test_names_may_be_those_of_kinds(self):
        self.renderer["materials.diffuse"] = materials.Diffuse(reflectance=0.25)
        self.assertEqual(self.renderer["materials.diffuse.diffuse.reflectance"], [0.25] * 3)


if __name__ == "__main__":
    unittest.main()
