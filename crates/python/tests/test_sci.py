"""Scientific pictures."""

import math
import pickle
import unittest
import warnings

import juggler as jg
from juggler import Object, Scene, sci, shapes
from support import needs_numpy, numpy as np

try:
    import matplotlib

    matplotlib.use("Agg")
except ImportError:
    matplotlib = None

needs_matplotlib = unittest.skipUnless(matplotlib, "matplotlib is not installed")

# A square of two triangles in the plane z = 0.
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]


def front(obj, size=(20, 20)):
    """Image of an object from +z, by exact colors."""
    camera = sci.camera(((0, 0, 0), (1, 1, 0)), view="+z", parallel=True, margin=1)
    scene = Scene(render=jg.RenderSettings(size=size, samples=1), camera=camera, objects=[obj])
    return jg.render(scene, **sci.flat())


def levels(color):
    """Levels from 0 to 255 of "#rrggbb"."""
    return [int(color[at : at + 2], 16) for at in (1, 3, 5)]


class Maps(unittest.TestCase):
    def test_known_colors(self):
        known = {
            "viridis": ("#440154", "#fde725"),
            "magma": ("#000004", "#fcfdbf"),
            "inferno": ("#000004", "#fcffa4"),
            "plasma": ("#0d0887", "#f0f921"),
            "cividis": ("#00224e", "#fee838"),
            "turbo": ("#30123b", "#7a0403"),
            "coolwarm": ("#3b4cc0", "#b40426"),
            "batlow": ("#011959", "#faccfa"),
            "gray": ("#000000", "#ffffff"),
        }
        self.assertEqual(set(sci.color_maps), set(known))
        for name, (first, last) in known.items():
            colors = sci.ColorMap(cmap=name, clim=(0, 1)).colors()
            self.assertEqual((len(colors), colors[0], colors[-1]), (256, first, last), name)
            self.assertEqual(sci.ColorMap(cmap=f"{name}_r", clim=(0, 1)).colors(), colors[::-1])

    def test_unknown_maps_are_refused(self):
        with self.assertRaisesRegex(jg.SceneError, "no color map `viridsi`"):
            sci.ColorMap(cmap="viridsi", clim=(0, 1)).colors()
        with self.assertRaisesRegex(jg.SceneError, "at least two"):
            sci.ColorMap(cmap=["#000000"], clim=(0, 1)).colors()

    @needs_matplotlib
    def test_maps_of_matplotlib(self):
        for name in ("viridis", "plasma", "inferno", "magma", "cividis", "turbo"):
            own = sci.ColorMap(cmap=name, clim=(0, 1)).colors()
            theirs = sci.ColorMap(cmap=matplotlib.colormaps[name], clim=(0, 1)).colors()
            self.assertEqual(own, theirs, name)
        self.assertEqual(sci.ColorMap(cmap="bone", clim=(0, 1)).colors()[-1], "#ffffff")


