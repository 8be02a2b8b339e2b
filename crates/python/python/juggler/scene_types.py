# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""The scene and its parts that are no kinds of a family."""

from ._array_nodes import ArrayInstances
from ._node import Node
from ._placement import Placement
from ._scene_methods import SceneMethods

__all__ = [
    "Scene",
    "Path",
    "RenderSettings",
    "Tone",
    "WhiteBalance",
    "Move",
    "Screen",
    "ViewPlane",
    "InputProduct",
    "Stop",
    "Spread",
    "Medium",
    "Object",
    "MeshAttribute",
    "Morph",
    "Chain",
    "ControlSphere",
    "Limb",
    "Model",
    "Instances",
    "InstanceAttribute",
    "AxisRotation",
    "Attenuation",
    "Ies",
    "Animation",
]


class Scene(SceneMethods):
    """Scene: everything that determines the rendered image.

    Args:
        title (string): Title of the scene, for people.
        description (string): Description of the scene in one sentence, for people.
        include (string or list of strings): Paths of other scene files, relative to this one.
        animation (`Animation`): Length and frame rate of an animation.
        variables (dict from names to numbers, strings or lists of numbers or strings): Named
            numbers and vectors for expressions such as `"=2 * radius"`. A variable may refer to
            variables above it.
        paths (dict from names to `Path` objects): Named curves for the value form `along`. A scene
            that is saved at a single frame has no paths.
        render (`RenderSettings`): Render settings: image size, samples, shutter, integrator,
            sampler and filter.
        tone (`Tone`): Tone mapping from linear radiance to the pixel values of an image file.
        camera (camera): Camera of a scene with a single camera. Without `camera` and `cameras`, a
            default camera sees all objects.
        cameras (dict from names to cameras): Cameras by name, in place of `camera`. The first is
            used unless `render.camera` or the command line selects another.
        background (color or background): Radiance of rays that leave the scene. Defaults to black,
            or to a uniform gray of 0.25 in a scene without lights and emissive materials.
        background_light_group (string): Light group of the background; each light group is written
            to an AOV of its own. Without it, the background belongs to the group `rest`.
        textures (dict from names to textures): Textures by name.
        materials (dict from names to materials): Materials by name.
        groups (dict from names to lists of `Object` objects): Groups of objects by name, which
            objects place any number of times. Groups may place other groups. Large groups with many
            placements are stored once and instanced.
        lights (list of lights): Lights. A scene without lights, without emissive materials and
            without a background that lights it gets a default light above the camera. An
            `environment` and a `sky` light the scene; with the integrators `path` and `direct`, so
            does every other background that is not black.
        objects (list of `Object` objects; default []): Objects of the scene, in world space.

    Example:
        Scene(objects=[Object(shapes.Plane()), Object(shapes.Sphere(radius=1)).translate(0, 1, 0)])
    """

    __slots__ = (
        "title",
        "description",
        "include",
        "animation",
        "variables",
        "paths",
        "render",
        "tone",
        "camera",
        "cameras",
        "background",
        "background_light_group",
        "textures",
        "materials",
        "groups",
        "lights",
        "objects",
    )
    _constants = {"version": 1}


class Path(Node):
    """Curve through points, for the value form `along`: `{"along": {"path": NAME, "at": SHARE}}`.

    The curve is a centripetal Catmull-Rom spline. It passes through all points in order with a
    continuous tangent and stays close to straight lines between points that are close to each
    other. Consecutive equal points count as one.

    Args:
        points (1 to 10000 groups of 3 numbers; required): Points `[x, y, z]` that the curve passes
            through, in the space of the value that uses the path.
        closed (True or False; default False): Whether the curve continues from the last point back
            to the first. Set it for cyclic motion: a closed path can be followed any number of
            times.

    Example:
        Path([(0, 0, 0), (1, 0, 2), (3, 1, 2)], closed=True)
    """

    __slots__ = ("points", "closed")
    _positional = ("points",)
    _required = ("points",)


