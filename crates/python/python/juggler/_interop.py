"""Scenes from the objects of other libraries. None of them is imported: their attributes are read."""

from . import _arrays, backgrounds, cameras, materials, shapes, textures
from ._errors import SceneError
from ._files import file_name
from .scene_types import InputProduct, Instances, Object, Scene


def warn_of(messages):
    """Warns of what a scene does not show, at the line of the user's code."""
    from ._scene import warn

    warn(messages)


def scene_of(objects, source, *, camera=None, up="y", lights=None, background=None):
    """A scene of objects, with a camera that sees all of them unless one is given."""
    if not objects:
        raise SceneError(f"{source} has nothing to show: no triangles, lines or points")
    if camera is None:
        from ._views import camera as view

        camera = view(objects, up=up, view=(0.45, 0.4, 1.0) if up == "y" else (0.45, -1.0, 0.4))
    if background is None and not lights:
        background = backgrounds.Studio(visible_as=(1, 1, 1), up=(0, 1, 0) if up == "y" else (0, 0, 1))
    return Scene(camera=camera, lights=lights, background=background, objects=objects)


def colors_of(array, count):
    """Colors of an array with `count` rows of 3 or 4 numbers, as float32 in linear light; `None` if
    there are none. Integers from 0 to 255 and numbers from 0 to 1 are encoded as sRGB.
    """
    np = _arrays.numpy()
    array = None if array is None else np.asarray(array)
    if array is None or array.ndim != 2 or len(array) != count or not count or array.shape[1] not in (3, 4):
        return None
    levels = array[:, :3] / 255.0 if array.dtype.kind in "iu" else array[:, :3].astype("f8")
    linear = np.where(levels <= 0.04045, levels / 12.92, ((np.maximum(levels, 0) + 0.055) / 1.055) ** 2.4)
    return linear.astype("f4")


def _linear(color):
    """A color in linear light, of one in sRGB: 3 or 4 numbers from 0 to 255, or from 0 to 1."""
    np = _arrays.numpy()
    color = np.asarray(color).reshape(1, -1)
    return [float(x) for x in colors_of(color, 1)[0]]


def shown_color(color):
    """A material of a color in linear light, or of the attribute `color`."""
    return materials.Principled(base_color=textures.Attribute("color") if color is None else color)


def points(positions, colors, radius, name=None):
    """An object of spheres around points."""
    np = _arrays.numpy()
    positions = _arrays.floats(positions, "the points", 3)
    if radius is None:
        extent = np.linalg.norm(np.ptp(positions, axis=0)) if len(positions) else 0.0
        # So many spheres would fill about a third of a cube's side.
        radius = float(extent / (3 * max(len(positions), 1) ** (1 / 3))) / 2 or 0.01
    alpha = None if colors is None else np.column_stack([colors, np.ones(len(colors), "f4")])
    instances = Instances(positions=positions, colors=alpha)
    material = shown_color((0.6, 0.6, 0.6) if colors is None else None)
    return Object(shapes.Sphere(radius=radius), instances=instances, material=material, name=name)


# trimesh


def from_trimesh(mesh, *, point_radius=None):
    """A `Scene` of a `trimesh.Trimesh`, `trimesh.PointCloud` or `trimesh.Scene`, with its colors,
    textures and transforms. The scene's camera is used if it has one of its own.
    """
    if not hasattr(mesh, "graph") and not hasattr(mesh, "vertices"):
        raise TypeError(
            f"from_trimesh takes a mesh, a point cloud or a scene of trimesh, not {type(mesh).__name__}"
        )
    unsupported = []
    if hasattr(mesh, "graph"):
        objects = []
        for node in mesh.graph.nodes_geometry:
            matrix, geometry = mesh.graph[node]
            made = _trimesh_object(mesh.geometry[geometry], str(node), unsupported, point_radius)
            if made is not None:
                objects.append(made.matrix(matrix))
        camera = _trimesh_camera(mesh)
    else:
        made = _trimesh_object(mesh, None, unsupported, point_radius)
        objects, camera = [made] if made is not None else [], None
    scene = scene_of(objects, "the scene of trimesh", camera=camera)
    warn_of(unsupported)
    return scene