@needs_numpy
class Surfaces(unittest.TestCase):
    def test_a_value_has_exactly_its_color(self):
        table = sci.ColorMap(cmap="viridis", clim=(0, 1)).colors()
        for index in (0, 1, 77, 128, 255):
            value = 10 + index / 255 * 5
            obj = sci.surface(CORNERS, FACES, values=np.full(4, value), clim=(10, 15))
            image = front(obj).to_uint8()
            self.assertEqual(image[10, 10].tolist(), levels(table[index]), index)

    def test_values_beyond_the_limits_have_the_last_colors(self):
        for value, color in ((-5, "#440154"), (99, "#fde725")):
            obj = sci.surface(CORNERS, FACES, values=np.full(4, float(value)), clim=(0, 1))
            self.assertEqual(front(obj).to_uint8()[10, 10].tolist(), levels(color))

    def test_values_are_interpolated_before_they_are_colored(self):
        obj = sci.surface(
            CORNERS, FACES, values=[0, 1, 1, 0], cmap=["#000000", "#ff0000", "#000000"], clim=(0, 1)
        )
        row = front(obj).color[10, :, 0]
        self.assertGreater(row[10], 0.85)
        self.assertLess(row[0], 0.1)
        self.assertLess(row[-1], 0.1)

    def test_values_of_faces(self):
        obj = sci.surface(CORNERS, FACES, values=[0.0, 1.0], cmap="gray")
        found = {tuple(pixel) for pixel in front(obj).to_uint8().reshape(-1, 3).tolist()}
        self.assertEqual(found, {(0, 0, 0), (255, 255, 255)})
        # As many faces as vertices: PerFace decides.
        faces = [*FACES, (0, 1, 3), (1, 2, 3)]
        by_vertex = sci.surface(CORNERS, faces, values=[0, 0, 1, 1])
        by_face = sci.surface(CORNERS, faces, values=jg.PerFace([0, 0, 1, 1]))
        self.assertNotIsInstance(by_vertex.shape.attributes["value"], jg.PerFace)
        self.assertIsInstance(by_face.shape.attributes["value"], jg.PerFace)
        squares = sci.surface(CORNERS, [(0, 1, 2, 3)], values=jg.PerFace([0.5]), clim=(0, 1), cmap="gray")
        self.assertEqual(front(squares).to_uint8()[3, 15].tolist(), [128] * 3)
        self.assertEqual(front(squares).to_uint8()[15, 3].tolist(), [128] * 3)

    def test_faces_without_a_value_have_their_color(self):
        for missing in (math.nan, math.inf):
            obj = sci.surface(CORNERS, FACES, values=[0, missing, 0, 0], nan="#ff0000", clim=(0, 1))
            self.assertEqual(len(obj.objects), 2)
            image = front(obj).to_uint8()
            self.assertEqual(image[15, 15].tolist(), [255, 0, 0])
            self.assertEqual(image[5, 5].tolist(), levels("#440154"))
        masked = sci.surface(CORNERS, FACES, values=np.ma.masked_equal([0, 9, 0, 0], 9), nan="#ff0000")
        self.assertEqual(front(masked).to_uint8()[15, 15].tolist(), [255, 0, 0])
        none = sci.surface(CORNERS, FACES, values=[math.nan] * 4, nan="#00ff00")
        self.assertEqual(front(none).to_uint8()[5, 5].tolist(), [0, 255, 0])

    def test_flat_warns_of_objects_without_lighting(self):
        with self.assertWarnsRegex(jg.SceneWarning, "`lit=False`.* use one of the two"):
            front(Object(objects=[sci.surface(CORNERS, FACES, lit=False)]))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            front(sci.surface(CORNERS, FACES))

    def test_one_value_everywhere(self):
        obj = sci.surface(CORNERS, FACES, values=[3, 3, 3, 3])
        self.assertEqual(obj.material.reflectance.clim, (2.5, 3.5))

    def test_mistakes(self):
        cases = [
            (dict(values=[1, 2, 3]), "for each of the 4 vertices or the 2 faces, it has 3"),
            (dict(values=jg.PerFace([1, 2, 3])), "for each of the 2 faces, it has 3"),
            (dict(values=np.zeros((4, 2))), r"shape \(n,\)"),
            (dict(values=["a"] * 4), "numbers"),
            (dict(values=[1, 2, 3, 4], clim=(5, 5)), "the lower first"),
            (dict(values=[1, 2, 3, 4], clim=(0, math.inf)), "finite"),
            (dict(values=[1, 2, 3, 4], cmap="none such"), "no color map"),
        ]
        for options, message in cases:
            with self.subTest(message), self.assertRaisesRegex(jg.SceneError, message):
                sci.surface(CORNERS, FACES, **options)
        with self.assertRaisesRegex(jg.SceneError, "index 4, but there are 4 vertices"):
            sci.surface(CORNERS, [(0, 1, 4)])
        with self.assertRaisesRegex(jg.SceneError, "is empty"):
            sci.surface(CORNERS, np.zeros((0, 3), int))

    def test_objects_are_nodes(self):
        obj = sci.surface(CORNERS, FACES, values=[0, 1, 2, 3])
        self.assertEqual(pickle.loads(pickle.dumps(obj)), obj)
        self.assertEqual(len(obj.to_dict()["material"]["diffuse"]["reflectance"]["ramp"]["stops"]), 256)
        self.assertEqual(Scene(objects=[obj]).check(), [])


