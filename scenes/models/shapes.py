"""Solids as meshes: beveled boxes, turned profiles, tubes, superellipsoids, a gem."""
import math

from mesh import Mesh, curve, grid, smoothed, turn
from vec import add, cross, dot, mix, scaled, sub, unit


def box(size, bevel=0.0, steps=2, density=1.0):
    """Return a box around the origin with rounded edges; `density` texture repeats per meter.

    The grain of a texture (its u) runs along the longest edge of each face.
    """
    mesh = Mesh()
    half = scaled(size, 0.5)
    bevel = min(bevel, *half)
    slopes = [math.tan(math.radians(45 * i / steps)) for i in range(steps + 1)] if bevel else [0.0]
    ticks = [(-1, -s) for s in reversed(slopes)] + [(1, s) for s in slopes]
    for axis in range(3):
        for side in (-1, 1):
            _face(mesh, half, bevel, ticks, axis, side, density)
    return mesh


def _face(mesh, half, bevel, ticks, axis, side, density):
    u, v = (axis + 1) % 3, (axis + 2) % 3
    if side < 0:
        u, v = v, u
    start, count = len(mesh.positions), len(ticks)
    long_v = half[v] > half[u]
    for core_v, slope_v in ticks:
        for core_u, slope_u in ticks:
            direction = [0.0, 0.0, 0.0]
            direction[axis], direction[u], direction[v] = side, slope_u, slope_v
            normal = unit(direction)
            core = [0.0, 0.0, 0.0]
            core[axis] = side * (half[axis] - bevel)
            core[u], core[v] = core_u * (half[u] - bevel), core_v * (half[v] - bevel)
            point = add(core, scaled(normal, bevel))
            mesh.positions.append(point)
            mesh.normals.append(normal)
            a, b = (point[v], point[u]) if long_v else (point[u], -point[v])
            mesh.uvs.append((a * density, b * density))
    for j in range(count - 1):
        for i in range(count - 1):
            a = start + j * count + i
            mesh.triangles += [(a, a + 1, a + count + 1), (a, a + count + 1, a + count)]


def profile(corners, steps=4):
    """Return points (radius, height, normal) of a polyline of (radius, height, fillet).

    Each inner corner becomes an arc of radius `fillet`, or stays sharp if that is 0. The outside
    is on the right of the polyline's direction for a solid that is followed upwards.
    """
    points = []
    last = len(corners) - 1
    for i, (r, y, fillet) in enumerate(corners):
        before = _direction(corners[i - 1], corners[i]) if i else None
        after = _direction(corners[i], corners[i + 1]) if i < last else None
        if before is None or after is None:
            points.append((r, y, _right(after or before)))
            continue
        angle = math.atan2(before[0] * after[1] - before[1] * after[0],
                           before[0] * after[0] + before[1] * after[1])
        if not fillet:
            points += [(r, y, _right(before)), (r, y, _right(after))]
            continue
        cut = fillet * math.tan(abs(angle) / 2)
        sign = 1 if angle > 0 else -1
        n0 = _right(before)
        center = (r - before[0] * cut - n0[0] * fillet * sign, y - before[1] * cut - n0[1] * fillet * sign)
        for k in range(steps + 1):
            c, s = math.cos(angle * k / steps), math.sin(angle * k / steps)
            n = (n0[0] * c - n0[1] * s, n0[0] * s + n0[1] * c)
            points.append((center[0] + n[0] * fillet * sign, center[1] + n[1] * fillet * sign, n))
    return points


def _direction(a, b):
    x, y = b[0] - a[0], b[1] - a[1]
    size = math.hypot(x, y)
    return (x / size, y / size)


def _right(direction):
    return (direction[1], -direction[0])


def smooth_profile(points, steps=6):
    """Return points (radius, height, normal) of a smooth curve through pairs (radius, height)."""
    line = curve(points, steps)
    result = []
    for i, (r, y) in enumerate(line):
        d = _direction(line[max(i - 1, 0)], line[min(i + 1, len(line) - 1)])
        result.append((max(r, 0.0), y, _right(d)))
    return result


def lathe(points, segments=48, arc=360.0):
    """Return the surface of a profile of (radius, height, normal) turned around the y axis."""
    mesh = Mesh()
    lengths = [0.0]
    for (r0, y0, _), (r1, y1, _) in zip(points, points[1:]):
        lengths.append(lengths[-1] + math.hypot(r1 - r0, y1 - y0))
    for (r, y, n), along in zip(points, lengths):
        for i in range(segments + 1):
            c, s = turn(arc * i / segments)
            mesh.positions.append((r * s, y, r * c))
            mesh.normals.append(unit((n[0] * s, n[1], n[0] * c)))
            mesh.uvs.append((i / segments, 1 - along / lengths[-1]))
    for j in range(len(points) - 1):
        if lengths[j + 1] - lengths[j] < 1e-9:
            continue
        for i in range(segments):
            a = j * (segments + 1) + i
            b, c, d = a + 1, a + segments + 2, a + segments + 1
            if points[j][0] > 1e-9:
                mesh.triangles.append((a, b, c))
            if points[j + 1][0] > 1e-9:
                mesh.triangles.append((a, c, d))
    return mesh


def turned(corners, segments=48, steps=4):
    """Return a solid of revolution of a polyline with fillets."""
    return lathe(profile(corners, steps), segments)


def cylinder(radius, bottom, top, bevel=0.0, segments=32):
    return turned([(0, bottom, 0), (radius, bottom, bevel), (radius, top, bevel), (0, top, 0)], segments, 3)