def _trimesh_camera(scene):
    """The camera of a scene that has one; trimesh would make one otherwise."""
    if not getattr(scene, "has_camera", False):
        return None
    np = _arrays.numpy()
    matrix = np.asarray(scene.camera_transform, "f8")
    eye, right, up, back = (matrix[:3, column] for column in (3, 0, 1, 2))
    fov = float(scene.camera.fov[1])
    return cameras.Perspective(
        eye=eye.tolist(), direction=(-back).tolist(), up=up.tolist(), vertical_fov_degrees=fov
    )


def _trimesh_object(mesh, name, unsupported, point_radius):
    kind = type(mesh).__name__
    if not hasattr(mesh, "faces"):
        if hasattr(mesh, "entities"):
            unsupported.append(f"{kind} {name or ''}".strip() + " of trimesh: paths are not shown")
            return None
        colors = colors_of(getattr(mesh, "colors", None), len(mesh.vertices))
        return points(mesh.vertices, colors, point_radius, name)
    visual = getattr(mesh, "visual", None)
    uvs = getattr(visual, "uv", None)
    attributes, material = None, shown_color((0.6, 0.6, 0.6))
    if getattr(visual, "kind", None) == "texture":
        material = _trimesh_material(visual.material, uvs is not None, unsupported)
    elif getattr(visual, "kind", None) in ("vertex", "face"):
        from ._array_nodes import PerFace

        on_faces = visual.kind == "face"
        found = colors_of(
            visual.face_colors if on_faces else visual.vertex_colors,
            len(mesh.faces if on_faces else mesh.vertices),
        )
        attributes = {"color": PerFace(found) if on_faces else found}
        material = shown_color(None)
    # Normals that the mesh only computes would smooth its edges.
    cache = getattr(mesh, "_cache", None)
    normals = mesh.vertex_normals if cache is not None and "vertex_normals" in cache.cache else None
    return Object(
        shapes.Mesh(
            positions=mesh.vertices, triangles=mesh.faces, normals=normals, uvs=uvs, attributes=attributes
        ),
        material=material,
        name=name,
    )


def _image(picture, color_space=None, channel=None):
    """A texture of a picture of Pillow."""
    np = _arrays.numpy()
    if getattr(picture, "mode", "RGB") not in ("L", "LA", "RGB", "RGBA"):
        picture = picture.convert("RGBA" if "transparency" in getattr(picture, "info", {}) else "RGB")
    return textures.Image(array=np.array(picture), color_space=color_space, channel=channel)


def _trimesh_material(material, has_uvs, unsupported):
    """The material of a mesh with surface coordinates: PBRMaterial or SimpleMaterial."""

    def picture(name):
        found = getattr(material, name, None)
        return found if has_uvs else None

    if hasattr(material, "baseColorFactor"):
        factor = material.baseColorFactor
        color = [1.0, 1.0, 1.0] if factor is None else _factor(factor)
        base = picture("baseColorTexture")
        mixed = picture("metallicRoughnessTexture")
        metallic = 1.0 if material.metallicFactor is None else float(material.metallicFactor)
        roughness = 1.0 if material.roughnessFactor is None else float(material.roughnessFactor)
        for name in ("normalTexture", "emissiveTexture", "occlusionTexture"):
            if picture(name) is not None:
                unsupported.append(f"materials of trimesh: `{name}` is not shown")

        def channel(value, letter):
            if mixed is None:
                return value
            return InputProduct(texture=_image(mixed, "linear", letter), factor=value)

        return materials.Principled(
            base_color=color if base is None else InputProduct(texture=_image(base), factor=color),
            metallic=channel(metallic, "b"),
            roughness=channel(roughness, "g"),
        )
    base = picture("image")
    if base is not None:
        return materials.Principled(base_color=_image(base))
    diffuse = getattr(material, "diffuse", None)
    return shown_color((0.6, 0.6, 0.6) if diffuse is None else _linear(diffuse))