@needs_numpy
class Glyphs(unittest.TestCase):
    def test_spheres(self):
        obj = sci.spheres([(0.5, 0.5, 0)], 0.3)
        np.testing.assert_allclose(obj.bounds, [(0.2, 0.2, -0.3), (0.8, 0.8, 0.3)], atol=1e-5)
        sizes = sci.spheres([(0, 0, 0), (3, 0, 0)], [0.5, 1])
        np.testing.assert_allclose(sizes.bounds, [(-0.5, -1, -1), (4, 1, 1)], atol=1e-5)
        for arguments, message in (
            (([(0, 0)],), r"shape \(n, 3\)"),
            (([(0, 0, 0)], [1, 2]), "a number or have 1"),
            ((np.zeros((0, 3)),), "is empty"),
        ):
            with self.assertRaisesRegex(jg.SceneError, message):
                sci.spheres(*arguments)

    def test_values_of_spheres(self):
        table = sci.ColorMap(cmap="magma", clim=(0, 1)).colors()
        centers = [(0.25, 0.25, 0), (0.75, 0.25, 0), (0.25, 0.75, 0), (0.75, 0.75, 0)]
        values = [0, 128 / 255, 1, math.nan]
        for radii in (0.2, [0.2] * 4):
            obj = sci.spheres(centers, radii, values=values, cmap="magma", clim=(0, 1), nan="#00ff00")
            image = front(obj).to_uint8()
            for (x, y, _), color in zip(centers, (table[0], table[128], table[255], "#00ff00"), strict=True):
                self.assertEqual(image[19 - int(20 * y), int(20 * x)].tolist(), levels(color))
        with self.assertRaisesRegex(jg.SceneError, "must have 4 numbers, it has 2"):
            sci.spheres(centers, values=[1, 2])

    def test_values_of_arrows(self):
        starts, vectors = [(0, 0.2, 0), (0, 0.8, 0)], [(0.5, 0, 0), (1, 0, 0)]
        obj = sci.arrows(starts, vectors, values="length", cmap=["#000000", "#ff0000"], clim=(0, 1))
        image = front(obj, (50, 50)).color
        np.testing.assert_allclose(image[40, 10], (0.5, 0, 0), atol=0.01)
        np.testing.assert_allclose(image[10, 10], (1, 0, 0), atol=0.01)

    def test_arrows_point_along_their_vectors(self):
        for vector in ((2, 0, 0), (0, 2, 0), (0, 0, 2), (0, 0, -2), (-2, 0, 0)):
            obj = sci.arrows([(1, 1, 1)], [vector])
            low, high = (np.array(corner) for corner in obj.bounds)
            tip = np.array((1, 1, 1)) + vector
            along = int(np.argmax(np.abs(vector)))
            self.assertAlmostEqual((high if tip[along] > 1 else low)[along], tip[along], places=5)
            self.assertAlmostEqual((low if tip[along] > 1 else high)[along], 1, places=5)
            across = np.delete(high - low, along)
            np.testing.assert_allclose(across, 0.36, atol=0.01)
        none = sci.arrows([(0, 0, 0), (1, 0, 0)], [(0, 0, 0), (1, 0, 0)])
        self.assertEqual(len(none.instances.matrices), 1)
        with self.assertRaisesRegex(jg.SceneError, "other than 0"):
            sci.arrows([(0, 0, 0)], [(0, 0, 0)])
        with self.assertRaisesRegex(jg.SceneError, "as many"):
            sci.arrows([(0, 0, 0)], [(0, 0, 0), (1, 1, 1)])

    def test_arrows_are_closed_and_face_outwards(self):
        from juggler._glyphs import arrow

        mesh = arrow()
        corners = np.asarray(mesh.positions, "f8")[np.asarray(mesh.triangles)]
        volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
        self.assertAlmostEqual(volume, math.pi * (0.03**2 * 0.7 + 0.09**2 * 0.3 / 3), delta=1e-4)

    def test_tubes(self):
        line = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)])
        obj = sci.tubes(line, 0.1, values=[0, 1, 2])
        np.testing.assert_allclose(obj.bounds, [(0, -0.1, -0.1), (2, 0.1, 0.1)], atol=1e-5)
        corners = np.asarray(obj.shape.positions, "f8")[np.asarray(obj.shape.triangles)]
        volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
        self.assertAlmostEqual(volume, 2 * 8 * math.sin(math.pi / 8) * 0.01, delta=1e-4)
        two = sci.tubes([line, line + (0, 1, 0)], [0.1, [0.1, 0.2, 0.1]], values=[[0, 1, 2], [2, 1, 0]])
        np.testing.assert_allclose(two.bounds, [(0, -0.1, -0.2), (2, 1.2, 0.2)], atol=1e-3)
        self.assertEqual(len(sci.tubes(line, 0.1, values=[0, math.nan, 2]).objects), 2)
        repeated = sci.tubes([(0, 0, 0), (0, 0, 0), (0, 0, 1)], 0.1)
        self.assertEqual(len(repeated.shape.positions), 2 * 16 + 2)
        for lines, options, message in (
            ([(0, 0, 0), (0, 0, 0)], {}, "line 0 has no two different points"),
            ([line, line], {"values": [[0, 1, 2]]}, "1 lines; there are 2"),
            (line, {"values": [0, 1]}, "line 0 has 3 points"),
        ):
            with self.assertRaisesRegex(jg.SceneError, message):
                sci.tubes(lines, 0.1, **options)

    def test_a_tube_turns_back_without_a_break(self):
        bent = sci.tubes([(0, 0, 0), (1, 0, 0), (0, 0, 0)], 0.1)
        self.assertTrue(np.isfinite(bent.shape.positions).all())


