"""Scenes from meshes and plotters of pyvista, which is not imported: their attributes are read."""

import math

from . import _arrays, backgrounds, cameras, lights, materials, sci, shapes
from ._interop import colors_of, points, scene_of, segments, warn_of
from ._values import material as _sci_material
from .scene_types import Object


def from_pyvista(source, *, values=None, cmap="viridis", clim=None, nan="#808080", point_radius=None):
    """A `Scene` of a mesh, a block of meshes or a plotter of pyvista.

    Of a plotter come the meshes with their scalars, color maps and transforms, the background, the
    camera and the lights; a warning names what is not shown. Of a mesh, `values` is the name of the
    array that `cmap` colors as in `sci.surface`, by default that of its active scalars.
    """
    unsupported = []
    if hasattr(source, "renderer") and hasattr(source, "camera"):
        scene = _plotter(source, unsupported, point_radius)
    else:
        options = {"cmap": cmap, "clim": clim, "nan": nan}
        objects = _blocks(source, values, options, unsupported, point_radius)
        scene = scene_of(objects, "the mesh of pyvista", up="z")
    warn_of(list(dict.fromkeys(unsupported)))
    return scene


from_pyvista.__module__ = "juggler"


def _blocks(source, values, options, unsupported, point_radius):
    if hasattr(source, "n_blocks"):
        blocks = (source[index] for index in range(source.n_blocks))
        found = [
            _blocks(block, values, options, unsupported, point_radius)
            for block in blocks
            if block is not None
        ]
        return [one for block in found for one in block]
    if not hasattr(source, "points"):
        raise TypeError(f"from_pyvista takes a mesh or a plotter of pyvista, not {type(source).__name__}")
    values = getattr(source, "active_scalars_name", None) if values is None else values
    return _mesh(source, values, options, unsupported, point_radius)


def _polygons(mesh):
    """The surface of a mesh: its points, triangles, and polygons with lines."""
    if not hasattr(mesh, "faces") or hasattr(mesh, "celltypes"):
        mesh = mesh.extract_surface()
    np = _arrays.numpy()
    whole = mesh.triangulate() if mesh.n_cells and len(mesh.faces) else mesh
    faces = np.asarray(whole.faces).reshape(-1, 4)[:, 1:] if len(whole.faces) else np.zeros((0, 3), "i8")
    return mesh, whole, faces


def _line_pairs(lines):
    """Start and end of each segment of lines, which follow their number of points."""
    np = _arrays.numpy()
    lines, at, pairs = np.asarray(lines), 0, []
    while at < len(lines):
        count = int(lines[at])
        line = lines[at + 1 : at + 1 + count]
        pairs += list(zip(line[:-1], line[1:]))
        at += count + 1
    return np.array(pairs, "i8").reshape(-1, 2)


def _array_of(mesh, name, faces):
    """Values of an array by its name, and whether they belong to faces; `None` without it."""
    from ._array_nodes import PerFace

    np = _arrays.numpy()
    for data, on_faces in ((mesh.point_data, False), (mesh.cell_data, True)):
        if name is not None and name in data:
            found = np.asarray(data[name])
            if on_faces and len(found) != len(faces):
                continue
            if found.ndim == 2 and not (found.shape[1] in (3, 4) and found.dtype == np.uint8):
                found = np.linalg.norm(found.astype("f8"), axis=1)
            return PerFace(found) if on_faces else found
    return None


