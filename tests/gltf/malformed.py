"""Defective glTF files: one property wrong, missing or out of range, and files cut short."""

import copy
import json
import random
import struct

# Indices by the property that holds them, and numbers of elements or bytes.
INDICES = {
    "accessor", "bufferView", "buffer", "mesh", "skin", "material", "texture", "sampler", "source", "scene", "node",
    "input", "output", "inverseBindMatrices", "indices", "camera", "skeleton", "index",
}
ENUMS = {"componentType", "type", "mode", "path", "interpolation", "wrapS", "minFilter", "alphaMode", "mimeType"}


def places(value, path=()):
    """All places of a JSON document, with the value at each."""
    yield path, value
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, path + (key,))


def with_value(document, path, value):
    """Copy of a document with another value at a place."""
    changed = copy.deepcopy(document)
    target = changed
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    return changed


def without(document, path):
    """Copy of a document without the property at a place."""
    changed = copy.deepcopy(document)
    target = changed
    for key in path[:-1]:
        target = target[key]
    del target[path[-1]]
    return changed


def wrong_values(path, value):
    """Values that are wrong at a place, by the kind of the property."""
    key = path[-1]
    owner = next((part for part in reversed(path[:-1]) if isinstance(part, str)), "")
    if key == "extras" or "extras" in path or "asset" in path[:-1] and key != "version":
        return []
    if isinstance(value, bool):
        return [1, "yes"]
    if isinstance(value, int) and key in INDICES | {"POSITION", "NORMAL", "TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"}:
        return [1_000_000, -1, 0.5, "0"]
    if isinstance(value, int) and owner in ("children", "nodes", "joints"):
        return [1_000_000, -1, "0"]
    if key in ("byteLength", "count", "byteOffset", "byteStride") and isinstance(value, int):
        return [2**40, -1, 1.5, "4"]
    if key in ENUMS:
        return [12345, "nothing"] if not isinstance(value, str) or key == "type" else [12345]
    if isinstance(value, list) and value and isinstance(value[0], (int, float)) and key not in ("min", "max"):
        # Arrays of indices may have any length.
        return [value[:-1] + ["x"]] + ([] if key in ("nodes", "children", "joints") else [value + [1], []])
    if isinstance(value, (dict, list)) and value:
        return [5, "x"]
    return []


def glb(document, binary):
    """Bytes of a .glb file."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def parts(data):
    """JSON and binary chunk of a .glb file."""
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    return document, data[20 + length + 8 :]


def defects(data, count, seed):
    """Defective variants of a .glb file, as pairs of a description and the bytes."""
    document, binary = parts(data)
    found = []
    for path, value in places(document):
        if not path:
            continue
        at = "/" + "/".join(map(str, path))
        found += [(f"{at} = {json.dumps(wrong)[:40]}", glb(with_value(document, path, wrong), binary))
                  for wrong in wrong_values(path, value)]
    found += [(f"without {name}", glb(without(document, (name,)), binary)) for name in ("asset", "accessors", "buffers")
              if name in document]
    required = dict(document, extensionsRequired=["EXT_unknown"], extensionsUsed=["EXT_unknown"])
    found.append(("unknown required extension", glb(required, binary)))
    generator = random.Random(seed)
    cuts = [(f"cut at byte {n}", data[:n]) for n in sorted(generator.sample(range(1, len(data) - 1), 30))]
    generator.shuffle(found)
    return (cuts + found)[:count]
