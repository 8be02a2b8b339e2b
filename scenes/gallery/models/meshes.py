"""Meshes from formulas, from which make.py makes the models of the gallery."""
import os

import numpy as np

FOLDER = os.path.dirname(os.path.abspath(__file__))
TURN = 2 * np.pi


# --- meshes: (points, triangles) ---

def write(name, mesh, smooth=True, uvs=None):
    """Write a binary PLY file.

    With smooth normals, edges are still sharp where faces meet at more than 40 degrees.
    """
    points, faces = np.asarray(mesh[0], float), np.asarray(mesh[1], int)
    names = ["x", "y", "z"]
    table = points
    if smooth:
        table, faces = creased(points, faces, np.radians(40), uvs)
        names += ["nx", "ny", "nz"] + (["s", "t"] if uvs is not None else [])
    fields = "".join(f"property float {name}\n" for name in names)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(table)}\n{fields}"
            f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n")
    rows = np.zeros(len(faces), [("n", "u1"), ("v", "<u4", 3)])
    rows["n"], rows["v"] = 3, faces
    with open(os.path.join(FOLDER, name + ".ply"), "wb") as file:
        file.write(head.encode() + table.astype("<f4").tobytes() + rows.tobytes())
    print(f"{name}: {len(faces)} triangles")


def creased(points, faces, limit, uvs=None):
    """Return vertices whose normals are means over the adjacent faces of similar orientation.

    A face contributes where its normal differs by less than `limit` from that of the vertex's face.
    """
    a, b, c = (points[faces[:, i]] for i in range(3))
    areas = np.cross(b - a, c - a)
    units = areas / np.maximum(np.linalg.norm(areas, axis=1, keepdims=True), 1e-20)
    places = [tuple(place) for place in np.round(points, 6)]
    around = {}
    for face, corners in enumerate(faces):
        for corner in corners:
            around.setdefault(places[corner], []).append(face)
    out, found, rows = [], {}, np.empty_like(faces)
    for face, corners in enumerate(faces):
        for place, corner in enumerate(corners):
            near = [other for other in around[places[corner]] if units[other] @ units[face] > np.cos(limit)] or [face]
            normal = areas[near].sum(axis=0)
            normal /= max(np.linalg.norm(normal), 1e-20)
            key = (corner, *np.round(normal, 4))
            if key not in found:
                found[key] = len(out)
                out.append((*points[corner], *normal, *(() if uvs is None else uvs[corner])))
            rows[face, place] = found[key]
    return np.array(out), rows


def joined(*meshes):
    points, faces, count = [], [], 0
    for p, f in meshes:
        points.append(np.asarray(p, float))
        faces.append(np.asarray(f, int) + count)
        count += len(p)
    return np.vstack(points), np.vstack(faces)


def moved(mesh, by=(0, 0, 0), scale=1.0, turn=None):
    points = np.asarray(mesh[0], float) * scale
    if turn is not None:
        points = points @ np.asarray(turn, float).T
    return points + np.asarray(by, float), mesh[1]