class RenderSettings(Node):
    """Render settings: image size, sampling, shutter and integrator.

    Args:
        size (2 whole numbers from 1 to 65536; default (640, 360)): Width and height of the image in
            pixels; at most 2³¹ pixels in total.
        samples (whole number from 1 to 16777216; default 16): Samples per pixel. Four times as many
            samples halve the noise and take four times as long.
        seed (whole number from 0; default 0): Seed of the sampler. The same seed reproduces an
            image bit for bit; another seed gives other noise.
        camera (string): Name of the camera to render with. Defaults to the first camera.
        shutter (2 numbers from -1000 to 1000): Times at which the shutter opens and closes, in
            frames relative to the frame's own time, in this order. Motion in between is blurred.
            `[0, 0.5]` is the 180° shutter of a movie camera; the default `[0, 0]` disables motion
            blur.
        transparent (True or False): Whether the background is transparent: the camera does not see
            it, also through glass, and PNG, WebP and EXR files store alpha. Its light stays.
        integrator (integrator): Light transport algorithm. Defaults to `path` if the scene contains
            anything that `classic` does not support: an `emissive` material, an `area` light, an
            `environment` or a `sky`, a medium, any material except `phong` and combinations of it.
            Otherwise defaults to `classic`. `juggler info` prints the choice and its reason.
        sampler (sampler; default "sobol"): Sampler: distribution of the samples in pixel, lens,
            time and light dimensions.
        filter (filter; default "box"): Reconstruction filter, which weights the samples near a
            pixel.

    Example:
        RenderSettings(size=(1280, 720), samples=256, integrator=integrators.Path(max_depth=8))
    """

    __slots__ = (
        "size",
        "samples",
        "seed",
        "camera",
        "shutter",
        "transparent",
        "integrator",
        "sampler",
        "filter",
    )


class Tone(Node):
    """Tone mapping from linear RGB to the levels of an image file. EXR, HDR and PFM files store
    linear values and ignore these settings, except for the primaries of EXR.

    Args:
        curve (curve; default "srgb"): Tone curve. The default `srgb` clips values above 1;
            `reinhard`, `aces`, `agx` and `pbr_neutral` compress highlights instead.
        exposure_stops (number from -64 to 64; default 0): Exposure in photographic stops, -64 to
            64, applied before the curve: 1 doubles the radiance, -1 halves it.
        white_balance (`WhiteBalance`): Light that appears white. By default colors are unchanged,
            so that D65 (6,504 K) appears white.
        primaries ("srgb", "display_p3", "rec2020" or "acescg"; default "srgb"): Primaries of the
            file. PNG supports `display_p3` and `rec2020`, EXR these and `acescg`; the other formats
            support sRGB only.
        dither (True or False; default True): Dithers 8-bit images, so that gradients show no
            banding; exact levels are preserved. Movies, images with a display look and interactive
            previews are never dithered.
        backdrop (color): Color behind a transparent picture (`render.transparent`) as displays show
            it: the curve leaves it as it is, so that white stays white. By default the file has
            alpha; EXR files always have it.

    Example:
        Tone(curve=curves.Agx(), exposure_stops=1)
    """

    __slots__ = ("curve", "exposure_stops", "white_balance", "primaries", "dither", "backdrop")


class WhiteBalance(Node):
    """Light source that appears white.

    Args:
        kelvin (number from 1667 to 25000; K; default 6504): Correlated color temperature of the
            light in kelvin, 1667 to 25000; 2850 is an incandescent bulb, the default 6504 is D65.
            Lower values make the image bluer.
        tint (number from -50 to 50; 0.001 Duv; default 0): Distance of the light from the Planckian
            or daylight locus in thousandths of Duv (ANSI C78.377), -50 to 50. Positive values state
            that the light is greenish and make the image more magenta.

    Example:
        WhiteBalance(kelvin=4000)
    """

    __slots__ = ("kelvin", "tint")


class Move(Node):
    """Translation along the camera's axes, in scene units.

    Args:
        right (number; scene units; default 0): Distance to the picture's right.
        up (number; scene units; default 0): Distance to the picture's top.
        forward (number; scene units; default 0): Distance into the picture.

    Example:
        Move(forward=1)
    """

    __slots__ = ("right", "up", "forward")


class Screen(Node):
    """Field of view as a virtual screen in front of the eye. The aspect ratio of the picture gives
    its height, so pixels are square.

    Args:
        width (number above 0; required): Width in scene units, above 0.
        distance (number above 0; required): Distance from the eye in scene units, above 0.

    Example:
        Screen(0.036, 0.05)
    """

    __slots__ = ("width", "distance")
    _positional = ("width", "distance")
    _required = ("width", "distance")


