"""Computes the direct light at a point of the floor of many-lights by a closed form.

The script sums Lambert's formula for each triangle of the lights, times the visible fraction of the
triangle. It ignores boxes, takes some seconds, and needs numpy.

    PYTHON tests/peers/direct_light.py SCENES [--point 0.3,0,3] [--points 4] [--end 1e-5] [--scene FOLDER]

--points N tests the visibility of N x N points of each triangle. --end E ignores occluders on the
last fraction E of the distance to the light, as some renderers do. --scene writes the scene that a
renderer has to show: the floor around the point, seen from above, with paths of two segments.
"""
import argparse
import json
import os
import shutil

import numpy as np

FLOOR = 0.7  # reflectance


def triangles(path):
    """Reads the corners of the triangles of a binary PLY file, n x 3 x 3."""
    head, body = open(path, "rb").read().split(b"end_header\n", 1)
    count = lambda what: int(head.decode().split(f"element {what} ")[1].split()[0])
    floats = head.decode().split("element vertex")[1].split("element face")[0].count("property float")
    vertices = np.frombuffer(body, "<f4", count("vertex") * floats).reshape(-1, floats)[:, :3].astype("f8")
    faces = np.frombuffer(body[count("vertex") * floats * 4 :], np.dtype([("n", "u1"), ("i", "<i4", 3)]), count("face"))
    return vertices[faces["i"]]


def hidden(origin, offsets, scene, end):
    """Returns which of the points at origin + offsets are occluded (Moller and Trumbore 1997)."""
    corner, a, b = scene[:, 0], scene[:, 1] - scene[:, 0], scene[:, 2] - scene[:, 0]
    found = np.zeros(len(offsets), bool)
    for first in range(0, len(offsets), 256):
        offset = offsets[first : first + 256, None]
        p, s = np.cross(offset, b), (origin - corner)[None]
        determinant = (p * a).sum(-1)
        determinant = np.where(abs(determinant) < 1e-14, 1e-14, determinant)
        q = np.cross(s, a[None])
        u, v, t = (p * s).sum(-1) / determinant, (offset * q).sum(-1) / determinant, (q * b).sum(-1) / determinant
        found[first : first + 256] = ((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-5) & (t < 1 - end)).any(1)
    return found


def irradiance(point, light):
    """Returns the irradiance of the floor by each triangle of radiance 1 (Lambert 1760)."""
    edges = light - point
    edges /= np.linalg.norm(edges, axis=-1, keepdims=True)
    total = np.zeros(len(light))
    for k in range(3):
        normal = np.cross(edges[:, k], edges[:, (k + 1) % 3])
        sine = np.linalg.norm(normal, axis=-1)
        total += np.arctan2(sine, (edges[:, k] * edges[:, (k + 1) % 3]).sum(-1)) * normal[:, 1] / sine
    return abs(total) / 2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes")
    parser.add_argument("--point", default="0.3,0,3")
    parser.add_argument("--points", type=int, default=4)
    parser.add_argument("--end", type=float, default=1e-5)
    parser.add_argument("--scene")
    arguments = parser.parse_args()
    folder = os.path.join(arguments.scenes, "many-lights")
    scene = json.load(open(os.path.join(folder, "scene.json")))
    scene["shapes"] = [shape for shape in scene["shapes"] if "boxes" not in shape["file"]]
    point = np.array([float(x) for x in arguments.point.split(",")])
    if arguments.scene:
        scene["integrator"]["max_depth"] = 2
        eye = (point + [0, 0.5, 0]).tolist()
        scene["camera"] = {"eye": eye, "look_at": point.tolist(), "up": [0, 0, -1], "vfov": 2.0}
        shutil.copytree(os.path.join(folder, "meshes"), os.path.join(arguments.scene, "meshes"))
        json.dump(scene, open(os.path.join(arguments.scene, "scene.json"), "w"), indent=1)
    meshes = [(triangles(os.path.join(folder, shape["file"])), shape.get("emission")) for shape in scene["shapes"]]
    everything = np.concatenate([mesh for mesh, _ in meshes])
    grid = (np.arange(arguments.points) + 0.5) / arguments.points
    places = np.array([(u, v) if u + v < 1 else (1 - u, 1 - v) for u in grid for v in grid])
    radiance = np.zeros(3)
    for light, emission in meshes:
        if not emission:
            continue
        faces = np.cross(light[:, 1] - light[:, 0], light[:, 2] - light[:, 0])
        light = light[((point - light[:, 0]) * faces).sum(-1) > 0]
        on = light[:, None, 0] + places[:, :1] * (light[:, None, 1] - light[:, None, 0]) + places[:, 1:] * (light[:, None, 2] - light[:, None, 0])
        seen = 1 - hidden(point, (on - point).reshape(-1, 3), everything, arguments.end).reshape(len(light), -1).mean(1)
        radiance += (irradiance(point, light) * seen).sum() * np.array(emission)
    print(*(radiance * FLOOR / np.pi))


main()