def tube(path, radius, segments=16, caps=True):
    """Return a tube along points; `radius` is a number or a function of the position 0 to 1."""
    radius_of = radius if callable(radius) else lambda t: radius
    rings = _rings(path, radius_of)
    if caps:
        rings = _cap(rings[0], -1) + rings + _cap(rings[-1], 1)
    mesh = Mesh()
    for center, side, up, size, along in rings:
        for i in range(segments + 1):
            c, s = turn(360 * i / segments)
            offset = add(scaled(side, c * size), scaled(up, s * size))
            mesh.positions.append(add(center, offset))
            mesh.uvs.append((i / segments, along))
    for j in range(len(rings) - 1):
        for i in range(segments):
            a = j * (segments + 1) + i
            b, c, d = a + 1, a + segments + 2, a + segments + 1
            if rings[j][3] > 0:
                mesh.triangles.append((a, b, c))
            if rings[j + 1][3] > 0:
                mesh.triangles.append((a, c, d))
    return smoothed(mesh)


def _rings(path, radius_of):
    rings, side = [], None
    for i, p in enumerate(path):
        ahead = unit(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
        if side is None:
            side = (0, 0, 1) if abs(ahead[2]) < 0.9 else (1, 0, 0)
        side = unit(sub(side, scaled(ahead, dot(side, ahead))))
        t = i / (len(path) - 1)
        rings.append((p, side, cross(ahead, side), radius_of(t), t))
    return rings


def _cap(ring, direction):
    """Return rings of a round end beyond the first (-1) or last (1) ring of a tube."""
    center, side, up, size, along = ring
    ahead = scaled(cross(side, up), direction)
    caps = [(add(center, scaled(ahead, size * s)), side, up, size * c, along)
            for c, s in ((0.924, 0.383), (0.707, 0.707), (0.383, 0.924), (0.0, 1.0))]
    return caps if direction > 0 else caps[::-1]


def superellipsoid(half, roundness=1.0, columns=32, rows=20):
    """Return an ellipsoid of half axes `half`; `roundness` under 1 makes it more like a box."""
    def power(x):
        return math.copysign(abs(x) ** roundness, x)

    def point(u, v):
        c, s = turn(360 * u)
        cv, sv = math.cos(math.pi * (v - 0.5)), math.sin(math.pi * (v - 0.5))
        ring = 0.0 if v in (0, 1) else power(cv)
        return (half[0] * ring * power(s), half[1] * power(sv), half[2] * ring * power(c))

    return grid(point, columns, rows)


def torus_knot(p, q, radius, hole, thickness, columns=24, rows=240):
    """Return a tube along the (p, q) knot on a torus around the y axis."""
    def center(t):
        a, b = 2 * math.pi * p * t, 2 * math.pi * q * t
        r = radius + hole * math.cos(b)
        return (r * math.sin(a), hole * math.sin(b), r * math.cos(a))

    def point(u, v):
        at = center(v)
        ahead = unit(sub(center(v + 1e-3), center(v - 1e-3)))
        a = 2 * math.pi * p * v
        outward = sub(at, (radius * math.sin(a), 0, radius * math.cos(a)))
        side = unit(sub(outward, scaled(ahead, dot(outward, ahead))))
        up = cross(side, ahead)
        c, s = turn(360 * (u % 1))
        return add(at, add(scaled(side, c * thickness), scaled(up, -s * thickness)))

    return grid(lambda u, v: point(u, v % 1), columns, rows)


def brilliant():
    """Return a round brilliant of radius 1: its table upwards, its girdle at y = 0."""
    def ring(count, from_degrees, r, y):
        return [(r * turn(from_degrees + 360 * i / count)[1], y, r * turn(from_degrees + 360 * i / count)[0])
                for i in range(count)]

    table, star = ring(8, 0, 0.55, 0.35), ring(8, 22.5, 0.8, 0.2156)
    upper, lower = ring(16, 0, 1, 0.03), ring(16, 0, 1, -0.03)
    main, culet = ring(8, 22.5, 0.32, -0.615), (0, -0.87, 0)
    faces = [[(0, 0.35, 0), table[i], table[(i + 1) % 8]] for i in range(8)]
    for i in range(8):
        j, g = (i + 1) % 8, 2 * i
        faces.append([table[i], star[i], table[j]])
        faces += [[table[i], upper[g], star[i]], [table[j], star[i], upper[(g + 2) % 16]]]
        faces += [[star[i], upper[g], upper[g + 1]], [star[i], upper[g + 1], upper[(g + 2) % 16]]]
        faces += [[culet, main[i], lower[g]], [culet, lower[(g + 2) % 16], main[i]]]
        faces += [[main[i], lower[g + 1], lower[g]], [main[i], lower[(g + 2) % 16], lower[g + 1]]]
    for i in range(16):
        j = (i + 1) % 16
        faces += [[upper[i], lower[i], lower[j]], [upper[i], lower[j], upper[j]]]
    mesh = Mesh()
    for face in faces:
        mesh.triangles.append(tuple(len(mesh.positions) + k for k in range(3)))
        mesh.positions += face
    return mesh.facets()


def bent(points, count):
    """Return `count` points at equal steps along a polyline."""
    lengths = [0.0]
    for a, b in zip(points, points[1:]):
        lengths.append(lengths[-1] + math.dist(a, b))
    result, k = [], 0
    for i in range(count):
        s = lengths[-1] * i / (count - 1)
        while k < len(points) - 2 and s > lengths[k + 1]:
            k += 1
        result.append(mix(points[k], points[k + 1], (s - lengths[k]) / (lengths[k + 1] - lengths[k])))
    return result