class ViewPlane(Node):
    """Field of view as a virtual screen of a given width and height. A picture of another aspect
    ratio is stretched over it.

    Args:
        width (number above 0; required): Width in scene units, above 0.
        height (number above 0; required): Height in scene units, above 0.
        distance (number above 0; required): Distance from the eye in scene units, above 0.

    Example:
        ViewPlane(width=4, height=3, distance=5)
    """

    __slots__ = ("width", "height", "distance")
    _required = ("width", "height", "distance")


class InputProduct(Node):
    """Product of a texture, a factor and an attribute of the mesh. At least a texture or an
    attribute is required. Products outside of the input's range are clamped, as values of textures
    are.

    Args:
        texture (texture or the name of one): Texture: inline, or the name of one. Numbers use its
            luminance. Without it, the product consists of the other parts.
        factor (color): Constant factor, in the range of the input; without it, 1.
        attribute (string): Name of an attribute of the mesh, such as `color`. Colors use its red,
            green and blue, numbers its alpha, which is 1 where the attribute has fewer than four
            channels. Surfaces without an attribute of this name count as white. For other channels,
            use the texture `attribute`.

    Example:
        InputProduct(texture="wood", factor=(1, 0.5, 0.5), attribute="color")
    """

    __slots__ = ("texture", "factor", "attribute")


class Stop(Node):
    """Color at a position of a gradient or ramp.

    Args:
        position (number; required): Position: from 0 at a gradient's start to 1 at its end, or the
            number that a ramp maps.
        color (color, texture, the name of one or `InputProduct`; required): Color at the position.

    Example:
        Stop(0.5, "#c02020")
    """

    __slots__ = ("position", "color")
    _positional = ("position", "color")
    _required = ("position", "color")


class Spread(Node):
    """Cone of rays around a reflected or refracted direction.

    Args:
        half_angle_degrees (number from 0 to 90; default 0): Half of the cone's opening angle, in
            degrees. 0 gives sharp images, larger values blur more.
        rays (whole number from 1 to 10000; default 1): Rays per sample in the integrator `classic`.
            More rays reduce noise.

    Example:
        Spread(half_angle_degrees=5, rays=4)
    """

    __slots__ = ("half_angle_degrees", "rays")


class Medium(Node):
    """Homogeneous participating medium.

    Args:
        absorption (color; 1/scene unit; default (0, 0, 0)): Absorption coefficient per channel, per
            scene unit, 0 to 1e12: 1 leaves 1/e of the light after one unit.
        scattering (color; 1/scene unit; default (0, 0, 0)): Scattering coefficient per channel, per
            scene unit, 0 to 1e12. Black leaves the medium clear.
        anisotropy (number from -0.999 to 0.999; default 0): Mean cosine g of the scattering angle
            in the phase function of Henyey and Greenstein (1941). 0 scatters isotropically,
            positive values forward: fog has some 0.8.
        color (color; default (1, 1, 1)): Color of white light after `distance`, 0 to 1 per channel:
            a convenient way to state absorption, which is added to `absorption`.
        distance (number from 1e-12; default 1): Distance over which white light takes the color
            `color`, in scene units.

    Example:
        Medium(color=(0.4, 0.9, 0.5), distance=2)
    """

    __slots__ = ("absorption", "scattering", "anisotropy", "color", "distance")


