"""Collects the parts of a glTF 2.0 document and writes it as one binary file (GLB)."""
import json
import struct

from mesh import tangents

FLOAT, U8, U16, U32 = 5126, 5121, 5123, 5125
_CODES = {FLOAT: "f", U8: "B", U16: "H", U32: "I"}
_SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Document:
    """Parts of a glTF file; every method that adds a part returns its index."""

    def __init__(self, name):
        self.binary = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "scenes/models/make.py of Juggler"},
                     "scene": 0, "scenes": [{"name": name, "nodes": []}]}

    def add(self, kind, part):
        self.json.setdefault(kind, []).append(part)
        return len(self.json[kind]) - 1

    def view(self, data, target=None):
        self.binary += bytes(-len(self.binary) % 4)
        part = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target:
            part["target"] = target
        self.binary += data
        return self.add("bufferViews", part)

    def accessor(self, values, kind, component=FLOAT, target=None, bounds=False, normalized=False):
        """Add an accessor of rows of numbers (plain numbers for SCALAR)."""
        rows = [(v,) for v in values] if kind == "SCALAR" else values
        flat = [x for row in rows for x in row]
        if component == FLOAT:
            flat = [round(x, 6) + 0.0 for x in flat]
        data = struct.pack(f"<{len(flat)}{_CODES[component]}", *flat)
        part = {"bufferView": self.view(data, target), "componentType": component,
                "count": len(rows), "type": kind}
        if normalized:
            part["normalized"] = True
        if bounds:
            size = _SIZES[kind]
            stored = struct.unpack(f"<{len(flat)}{_CODES[component]}", data)
            part["min"] = [min(stored[i::size]) for i in range(size)]
            part["max"] = [max(stored[i::size]) for i in range(size)]
        return self.add("accessors", part)

    def texture(self, png, name, repeat=True):
        """Add an image with a trilinear sampler and the texture of both."""
        wrap = 10497 if repeat else 33071
        sampler = {"magFilter": 9729, "minFilter": 9987, "wrapS": wrap, "wrapT": wrap}
        samplers = self.json.setdefault("samplers", [])
        if sampler not in samplers:
            samplers.append(sampler)
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(png)})
        return self.add("textures", {"source": image, "sampler": samplers.index(sampler)})

    def material(self, name, color=(1, 1, 1), roughness=0.5, metallic=0.0, extensions=None, **more):
        """Add a metallic-roughness material; `color` is linear, with an alpha if it has 4 parts.

        `texture` and `surface` are texture infos of base color and metallic-roughness; other
        keywords are keys of the material.
        """
        pbr = {"baseColorFactor": list(color) + [1] * (4 - len(color)), "metallicFactor": metallic,
               "roughnessFactor": roughness}
        for key, name_of in (("texture", "baseColorTexture"), ("surface", "metallicRoughnessTexture")):
            if key in more:
                pbr[name_of] = more.pop(key)
        part = {"name": name, "pbrMetallicRoughness": pbr}
        if extensions:
            part["extensions"] = extensions
        return self.add("materials", part | more)

    def primitive(self, mesh, material, mappings=None):
        """Return a primitive of `mesh`; `mappings` pairs lists of variants with their materials."""
        attributes = {
            "POSITION": self.accessor(mesh.positions, "VEC3", target=34962, bounds=True),
            "NORMAL": self.accessor(mesh.normals, "VEC3", target=34962)}
        self._surface_coordinates(mesh, self.json["materials"][material], attributes)
        if mesh.colors:
            rows = [[min(max(int(c * 255 + 0.5), 0), 255) for c in color] + [255] for color in mesh.colors]
            attributes["COLOR_0"] = self.accessor(rows, "VEC4", U8, 34962, normalized=True)
        if mesh.joints:
            attributes["JOINTS_0"] = self.accessor(mesh.joints, "VEC4", U8, 34962)
            attributes["WEIGHTS_0"] = self.accessor(mesh.weights, "VEC4", U16, 34962, normalized=True)
        indices = [i for triangle in mesh.triangles for i in triangle]
        part = {"attributes": attributes, "material": material,
                "indices": self.accessor(indices, "SCALAR", U16 if len(mesh.positions) < 65535 else U32, 34963)}
        if mesh.targets:
            part["targets"] = [{"POSITION": self.accessor(t, "VEC3", target=34962, bounds=True)}
                               for t in mesh.targets]
        if mappings:
            part["extensions"] = {"KHR_materials_variants": {"mappings": [
                {"variants": variants, "material": other} for variants, other in mappings]}}
        return part

    def _surface_coordinates(self, mesh, material, attributes):
        """Add the texture coordinates and tangents that a material uses."""
        text = json.dumps(material)
        bumps = material.get("normalTexture")
        if "Texture" in text or "anisotropy" in text:
            attributes["TEXCOORD_0"] = self.accessor(mesh.uvs, "VEC2", target=34962)
        if mesh.uvs1:
            attributes["TEXCOORD_1"] = self.accessor(mesh.uvs1, "VEC2", target=34962)
        if bumps or "anisotropy" in text:
            uvs = mesh.uvs1 if bumps and bumps.get("texCoord") else mesh.uvs
            attributes["TANGENT"] = self.accessor(tangents(mesh, uvs), "VEC4", target=34962)

    def mesh(self, name, *primitives, **more):
        return self.add("meshes", {"name": name, "primitives": list(primitives)} | more)

    def node(self, name, parent=None, **more):
        """Add a node under `parent`, or to the scene if that is None."""
        index = self.add("nodes", {"name": name} | {k: v for k, v in more.items() if v is not None})
        if parent is None:
            self.json["scenes"][0]["nodes"].append(index)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(index)
        return index

    def camera(self, name, eye, target, vertical_degrees, rotation, aspect=4 / 3):
        lens = {"yfov": round(vertical_degrees * 3.141592653589793 / 180, 6),
                "aspectRatio": round(aspect, 6), "znear": 0.01, "zfar": 100}
        camera = self.add("cameras", {"name": name, "type": "perspective", "perspective": lens})
        return self.node(name, camera=camera, translation=list(eye), rotation=rounded(rotation))

    def light(self, **light):
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
        lights["lights"].append(light)
        return {"KHR_lights_punctual": {"light": len(lights["lights"]) - 1}}

    def glb(self):
        """Return the bytes of the binary file."""
        used = set()
        _extensions(self.json, used)
        if used:
            self.json["extensionsUsed"] = sorted(used)
        self.binary += bytes(-len(self.binary) % 4)
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self.binary)
        return (struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
                + struct.pack("<I4s", len(self.binary), b"BIN\0") + bytes(self.binary))


def _extensions(part, used):
    if isinstance(part, dict):
        used.update(part.get("extensions", {}))
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            _extensions(inner, used)


def rounded(values):
    """Return JSON numbers of at most 7 decimals."""
    return [round(v, 7) + 0.0 for v in values]


def transformed(index, scale=(1, 1), offset=(0, 0), rotation=0.0, **more):
    """Return a texture info with KHR_texture_transform; the rotation is in radians."""
    part = {"offset": list(offset), "scale": list(scale)}
    if rotation:
        part["rotation"] = rotation
    return {"index": index, "extensions": {"KHR_texture_transform": part}} | more


def srgb(code):
    """Return the linear color of an sRGB color such as `e08a3c`."""
    parts = [int(code[i:i + 2], 16) / 255 for i in (0, 2, 4)]
    return [round(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4, 4) for c in parts]
