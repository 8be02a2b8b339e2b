"""Arrays as meshes, pictures and instances."""

import os
import pickle
import unittest

import juggler as jg
from juggler import Instances, Morph, Object, Scene, backgrounds, cameras, materials, shapes, textures
from support import Folder, needs_numpy, numpy as np

CORNERS = [(-1, -1, 0), (1, -1, 0.25), (1, 1, 0), (-1, 1, 0.25)]
TRIANGLES = [(0, 1, 2), (0, 2, 3)]


def shown(mesh, material=None, **sections):
    """A scene that shows a mesh from the front."""
    return Scene(
        render=jg.RenderSettings(size=(24, 16), samples=4),
        camera=cameras.Perspective(eye=(0, 0, 4), vertical_fov_degrees=40),
        background="#c0c0c0",
        objects=[Object(mesh, material=material)],
        **sections,
    )


def color_of(name, **fields):
    return materials.Diffuse(reflectance=textures.Attribute(name, **fields))


@needs_numpy
class Meshes(Folder):
    def setUp(self):
        super().setUp()
        self.positions = np.array(CORNERS, dtype="f4")
        self.triangles = np.array(TRIANGLES, dtype="u4")
        self.normals = np.array([(0, 0.125, 1), (0.25, 0, 1), (0, -0.5, 1), (0.125, 0.125, 1)], dtype="f4")

    def hash(self, mesh, **sections):
        return jg.render(shown(mesh, **sections)).hash

    def mesh(self, **fields):
        return shapes.Mesh(**{"positions": self.positions, "triangles": self.triangles, **fields})

    def test_arrays_give_the_picture_of_lists(self):
        lists = self.hash(shapes.Mesh(positions=CORNERS, triangles=TRIANGLES, normals=self.normals.tolist()))
        self.assertEqual(self.hash(self.mesh(normals=self.normals)), lists)
        self.assertNotEqual(self.hash(self.mesh()), lists)
        self.assertEqual(self.hash(self.mesh().replace(normals=self.normals.tolist())), lists)
        scene = shown(self.mesh(normals=self.normals))
        self.assertEqual(jg.render(scene.to_dict()).hash, lists)
        self.assertEqual(jg.Renderer(scene).to_dict()["objects"], scene.to_dict()["objects"])

    def test_every_layout_and_type_of_numbers_is_read(self):
        expected = self.hash(self.mesh())
        wide = np.zeros((4, 6), "f8")
        wide[:, ::2] = self.positions
        forms = {
            "big-endian": self.positions.astype(">f4"),
            "double": self.positions.astype("f8"),
            "half": self.positions.astype("f2"),
            "columns first": np.asfortranarray(self.positions),
            "strided": wide[:, ::2],
            "reversed": self.positions[::-1].copy()[::-1],
            "read-only": np.frombuffer(self.positions.tobytes(), "f4").reshape(4, 3),
            "tuples": CORNERS,
        }
        for name, positions in forms.items():
            with self.subTest(name):
                self.assertEqual(self.hash(self.mesh(positions=positions)), expected)
        for kind in (">u4", "i8", "u8", "i4", "u1", ">i2"):
            with self.subTest(kind):
                self.assertEqual(self.hash(self.mesh(triangles=self.triangles.astype(kind))), expected)

    def test_attributes_of_vertices_and_faces(self):
        color = np.array([(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)], "u1")
        by_vertex = jg.render(shown(self.mesh(attributes={"color": color}), color_of("color")))
        as_floats = jg.render(shown(self.mesh(attributes={"color": color / 255.0}), color_of("color")))
        self.assertEqual(by_vertex.hash, as_floats.hash)
        faces = {"part": jg.PerFace(np.array([0.2, 0.9]))}
        by_face = jg.render(
            shown(self.mesh(attributes=faces), color_of("part")), integrator="albedo", samples=1
        )
        self.assertEqual({round(float(x), 3) for x in np.unique(by_face.color)} - {0.0}, {0.2, 0.9})
        lists = {"part": {"domain": "face", "channels": 1, "data": {"f32": [0.2, 0.9]}}}
        known = jg.render(
            shown(self.mesh(attributes=lists), color_of("part")), integrator="albedo", samples=1
        )
        self.assertEqual(known.hash, by_face.hash)
        plain = shapes.Mesh(
            positions=CORNERS, triangles=TRIANGLES, attributes={"part": jg.PerFace([0.2, 0.9])}
        )
        self.assertEqual(
            jg.render(shown(plain, color_of("part")), integrator="albedo", samples=1).hash, by_face.hash
        )

    def test_a_renderer_has_its_own_copy(self):
        scene = shown(self.mesh())
        renderer = jg.Renderer(scene)
        before = renderer.render().hash
        self.positions[0, 0] = -3
        self.assertEqual(renderer.render().hash, before)
        self.assertNotEqual(jg.render(scene).hash, before)

    def test_edits_take_arrays(self):
        renderer = jg.Renderer(shown(self.mesh()))
        renderer.render()
        moved = self.positions + np.array([0.3, 0, 0], "f4")
        renderer["objects[0].shape"] = self.mesh(positions=moved)
        self.assertEqual(renderer.render().hash, self.hash(self.mesh(positions=moved)))
        self.assertIn("geometry", renderer.changed)

    def test_arrays_in_dicts_are_assets(self):
        from juggler._scene import to_json

        color = np.array([(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)], "u1")
        members = {"positions": self.positions, "triangles": self.triangles, "attributes": {"color": color}}
        material = color_of("color").to_dict()
        typed = shown(self.mesh(attributes={"color": color}), color_of("color"))
        in_typed = shown({"mesh": members}, material)
        plain = {**shown("sphere").to_dict(), "objects": [{"shape": {"mesh": members}, "material": material}]}
        part = {"mesh": {**members, "attributes": {"color": color, "part": jg.PerFace(np.array([0.2, 0.9]))}}}
        for scene in (in_typed, plain, shown(part, material), {"version": 1, **plain}):
            self.assertEqual(jg.render(scene).hash, jg.render(typed).hash)
            self.assertEqual(len(to_json(scene)[1]), 1)
        renderer = jg.Renderer(shown("sphere"))
        renderer["objects[0]"] = {"shape": {"mesh": members}, "material": material}
        self.assertEqual(renderer.render().hash, jg.render(typed).hash)
        with self.assertRaisesRegex(jg.SceneError, "did you mean `triangles`"):
            jg.render(shown({"mesh": {"positions": self.positions, "triangle": self.triangles}}))

    def test_morph_targets_are_arrays(self):
        target = self.positions + np.array([0, 0.5, 0.5], "f4")
        lists = shapes.Mesh(
            positions=CORNERS, triangles=TRIANGLES, morphs=[Morph(positions=target.tolist(), weight=0.5)]
        )
        expected = self.hash(lists)
        for morph in (Morph(positions=target, weight=0.5), Morph(positions=target.tolist(), weight=0.5)):
            self.assertEqual(self.hash(self.mesh(morphs=[morph])), expected)
        self.assertNotEqual(self.hash(self.mesh()), expected)

    def test_large_lists_become_arrays(self):
        from juggler._scene import to_json

        count = 1500
        positions = [(i, 0, 0) for i in range(count)]
        triangles = [(i, i + 1, 0) for i in range(count - 1)]
        text, assets = to_json(shown(shapes.Mesh(positions=positions, triangles=triangles)))
        self.assertEqual(len(assets), 1)
        self.assertLess(len(text), 1000)
        positions[3] = ("=1 + 2", 0, 0)
        text, assets = to_json(shown(shapes.Mesh(positions=positions, triangles=triangles)))
        self.assertEqual(assets, [])
        self.assertIn("=1 + 2", text)
        self.assertEqual(to_json(shown(shapes.Mesh(positions=CORNERS, triangles=TRIANGLES)))[1], [])

    def test_equal_arrays_are_one_asset(self):
        from juggler._scene import to_json

        mesh = self.mesh()
        same = self.mesh(positions=self.positions.astype("f8"))
        other = self.mesh(positions=self.positions + 1)
        scene = shown(mesh).replace(objects=[Object(one) for one in (mesh, mesh, same, other)])
        text, assets = to_json(scene)
        self.assertEqual(len(assets), 2)
        self.assertEqual(text.count(assets[0][0]), 3)
        self.assertRegex(assets[0][0], r"^mesh-[0-9a-f]{16}\.ply$")

    def test_mistakes_are_named(self):
        nan = self.positions.copy()
        nan[2, 1] = np.nan
        cases = [
            (
                {"positions": self.positions[:, :2]},
                r"`positions` of shapes.Mesh must be an array of shape \(n, 3\); its shape is \(4, 2\)",
            ),
            ({"positions": self.positions.reshape(-1)}, r"its shape is \(12,\)"),
            ({"positions": self.positions.astype("c8")}, "real numbers"),
            ({"positions": np.array([["a", "b", "c"]])}, "real numbers"),
            ({"positions": np.array([[None, 1, 2]])}, "numbers and other values"),
            (
                {"triangles": self.triangles.astype("f4")},
                "`triangles` of shapes.Mesh must be whole numbers, not float32",
            ),
            ({"triangles": self.triangles.astype("i8") - 1}, "not -1"),
            ({"triangles": self.triangles.astype("i8") + 2**32}, "not 4294967299"),
            ({"triangles": self.triangles + 1}, "is 4, but there are only 4 positions"),
            (
                {"positions": np.ma.masked_less(self.positions, 0)},
                "`positions` of shapes.Mesh has masked numbers",
            ),
            ({"positions": nan}, r"positions\[2\]"),
            ({"normals": self.normals[:2]}, "one entry per position"),
            (
                {"attributes": {"a": np.zeros((4, 5))}},
                r"the attribute `a` of shapes.Mesh must be .* its shape is \(4, 5\)",
            ),
            ({"attributes": {"a": np.zeros(3)}}, "`a`"),
            ({"attributes": {"a": {"channels": 7, "data": {"f32": [1]}}}}, "`channels` from 1 to 4"),
            ({"positions": self.positions.astype("f8") * 1e300}, "positions"),
        ]
        for fields, message in cases:
            with self.subTest(message), self.assertRaisesRegex(jg.SceneError, message):
                jg.render(shown(self.mesh(**fields)))

    def test_wrong_numbers_are_those_of_the_mesh(self):
        self.positions[2, 1] = np.nan
        with self.assertRaises(jg.SceneError) as caught:
            self.hash(self.mesh())
        (problem,) = caught.exception.problems
        self.assertEqual(problem.path, "objects[0].shape.mesh")
        self.assertTrue(problem.message.startswith("the mesh is invalid: `positions[2][1]` must be"))
        self.assertEqual(str(caught.exception), f"{problem.path}: {problem.message}")

    def test_empty_arrays(self):
        empty = shapes.Mesh(positions=np.zeros((0, 3)), triangles=np.zeros((0, 3), "i8"))
        plain = shapes.Mesh(positions=[], triangles=[])
        outcomes = []
        for mesh in (empty, plain):
            try:
                outcomes.append(jg.render(shown(mesh)).hash)
            except jg.SceneError:
                outcomes.append("error")
        self.assertEqual(outcomes[0], outcomes[1])

    def test_scenes_and_renderers_are_pickled_with_their_arrays(self):
        scene = shown(
            self.mesh(attributes={"color": self.positions, "part": jg.PerFace(np.array([3, 7], "u2"))}),
            color_of("color"),
        )
        expected = jg.render(scene).hash
        renderer = jg.Renderer(scene)
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            self.assertEqual(jg.render(pickle.loads(pickle.dumps(scene, protocol))).hash, expected)
            again = pickle.loads(pickle.dumps(renderer, protocol))
            self.assertEqual(again.render().hash, expected)
            self.assertEqual(again.fingerprint, renderer.fingerprint)
        buffers = []
        data = pickle.dumps(renderer, 5, buffer_callback=buffers.append)
        self.assertEqual(len(buffers), 4)
        self.assertNotIn(self.positions.tobytes(), data)
        self.assertEqual(pickle.loads(data, buffers=buffers).render().hash, expected)
        writable = [bytearray(buffer) for buffer in buffers]
        self.assertEqual(pickle.loads(data, buffers=writable).render().hash, expected)

    def test_saved_scenes_have_their_arrays_beside(self):
        scene = shown(self.mesh(attributes={"heat": np.arange(4) / 3}), color_of("heat"))
        expected = jg.render(scene).hash
        path = os.path.join(self.folder, "one.json")
        scene.save(path)
        # A second scene in the same folder leaves the files of the first.
        shown(self.mesh(positions=self.positions * 2)).save(os.path.join(self.folder, "two.json"))
        files = [name for name in os.listdir(self.folder) if name.endswith(".ply")]
        self.assertEqual(len(files), 2)
        self.assertEqual(jg.render(path).hash, expected)
        self.assertEqual(jg.render(Scene.load(path)).hash, expected)

    def test_equality(self):
        self.assertEqual(self.mesh(), self.mesh(positions=self.positions.copy()))
        self.assertNotEqual(self.mesh(), self.mesh(positions=self.positions + 1))
        self.assertNotEqual(self.mesh(), self.mesh(positions=self.positions[:3]))
        self.assertEqual(jg.PerFace(self.positions), jg.PerFace(self.positions.copy()))
        self.assertEqual(shown(self.mesh()), shown(self.mesh()))