def about(axis, angle):
    """Return the rotation matrix about an axis."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def grid(points, wrap_u=False, wrap_v=False):
    """Return the mesh of an array of points (rows, columns, 3); u × v points to its front."""
    rows, columns = points.shape[:2]
    faces = []
    for i in range(rows if wrap_v else rows - 1):
        for j in range(columns if wrap_u else columns - 1):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            c, d = (i + 1) % rows * columns + (j + 1) % columns, (i + 1) % rows * columns + j
            faces += [(a, b, c), (a, c, d)]
    faces = np.array(faces)
    flat = points.reshape(-1, 3)
    a, b, c = (flat[faces[:, i]] for i in range(3))
    kept = np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-14
    return flat, faces[kept]


def lathe(profile, around=96, ridges=None):
    """Return the surface of revolution of a profile of (radius, height), bottom first, about y.

    `ridges(radius, height, angle)` may modify the radius.
    """
    profile, angles = np.asarray(profile, float), np.arange(around) / around * TURN
    radius, height = (np.repeat(profile[:, i:i + 1], around, axis=1) for i in range(2))
    if ridges:
        radius = ridges(radius, height, np.repeat(angles[None, :], len(profile), axis=0))
    points = np.stack([radius * np.cos(angles), height, -radius * np.sin(angles)], axis=2)
    return grid(points, wrap_u=True)


def curve(*points, steps=8):
    """Return points of the Catmull-Rom spline through `points`; a repeated point is a corner."""
    p = np.array(points, float)
    out = []
    for i in range(len(p) - 1):
        a, b = p[i], p[i + 1]
        if np.allclose(a, b):
            continue
        before = p[i - 1] if i > 0 and not np.allclose(p[i - 1], a) else 2 * a - b
        after = p[i + 2] if i + 2 < len(p) and not np.allclose(p[i + 2], b) else 2 * b - a
        for t in np.arange(steps) / steps:
            out.append(0.5 * (2 * a + (b - before) * t + (2 * before - 5 * a + 4 * b - after) * t ** 2
                              + (3 * a - before - 3 * b + after) * t ** 3))
    out.append(p[-1])
    return np.array(out)


def cushion(size, power=(4.0, 4.0, 4.0), steps=40):
    """Return the superellipsoid |x/a|^p + |y/b|^q + |z/c|^r = 1, along rays from its center."""
    v, u = np.meshgrid(np.linspace(-1, 1, steps) * np.pi / 2, np.arange(2 * steps) / (2 * steps) * TURN, indexing="ij")
    way = np.stack([np.cos(v) * np.cos(u), np.sin(v), -np.cos(v) * np.sin(u)], axis=2)
    # Concentrate the rays at the corners, where curvature is highest.
    way = np.sign(way) * np.abs(way) ** 0.6 * np.asarray(size, float)
    low, high = np.zeros(way.shape[:2]), np.full(way.shape[:2], 4.0)
    for _ in range(50):
        middle = (low + high) / 2
        inside = sum(np.abs(way[..., i] * middle / size[i]) ** power[i] for i in range(3)) < 1
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return grid(way * low[..., None], wrap_u=True)


def box(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    points = [(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]


def cut(planes):
    """Return the convex solid bounded by planes (normal, distance), with flat faces."""
    planes = [(np.asarray(n, float) / np.linalg.norm(n), d) for n, d in planes]
    points, faces = [], []
    for normal, distance in planes:
        side = np.cross(normal, (1, 0, 0) if abs(normal[0]) < 0.9 else (0, 1, 0))
        side /= np.linalg.norm(side)
        up = np.cross(normal, side)
        corners = [normal * distance + 50 * (a * side + b * up) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for other, far in planes:
            if other is normal:
                continue
            kept = []
            for p, q in zip(corners, corners[1:] + corners[:1]):
                a, b = other @ p - far, other @ q - far
                if a <= 0:
                    kept.append(p)
                if a * b < 0:
                    kept.append(p + (q - p) * a / (a - b))
            corners = kept
            if not corners:
                break
        clean = [p for i, p in enumerate(corners) if np.linalg.norm(p - corners[i - 1]) > 1e-7]
        if len(clean) < 3:
            continue
        start = len(points)
        points += clean
        faces += [(start, start + i, start + i + 1) for i in range(1, len(clean) - 1)]
    return points, faces


def tube_along(points, radius, around=12):
    """Return an open round tube through points; `radius` is a number or one for each point."""
    points = np.asarray(points, float)
    radius = np.broadcast_to(np.asarray(radius, float), len(points))
    ways = np.gradient(points, axis=0)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    side = np.cross(ways[0], (0.31, 0.87, 0.39))
    rows = []
    for point, way, r in zip(points, ways, radius):
        side = side - way * (side @ way)
        side /= np.linalg.norm(side)
        up = np.cross(way, side)
        angles = np.arange(around) / around * TURN
        rows.append(point + r * (np.cos(angles)[:, None] * side + np.sin(angles)[:, None] * up))
    return grid(np.array(rows), wrap_u=True)
