"""Small models of extensions, each with the same material, node or clip as a scene of our own format.

Both must give pictures equal in every byte: the extension means what the scene format says.
"""

import base64
import json
import math
from pathlib import Path

import numpy as np

import png
from large import Model

# The material of all models, in glTF and in the scene format.
BASE = {"name": "M", "doubleSided": True,
        "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.5, 0.25, 1], "metallicFactor": 0, "roughnessFactor": 0.5}}
OURS = {"base_color": [0.8, 0.5, 0.25], "roughness": 0.5}
GLASS = {"KHR_materials_transmission": {"transmissionFactor": 1}}
SOLID = GLASS | {"KHR_materials_volume": {"thicknessFactor": 1}}


def ball(columns=32, rows=16):
    """Positions, normals, texture coordinates and indices of a sphere."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    around, down = 2 * np.pi * u, np.pi * v
    normals = np.stack([np.sin(down) * np.sin(around), np.cos(down), np.sin(down) * np.cos(around)], -1)
    normals = normals.reshape(-1, 3).astype(np.float32)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1)
    below = first + columns + 1
    corners = np.stack([first, below, first + 1, first + 1, below, below + 1], -1)
    return normals, np.stack([u, v], -1).reshape(-1, 2).astype(np.float32), corners.reshape(-1).astype(np.uint32)


def model(extensions=None, **more):
    """A ball whose material has these extensions."""
    result = Model()
    normals, uvs, corners = ball()
    mesh = result.mesh(normals, normals, corners)
    result.json["meshes"][mesh]["primitives"][0]["attributes"]["TEXCOORD_0"] = result.accessor(uvs, "VEC2")
    result.json["meshes"][mesh]["primitives"][0]["material"] = 0
    result.json["materials"] = [BASE | ({"extensions": extensions} if extensions else {}) | more]
    use(result, *(extensions or {}))
    return result


def use(result, *names):
    """Declares extensions."""
    result.json["extensionsUsed"] = sorted({*result.json.get("extensionsUsed", []), *names})


def placed(result, **node):
    """Adds a node with the mesh; returns the model."""
    result.node(mesh=0, **node)
    return result


def materials():
    """Cases of materials: name, extensions of the model, settings of `principled`."""
    for color, roughness in (([1, 0.9, 0.8], 0.3), ([0.1, 0.3, 0.9], 0.8), ([0.5, 0.5, 0.5], 0)):
        yield ("sheen", {"KHR_materials_sheen": {"sheenColorFactor": color, "sheenRoughnessFactor": roughness}},
               {"sheen_color": color, "sheen_roughness": roughness})
    for weight, color in ((0, [1, 1, 1]), (0.5, [1, 0.2, 0.2]), (1, [4, 4, 1])):
        yield ("specular", {"KHR_materials_specular": {"specularFactor": weight, "specularColorFactor": color}},
               {"specular": weight, "specular_color": color})
    for weight, ior, thickness in ((1, 1.3, 400), (0.5, 1.8, 250), (1, 1.1, 900)):
        film = {"iridescenceFactor": weight, "iridescenceIor": ior, "iridescenceThicknessMaximum": thickness}
        yield ("iridescence", {"KHR_materials_iridescence": film},
               {"iridescence": weight, "iridescence_ior": ior, "iridescence_thickness": thickness})
    for strength, rotation in ((0.3, 0), (0.7, 0.5), (1, 2.5)):
        brushed = {"anisotropyStrength": strength, "anisotropyRotation": rotation}
        yield ("anisotropy", {"KHR_materials_anisotropy": brushed},
               {"anisotropy": strength, "anisotropy_rotation": rotation / (2 * math.pi)})
    for weight, roughness in ((1, 0), (0.5, 0.3), (0.25, 1)):
        yield ("clearcoat", {"KHR_materials_clearcoat": {"clearcoatFactor": weight, "clearcoatRoughnessFactor": roughness}},
               {"clearcoat": weight, "clearcoat_roughness": roughness})
    for strength in (0.1, 0.7, 3):
        yield ("dispersion", SOLID | {"KHR_materials_dispersion": {"dispersion": strength}},
               {"transmission": 1, "dispersion": strength})
    for weight, color in ((0.3, [1, 1, 1]), (0.7, [0.2, 0.9, 0.1]), (1, [0.9, 0.3, 0.3])):
        leaf = {"diffuseTransmissionFactor": weight, "diffuseTransmissionColorFactor": color}
        yield ("diffuse_transmission", {"KHR_materials_diffuse_transmission": leaf},
               {"diffuse_transmission": weight, "diffuse_transmission_color": color, "thin": True})
    for ior in (1, 1.33, 2.42):
        yield ("ior", SOLID | {"KHR_materials_ior": {"ior": ior}}, {"transmission": 1, "ior": ior})
    for color, distance in (([0.9, 0.5, 0.1], 0.5), ([0.2, 0.8, 0.9], 2), ([1, 1, 1], 1)):
        volume = {"thicknessFactor": 0.5, "attenuationColor": color, "attenuationDistance": distance}
        yield ("volume", GLASS | {"KHR_materials_volume": volume},
               {"transmission": 1, "medium": {"color": color, "distance": distance}})
    yield "transmission", GLASS, {"transmission": 1, "thin": True}
    for strength in (1, 5):
        yield ("emissive_strength", {"KHR_materials_emissive_strength": {"emissiveStrength": strength}},
               {"emissive": [0.5, 0.25, 1], "emissive_strength": strength})
    for diffuse, specular, gloss in (([0.6, 0.3, 0.1], [0.04, 0.04, 0.04], 0.5), ([0, 0, 0], [1, 0.75, 0.25], 0.75)):
        glossy = {"diffuseFactor": [*diffuse, 1], "specularFactor": specular, "glossinessFactor": gloss}
        yield ("pbrSpecularGlossiness", {"KHR_materials_pbrSpecularGlossiness": glossy},
               {"base_color": diffuse, "specular_color": specular, "ior": 0, "roughness": 1 - gloss})


def material_cases(folder):
    """Pairs of scenes: the material of the model, and that of the scene format in its place."""
    for number, (name, extensions, ours) in enumerate(materials()):
        more = {"emissiveFactor": [0.5, 0.25, 1]} if name == "emissive_strength" else {}
        if name == "pbrSpecularGlossiness":
            more["pbrMetallicRoughness"] = {}
        path = placed(model(extensions, **more)).write(folder / f"{number}.glb")
        yield f"{name} {json.dumps(ours)}", {"file": path}, {"file": path, "materials": {"M": {"principled": OURS | ours}}}


def node_cases(folder):
    """Pairs of lists of objects: variants, visibility, instances, animated properties."""
    painted = {"principled": OURS | {"base_color": [0.1, 0.2, 0.7]}}
    blue = BASE["pbrMetallicRoughness"] | {"baseColorFactor": [0.1, 0.2, 0.7, 1]}
    varied = placed(model())
    varied.json["materials"].append(BASE | {"name": "Blue", "pbrMetallicRoughness": blue})
    varied.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "plain"}, {"name": "blue"}]}}
    mappings = [{"material": 1, "variants": [1]}]
    varied.json["meshes"][0]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
    use(varied, "KHR_materials_variants")
    path = varied.write(folder / "variants.glb")
    yield "variants", [{"file": path, "variant": "blue"}], [{"file": path, "materials": {"M": painted}}]

    hidden = placed(placed(model(), name="A"), name="B", translation=[1.5, 0, 0],
                    extensions={"KHR_node_visibility": {"visible": False}})
    use(hidden, "KHR_node_visibility")
    path = hidden.write(folder / "visibility.glb")
    yield "node_visibility", [{"file": path}], [{"file": path, "hide": ["B"]}]

    many = model()
    offsets = np.array([[-1.5, 0, 0], [0, 0, 0.5], [1.5, 0.25, 0]], np.float32)
    scales = np.array([[0.5, 0.5, 0.5], [1, 1, 1], [0.25, 0.75, 0.5]], np.float32)
    attributes = {"TRANSLATION": many.accessor(offsets, "VEC3"), "SCALE": many.accessor(scales, "VEC3")}
    placed(many, extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})
    use(many, "EXT_mesh_gpu_instancing")
    apart = model()
    for offset, scale in zip(offsets.tolist(), scales.tolist()):
        placed(apart, translation=offset, scale=scale)
    pair = [[{"file": one.write(folder / name)}] for one, name in ((many, "many.glb"), (apart, "apart.glb"))]
    yield "gpu_instancing", *pair

    animated = placed(model())
    keys = animated.accessor(np.array([0, 1], np.float32), "SCALAR")
    animated.json["accessors"][keys] |= {"min": [0], "max": [1]}
    values = animated.accessor(np.array([0, 1], np.float32), "SCALAR")
    pointer = "/materials/0/pbrMetallicRoughness/roughnessFactor"
    target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}
    animated.json["animations"] = [{"name": "Clip", "samplers": [{"input": keys, "output": values}],
                                    "channels": [{"sampler": 0, "target": target}]}]
    use(animated, "KHR_animation_pointer")
    path = animated.write(folder / "pointer.glb")
    for at in (0, 0.25, 0.75):
        override = {"M": {"principled": OURS | {"roughness": at}}}
        yield (f"animation_pointer at {at}", [{"file": path, "at": at}],
               [{"file": path, "animation": "none", "materials": override}])


def panorama(colors, height):
    """A PFM file of a cube map of constant faces +x, -x, +y, -y, +z, -z that a quarter about y rotates."""
    def samples(count):
        return (np.repeat(np.arange(count), 2) + np.tile([0.25, 0.75], count)) / count
    v, u = np.meshgrid(samples(height), samples(height * 2), indexing="ij")
    x, y, z = np.sin(np.pi * v) * np.sin(2 * np.pi * u), np.cos(np.pi * v), -np.sin(np.pi * v) * np.cos(2 * np.pi * u)
    x, z = -z, x
    size = np.abs([x, y, z])
    axis = size.argmax(0)
    face = 2 * axis + (np.take_along_axis(np.stack([x, y, z]), axis[None], 0)[0] < 0)
    found = np.float32(colors)[face].reshape(height, 2, height * 2, 2, 3)
    # In the order of the program: the rows of the first column, then those of the second.
    image = (found[:, 0, :, 0] + found[:, 1, :, 0] + found[:, 0, :, 1] + found[:, 1, :, 1]) * np.float32(0.25)
    return b"PF\n%d %d\n-1.0\n" % (height * 2, height) + image[::-1].astype("<f4").tobytes()


def light_cases(folder):
    """Pairs of scenes without background: image-based lights and light profiles."""
    bright = placed(model())
    levels = [[255, 0, 0, 128], [0, 255, 0, 255], [0, 0, 255, 51], [255, 255, 0, 255], [255, 255, 255, 85], [0, 255, 255, 255]]
    faces = [base64.b64encode(png.encode(np.full((4, 4, 4), level, np.uint8))).decode() for level in levels]
    bright.json["images"] = [{"uri": f"data:image/png;base64,{face}"} for face in faces]
    light = {"intensity": 0.5, "rotation": [0, math.sqrt(0.5), 0, math.sqrt(0.5)], "specularImageSize": 4,
             "specularImages": [list(range(6))], "irradianceCoefficients": [[0, 0, 0]] * 9}
    bright.json["extensions"] = {"EXT_lights_image_based": {"lights": [light]}}
    bright.json["scenes"][0]["extensions"] = {"EXT_lights_image_based": {"light": 0}}
    use(bright, "EXT_lights_image_based")
    path = bright.write(folder / "image-based.glb")
    colors = [[np.float32((level > 0) / (alpha / 255)) for level in color] for *color, alpha in levels]
    (folder / "image-based.pfm").write_bytes(panorama(colors, 8))
    environment = {"environment": {"file": "image-based.pfm", "scale": 0.5}}
    objects = [{"model": {"file": path}}]
    yield ("lights_image_based", {"objects": objects},
           {"objects": [{"model": {"file": path, "lights": False}}], "background": environment})

    profile = ("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 5 1 1 1 0 0 0\n1 1 100\n0 22.5 45 67.5 90\n0\n"
               "100 80 60 20 5\n")
    (folder / "profile.ies").write_text(profile)
    for multiplier, color in ((1, [1, 1, 1]), (0.25, [1, 0.5, 0.25])):
        lit = placed(model())
        uri = "data:application/octet-stream;base64," + base64.b64encode(profile.encode()).decode()
        lit.json["extensions"] = {"EXT_lights_ies": {"lights": [{"uri": uri}]}}
        lit.node(translation=[0, 3, 0], rotation=[-math.sqrt(0.5), 0, 0, math.sqrt(0.5)],
                 extensions={"EXT_lights_ies": {"light": 0, "multiplier": multiplier, "color": color}})
        use(lit, "EXT_lights_ies")
        path = lit.write(folder / f"ies{multiplier}.glb")
        point = {"position": [0, 3, 0], "color": color, "intensity": multiplier,
                 "ies": {"file": "profile.ies", "direction": [0, -1, 0], "absolute": True}}
        yield (f"lights_ies {multiplier}", {"objects": [{"model": {"file": path}}], "background": {"solid": {"color": 0}}},
               {"objects": [{"model": {"file": path, "lights": False}}], "background": {"solid": {"color": 0}},
                "lights": [{"point": point}]})


def cases(folder):
    """Names and pairs of scene files whose pictures must be equal."""
    folder = Path(folder)
    studio = {"background": {"studio": {}}}
    listed = [(name, [one], [other]) for name, one, other in material_cases(folder)] + list(node_cases(folder))
    pairs = [(name, *(studio | {"objects": [{"model": one} for one in side]} for side in sides)) for name, *sides in listed]
    for number, (name, *sides) in enumerate(pairs + list(light_cases(folder))):
        files = []
        for side, parts in zip("ab", sides):
            scene = {"version": 1, "render": {"integrator": "path"}, **parts,
                     "camera": {"perspective": {"eye": [1, 1.5, 5], "look_at": [0, 0, 0], "vertical_fov_degrees": 35}}}
            files.append(folder / f"{number}{side}.json")
            files[-1].write_text(json.dumps(scene))
        yield name, *files
