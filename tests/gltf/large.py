"""Writes the large models of the speed checks into a folder, and prints their paths as JSON.

    python large.py FOLDER

grid.glb       16 meshes, 2.1 million triangles, about 58 MB
nodes.glb      20,000 nodes that share one mesh
meshes.glb     5,000 distinct meshes
instances.glb  one mesh, a million times by EXT_mesh_gpu_instancing
"""

import json
import sys
from pathlib import Path

import numpy as np

from malformed import glb

FLOAT, UINT = 5126, 5125


class Model:
    """A growing glTF document with one buffer."""

    def __init__(self):
        self.chunks, self.size = [], 0
        self.json = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "meshes": [], "nodes": [],
                     "scenes": [{"nodes": []}], "scene": 0}

    def accessor(self, array, kind):
        """Adds an array; returns the number of its accessor."""
        data = array.tobytes()
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": self.size, "byteLength": len(data)})
        self.chunks.append(data)
        self.size += len(data)
        entry = {"bufferView": len(self.json["bufferViews"]) - 1, "count": len(array), "type": kind,
                 "componentType": UINT if array.dtype == np.uint32 else FLOAT}
        if kind == "VEC3":
            entry |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def mesh(self, positions, normals, indices):
        """Adds a mesh of one primitive; returns its number."""
        attributes = {"POSITION": self.accessor(positions, "VEC3")}
        if normals is not None:
            attributes["NORMAL"] = self.accessor(normals, "VEC3")
        primitive = {"attributes": attributes, "indices": self.accessor(indices, "SCALAR")}
        self.json["meshes"].append({"primitives": [primitive]})
        return len(self.json["meshes"]) - 1

    def node(self, **node):
        """Adds a root node."""
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]))
        self.json["nodes"].append(node)

    def write(self, path):
        """Writes the .glb file; returns its path."""
        self.json["buffers"] = [{"byteLength": self.size}]
        path.write_bytes(glb(self.json, b"".join(self.chunks)))
        return str(path)


def grid(edge, height=0.1):
    """Positions, normals and indices of a wavy square of edge × edge cells."""
    u, v = np.meshgrid(np.linspace(0, 1, edge + 1), np.linspace(0, 1, edge + 1))
    wave = height * np.sin(9 * u) * np.cos(7 * v)
    positions = np.stack([u, wave, v], -1).reshape(-1, 3).astype(np.float32)
    normals = np.stack([-9 * height * np.cos(9 * u) * np.cos(7 * v), np.ones_like(u),
                        7 * height * np.sin(9 * u) * np.sin(7 * v)], -1).reshape(-1, 3)
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32)
    first = (np.arange(edge)[:, None] * (edge + 1) + np.arange(edge)).reshape(-1)
    corners = np.stack([first, first + edge + 1, first + 1, first + 1, first + edge + 1, first + edge + 2], -1)
    return positions, normals, corners.reshape(-1).astype(np.uint32)


def main():
    """Writes all models."""
    folder = Path(sys.argv[1])
    large = Model()
    for i in range(16):
        large.node(mesh=large.mesh(*grid(256)), translation=[i % 4, 0, i // 4])
    nodes = Model()
    shared = nodes.mesh(*grid(4))
    for i in range(20_000):
        nodes.node(mesh=shared, translation=[i % 141, 0, i // 141])
    meshes = Model()
    for i in range(5_000):
        positions, normals, indices = grid(4, 0.1 + i * 1e-5)
        meshes.node(mesh=meshes.mesh(positions, normals, indices), translation=[i % 71, 0, i // 71])
    instances = Model()
    one = instances.mesh(*grid(4))
    places = np.stack([np.arange(1_000_000) % 1000, np.zeros(1_000_000), np.arange(1_000_000) // 1000], -1)
    places = instances.accessor(places.astype(np.float32), "VEC3")
    instances.node(mesh=one, extensions={"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}})
    instances.json["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    models = {"grid": large, "nodes": nodes, "meshes": meshes, "instances": instances}
    print(json.dumps({name: model.write(folder / f"{name}.glb") for name, model in models.items()}))


if __name__ == "__main__":
    main()