def _mesh(mesh, name, options, unsupported, point_radius, smooth=False, color="#c8c8c8"):
    """Objects of a mesh: triangles, lines or points."""
    from ._array_nodes import PerFace

    np = _arrays.numpy()
    mesh, whole, faces = _polygons(mesh)
    objects = []
    if len(faces):
        values = _array_of(whole, name, faces)
        if name is not None and values is None:
            unsupported.append(
                f"the array `{name}` of pyvista belongs to no points and no faces of the surface; it is not shown"
            )
        numbers = values.values if isinstance(values, PerFace) else values
        normals = whole.point_data["Normals"] if "Normals" in whole.point_data else None
        if numbers is not None and numbers.ndim == 2:
            found = colors_of(numbers, len(numbers))
            attributes = {"color": PerFace(found) if isinstance(values, PerFace) else found}
            made = shapes.Mesh(
                positions=whole.points, triangles=faces, normals=normals, attributes=attributes
            )
            from .textures import Attribute

            objects.append(Object(made, material=_sci_material(Attribute("color"))))
        else:
            objects.append(
                sci.surface(
                    whole.points, faces, values=values, normals=normals, smooth=smooth, color=color, **options
                )
            )
    pairs = _line_pairs(mesh.lines) if len(getattr(mesh, "lines", ())) else ()
    if len(pairs):
        positions = np.asarray(mesh.points, "f8")
        radius = float(np.linalg.norm(np.ptp(positions, axis=0))) / 500 or 0.01
        objects.append(segments(positions[pairs[:, 0]], positions[pairs[:, 1]], radius))
    if not len(faces) and not len(pairs) and len(mesh.points):
        objects.append(_cloud(mesh, name, options, color, point_radius))
    return objects


def _cloud(mesh, name, options, color, radius):
    """Spheres at the points of a mesh without faces."""
    np = _arrays.numpy()
    values = np.asarray(mesh.point_data[name]) if name is not None and name in mesh.point_data else None
    if values is not None and values.ndim == 2 and values.shape[1] in (3, 4) and values.dtype == np.uint8:
        return points(mesh.points, colors_of(values, len(values)), radius)
    if values is not None and values.ndim == 2:
        values = np.linalg.norm(values.astype("f8"), axis=1)
    made = points(mesh.points, None, radius)
    return sci.spheres(mesh.points, made.shape.radius, values=values, color=color, **options)


# Plotters


def _plotter(plotter, unsupported, point_radius):
    renderer = plotter.renderer
    objects = []
    for name, actor in dict(renderer.actors).items():
        visible = getattr(actor, "visibility", True)
        if not visible:
            continue
        mapper = getattr(actor, "mapper", None)
        dataset = getattr(mapper, "dataset", None)
        if dataset is None or getattr(actor, "prop", None) is None:
            unsupported.append(_not_shown(actor))
            continue
        objects += [
            one.replace(name=str(name)) for one in _actor(actor, mapper, dataset, unsupported, point_radius)
        ]
    made = scene_of(objects, "the plotter of pyvista", camera=_camera(plotter.camera), up="z")
    shown = _lights(getattr(renderer, "lights", ()), made.camera, unsupported)
    color = _color(plotter.background_color)
    if shown:
        # The background is seen, and lights nothing.
        return made.replace(lights=shown, background=backgrounds.Studio(scale=0, visible_as=color))
    return made.replace(background=backgrounds.Studio(visible_as=color, up=(0, 0, 1)))


def _not_shown(actor):
    kind = type(actor).__name__
    if "ScalarBar" in kind:
        return "scalar bars of pyvista are not shown; `Image.plot(colorbar=True)` draws them"
    return f"actors of the type {kind} of pyvista are not shown"


def _color(color):
    """A color of pyvista as "#rrggbb"."""
    return str(color.hex_rgb) if hasattr(color, "hex_rgb") else color


def _actor(actor, mapper, dataset, unsupported, point_radius):
    prop = actor.prop
    label = f"the mesh `{getattr(actor, 'name', '')}` of pyvista"
    if getattr(prop, "show_edges", False):
        unsupported.append(f"{label}: edges of faces are not shown")
    style = str(getattr(prop, "style", "surface")).lower()
    if style not in ("surface", "points") and "points" not in style:
        unsupported.append(f"{label}: the style {prop.style} is shown as a surface")
    name, options = _scalars(mapper, label, unsupported)
    color = _color(prop.color)
    smooth = (
        "phong" in str(getattr(prop, "interpolation", "")).lower()
        or "gouraud" in str(getattr(prop, "interpolation", "")).lower()
    )
    if "points" in style:
        made = [_cloud(dataset, name, options, color, point_radius)]
    else:
        made = _mesh(dataset, name, options, unsupported, point_radius, smooth, color)
    made = [_with_material(one, prop) for one in made]
    matrix = _matrix(actor)
    return made if matrix is None else [one.matrix(matrix) for one in made]


