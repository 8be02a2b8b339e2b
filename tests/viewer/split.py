#!/usr/bin/env python3
"""Writes a .glb as a .gltf with its buffer and pictures as files beside it.

    tests/viewer/split.py MODEL.glb MODEL.gltf
"""

import json
import sys
from pathlib import Path
from urllib.parse import quote


def split(glb, target):
    """Writes the files."""
    length = int.from_bytes(glb[12:16], "little")
    document, buffer = json.loads(glb[20:20 + length]), glb[28 + length:]
    contents = {f"{target.stem}.bin": buffer}
    document["buffers"][0]["uri"] = quote(f"{target.stem}.bin")
    for index, image in enumerate(document.get("images", [])):
        view = document["bufferViews"][image.pop("bufferView")]
        start = view.get("byteOffset", 0)
        name = f"picture {index}.{image.pop('mimeType').split('/')[1]}"
        contents[name] = buffer[start:start + view["byteLength"]]
        image["uri"] = quote(name)
    for name, content in contents.items():
        (target.parent / name).write_bytes(content)
    target.write_text(json.dumps(document))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    split(Path(sys.argv[1]).read_bytes(), Path(sys.argv[2]))