@needs_numpy
class Pictures(Folder):
    def scene(self, array, **fields):
        wall = textures.Image(array=array, filter="nearest", **fields)
        corners = shapes.Mesh(positions=CORNERS, triangles=TRIANGLES, uvs=[(0, 0), (1, 0), (1, 1), (0, 1)])
        return shown(corners, materials.Diffuse(reflectance=wall))

    def test_types_and_channels(self):
        hashes = set()
        generator = np.random.default_rng(1)
        for kind in ("u1", "u2", "f2", "f4", "f8"):
            for shape in ((3, 4), (3, 4, 1), (3, 4, 2), (3, 4, 3), (3, 4, 4)):
                with self.subTest((kind, shape)):
                    numbers = generator.random(shape)
                    scale = {"u1": 255, "u2": 65535}.get(kind, 1)
                    array = (numbers * scale).astype(kind)
                    scene = self.scene(array)
                    expected = jg.render(scene).hash
                    hashes.add(expected)
                    path = os.path.join(self.folder, "scene.json")
                    scene.save(path)
                    self.assertEqual(jg.render(path).hash, expected)
                    self.assertEqual(jg.render(Scene.load(path)).hash, expected)
                    self.assertEqual(pickle.loads(pickle.dumps(jg.Renderer(scene))).render().hash, expected)
                    swapped = array.astype(array.dtype.newbyteorder(">"))
                    self.assertEqual(jg.render(self.scene(swapped[::-1].copy()[::-1])).hash, expected)
        self.assertEqual(len(hashes), 25)

    def test_rows_start_at_the_top_and_levels_are_srgb(self):
        array = np.array([[(255, 0, 0)], [(0, 0, 188)]], "u1")
        image = jg.render(self.scene(array), integrator="albedo", samples=1)
        np.testing.assert_allclose(image.color[4, 12], (1, 0, 0), atol=1e-6)
        np.testing.assert_allclose(
            image.color[11, 12], (0, 0, ((188 / 255 + 0.055) / 1.055) ** 2.4), atol=1e-3
        )
        linear = jg.render(self.scene(array, color_space="linear"), integrator="albedo", samples=1)
        np.testing.assert_allclose(linear.color[11, 12], (0, 0, 188 / 255), atol=1e-3)

    def test_arrays_in_dicts_are_images(self):
        texels = np.arange(24, dtype="u1").reshape(2, 4, 3) * 10
        shown_by = {}
        for name, texture in (
            ("class", textures.Image(array=texels)),
            ("dict", {"image": {"array": texels}}),
        ):
            scene = shown("sphere", {"diffuse": {"reflectance": "photo"}}, textures={"photo": texture})
            shown_by[name] = jg.render(scene).hash
        self.assertEqual(shown_by["dict"], shown_by["class"])

    def test_an_environment_is_an_array(self):
        sky = np.full((4, 8, 3), (0.1, 0.4, 0.9), "f4")
        scene = shown(shapes.Mesh(positions=CORNERS, triangles=TRIANGLES)).replace(
            background=backgrounds.Environment(array=sky)
        )
        np.testing.assert_allclose(jg.render(scene).color[0, 0], (0.1, 0.4, 0.9), rtol=1e-3)

    def test_mistakes_are_named(self):
        cases = [
            (np.zeros(3), r"shape \(height, width\)"),
            (np.zeros((2, 2, 5)), r"its shape is \(2, 2, 5\)"),
            (np.zeros((2, 2), "i8"), "not int64"),
            (np.zeros((2, 2), bool), "not bool"),
            (np.zeros((0, 2), "u1"), "each side must be 1 to"),
        ]
        for array, message in cases:
            with self.subTest(message), self.assertRaisesRegex(jg.SceneError, message):
                jg.render(self.scene(array))
        with self.assertRaisesRegex(TypeError, "`Scene.save` writes it as a file"):
            jg.Renderer(self.scene(np.zeros((2, 2), "u1"))).to_dict()


