"""Values of other libraries, and of wrong types, in every place of the package."""

import math
import unittest
from collections import UserDict
from decimal import Decimal
from fractions import Fraction
from types import MappingProxyType

import juggler as jg
from juggler import Instances, Object, Scene, materials, sci, shapes, textures
from support import needs_numpy, numpy as np

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]


def hash_of(*objects):
    """Hash of a small picture of objects."""
    return jg.render(Scene(objects=list(objects)), size=(8, 8), samples=1).hash


@needs_numpy
class Colors(unittest.TestCase):
    def test_colors_are_arrays_beside_color_maps(self):
        color = (0.8, 0.2, 0.1)
        for kind, field in (
            (materials.Diffuse, "reflectance"),
            (materials.Unlit, "color"),
            (materials.Principled, "base_color"),
        ):
            shown = [
                hash_of(Object(shapes.Sphere(), material=kind(**{field: one})))
                for one in (color, np.array(color))
            ]
            self.assertEqual(*shown)
        for field, values in (("color", None), ("nan", [0, 1, float("nan"), 1])):
            shown = [
                hash_of(sci.surface(CORNERS, FACES, values=values, **{field: one}))
                for one in (color, np.array(color))
            ]
            self.assertEqual(*shown)

    def test_directions_of_cameras_are_arrays(self):
        box = np.array([(0, 0, 0), (1, 2, 3)])
        self.assertEqual(sci.camera(box, view=np.array([1, 2, 3])), sci.camera(box.tolist(), view=(1, 2, 3)))
        with self.assertRaisesRegex(jg.SceneError, "`up` is"):
            sci.camera(box, up=np.array([0, 1, 0]))


class Table:
    """Array of two dimensions that behaves as a `DataFrame` of pandas."""

    def __init__(self, rows):
        self.rows = np.asarray(rows)

    def __array__(self, dtype=None, copy=None):
        return np.array(self.rows, dtype)

    def __eq__(self, other):
        return Table(self.rows == np.asarray(other))

    def all(self):
        return Table(self.rows.all(axis=0))

    def __bool__(self):
        raise ValueError("the truth value of a Table is ambiguous")

    def __iter__(self):
        return iter(self.keys())

    def __len__(self):
        return len(self.rows)

    def __getitem__(self, key):
        return Column(self.rows[:, key])

    def keys(self):
        return range(self.rows.shape[1])

    def to_json(self, path=None):
        raise ValueError("invalid file path")

    shape = property(lambda self: self.rows.shape)
    ndim = property(lambda self: self.rows.ndim)


class Column(Table):
    """Array of one dimension that behaves as a `Series` of pandas."""

    def keys(self):
        return range(len(self.rows))

    def tolist(self):
        return self.rows.tolist()


@needs_numpy
class Tables(unittest.TestCase):
    def mesh(self, kind, heat=(0, 1, 2, 3)):
        return shapes.Mesh(positions=kind(CORNERS), triangles=kind(FACES), attributes={"heat": kind(heat)})

    def pandas(self):
        try:
            import pandas
        except ImportError:
            return []
        return [lambda rows: (pandas.DataFrame if np.ndim(rows) == 2 else pandas.Series)(rows)]

    def test_tables_are_arrays(self):
        kinds = [lambda rows: (Table if np.ndim(rows) == 2 else Column)(rows), *self.pandas()]
        expected = self.mesh(np.array)
        for kind in kinds:
            mesh = self.mesh(kind)
            self.assertEqual(hash_of(Object(mesh)), hash_of(Object(expected)))
            self.assertEqual(mesh.to_dict(), expected.to_dict())
            self.assertEqual(mesh, self.mesh(kind))
            self.assertEqual(Object(mesh), Object(expected))
            self.assertNotEqual(mesh, self.mesh(kind, (0, 1, 2, 4)))
            self.assertNotEqual(mesh, mesh.replace(positions=kind(CORNERS[:3])))
            self.assertIn("positions=[[0, 0, 0], ", repr(mesh))
            self.assertEqual(sci.camera(kind([(0, 0, 0), (1, 2, 3)])), sci.camera([(0, 0, 0), (1, 2, 3)]))
            color = Object(shapes.Sphere(), material=materials.Diffuse(reflectance=kind([0.8, 0.2, 0.1])))
            self.assertTrue(hash_of(color))
            with self.assertRaisesRegex(
                jg.SceneError, r"reflectance\[0\]: expected a number, found an array"
            ):
                hash_of(color.replace(material=materials.Diffuse(reflectance=kind([[0.8], [0.2], [0.1]]))))