def _scalars(mapper, label, unsupported):
    """Name of the array that a mapper shows, and options of its color map."""
    options = {"cmap": "viridis", "clim": None, "nan": "#808080"}
    if not getattr(mapper, "scalar_visibility", False):
        return None, options
    name = getattr(mapper, "array_name", None) or getattr(mapper.dataset, "active_scalars_name", None)
    table = getattr(mapper, "lookup_table", None)
    if table is not None:
        np = _arrays.numpy()
        values = np.asarray(table.values)
        if len(values):
            options["cmap"] = [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in values[:, :3].tolist()]
        if hasattr(table, "nan_color") and table.nan_color is not None:
            options["nan"] = _color(table.nan_color)
        if getattr(table, "log_scale", False):
            unsupported.append(f"{label}: the logarithmic scale of its color map is shown as a linear one")
        if len(values) and values.shape[1] == 4 and (values[:, 3] < 255).any():
            unsupported.append(f"{label}: the opacity of its color map is not shown")
    low, high = (float(limit) for limit in mapper.scalar_range)
    options["clim"] = (low, high) if low < high else None
    return name, options


def _with_material(made, prop):
    """The object with the surface of a property of pyvista."""
    if made.objects is not None:
        return made.replace(objects=[_with_material(one, prop) for one in made.objects])
    material = made.material
    color = getattr(material, "reflectance", None)
    if color is None:
        return made
    opacity = float(getattr(prop, "opacity", 1.0))
    is_physical = "physical" in str(getattr(prop, "interpolation", "")).lower()
    if opacity >= 1 and not is_physical:
        return made
    fields = {"opacity": opacity} if opacity < 1 else {}
    if is_physical:
        fields |= {"metallic": float(prop.metallic), "roughness": float(prop.roughness)}
    else:
        fields |= {"roughness": 1, "specular": 0}
    return made.replace(material=materials.Principled(base_color=color, **fields))


def _matrix(actor):
    """The transform of an actor; `None` for the identity."""
    np = _arrays.numpy()
    matrix = getattr(actor, "user_matrix", None)
    if hasattr(actor, "GetMatrix"):
        # With position, orientation, scale and origin.
        found = actor.GetMatrix()
        matrix = [[found.GetElement(row, column) for column in range(4)] for row in range(4)]
    matrix = None if matrix is None else np.asarray(matrix, "f8")
    return None if matrix is None or np.array_equal(matrix, np.eye(4)) else matrix


def _camera(camera):
    eye, target, up = (tuple(map(float, of)) for of in (camera.position, camera.focal_point, camera.up))
    if camera.parallel_projection:
        return cameras.Orthographic(eye=eye, look_at=target, up=up, height=2 * float(camera.parallel_scale))
    return cameras.Perspective(eye=eye, look_at=target, up=up, vertical_fov_degrees=float(camera.view_angle))


def _lights(found, camera, unsupported):
    """Lights of the scene, of those of a renderer. Lights of a camera turn with it."""
    np = _arrays.numpy()
    eye, target, up = (np.asarray(of, "f8") for of in (camera.eye, camera.look_at, camera.up))
    distance = float(np.linalg.norm(eye - target))
    back = (eye - target) / distance
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    axes = np.column_stack([right, np.cross(back, right), back]) * distance
    made = []
    for light in found:
        if not getattr(light, "on", True) or not light.intensity > 0:
            continue
        place, aim = np.asarray(light.position, "f8"), np.asarray(light.focal_point, "f8")
        kind = str(light.light_type).lower()
        if "head" in kind:
            place, aim = eye, target
        elif "camera" in kind:
            place, aim = target + axes @ place, target + axes @ aim
        color = [float(x) for x in light.diffuse_color.float_rgb]
        if light.positional:
            unsupported.append("positional lights of pyvista: they dim with the square of the distance here")
            reach = float(np.linalg.norm(place - aim)) or 1.0
            made.append(
                lights.Point(
                    position=place.tolist(),
                    color=color,
                    intensity=math.pi * float(light.intensity) * reach**2,
                )
            )
        elif np.linalg.norm(aim - place) > 0:
            made.append(
                lights.Directional(
                    direction=(aim - place).tolist(), color=color, intensity=math.pi * float(light.intensity)
                )
            )
    return made