class Views(unittest.TestCase):
    BOX = ((-1, -2, -3), (1, 2, 3))

    def seen(self, camera, size=(40, 40)):
        """The corners of the box in pixels."""
        scene = {
            "version": 1,
            "camera": camera,
            "render": {"size": size, "samples": 1},
            "objects": [{"shape": "sphere"}],
        }
        matrix = jg.render(scene).camera.world_to_image
        low, high = self.BOX
        corners = np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] + [1] for i in range(8)])
        projected = corners @ matrix.T
        return projected[:, :2] / projected[:, 2:]

    @needs_numpy
    def test_the_box_fills_the_picture(self):
        for view in ("isometric", "+x", "-x", "+y", "-y", "+z", "-z", (1, 2, -1)):
            for parallel in (False, True):
                for size in ((40, 40), (80, 40), (40, 80)):
                    with self.subTest((view, parallel, size)):
                        pixels = self.seen(sci.camera(self.BOX, view, parallel=parallel, margin=1), size)
                        self.assertTrue(
                            (pixels > -0.01).all() and (pixels < np.array(size) + 0.01).all(), pixels
                        )
                        self.assertGreater(np.ptp(pixels, axis=0).max() / min(size), 0.6)

    @needs_numpy
    def test_axes_point_to_the_right_and_up(self):
        def directions(view, up):
            camera = sci.camera(((-1, -1, -1), (1, 1, 1)), view, up=up, parallel=True)
            matrix = jg.render(
                {"version": 1, "camera": camera, "render": {"size": [40, 40], "samples": 1}}
            ).camera.world_to_image
            return np.sign(np.round(matrix[:2, :3], 3))

        right, down = directions("+z", "y")
        self.assertEqual((right.tolist(), down.tolist()), ([1, 0, 0], [0, -1, 0]))
        right, down = directions("+y", "y")
        self.assertEqual((right.tolist(), down.tolist()), ([1, 0, 0], [0, 0, 1]))
        right, down = directions("-y", "z")
        self.assertEqual((right.tolist(), down.tolist()), ([1, 0, 0], [0, 0, -1]))
        right, down = directions("+z", "z")
        self.assertEqual((right.tolist(), down.tolist()), ([1, 0, 0], [0, -1, 0]))

    def test_mistakes(self):
        for arguments, message in (
            ((self.BOX, "top"), "`view` is"),
            ((self.BOX, (0, 0, 0)), "not all 0"),
            (((1, 2),), "`bounds` is a pair"),
            ((((1, 0, 0), (0, 0, 0)),), "least and the greatest"),
        ):
            with self.assertRaisesRegex(jg.SceneError, message):
                sci.camera(*arguments)
        with self.assertRaisesRegex(jg.SceneError, "`up` is"):
            sci.camera(self.BOX, up="w")
        with self.assertRaisesRegex(jg.SceneError, "between 0 and 180"):
            sci.camera(self.BOX, fov_degrees=180)

    def test_bounds(self):
        ball = Object(shapes.Sphere(radius=2), material="named").translate(1, 0, 0)
        self.assertEqual(ball.bounds, ((-1, -2, -2), (3, 2, 2)))
        both = Object(objects=[ball, {"shape": "sphere", "material": "other"}])
        self.assertEqual(both.bounds, ((-1, -2, -2), (3, 2, 2)))
        with self.assertRaisesRegex(jg.SceneError, "no bounds"):
            Object(shapes.Plane()).bounds

    @needs_numpy
    def test_axes(self):
        axes = sci.axes(((0, 0, 0), (1, 2, 3)), radius=0.01)
        np.testing.assert_allclose(axes.bounds, [(-0.01,) * 3, (1, 2, 3)], atol=1e-4)
        self.assertEqual(len(sci.axes(((0, 0, 0), (1, 2, 0))).objects), 2)