class Unusual(unittest.TestCase):
    def test_every_kind_of_number_is_read(self):
        numbers = [Decimal("0.5"), Fraction(1, 2)]
        if np:
            numbers += [np.longdouble(0.5), np.float16(0.5), np.array(0.5, "longdouble")]
        expected = hash_of(Object(shapes.Sphere(radius=0.5)))
        for number in numbers:
            for obj in (Object(shapes.Sphere(radius=number)), {"shape": {"sphere": {"radius": number}}}):
                scene = {"version": 1, "objects": [obj]}
                self.assertEqual(jg.render(scene, size=(8, 8), samples=1).hash, expected)
                self.assertEqual(hash_of(obj), expected)

    @needs_numpy
    def test_arrays_of_long_numbers_are_read(self):
        color = np.array([0.5, 0.25, 0.75], "longdouble")
        for obj in (
            Object(shapes.Sphere(), material=materials.Diffuse(reflectance=color)),
            {"shape": "sphere", "material": {"diffuse": {"reflectance": color}}},
        ):
            expected = {"shape": "sphere", "material": {"diffuse": {"reflectance": color.tolist()}}}
            self.assertEqual(hash_of(obj), hash_of(expected))

    def test_every_mapping_is_a_dict(self):
        expected = hash_of({"shape": {"sphere": {"radius": 0.5}}})
        for kind in (MappingProxyType, UserDict):
            obj = kind({"shape": kind({"sphere": kind({"radius": 0.5})})})
            self.assertEqual(hash_of(obj), expected)
            scene = kind({"version": 1, "objects": [obj]})
            self.assertEqual(jg.render(scene, size=(8, 8), samples=1).hash, expected)
            if np:
                mesh = kind(
                    {"positions": np.array(CORNERS), "triangles": FACES, "attributes": kind({"a": [1] * 4})}
                )
                self.assertEqual(
                    hash_of({"shape": kind({"mesh": mesh})}), hash_of(Object(shapes.Mesh(**mesh)))
                )

    def test_scenes_that_contain_themselves_are_refused(self):
        own = Object(shapes.Sphere())
        own.objects = [own]
        cyclic = {"shape": "sphere"}
        cyclic["objects"] = [cyclic]
        deep = Object(shapes.Sphere())
        for _ in range(400):
            deep = Object(objects=[deep])
        for obj in (own, cyclic, deep):
            for scene in (Scene(objects=[obj]), {"version": 1, "objects": [obj]}):
                with self.assertRaisesRegex(
                    jg.SceneError, "contains itself, or its parts are nested too deeply"
                ):
                    jg.render(scene)
        nested = math.inf
        for _ in range(600):
            nested = [nested]
        with self.assertRaisesRegex(
            jg.SceneError, "nested too deeply|must be a finite number|expected a finite"
        ):
            jg.render({"version": 1, "objects": nested})

    def test_other_values_are_refused(self):
        for value in (object(), {1}, b"a", 1j, print):
            message = f"an object of the type {type(value).__name__} cannot be part of a scene"
            for scene in (
                Scene(objects=[Object(shapes.Sphere(radius=value))]),
                {"version": 1, "objects": [{"shape": {"sphere": {"radius": value}}}]},
            ):
                with self.assertRaisesRegex(jg.SceneError, message):
                    jg.render(scene)
        for key in (1, (1, 2)):
            with self.assertRaisesRegex(jg.SceneError, r"`objects` of Scene: the key .* is not a string"):
                jg.render(Scene(objects=[{"shape": {key: {}}}]))