@needs_numpy
class ManyInstances(Folder):
    POSITIONS = ((-1, 0, 0), (1, 0, 0), (0, 1, 0))
    SCALES = (0.25, 0.5, 0.125)

    def scene(self, material=None, **fields):
        made = Object(shapes.Sphere(), instances=Instances(**fields), material=material)
        return shown(shapes.Sphere()).replace(objects=[made])

    def hash(self, **fields):
        return jg.render(self.scene(**fields)).hash

    def test_arrays_are_those_of_lists(self):
        positions, scales = np.array(self.POSITIONS, "f8"), np.array(self.SCALES)
        expected = self.hash(positions=list(self.POSITIONS), scales=list(self.SCALES))
        self.assertEqual(self.hash(positions=positions, scales=scales), expected)
        self.assertEqual(self.hash(positions=positions.astype(">f4"), scales=list(self.SCALES)), expected)
        self.assertEqual(
            self.hash(positions=positions, scales=np.repeat(scales[:, None], 3, axis=1)), expected
        )
        self.assertEqual(self.hash(positions=positions, scales=[0.25, (0.5, 0.5, 0.5), 0.125]), expected)
        turned = np.array([(0, 0, 0, 1)] * 3)
        self.assertEqual(self.hash(positions=positions, scales=scales, rotations=turned), expected)

    def test_matrices_have_three_or_four_rows(self):
        matrices = np.zeros((3, 4, 4))
        matrices[:, 3, 3] = 1
        for matrix, position, scale in zip(matrices, self.POSITIONS, self.SCALES, strict=True):
            matrix[:3, :3] = np.eye(3) * scale
            matrix[:3, 3] = position
        expected = self.hash(matrices=matrices[:, :3].reshape(3, 12).tolist())
        for form in (matrices, matrices[:, :3], matrices.reshape(3, 16), matrices[:, :3].reshape(3, 12)):
            self.assertEqual(self.hash(matrices=form), expected)
            self.assertEqual(self.hash(matrices=form.tolist()), expected)
        matrices[1, 3, 0] = 0.5
        with self.assertRaisesRegex(jg.SceneError, r"last row of each is \(0, 0, 0, 1\)"):
            self.hash(matrices=matrices)

    def test_attributes_are_those_of_lists(self):
        heat = np.array([0.25, 0.5, 0.75])
        arrays = {"positions": np.array(self.POSITIONS), "scales": np.array(self.SCALES)}
        lists = {"heat": {"channels": 1, "data": {"f32": [0.25, 0.5, 0.75]}}}
        scene = self.scene(color_of("heat", channel="r"), **arrays, attributes={"heat": heat})
        image = jg.render(scene, integrator="albedo", samples=1)
        self.assertEqual(set(np.unique(image.color).tolist()), {0.0, 0.25, 0.5, 0.75})
        for attributes in (lists, {"heat": [0.25, 0.5, 0.75]}, {"heat": heat.reshape(3, 1)}):
            other = self.scene(color_of("heat", channel="r"), **arrays, attributes=attributes)
            self.assertEqual(jg.render(other, integrator="albedo", samples=1).hash, image.hash)
        plain = self.scene(
            color_of("heat", channel="r"),
            positions=list(self.POSITIONS),
            scales=list(self.SCALES),
            attributes={"heat": [0.25, 0.5, 0.75]},
        )
        self.assertEqual(jg.render(plain.to_dict(), integrator="albedo", samples=1).hash, image.hash)
        instances = jg.Renderer(scene).to_dict()["objects"][0]["instances"]
        self.assertEqual(instances, plain.to_dict()["objects"][0]["instances"])

    def test_they_are_saved_and_pickled(self):
        for fields in (
            {"positions": np.array(self.POSITIONS), "scales": np.array(self.SCALES)},
            {"positions": np.array(self.POSITIONS), "scales": np.array([(0.25, 0.5, 0.25)] * 3)},
            {"matrices": np.array([[(0.5, 0, 0, 1), (0, 0.25, 0, 0), (0, 0, 0.5, 0)]])},
            {"positions": np.array(self.POSITIONS), "colors": np.eye(3, 4), "end_colors": np.ones((3, 4))},
            {"positions": np.array(self.POSITIONS), "attributes": {"color": np.eye(3, dtype="u1") * 255}},
        ):
            with self.subTest(tuple(fields)):
                scene = self.scene(color_of("color"), **fields)
                expected = jg.render(scene).hash
                path = os.path.join(self.folder, "scene.json")
                scene.save(path)
                self.assertEqual(jg.render(path).hash, expected)
                self.assertEqual(jg.render(Scene.load(path)).hash, expected)
                self.assertEqual(pickle.loads(pickle.dumps(jg.Renderer(scene))).render().hash, expected)
                self.assertEqual(jg.render(pickle.loads(pickle.dumps(scene))).hash, expected)
        self.assertTrue(any(name.startswith("instances-") for name in os.listdir(self.folder)))

    def test_mistakes_are_named(self):
        positions = np.array(self.POSITIONS, "f4")
        cases = [
            ({"positions": positions[:, :2]}, r"`positions` of Instances must be an array of shape \(n, 3\)"),
            (
                {"positions": positions, "scales": np.zeros((3, 2))},
                r"`scales` of Instances .* \(n,\) or \(n, 3\)",
            ),
            ({"positions": positions, "scales": np.ones(2)}, "scales"),
            ({"positions": positions, "scales": np.zeros(3)}, "scale"),
            ({"positions": positions, "rotations": np.zeros((3, 3))}, r"shape \(n, 4\)"),
            (
                {"matrices": np.zeros((3, 2, 4))},
                r"shape \(n, 3, 4\) or \(n, 4, 4\); its shape is \(3, 2, 4\)",
            ),
            ({"positions": positions, "attributes": {"a": jg.PerFace([1, 2, 3])}}, "instances have no faces"),
            ({"positions": positions, "attributes": {"a": np.ones(2)}}, "`a`"),
        ]
        for fields, message in cases:
            with self.subTest(message), self.assertRaisesRegex(jg.SceneError, message):
                self.hash(**fields)


@unittest.skipIf(np, "NumPy is installed")
class WithoutNumpy(unittest.TestCase):
    def test_lists_need_no_numpy(self):
        self.assertTrue(jg.render(shown(shapes.Mesh(positions=CORNERS, triangles=TRIANGLES))).hash)


if __name__ == "__main__":
    unittest.main()