@needs_numpy
@needs_matplotlib
class Plots(unittest.TestCase):
    def tearDown(self):
        from matplotlib import pyplot

        pyplot.close("all")

    def image(self, **settings):
        obj = sci.surface(CORNERS, FACES, values=[0, 1, 2, 5])
        camera = sci.camera(obj.bounds, view="+z", parallel=True, margin=1)
        scene = Scene(render=jg.RenderSettings(size=(50, 50), samples=1), camera=camera, objects=[obj])
        return jg.render(scene, **settings), obj

    def test_color_bars(self):
        image, obj = self.image()
        figure = image.plot(colorbar=True, title="Pressure", label="Pa")
        picture, bar = figure.axes
        self.assertEqual(picture.get_title(), "Pressure")
        self.assertEqual((bar.get_ylabel(), *bar.get_ylim()), ("Pa", 0, 5))
        self.assertEqual(len(pickle.loads(pickle.dumps(image)).plot(colorbar=True).axes), 2)
        self.assertEqual(len(jg.render("juggler", size=(8, 8), samples=1).plot(colorbar=obj).axes), 2)
        self.assertEqual(len(image.plot().axes), 1)
        with self.assertRaisesRegex(jg.SettingsError, "no color map"):
            jg.render("juggler", size=(8, 8), samples=1).plot(colorbar=True)
        with self.assertWarnsRegex(jg.SceneWarning, "`aces` shifts the colors"):
            self.image(tone="aces")[0].plot(colorbar=True)

    def test_scale_bars(self):
        image, _ = self.image()
        axes = image.plot(scale_bar="0.5 mm").axes[0]
        ends = axes.lines[0].get_xdata()
        self.assertAlmostEqual(ends[1] - ends[0], 25, places=4)
        self.assertEqual(axes.texts[0].get_text(), "0.5 mm")
        for text, message in (("mm", "begins with its length"), ("-1 mm", "begins"), ("3 mm", "pixels long")):
            with self.assertRaisesRegex(jg.SettingsError, message):
                image.plot(scale_bar=text)
        with self.assertRaisesRegex(jg.SettingsError, "orthographic"):
            jg.render("juggler", size=(8, 8), samples=1).plot(scale_bar="1 mm")


if __name__ == "__main__":
    unittest.main()