class Object(Placement):
    """Object of the scene. Requires exactly one of `shape`, `group`, `objects`, `chain`, `limb` and
    `model`.

    Args:
        name (string): Name of the object. In the scene's own `objects`, it identifies the object in
            masks; objects of equal name share a mask. It does not affect the image.
        shape (shape): Single shape.
        group (string): Name of a group of the scene, all of whose objects are placed.
        objects (list of `Object` objects): Child objects, with this object's transform applied to
            all of them.
        chain (`Chain`): Row of spheres between two end spheres.
        limb (`Limb`): Spheres along two bones that meet in a joint.
        model (`Model`): Model file of another format.
        instances (`Instances`): Instances of the object: it is placed once for each of them, then
            by `transform`. In memory, a scene may have millions.
        transform (list of transform steps or transform step): Transform from the object's space to
            that of its parent: a list of steps, applied in order, or a single step. Defaults to the
            identity.
        material (material or the name of one): Material: inline, or the name of a material of the
            scene. Defaults to the material of the enclosing object or group, or else to a gray
            diffuse `phong` material.
        light_group (string): Light group of the emitters inside this object; each light group is
            written to an AOV of its own. It has an effect only in the scene's own `objects`.
            Without it, the object belongs to the group `rest`.
        shadow_catcher (True or False): Whether the object is a shadow catcher: in a transparent
            picture ([`transparent` ](Render::transparent)) the camera sees only the shadows that
            other objects cast on it, as black whose alpha is the lost fraction of the light. Other
            objects see the whole object. It has an effect only in the scene's own `objects`.
        visible (True, False or number): Whether the scene contains the object with its children.
            Numbers other than 0 count as `true`, so an expression such as `"=seconds >= 1"` can
            show and hide the object.

    Example:
        Object(shapes.Sphere(), material="gold").translate(0, 1, 0)
    """

    __slots__ = (
        "name",
        "shape",
        "group",
        "objects",
        "chain",
        "limb",
        "model",
        "instances",
        "transform",
        "material",
        "light_group",
        "shadow_catcher",
        "visible",
    )
    _positional = ("shape",)


class MeshAttribute(Node):
    """Named attribute of a mesh, for the texture `attribute`.

    Args:
        domain ("vertex" or "face"; default "vertex"): Whether each vertex or each triangle has a
            value.
        channels (whole number from 1 to 4; required): Numbers per value, 1 to 4: gray; red and
            green; red, green and blue; red, green, blue and alpha.
        data (attribute array; required): Numbers of all values, in linear light: `channels` for
            each vertex or triangle, in the order of `positions` or `triangles`.

    Example:
        MeshAttribute(1, {"f32": [0, 0.5, 1]}, domain="vertex")
    """

    __slots__ = ("domain", "channels", "data")
    _positional = ("channels", "data")
    _required = ("channels", "data")


class Morph(Node):
    """Morph target (blend shape) of a mesh: target positions of its corners and a weight. The
    mesh's normals and tangents are blended with the target's normals and tangents. If a target has
    no normals, new normals are computed from the blended surface; if a target has no tangents, the
    mesh keeps its tangents.

    Args:
        file (string): Model file with as many corners as the mesh, relative to the scene file,
            instead of `positions`, `normals` and `tangents`.
        positions (list of groups of 3 numbers): Target positions in scene units, one for each of
            the mesh's.
        normals (list of groups of 3 numbers): Target normals, one for each position, of any length.
            By default the mesh's normals are computed anew from the blended surface.
        tangents (list of groups of 4 numbers): Target tangents, one for each position: x, y, z and
            a sign, which is not used. By default the mesh's tangents stay.
        weight (number from -100 to 100; default 0): Weight of the displacement from the mesh to the
            target, -100 to 100: 0 has no effect, 1 reaches the target, and values outside 0 to 1
            extrapolate.

    Example:
        Morph(file="smile.ply", weight=0.5)
    """

    __slots__ = ("file", "positions", "normals", "tangents", "weight")


class Chain(Node):
    """Spheres in a row, with centers and radii interpolated linearly.

    Args:
        from_ (`ControlSphere`; required): First sphere.
        to (`ControlSphere`; required): Sphere at the other end.
        count (whole number from 1 to 100000; required): Number of spheres.
        include_last (True or False; default True): Whether the row includes the sphere `to`. With
            `false`, it ends one step before, so that the next chain can begin there without a
            duplicate sphere.

    Example:
        Chain(from_=ControlSphere((0, 0, 0), 0.2), to=ControlSphere((0, 2, 0), 0.1), count=10)
    """

    __slots__ = ("from_", "to", "count", "include_last")
    _required = ("from_", "to", "count")
    _keys = {"from_": "from"}


class ControlSphere(Node):
    """Sphere at one end of a chain.

    Args:
        center (3 numbers; scene units; required): Center, in object space.
        radius (number above 0; scene units; required): Radius, in units of object space.

    Example:
        ControlSphere((0, 1, 0), 0.5)
    """

    __slots__ = ("center", "radius")
    _positional = ("center", "radius")
    _required = ("center", "radius")


