"""Scenes from objects of other libraries: the real ones where they are installed, else stand-ins."""

import pathlib
import unittest
import warnings
from types import SimpleNamespace

import juggler as jg
from juggler import Scene, shapes
from support import ROOT, SMALL, Folder, needs_numpy, numpy as np


def optional(name):
    """A library, or `None`."""
    try:
        return __import__(name)
    except ImportError:
        return None


trimesh, meshio, pyvista, open3d = map(optional, ("trimesh", "meshio", "pyvista", "open3d"))

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TRIANGLES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]


def flat(scene):
    """Image of the albedo alone."""
    return jg.render(scene, **{**SMALL, "samples": 1}, integrator="albedo")


def colors(scene):
    """The colors that a flat image has, without black and without what all surfaces reflect alike: the
    least of red, green and blue.
    """
    pixels = flat(scene).color.reshape(-1, 3).astype("f8")
    least = pixels.min(axis=1, keepdims=True)
    pixels = np.round((pixels - least) / np.maximum(1 - least, 1e-9), 2)
    return {tuple(pixel) for pixel in pixels.tolist()} - {(0, 0, 0)}


@needs_numpy
class Trimesh(Folder):
    def mesh(self, **more):
        if trimesh is None or "fake" in more:
            visual = SimpleNamespace(kind=None)
            return SimpleNamespace(vertices=np.array(CORNERS, "f8"), faces=np.array(TRIANGLES), visual=visual)
        return trimesh.Trimesh(CORNERS, TRIANGLES, process=False)

    def test_a_mesh_is_that_of_its_arrays(self):
        for mesh in (self.mesh(), self.mesh(fake=True)):
            scene = jg.from_trimesh(mesh)
            self.assertIsInstance(scene, Scene)
            shape = scene.objects[0].shape
            self.assertEqual(
                shape, shapes.Mesh(positions=np.array(CORNERS, "f8"), triangles=np.array(TRIANGLES))
            )
            self.assertEqual(scene.check(), [])

    def test_other_objects_are_refused(self):
        with self.assertRaisesRegex(TypeError, "not list"):
            jg.from_trimesh([])

    @unittest.skipUnless(trimesh, "trimesh is not installed")
    def test_colors(self):
        mesh = self.mesh()
        mesh.visual.face_colors = [(255, 0, 0, 255)] * 4
        self.assertEqual(colors(jg.from_trimesh(mesh)), {(1, 0, 0)})
        mesh = self.mesh()
        mesh.visual.vertex_colors = [(0, 188, 0, 255)] * 4
        self.assertEqual(colors(jg.from_trimesh(mesh)), {(0, 0.5, 0)})

    @unittest.skipUnless(trimesh, "trimesh is not installed")
    def test_scenes_have_transforms_and_points(self):
        scene = trimesh.Scene()
        moved = np.eye(4)
        moved[:3, 3] = 5, 0, 0
        scene.add_geometry(self.mesh(), node_name="first")
        scene.add_geometry(self.mesh(), node_name="second", transform=moved)
        scene.add_geometry(
            trimesh.PointCloud([(0, 9, 0), (0, 10, 0)], colors=[(255, 0, 0, 255), (0, 0, 255, 255)])
        )
        made = jg.from_trimesh(scene, point_radius=0.5)
        self.assertEqual([one.name for one in made.objects][:2], ["first", "second"])
        np.testing.assert_allclose(made.objects[1].bounds, [(5, 0, 0), (6, 1, 1)], atol=1e-5)
        np.testing.assert_allclose(made.objects[2].bounds, [(-0.5, 8.5, -0.5), (0.5, 10.5, 0.5)], atol=1e-5)
        self.assertTrue(jg.render(made, **SMALL).hash)

    @unittest.skipUnless(trimesh, "trimesh is not installed")
    def test_textures(self):
        image = optional("PIL") and __import__("PIL.Image").Image.fromarray(
            np.full((2, 2, 3), (255, 0, 0), "u1")
        )
        if image is None:
            self.skipTest("Pillow is not installed")
        uv = [(0, 0), (1, 0), (0, 1), (1, 1)]
        simple = trimesh.visual.TextureVisuals(uv=uv, image=image)
        physical = trimesh.visual.TextureVisuals(
            uv=uv,
            material=trimesh.visual.material.PBRMaterial(
                metallicFactor=0.0, baseColorTexture=image, baseColorFactor=[128, 255, 255, 255]
            ),
        )
        for visual, expected in ((simple, {(1, 0, 0)}), (physical, {(0.5, 0, 0)})):
            mesh = trimesh.Trimesh(CORNERS, TRIANGLES, process=False, visual=visual)
            self.assertEqual(colors(jg.from_trimesh(mesh)), expected)

    @unittest.skipUnless(trimesh, "trimesh is not installed")
    def test_paths_are_named(self):
        scene = trimesh.Scene([self.mesh(), trimesh.load_path([[(0, 0, 0), (1, 1, 1)]])])
        with self.assertWarnsRegex(jg.SceneWarning, "paths are not shown"):
            jg.from_trimesh(scene)


