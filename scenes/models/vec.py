"""Vectors as tuples, quaternions as (x, y, z, w), rigid and scaled transforms as functions."""
import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scaled(a, factor):
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    """Return `a` with length 1; a vector without length becomes +Y."""
    size = length(a)
    return scaled(a, 1 / size) if size > 1e-12 else (0.0, 1.0, 0.0)


def mix(a, b, t):
    """Interpolate linearly between numbers or between tuples of one length."""
    if isinstance(a, (int, float)):
        return a + (b - a) * t
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def rotation(axis, degrees):
    """Return the quaternion of a rotation around `axis`."""
    half = math.radians(degrees) / 2
    x, y, z = scaled(unit(axis), math.sin(half))
    return (x, y, z, math.cos(half))


def product(a, b):
    """Return the quaternion of rotation `b` followed by rotation `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def euler(x=0.0, y=0.0, z=0.0):
    """Return the quaternion of rotations around x, then y, then z, in degrees."""
    return product(rotation((0, 0, 1), z), product(rotation((0, 1, 0), y), rotation((1, 0, 0), x)))


def rotate(q, v):
    axis, w = q[:3], q[3]
    twice = scaled(cross(axis, v), 2)
    return add(add(v, scaled(twice, w)), cross(axis, twice))


def look_at(eye, target):
    """Return the quaternion that turns -Z from `eye` to `target` and keeps +Y upwards."""
    back = unit(sub(eye, target))
    right = unit(cross((0, 1, 0), back))
    up = cross(back, right)
    w = math.sqrt(max(0.0, 1 + right[0] + up[1] + back[2])) / 2
    return ((up[2] - back[1]) / (4 * w), (back[0] - right[2]) / (4 * w), (right[1] - up[0]) / (4 * w), w)