class Limb(Node):
    """Arm or leg: spheres along two bones that meet in a joint.

    The limb bends from the line between its ends toward the direction of the cross product (to −
    from) × `plane_normal`. The distance between the ends must not exceed the sum of the lengths,
    nor fall below their difference.

    Args:
        from_ (3 numbers; scene units; required): One end, in object space: a hand or a foot.
        to (3 numbers; scene units; required): Other end, in object space: a shoulder or a hip.
        lengths (2 numbers above 0; scene units; required): Lengths of the bones at `from` and at
            `to`.
        plane_normal (3 numbers; required): Normal of the plane in which the limb bends, in the
            space of `from` and `to`. It has any length except zero and must not be parallel to `to
            − from`.
        counts (2 whole numbers from 1 to 100000; default (8, 8)): Number of spheres on the bones at
            `from` and at `to`; the joint has one more sphere.
        keep_lengths (True or False; default True): Whether the bones keep their lengths if
            `plane_normal` is not perpendicular to `to − from`. With `false`, the joint moves closer
            to the line between the ends, as in the Juggler of 2010, whose forearms are up to 1 %
            too short.
        radii (3 numbers above 0; scene units; required): Radii at `from`, at the joint and at `to`,
            interpolated linearly in between.

    Example:
        Limb(from_=(0, 0, 0), to=(1.5, 0, 0), lengths=(1, 1), plane_normal=(0, 0, 1), radii=(0.1, 0.1, 0.1))
    """

    __slots__ = ("from_", "to", "lengths", "plane_normal", "counts", "keep_lengths", "radii")
    _required = ("from_", "to", "lengths", "plane_normal", "radii")
    _keys = {"from_": "from"}


class Model(Node):
    """Scene of a model file (glTF), placed as one object. Its materials, textures, lights and
    cameras belong to the scene too, under names that begin with the name of the file.

    Args:
        file (string; required): Model file, relative to the scene file.
        scene (whole number from 0 or string): Scene of the file, by name or index. Defaults to the
            file's own choice.
        variant (whole number from 0 or string): Variant of the materials, by name or index.
            Defaults to the materials without a variant.
        animation (whole number from 0 or string): Animation clip, by name or index; `"none"` shows
            the rest pose. Defaults to the first clip.
        at (number; seconds): Time in the clip. Defaults to the time of the scene.
        repeat ("loop" or "once"; default "loop"): What happens after the end of the clip.
        materials (dict from names to materials or names of them): Materials that replace those of
            the file, by the names of the file's materials.
        nodes (list of strings): Names of nodes. If there are any, only these nodes are placed, with
            the nodes below them.
        hide (list of strings): Names of nodes that are not placed, nor the nodes below them.
        lights (True or False; default True): Whether the lights of the file belong to the scene.
        photometric (True or False; default False): Whether light intensities of the file are
            photometric (candela, lux). They are then divided by 683 lm/W.

    Example:
        Model("fox.glb", animation="Run")
    """

    __slots__ = (
        "file",
        "scene",
        "variant",
        "animation",
        "at",
        "repeat",
        "materials",
        "nodes",
        "hide",
        "lights",
        "photometric",
    )
    _positional = ("file",)
    _required = ("file",)


class Instances(ArrayInstances):
    """Transforms of the instances of an object, each to the object's space, and their attributes,
    from a file or from the arrays given here. `matrices` give whole transforms; without them, each
    instance is scaled, then rotated, then translated. All arrays that are not empty have the same
    length.

    Args:
        file (string): PLY file of points, relative to the scene file: each of its vertices is an
            instance at `x y z`. The columns `qx qy qz qw` are the rotations, `scale` or `scale_x
            scale_y scale_z` the scale factors, and `m00` to `m23`, row by row, the matrices in
            place of all of these. `red green blue` and perhaps `alpha` are the colors. Every other
            column of numbers is an attribute of its name; columns `attribute.NAME.0` to
            `attribute.NAME.3` are one attribute NAME of several numbers. The arrays below may add
            what the file does not have.
        positions (list of groups of 3 numbers): Positions of the instances' origins.
        rotations (list of groups of 4 numbers): Rotations as quaternions `[x, y, z, w]` as in glTF.
            They are normalized and must not be zero.
        scales (list of numbers or groups of 3 numbers): Scale factors, other than 0: one, or one
            for each axis.
        matrices (list of groups of 12 numbers): Affine maps in place of positions, rotations and
            scales: the 12 numbers of 3 rows of a matrix that multiplies column vectors. The
            matrices must be invertible.
        colors (list of groups of 4 numbers): Colors: red, green, blue and alpha of each instance,
            from 0 to 1 in linear light. They are the attribute `color`; a material shows them by
            the texture [`attribute`](#texture-attribute).
        end_colors (list of groups of 4 numbers): Colors at the surface coordinate v = 1, such as
            the upper end of a `cylinder`. `colors` are then those at v = 0, and the colors between
            are interpolated linearly. Needs `colors`.
        attributes (dict from names to `InstanceAttribute` objects): Named attributes of the
            instances, for the texture [`attribute`](#texture-attribute). A mesh that has an
            attribute of the same name shows its own. Of nested instances, the innermost that have
            an attribute of the name count.

    Example:
        Instances(positions=[(0, 0, 0), (2, 0, 0)], scales=[1, 0.5])
    """

    __slots__ = (
        "file",
        "positions",
        "rotations",
        "scales",
        "matrices",
        "colors",
        "end_colors",
        "attributes",
    )