@needs_numpy
class Open3D(unittest.TestCase):
    def mesh(self, **more):
        fields = dict(
            vertices=np.array(CORNERS, "f8"),
            triangles=np.array(TRIANGLES),
            vertex_normals=np.zeros((0, 3)),
            vertex_colors=np.zeros((0, 3)),
            triangle_uvs=np.zeros((0, 2)),
            textures=[],
        )
        return SimpleNamespace(**{**fields, **more})

    def test_meshes(self):
        scene = jg.from_open3d(self.mesh())
        self.assertEqual(
            scene.objects[0].shape,
            shapes.Mesh(positions=np.array(CORNERS, "f8"), triangles=np.array(TRIANGLES)),
        )
        red = jg.from_open3d(self.mesh(vertex_colors=np.array([(1.0, 0, 0)] * 4)))
        self.assertEqual(colors(red), {(1, 0, 0)})
        picture = np.full((2, 2, 3), (0, 0, 255), "u1")
        textured = self.mesh(triangle_uvs=np.zeros((12, 2)), textures=[picture, picture])
        with self.assertWarnsRegex(jg.SceneWarning, "2 textures; only the first"):
            self.assertEqual(colors(jg.from_open3d(textured)), {(0, 0, 1)})

    def test_clouds_and_lines(self):
        cloud = SimpleNamespace(points=np.array(CORNERS, "f8"), colors=np.array([(0, 1.0, 0)] * 4))
        lines = SimpleNamespace(
            points=np.array(CORNERS, "f8"), lines=np.array([(0, 1), (0, 2)]), colors=np.zeros((0, 3))
        )
        scene = jg.from_open3d([cloud, lines], point_radius=0.1, line_radius=0.05)
        np.testing.assert_allclose(scene.objects[0].bounds, [(-0.1,) * 3, (1.1,) * 3], atol=1e-5)
        np.testing.assert_allclose(scene.objects[1].bounds, [(-0.05,) * 3, (1, 1, 0.05)], atol=1e-3)
        self.assertIn((0, 1, 0), colors(scene))
        with self.assertRaisesRegex(jg.SceneError, "nothing to show"):
            jg.from_open3d([])
        with self.assertWarnsRegex(jg.SceneWarning, "SimpleNamespace of Open3D"):
            jg.from_open3d([cloud, SimpleNamespace()])

    @unittest.skipUnless(open3d, "Open3D is not installed")
    def test_the_real_library(self):
        mesh = open3d.geometry.TriangleMesh.create_box()
        mesh.compute_vertex_normals()
        mesh.paint_uniform_color((1, 0, 0))
        scene = jg.from_open3d(mesh)
        np.testing.assert_allclose(scene.objects[0].bounds, [(0, 0, 0), (1, 1, 1)], atol=1e-6)
        self.assertEqual(colors(scene), {(1, 0, 0)})
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(np.array(CORNERS, "f8")))
        self.assertTrue(jg.render(jg.from_open3d([mesh, cloud]), **SMALL).hash)


