"""Geometry of arrows and tubes."""

import math

from . import _arrays, shapes


def arrow():
    """An arrow of length 1 along the z axis: a shaft of radius 0.03 with a conical tip."""
    np = _arrays.numpy()
    sides = 24
    profile = np.array([(0, 0), (0.03, 0), (0.03, 0.7), (0.09, 0.7), (0, 1)])
    angles = np.arange(sides) * (2 * math.pi / sides)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = [np.column_stack([circle * radius, np.full(sides, z)]) for radius, z in profile]
    faces = ring_faces(len(profile), sides)
    # The first and the last ring are points.
    positions = np.concatenate(rings)
    corners = positions[faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return shapes.Mesh(
        positions=positions.astype("f4"), triangles=faces[area > 1e-9], crease_angle_degrees=40
    )


def ring_faces(rings, sides):
    """Triangles between rings of vertices that follow each other, seen from outside."""
    np = _arrays.numpy()
    ring, side = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
    a = ring * sides + side
    b = ring * sides + (side + 1) % sides
    quads = np.stack([a, b, b + sides, a + sides], axis=-1).reshape(-1, 4)
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def frames(directions, origins, sizes):
    """Matrices of shape (n, 3, 4) that turn the z axis to the directions, scale and move."""
    np = _arrays.numpy()
    z = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    # Any axis that is far from parallel.
    other = np.where(np.abs(z[:, :1]) < 0.7, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    x = np.cross(other, z)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(z, x)
    turned = np.stack([x, y, z], axis=2) * np.reshape(sizes, (-1, 1, 1))
    return np.concatenate([turned, np.reshape(origins, (-1, 3, 1))], axis=2).astype("f4")


def rings(line, radii, sides):
    """Rings of vertices around the points of a line, which turn as little as possible from one to
    the next (double reflection, Wang et al. 2008).
    """
    np = _arrays.numpy()
    tangents = np.gradient(line, axis=0)
    lengths = np.linalg.norm(tangents, axis=1, keepdims=True)
    # Where a line turns back, its next segment gives the direction.
    ahead = np.concatenate([np.diff(line, axis=0), line[-1:] - line[-2:-1]])
    tangents = np.where(lengths > 1e-12, tangents, ahead)
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    frame = frames(tangents[:1], line[:1], [1.0])[0].astype("f8")
    normals = [frame[:, 0]]
    for i in range(len(line) - 1):
        v = line[i + 1] - line[i]
        c = v @ v
        reflected = normals[i] - 2 / c * (v @ normals[i]) * v
        tangent = tangents[i] - 2 / c * (v @ tangents[i]) * v
        w = tangents[i + 1] - tangent
        d = w @ w
        normals.append(reflected - 2 / d * (w @ reflected) * w if d > 1e-18 else reflected)
    normals = np.array(normals)
    binormals = np.cross(tangents, normals)
    angles = np.arange(sides) * (2 * math.pi / sides)
    around = np.cos(angles)[:, None] * normals[:, None] + np.sin(angles)[:, None] * binormals[:, None]
    return (line[:, None] + around * np.reshape(radii, (-1, 1, 1))).reshape(-1, 3)


def caps(start, ends, rings, sides):
    """Triangles that close both ends of a tube, whose centers are the vertices `ends` and the next."""
    np = _arrays.numpy()
    side = np.arange(sides)
    following = (side + 1) % sides
    last = start + (rings - 1) * sides
    first_cap = np.stack([np.full(sides, ends), start + following, start + side], axis=1)
    last_cap = np.stack([np.full(sides, ends + 1), last + side, last + following], axis=1)
    return first_cap, last_cap