def _factor(factor):
    """Three factors in linear light, of numbers from 0 to 1 or integers from 0 to 255."""
    np = _arrays.numpy()
    factor = np.asarray(factor)
    scale = 255.0 if factor.dtype.kind in "iu" else 1.0
    return [float(x) / scale for x in factor[:3]]


# Open3D


def from_open3d(geometry, *, point_radius=None, line_radius=None):
    """A `Scene` of a geometry of Open3D or a list of them: triangle meshes with colors and textures,
    point clouds, and line sets.
    """
    geometries = geometry if isinstance(geometry, (list, tuple)) else [geometry]
    unsupported, objects = [], []
    for one in geometries:
        if hasattr(one, "vertices") and hasattr(one, "triangles"):
            objects += _open3d_mesh(one, unsupported)
        elif hasattr(one, "points") and hasattr(one, "lines"):
            objects += _open3d_lines(one, line_radius)
        elif hasattr(one, "points"):
            np = _arrays.numpy()
            found = np.asarray(one.points)
            if len(found):
                objects.append(points(found, colors_of(one.colors, len(found)), point_radius))
        else:
            unsupported.append(f"{type(one).__name__} of Open3D is not shown")
    scene = scene_of(objects, "the geometry of Open3D")
    warn_of(unsupported)
    return scene


def _open3d_mesh(mesh, unsupported):
    np = _arrays.numpy()
    positions, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if not len(triangles):
        return []
    normals = np.asarray(mesh.vertex_normals)
    colors = colors_of(mesh.vertex_colors, len(positions))
    uvs = np.asarray(getattr(mesh, "triangle_uvs", ()))
    pictures = [np.asarray(picture) for picture in getattr(mesh, "textures", ())]
    normals = normals if len(normals) == len(positions) else None
    if len(uvs) == 3 * len(triangles) and pictures and pictures[0].size:
        if len(pictures) > 1:
            unsupported.append(f"a mesh of Open3D has {len(pictures)} textures; only the first is shown")
        # Surface coordinates belong to corners of triangles, which become vertices of their own.
        corners = triangles.reshape(-1)
        # The first row of an image of Open3D is at v = 0.
        uvs = np.column_stack([uvs[:, 0], 1 - uvs[:, 1]])
        made = shapes.Mesh(
            positions=positions[corners],
            triangles=np.arange(len(corners)).reshape(-1, 3),
            uvs=uvs,
            normals=None if normals is None else normals[corners],
        )
        return [Object(made, material=materials.Principled(base_color=textures.Image(array=pictures[0])))]
    attributes = None if colors is None else {"color": colors}
    made = shapes.Mesh(positions=positions, triangles=triangles, normals=normals, attributes=attributes)
    return [Object(made, material=shown_color((0.6, 0.6, 0.6) if colors is None else None))]


def _open3d_lines(lines, radius):
    np = _arrays.numpy()
    positions, pairs = np.asarray(lines.points, "f8"), np.asarray(lines.lines)
    if not len(pairs):
        return []
    if radius is None:
        radius = float(np.linalg.norm(np.ptp(positions, axis=0))) / 500 or 0.01
    colors = colors_of(lines.colors, len(pairs))
    return [segments(positions[pairs[:, 0]], positions[pairs[:, 1]], radius, colors)]


def segments(starts, ends, radius, colors=None, name=None):
    """An object of cylinders between points."""
    from ._glyphs import frames

    np = _arrays.numpy()
    vectors = np.asarray(ends, "f8") - np.asarray(starts, "f8")
    lengths = np.linalg.norm(vectors, axis=1)
    seen = lengths > 0
    matrices = frames(vectors[seen], np.asarray(starts, "f8")[seen], np.ones(int(seen.sum())))
    # A cylinder of length 1 along y: its y axis is the line, and the others are the radius.
    turned = matrices.copy()
    turned[:, :, 0] = matrices[:, :, 0] * radius
    turned[:, :, 1] = matrices[:, :, 2] * lengths[seen, None]
    turned[:, :, 2] = -matrices[:, :, 1] * radius
    alpha = None if colors is None else np.column_stack([colors[seen], np.ones(int(seen.sum()), "f4")])
    material = shown_color((0.1, 0.1, 0.1) if colors is None else None)
    shape = shapes.Cylinder(radius=1, y_min=0, y_max=1)
    return Object(shape, instances=Instances(matrices=turned, colors=alpha), material=material, name=name)


