"""Renders one job of cycles.py with Blender's Cycles: python blender.py JOB.json

The job is a JSON object: `model` (a glTF or OBJ file), `texture` (for OBJ files without materials),
`camera` (eye, target, up and vertical field of view in degrees, with Y up), `environment`, `size`,
`samples`, `max_depth`, `seed`, `output` (a PFM file) and `changes`, names of functions of CHANGES.
"""

import json
import math
import sys
import tempfile
from pathlib import Path

sys.path.pop(0)  # Blender has an add-on `cycles`, which the script of this name would replace.
import bpy
import mathutils
import numpy as np


def blender_axes(v):
    """A vector with Y up as one with Z up."""
    return mathutils.Vector((v[0], -v[2], v[1]))


def import_model(job):
    """Imports a model in its rest pose."""
    path, changes = job["model"], job["changes"]
    if path.endswith(".obj"):
        bpy.ops.wm.obj_import(filepath=path)
        return
    from io_scene_gltf2.blender.imp.animation import BlenderAnimation
    BlenderAnimation.anim = staticmethod(lambda gltf, index: None)
    unit = "COMPAT" if "radiometric" in changes else "SPEC"
    bpy.ops.import_scene.gltf(filepath=path, export_import_convert_lighting_mode=unit)


def set_camera(camera, scene):
    """Places the camera."""
    eye, target, up = (blender_axes(camera[key]) for key in ("eye", "target", "up"))
    forward = (target - eye).normalized()
    right = forward.cross(up).normalized()
    up = right.cross(forward)
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "VERTICAL", math.radians(camera["vertical_fov_degrees"])
    distance = (target - eye).length
    data.clip_start, data.clip_end = distance * 1e-3, distance * 1e3
    placed = bpy.data.objects.new("camera", data)
    rows = [[right[i], up[i], -forward[i], eye[i]] for i in range(3)]
    placed.matrix_world = mathutils.Matrix([*rows, [0, 0, 0, 1]])
    scene.collection.objects.link(placed)
    scene.camera = placed


def set_environment(file, scene):
    """Surrounds the scene with a map whose left edge is at -Z (Y up), as in Juggler."""
    world = bpy.data.worlds.new("world")
    scene.world = world
    tree = world.node_tree
    tree.nodes.clear()
    names = ("TexCoord", "Mapping", "TexEnvironment", "Background", "OutputWorld")
    place, turn, image, background, output = (tree.nodes.new("ShaderNode" + name) for name in names)
    turn.inputs["Rotation"].default_value = (0, 0, math.pi / 2)
    image.image = bpy.data.images.load(file)
    tree.links.new(place.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], image.inputs["Vector"])
    tree.links.new(image.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs[0], output.inputs["Surface"])


def set_cycles(job, scene):
    """Selects an unbiased rendering without clamping, with a box filter."""
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.resolution_x, render.resolution_y, render.resolution_percentage = *job["size"], 100
    cycles.samples, cycles.seed = job["samples"], job["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_guiding = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    bounces = job["max_depth"] - 2
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max", "volume"):
        setattr(cycles, f"{kind}_bounces", bounces)
    scene.view_settings.view_transform = "Raw"
    settings = render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"


def materials():
    """All materials with their Principled node, if they have one."""
    for material in bpy.data.materials:
        if material.node_tree:
            kinds = {node.type: node for node in material.node_tree.nodes}
            if "BSDF_PRINCIPLED" in kinds:
                yield material, kinds["BSDF_PRINCIPLED"]


def cull_backs():
    """Hides the back of one-sided surfaces."""
    for material, principled in materials():
        if not material.use_backface_culling or principled.inputs["Transmission Weight"].default_value > 0:
            continue
        tree = material.node_tree
        output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        surface = output.inputs["Surface"].links[0].from_socket
        names = ("NewGeometry", "BsdfTransparent", "MixShader")
        geometry, transparent, mix = (tree.nodes.new("ShaderNode" + name) for name in names)
        tree.links.new(geometry.outputs["Backfacing"], mix.inputs[0])
        tree.links.new(surface, mix.inputs[1])
        tree.links.new(transparent.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])


def single_scattering():
    """Leaves out light that scatters several times between microfacets."""
    for _, principled in materials():
        principled.distribution = "GGX"


def default_material():
    """Gives primitives without material the metal of the glTF specification."""
    for material, principled in materials():
        if material.name == "DefaultMaterial":
            principled.inputs["Metallic"].default_value = principled.inputs["Roughness"].default_value = 1.0


def tint_interfaces():
    """Squares the base color of glass, whose square root Cycles takes for each interface."""
    for _, principled in materials():
        color = principled.inputs["Base Color"]
        if principled.inputs["Transmission Weight"].default_value > 0 and not color.links:
            color.default_value = [channel**2 for channel in color.default_value]


def half_specular():
    """Halves the specular level of MTL materials, of which Cycles takes 0.5 for a reflectance of 0.04."""
    for _, principled in materials():
        principled.inputs["Specular IOR Level"].default_value *= 0.5


def without_coat():
    """Leaves out clear coats."""
    for _, principled in materials():
        principled.inputs["Coat Weight"].default_value = 0.0


def without_normal_maps():
    """Shows surfaces without normal maps."""
    for material, principled in materials():
        for link in list(principled.inputs["Normal"].links):
            material.node_tree.links.remove(link)


def metal():
    """Makes all surfaces metal, which has one layer."""
    for _, principled in materials():
        principled.inputs["Metallic"].default_value = 1.0


def thin_walls():
    """Makes glass without a volume a thin wall, as the glTF specification has it."""
    for material, principled in materials():
        output = next(node for node in material.node_tree.nodes if node.type == "OUTPUT_MATERIAL")
        transmission = principled.inputs["Transmission Weight"]
        if not output.inputs["Volume"].links and (transmission.links or transmission.default_value > 0):
            principled.inputs["Thin Wall"].default_value = True


CHANGES = {function.__name__: function for function in
           (cull_backs, single_scattering, default_material, tint_interfaces, half_specular,
            without_coat, without_normal_maps, metal, thin_walls)}
CHANGES["radiometric"] = lambda: None  # by import_model


def texture_model(file):
    """Gives objects without material a Principled material with this texture."""
    material = bpy.data.materials.new("textured")
    tree = material.node_tree
    principled = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    principled.inputs["Roughness"].default_value = 0.5
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.load(file)
    tree.links.new(image.outputs["Color"], principled.inputs["Base Color"])
    for placed in bpy.data.objects:
        if placed.type == "MESH" and not placed.data.materials:
            placed.data.materials.append(material)


def write_pfm(path, result):
    """Saves the linear radiance of the rendered picture."""
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "picture.exr")
        result.save_render(file)
        image = bpy.data.images.load(file)
        image.colorspace_settings.name = "Non-Color"
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        width, height = image.size
        rows = pixels.reshape(height, width, -1)[:, :, :3]
    Path(path).write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + np.ascontiguousarray(rows).tobytes())


def main():
    """Renders the job."""
    job = json.loads(Path(sys.argv[1]).read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    import_model(job)
    if job.get("texture"):
        texture_model(job["texture"])
    for change in job["changes"]:
        CHANGES[change]()
    set_camera(job["camera"], scene)
    set_environment(job["environment"], scene)
    set_cycles(job, scene)
    bpy.ops.render.render()
    write_pfm(job["output"], bpy.data.images["Render Result"])
    print(json.dumps({"blender": bpy.app.version_string}))


if __name__ == "__main__":
    main()
