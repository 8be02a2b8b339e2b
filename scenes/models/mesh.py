"""Triangle meshes with the vertex data of glTF, and operations on them."""
import math

from vec import add, cross, dot, rotate, sub, unit


class Mesh:
    """Lists of vertex data and triangles; lists that a mesh does not have are empty."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.uvs1, self.colors = [], [], [], [], []
        self.joints, self.weights, self.targets, self.triangles = [], [], [], []

    def moved(self, offset=(0, 0, 0), rotation=None, scale=(1, 1, 1)):
        """Return the mesh scaled, then rotated by a quaternion, then translated."""
        def turn(v):
            return rotate(rotation, v) if rotation else v

        if isinstance(scale, (int, float)):
            scale = (scale,) * 3
        result = self.copied()
        result.positions = [add(turn((p[0] * scale[0], p[1] * scale[1], p[2] * scale[2])), offset)
                            for p in self.positions]
        result.normals = [unit(turn((n[0] / scale[0], n[1] / scale[1], n[2] / scale[2])))
                          for n in self.normals]
        if scale[0] * scale[1] * scale[2] < 0:
            result.triangles = [(a, c, b) for a, b, c in self.triangles]
        return result

    def copied(self):
        result = Mesh()
        for name, values in vars(self).items():
            setattr(result, name, list(values))
        return result

    def colored(self, color_of):
        """Return the mesh with the linear vertex colors `color_of(position, normal)`."""
        result = self.copied()
        result.colors = [color_of(p, n) for p, n in zip(self.positions, self.normals)]
        return result

    def with_uvs(self, uv_of, second=False):
        """Return the mesh with texture coordinates `uv_of(position, normal)`."""
        result = self.copied()
        uvs = [uv_of(p, n) for p, n in zip(self.positions, self.normals)]
        setattr(result, "uvs1" if second else "uvs", uvs)
        return result

    def scaled_uvs(self, u, v):
        result = self.copied()
        result.uvs = [(a * u, b * v) for a, b in self.uvs]
        return result

    def bound(self, weights_of):
        """Return the mesh skinned by `weights_of(position)`, pairs of a joint and its weight.

        Weights become whole numbers whose sum is 65535.
        """
        result = self.copied()
        result.joints, result.weights = [], []
        for p in self.positions:
            pairs = sorted(weights_of(p), key=lambda pair: -pair[1])[:4]
            pairs = [(joint, weight) for joint, weight in pairs if weight > 1e-4]
            total = sum(weight for _, weight in pairs)
            pairs = [(joint, int(weight / total * 65535 + 0.5)) for joint, weight in pairs]
            pairs[0] = (pairs[0][0], 65535 - sum(weight for _, weight in pairs[1:]))
            pairs = [pair for pair in pairs if pair[1]]
            pairs += [(0, 0)] * (4 - len(pairs))
            result.joints.append([joint for joint, _ in pairs])
            result.weights.append([weight for _, weight in pairs])
        return result

    def facets(self):
        """Return the mesh with flat normals; each triangle gets vertices of its own."""
        result = Mesh()
        for triangle in self.triangles:
            a, b, c = (self.positions[i] for i in triangle)
            n = unit(cross(sub(b, a), sub(c, a)))
            start = len(result.positions)
            result.positions += [a, b, c]
            result.normals += [n] * 3
            result.triangles.append((start, start + 1, start + 2))
        return result


def joined(*meshes):
    """Return one mesh of several that have the same kinds of vertex data."""
    result = Mesh()
    for mesh in meshes:
        start = len(result.positions)
        for name in ("positions", "normals", "uvs", "uvs1", "colors", "joints", "weights"):
            getattr(result, name).extend(getattr(mesh, name))
        result.triangles += [(a + start, b + start, c + start) for a, b, c in mesh.triangles]
        count = max(len(result.targets), len(mesh.targets))
        for i in range(count):
            if i == len(result.targets):
                result.targets.append([(0, 0, 0)] * start)
            target = mesh.targets[i] if i < len(mesh.targets) else [(0, 0, 0)] * len(mesh.positions)
            result.targets[i] = result.targets[i] + target
    for target in result.targets:
        target += [(0, 0, 0)] * (len(result.positions) - len(target))
    return result


def smoothed(mesh):
    """Return the mesh with normals that average the facets, by area, around equal positions."""
    sums = {}
    keys = [tuple(round(x, 6) for x in p) for p in mesh.positions]
    for i, j, k in mesh.triangles:
        a, b, c = mesh.positions[i], mesh.positions[j], mesh.positions[k]
        n = cross(sub(b, a), sub(c, a))
        for key in (keys[i], keys[j], keys[k]):
            sums[key] = add(sums.get(key, (0, 0, 0)), n)
    result = mesh.copied()
    result.normals = [unit(sums.get(key, (0, 1, 0))) for key in keys]
    return result


def tangents(mesh, uvs):
    """Return the tangents (x, y, z, w) of a mesh: x along increasing u, w the sign of -v."""
    along, down = ([(0.0, 0.0, 0.0)] * len(mesh.positions) for _ in range(2))
    for triangle in mesh.triangles:
        a, b, c = (mesh.positions[i] for i in triangle)
        (u0, v0), (u1, v1), (u2, v2) = (uvs[i] for i in triangle)
        p, q = sub(b, a), sub(c, a)
        du1, dv1, du2, dv2 = u1 - u0, v1 - v0, u2 - u0, v2 - v0
        area = du1 * dv2 - du2 * dv1
        sign = 1 if area > 0 else -1
        for i in triangle:
            along[i] = add(along[i], tuple(sign * (x * dv2 - y * dv1) for x, y in zip(p, q)))
            down[i] = add(down[i], tuple(sign * (y * du1 - x * du2) for x, y in zip(p, q)))
    result = []
    for n, t, b in zip(mesh.normals, along, down):
        t = tuple(x - y * dot(n, t) for x, y in zip(t, n))
        if dot(t, t) < 1e-24:
            t = cross(n, (0, 0, 1)) if abs(n[2]) < 0.9 else cross(n, (1, 0, 0))
        t = unit(t)
        result.append((*t, -1.0 if dot(cross(n, t), b) > 0 else 1.0))
    return result


def grid(point, columns, rows):
    """Return the surface `point(u, v)`, u and v in 0 to 1, with smooth normals.

    The front is where u runs to the right and v upwards. Normals agree at seams, where points of
    the surface meet.
    """
    mesh = Mesh()
    for j in range(rows + 1):
        for i in range(columns + 1):
            mesh.positions.append(point(i / columns, j / rows))
            mesh.uvs.append((i / columns, 1 - j / rows))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            mesh.triangles += _split(mesh.positions, a, b, c, d)
    return smoothed(mesh)


def _split(points, a, b, c, d):
    """Return the triangles of a quadrilateral without those that have no area."""
    triangles = [(a, b, c), (a, c, d)]
    return [t for t in triangles if _area(points, t) > 1e-12]


def _area(points, triangle):
    a, b, c = (points[i] for i in triangle)
    n = cross(sub(b, a), sub(c, a))
    return dot(n, n) ** 0.5


def curve(points, steps):
    """Return `steps` points on each span of a Catmull-Rom spline through tuples `points`."""
    def at(p0, p1, p2, p3, t):
        return tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t
                            + (3 * b - a - 3 * c + d) * t * t * t)
                     for a, b, c, d in zip(p0, p1, p2, p3))

    result = []
    for i in range(len(points) - 1):
        p0, p3 = points[max(i - 1, 0)], points[min(i + 2, len(points) - 1)]
        result += [at(p0, points[i], points[i + 1], p3, k / steps) for k in range(steps)]
    return result + [tuple(float(x) for x in points[-1])]


def turn(degrees):
    """Return cosine and sine of an angle in degrees, exact at right angles."""
    quarter, rest = divmod(degrees, 90)
    c, s = (math.cos(math.radians(rest)), math.sin(math.radians(rest))) if rest else (1.0, 0.0)
    return ((c, s), (-s, c), (-c, -s), (s, -c))[int(quarter) % 4]