@needs_numpy
class Meshio(unittest.TestCase):
    POINTS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)]
    HEXAHEDRA = [(0, 1, 4, 3, 6, 7, 10, 9), (1, 2, 5, 4, 7, 8, 11, 10)]

    def mesh(self, points, cells, **data):
        if meshio is not None:
            return meshio.Mesh(points, cells, point_data=data)
        blocks = [SimpleNamespace(type=kind, data=np.array(cells)) for kind, cells in cells]
        return SimpleNamespace(points=np.array(points, "f8"), cells=blocks, point_data=data)

    def volume(self, scene):
        mesh = scene.objects[0].shape
        corners = np.asarray(mesh.positions, "f8")[np.asarray(mesh.triangles)]
        return np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6

    def test_the_boundary_of_solid_cells_faces_outwards(self):
        scene = jg.from_meshio(self.mesh(self.POINTS, [("hexahedron", self.HEXAHEDRA)]))
        self.assertEqual(len(scene.objects[0].shape.triangles), 2 * 10)
        self.assertAlmostEqual(self.volume(scene), 2, places=5)
        tetra = jg.from_meshio(self.mesh(CORNERS, [("tetra", [(0, 1, 2, 3)])]))
        self.assertAlmostEqual(self.volume(tetra), 1 / 6, places=5)
        wedge = jg.from_meshio(
            self.mesh([*CORNERS[:3], (0, 0, 1), (1, 0, 1), (0, 1, 1)], [("wedge", [range(6)])])
        )
        self.assertAlmostEqual(self.volume(wedge), 1 / 2, places=5)
        base = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)]
        self.assertAlmostEqual(
            self.volume(jg.from_meshio(self.mesh(base, [("pyramid", [range(5)])]))), 1 / 3, places=5
        )

    def test_values(self):
        mesh = self.mesh(
            CORNERS, [("triangle", TRIANGLES)], heat=np.array([0.0, 1, 2, 3]), flow=np.ones((4, 3))
        )
        scene = jg.from_meshio(mesh, values="heat", clim=(0, 3))
        self.assertEqual(scene.objects[0].material.reflectance.clim, (0, 3))
        jg.from_meshio(mesh, values="flow")
        with self.assertRaisesRegex(jg.SceneError, "no `hat` in `point_data`; it has heat, flow"):
            jg.from_meshio(mesh, values="hat")
        lines = self.mesh(CORNERS, [("triangle", TRIANGLES), ("line", [(0, 1)])])
        with self.assertWarnsRegex(jg.SceneWarning, "type line of meshio"):
            jg.from_meshio(lines)