class InstanceAttribute(Node):
    """Named attribute of instances, for the texture `attribute`.

    Args:
        channels (whole number from 1 to 4; required): Numbers per instance, 1 to 4: gray; red and
            green; red, green and blue; red, green, blue and alpha.
        data (attribute array; required): Numbers of all instances, in linear light: `channels` for
            each of them.

    Example:
        InstanceAttribute(1, {"f32": [0, 0.5, 1]})
    """

    __slots__ = ("channels", "data")
    _positional = ("channels", "data")
    _required = ("channels", "data")


class AxisRotation(Node):
    """Right-handed rotation about an axis through the origin.

    Args:
        axis (3 numbers; required): Rotation axis, of any length except zero.
        degrees (number; degrees; required): Rotation angle, counterclockwise as seen from the tip
            of the axis.

    Example:
        AxisRotation(axis=(0, 1, 0), degrees=30)
    """

    __slots__ = ("axis", "degrees")
    _positional = ("axis", "degrees")
    _required = ("axis", "degrees")


class Attenuation(Node):
    """Falloff with the distance d from the light's center: the factor 1 / (constant + linear · d +
    quadratic · d²). The default is the physical inverse square.

    A missing coefficient is 0: `{"constant": 1}` gives light without falloff. At least one
    coefficient must be above 0.

    Args:
        constant (number from 0; default 0): Constant coefficient, 0 or more.
        linear (number from 0; default 0): Coefficient of the distance, 0 or more.
        quadratic (number from 0; default 0): Coefficient of the squared distance, 0 or more.

    Example:
        Attenuation(quadratic=1)
    """

    __slots__ = ("constant", "linear", "quadratic")


class Ies(Node):
    """Photometric file (IES LM-63): the measured distribution of a luminaire's intensity over
    directions.

    Args:
        file (string; required): Path of the file, relative to the scene file. Its photometry must
            be of type C.
        direction (3 numbers): Direction of vertical angle 0, of any length. The default is the
            direction of a spot light, and straight down, along -Y, for other lights.
        rotation_degrees (number from -10000 to 10000; default 0): Rotation of the luminaire about
            that direction, in degrees from -10,000 to 10,000, counterclockwise as seen from behind
            the luminaire. At 0, the horizontal angle 0 points along +X if the luminaire hangs down.
        absolute (True or False; default False): Whether the intensity is multiplied by the file's
            candelas. By default it is multiplied by the candelas relative to their maximum, so that
            the file changes only the distribution.

    Example:
        Ies("downlight.ies", rotation_degrees=90)
    """

    __slots__ = ("file", "direction", "rotation_degrees", "absolute")
    _positional = ("file",)
    _required = ("file",)


class Animation(Node):
    """Length and frame rate of an animation.

    Args:
        frames (whole number from 1 to 1000000; default 1): Number of frames. The default of 1
            describes a still image.
        frames_per_second (number above 0 to 1000; frames/second; default 30): Frame rate: playback
            speed, and the ratio of `frame` to `seconds` in expressions.

    Example:
        Animation(frames=96, frames_per_second=24)
    """

    __slots__ = ("frames", "frames_per_second")