@needs_numpy
class Texels(unittest.TestCase):
    ROWS = ((0.25, 0.5), (0.75, 1.0))

    def hash(self, texture):
        sections = {"objects": [{"shape": "sphere", "material": {"diffuse": {"reflectance": texture}}}]}
        hashes = {
            jg.render(scene, size=(8, 8), samples=1).hash
            for scene in (Scene(**sections), {"version": 1, **sections})
        }
        self.assertEqual(len(hashes), 1)
        return hashes.pop()

    def test_texels_in_dicts_may_be_lists(self):
        rows = list(map(list, self.ROWS))
        expected = self.hash(textures.Image(array=np.array(rows)))
        for array in (rows, np.array(rows)):
            self.assertEqual(self.hash({"image": {"array": array}}), expected)

    def test_mistakes_beside_texels_are_named(self):
        for array in (np.array(self.ROWS), list(map(list, self.ROWS))):
            for texture, message in (
                ({"array": array, "color_space_": "srgb"}, "no `color_space_`; did you mean `color_space`?"),
                (
                    {"array": array, "file": "a.png"},
                    "textures.Image has `file` and `array`; give one of them",
                ),
                ({"array": [[[0] * 5]]}, "`array` of textures.Image must be an array of shape"),
            ):
                with self.subTest(message), self.assertRaises(jg.SceneError) as caught:
                    self.hash({"image": texture})
                self.assertIn(message, str(caught.exception))
        both = textures.Image(array=np.array(self.ROWS), file="a.png")
        with self.assertRaisesRegex(jg.SceneError, "has `file` and `array`"):
            self.hash(both)

    def test_other_parts_may_have_the_name_of_a_part_with_texels(self):
        scene = {"version": 1, "materials": {"image": {"diffuse": {}}}, "textures": {"array": "checker"}}
        scene["objects"] = [{"shape": "sphere", "material": "image"}]
        self.assertTrue(jg.render(scene, size=(8, 8), samples=1).hash)


@needs_numpy
class Missing(unittest.TestCase):
    def test_masked_numbers_are_refused(self):
        radii = np.ma.masked_equal([1.0, 2, 3, 4], 2)
        with self.assertRaisesRegex(jg.SceneError, "`radii` of sci.spheres has masked numbers"):
            sci.spheres(CORNERS, radii)
        with self.assertRaisesRegex(jg.SceneError, "line 0: its radius has masked numbers"):
            sci.tubes(CORNERS, radii)
        color = np.zeros((4, 4, 3))
        for fields in (
            {"color": np.ma.masked_equal(color + (1, 2, 3), 2)},
            {"color": color, "depth": np.ma.masked_equal(np.ones((4, 4)), 1)},
        ):
            name = list(fields)[-1]
            with self.assertRaisesRegex(jg.SettingsError, f"`{name}` has masked numbers") as caught:
                jg.denoise(**fields)
            self.assertEqual(caught.exception.setting, name)
        with self.assertRaisesRegex(jg.SettingsError, "`color` must be an array of real numbers"):
            jg.denoise(color * 1j)

    def test_colors_of_instances_are_finite(self):
        colors = np.ones((4, 4))
        for number in (math.nan, math.inf):
            colors[2, 1] = number
            for name in ("colors", "end_colors"):
                many = Instances(positions=np.array(CORNERS), **{"colors": np.ones((4, 4)), name: colors})
                with self.assertRaisesRegex(
                    jg.SceneError, f"`{name}` of Instances must be finite numbers; it has {number} in row 2"
                ):
                    hash_of(Object(shapes.Sphere(), instances=many))

    def test_texels_without_a_number_give_a_warning(self):
        for kind in ("f2", "f4", "f8"):
            texels = np.ones((4, 6, 3), kind)
            texels[1, 2] = texels[3, 3, 0] = math.nan
            material = materials.Diffuse(reflectance=textures.Image(array=texels))
            with self.assertWarnsRegex(
                jg.SceneWarning, "`array` of textures.Image: 2 pixels are no numbers"
            ) as caught:
                hash_of(Object(shapes.Sphere(), material=material))
            self.assertEqual(caught.filename, __file__)