# meshio

# Corners of the faces of cells, seen from outside.
_FACES = {
    "triangle": [(0, 1, 2)],
    "quad": [(0, 1, 2), (0, 2, 3)],
    "tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
    "hexahedron": [
        (0, 3, 2, 1),
        (4, 5, 6, 7),
        (0, 1, 5, 4),
        (1, 2, 6, 5),
        (2, 3, 7, 6),
        (3, 0, 4, 7),
    ],
    "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
}


def from_meshio(mesh, *, values=None, cmap="viridis", clim=None, nan="#808080"):
    """A `Scene` of the triangles and quadrilaterals of a `meshio.Mesh`, and of the boundary of its
    tetrahedra, hexahedra, wedges and pyramids. `values` is the name of an array of its `point_data`,
    which `cmap` colors as in `sci.surface`.
    """
    from . import sci

    if not hasattr(mesh, "points") or not hasattr(mesh, "cells"):
        raise TypeError(f"from_meshio takes a mesh of meshio, not {type(mesh).__name__}")
    np = _arrays.numpy()
    positions = np.asarray(mesh.points, "f8")
    if positions.ndim == 2 and positions.shape[1] == 2:
        positions = np.column_stack([positions, np.zeros(len(positions))])
    shown, unsupported = [], []
    solids = {3: [], 4: []}
    for block in mesh.cells:
        cells = np.asarray(block.data)
        if block.type in ("triangle", "quad"):
            shown += [cells[:, face] for face in _FACES[block.type]]
        elif block.type in _FACES:
            for face in _FACES[block.type]:
                solids[len(face)].append(cells[:, face])
        else:
            unsupported.append(f"cells of the type {block.type} of meshio are not shown")
    for faces in solids.values():
        shown += _boundary(faces)
    if not shown:
        raise SceneError(
            "the mesh of meshio has nothing to show: no triangles, quadrilaterals or solid cells"
        )
    if values is not None:
        if values not in mesh.point_data:
            known = ", ".join(mesh.point_data) or "none"
            raise SceneError(f"the mesh of meshio has no `{values}` in `point_data`; it has {known}")
        values = np.asarray(mesh.point_data[values])
        if values.ndim > 1:
            values = np.linalg.norm(values.reshape(len(values), -1), axis=1)
    triangles = np.concatenate(shown)
    made = sci.surface(positions, triangles, values=values, cmap=cmap, clim=clim, nan=nan)
    scene = scene_of([made], "the mesh of meshio", up="z")
    warn_of(sorted(set(unsupported)))
    return scene


def _boundary(faces):
    """Triangles of the faces that belong to one cell alone."""
    if not faces:
        return []
    np = _arrays.numpy()
    faces = np.concatenate(faces)
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    faces = faces[np.sort(first[counts == 1])]
    return [faces] if faces.shape[1] == 3 else [faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]]


# glTF


def from_gltf(path, *, variant=None, animation=None, scene=None, at=None, lenient=False, **fields):
    """A `Scene` of a model file, with its cameras and lights: the sections of `Scene.load`, in which
    the model has this variant, animation clip, scene, time `at` and other `fields` of `Model`.
    `lenient` shows missing and broken pictures gray.
    """
    from .scene_types import Model

    fields = {"variant": variant, "animation": animation, "scene": scene, "at": at, **fields}
    fields = {name: value for name, value in fields.items() if value is not None}
    loaded = Scene.load(path, lenient=lenient)
    objects = [dict(one) for one in loaded.objects or ()]
    models = [one for one in objects if "model" in one]
    if not models:
        raise SceneError(f"`{file_name(path)}` is no model; `Scene.load` reads other files")
    for one in models:
        one["model"] = Model(**{**one["model"], **fields})
    loaded.objects = objects
    return loaded


for _function in (from_trimesh, from_open3d, from_meshio, from_gltf):
    _function.__module__ = "juggler"
del _function