@needs_numpy
@unittest.skipUnless(pyvista, "pyvista is not installed")
class Pyvista(unittest.TestCase):
    def test_meshes(self):
        scene = jg.from_pyvista(pyvista.Cube())
        np.testing.assert_allclose(scene.objects[0].bounds, [(-0.5,) * 3, (0.5,) * 3], atol=1e-6)
        sphere = pyvista.Sphere()
        sphere["height"] = sphere.points[:, 2]
        made = jg.from_pyvista(sphere, values="height", cmap="coolwarm")
        self.assertEqual(made.objects[0].material.reflectance.cmap, "coolwarm")
        self.assertEqual(made.check(), [])
        grid = pyvista.ImageData(dimensions=(3, 3, 3))
        grid.cell_data["part"] = np.arange(8.0)
        made = jg.from_pyvista(grid)
        self.assertEqual(len(made.objects[0].shape.triangles), 6 * 4 * 2)
        self.assertIsInstance(made.objects[0].shape.attributes["value"], jg.PerFace)
        lines = pyvista.Line((0, 0, 0), (1, 0, 0))
        self.assertEqual(len(jg.from_pyvista(lines).objects), 1)
        cloud = pyvista.PolyData(np.array(CORNERS, "f4"))
        self.assertEqual(len(jg.from_pyvista(cloud).objects), 1)
        blocks = pyvista.MultiBlock([pyvista.Cube(), None, pyvista.Sphere()])
        self.assertEqual(len(jg.from_pyvista(blocks).objects), 2)
        with self.assertRaisesRegex(TypeError, "not int"):
            jg.from_pyvista(3)

    def test_plotters(self):
        plotter = pyvista.Plotter(off_screen=True)
        sphere = pyvista.Sphere()
        sphere["height"] = sphere.points[:, 2]
        plotter.add_mesh(
            sphere, scalars="height", cmap="plasma", clim=(-1, 1), name="ball", show_scalar_bar=True
        )
        plotter.add_mesh(
            pyvista.Cube().translate((2, 0, 0)), color="red", opacity=0.5, name="cube", show_edges=True
        )
        plotter.add_mesh(
            pyvista.Cube(), user_matrix=np.diag([1.0, 1, 1, 1]) + np.eye(4, k=3) * 5, name="moved"
        )
        plotter.add_text("title")
        plotter.background_color = "white"
        plotter.camera_position = [(9, 8, 7), (1, 0, 0), (0, 0, 1)]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            scene = jg.from_pyvista(plotter)
        texts = " ".join(str(one.message) for one in caught)
        for part in ("edges of faces", "scalar bars", "CornerAnnotation"):
            self.assertIn(part, texts)
        ball, cube, moved = scene.objects
        self.assertEqual((ball.name, cube.name), ("ball", "cube"))
        color_map = ball.material.reflectance
        self.assertEqual(color_map.clim, (-1, 1))
        # VTK rounds levels down.
        self.assertEqual((color_map.colors()[0], color_map.colors()[-1]), ("#0c0786", "#eff821"))
        self.assertEqual(cube.material.opacity, 0.5)
        np.testing.assert_allclose(moved.bounds, [(4.5, -0.5, -0.5), (5.5, 0.5, 0.5)], atol=1e-5)
        self.assertEqual(tuple(scene.camera.eye), (9, 8, 7))
        self.assertGreater(len(scene.lights), 0)
        image = jg.render(scene, **SMALL)
        np.testing.assert_allclose(image.color[0, 0], (1, 1, 1), atol=1e-4)
        plotter.close()


class Gltf(Folder):
    CAR = ROOT / "scenes/models"

    def models(self):
        return sorted(pathlib.Path(self.CAR).rglob("*.gl*"))

    def test_a_model_is_the_one_that_is_rendered_by_name(self):
        if not self.models():
            self.skipTest("there are no models")
        path = str(self.models()[0])
        self.assertEqual(jg.render(jg.from_gltf(path), **SMALL).hash, jg.render(path, **SMALL).hash)

    def test_variants_and_clips(self):
        found = False
        for path in map(str, self.models()):
            (model,) = jg.models(path) or [None]
            if model is None:
                continue
            for variant in model["variants"][:2]:
                found = True
                made = jg.render(jg.from_gltf(path, variant=variant), **SMALL).hash
                self.assertEqual(made, jg.render(path, variant=variant, **SMALL).hash)
            for clip in model["clips"][:1]:
                found = True
                made = jg.render(jg.from_gltf(path, animation=clip["name"]), frame=3, **SMALL).hash
                self.assertEqual(made, jg.render(path, animation=clip["name"], frame=3, **SMALL).hash)
        if not found:
            self.skipTest("no model has variants or clips")

    def test_other_files_are_refused(self):
        with self.assertRaisesRegex(jg.SceneError, "is no model"):
            jg.from_gltf("juggler")


if __name__ == "__main__":
    unittest.main()