class NotFinite(unittest.TestCase):
    def test_the_path_of_the_first_number_is_named(self):
        nan, inf = math.nan, math.inf
        ball = Object(shapes.Sphere())
        for obj, path, number in (
            (Object(shapes.Sphere(radius=nan)), "objects[1].shape.sphere.radius", "nan"),
            ({"shape": {"sphere": {"radius": -inf}}}, "objects[1].shape.sphere.radius", "-inf"),
            (ball.translate(0, inf, nan), "objects[1].transform[0].translate[1]", "inf"),
            (ball.replace(material={"my part": nan}), 'objects[1].material["my part"]', "nan"),
            (
                ball.replace(material={"phong": {"diffuse": Decimal("nan")}}),
                "objects[1].material.phong.diffuse",
                "nan",
            ),
        ):
            for scene in (Scene(objects=[ball, obj]), {"version": 1, "objects": [{"shape": "sphere"}, obj]}):
                with self.subTest(path), self.assertRaises(jg.SceneError) as caught:
                    jg.render(scene)
                message = f"expected a finite number, found {number}"
                self.assertEqual(str(caught.exception), f"{path}: {message}")
                self.assertEqual(caught.exception.problems, [jg.Problem(path, message)])

    def test_edits_name_the_path(self):
        renderer = jg.Renderer({"version": 1, "objects": [{"shape": "sphere"}]})
        path = "objects[0].shape.sphere.radius"
        with self.assertRaisesRegex(jg.SceneError, r"^objects\[0\].shape.sphere.radius: expected a finite"):
            renderer[path] = math.nan
        with self.assertRaisesRegex(jg.SceneError, r"eye\[1\]: expected a finite number, found inf"):
            renderer.camera = renderer.camera.replace(eye=(0, math.inf, 0))

    def test_the_line_of_the_code_is_named(self):
        jg.trace_nodes()
        try:
            scene = Scene(objects=[Object(shapes.Sphere(radius=math.nan))])
        finally:
            jg.trace_nodes(False)
        with self.assertRaisesRegex(jg.SceneError, r"found nan; made at .*test_values.py:\d+$"):
            jg.render(scene)

    @needs_numpy
    def test_numbers_of_arrays_are_named(self):
        obj = Object(shapes.Sphere(radius=np.float32("nan")))
        with self.assertRaisesRegex(jg.SceneError, r"objects\[0\].shape.sphere.radius: expected a finite"):
            hash_of(obj)
        color = Object(shapes.Sphere(), material=materials.Diffuse(reflectance=np.array([0, math.nan, 0])))
        with self.assertRaisesRegex(jg.SceneError, r"diffuse.reflectance\[1\]: expected a finite"):
            hash_of(color)


@needs_numpy
class Ranges(unittest.TestCase):
    BASE = (0, 1, 0.25, 0.6)

    def shown(self, values, **options):
        camera = sci.camera(((0, 0, 0), (1, 1, 0)), view="+z", parallel=True, margin=1)
        obj = sci.surface(CORNERS, FACES, values=values, **options)
        scene = Scene(camera=camera, objects=[obj])
        return jg.render(scene, size=(12, 12), samples=1, **sci.flat())

    def test_values_of_any_offset_and_scale_have_their_colors(self):
        base = np.array(self.BASE)
        expected = self.shown(base)
        for values in (base + 1e6, base + 1.7e9, base * 1e300, (2 * base - 1) * 1.7e308, base * 1e-300):
            for clim in (None, (values.min(), values.max())):
                image = self.shown(values, clim=clim)
                np.testing.assert_allclose(image.color, expected.color, atol=1e-5)
                # Color bars have the units of the values.
                self.assertEqual(image._color_maps[0].clim, (values.min(), values.max()))
        spheres = [
            sci.spheres([(0.5, 0.5, 0)] * 4, 0.4, values=values, clim=(values[0], values[1]))
            for values in (base, base + 1.7e9)
        ]
        self.assertEqual(*(jg.render(Scene(objects=[one]), size=(8, 8)).hash for one in spheres))

    def test_values_far_beyond_the_limits_have_the_last_color(self):
        image = self.shown([1e300, 1e39, 1e300, 5], clim=(0, 1)).to_uint8()
        self.assertEqual(image[6, 6].tolist(), [0xFD, 0xE7, 0x25])

    def test_one_value_everywhere_has_the_middle_color(self):
        expected = self.shown([0] * 4).to_uint8()[6, 6].tolist()
        for value in (5, 1.7e9, 1e300, -1.797e308):
            self.assertEqual(self.shown([value] * 4).to_uint8()[6, 6].tolist(), expected)

    def test_ordinary_values_keep_their_units(self):
        obj = sci.surface(CORNERS, FACES, values=self.BASE, clim=(0, 5))
        self.assertEqual(np.asarray(obj.shape.attributes["value"]).tolist(), np.float32(self.BASE).tolist())


if __name__ == "__main__":
    unittest.main()
