"""Makes the models of the gallery, and the lists of what stands where.

    python3 scenes/gallery/models/make.py

Every model is a formula; the same program makes the same files. Needs numpy.
"""
import json
import os

import numpy as np

from meshes import FOLDER, TURN, about, box, curve, cushion, cut, grid, joined, lathe, moved, tube_along, write


# -- jewels -----------------------------------------------------------------------------------------------------------

def facets(count, from_degrees, slope_degrees, distance):
    """Planes all round, whose normals lean `slope_degrees` from the y axis."""
    slope = np.radians(slope_degrees)
    for i in range(count):
        angle = np.radians(from_degrees) + i * TURN / count
        yield (np.sin(slope) * np.cos(angle), np.cos(slope), np.sin(slope) * np.sin(angle)), distance


def brilliant():
    """A round brilliant, girdle of radius 1 at y = 0 (Tolkowsky 1919: table 53 %, crown 34.5, pavilion 40.75 degrees)."""
    crown, pavilion = np.radians(34.5), np.radians(40.75)
    girdle = 0.02
    upper = np.sin(crown) * np.cos(np.pi / 16) + np.cos(crown) * girdle
    lower = np.sin(pavilion) * np.cos(np.pi / 16) + np.cos(pavilion) * girdle
    table = girdle + (1 - 0.53) * np.tan(crown) * 0.97
    planes = [((0, 1, 0), table)]
    planes += facets(8, 0, 34.5, upper)
    # Star facets cut the corners between table and crown, upper and lower halves those at the girdle.
    star = np.radians(20)
    planes += facets(8, 22.5, 20, np.sin(star) * 0.60 + np.cos(star) * (table - 0.02))
    half = np.radians(42)
    for turn in (11.25, -11.25):
        planes += facets(8, turn, 42, np.sin(half) + np.cos(half) * girdle - 0.004)
        planes += facets(8, turn, 180 - 42.1, np.sin(np.radians(42.1)) + np.cos(np.radians(42.1)) * girdle - 0.004)
    planes += facets(8, 0, 180 - 40.75, lower)
    planes += facets(64, 0, 90, 1.0)
    return cut(planes)


def step_cut(width=1.0, length=1.4):
    """An emerald cut: three steps above and below the girdle, corners cut."""
    planes = [((0, 1, 0), 0.42)]
    for slope, drop in ((28, 0.0), (40, 0.018), (52, 0.055)):
        for side, reach in (((1, 0), width), ((0, 1), length)):
            s, c = np.sin(np.radians(slope)), np.cos(np.radians(slope))
            top = 0.42 - drop - {28: 0.0, 40: 0.05, 52: 0.10}[slope]
            inner = reach * {28: 0.66, 40: 0.745, 52: 0.82}[slope]
            for sign in (1, -1):
                planes.append(((sign * side[0] * s, c, sign * side[1] * s), s * inner + c * top))
    for slope, inner, height in ((48, 1.0, -0.03), (40, 0.80, -0.25), (32, 0.55, -0.45)):
        for side, reach in (((1, 0), width), ((0, 1), length)):
            s, c = np.sin(np.radians(slope)), np.cos(np.radians(slope))
            for sign in (1, -1):
                planes.append(((sign * side[0] * s, -c, sign * side[1] * s),
                               s * (reach - width * (1 - inner)) - c * height))
    for a in (1, -1):
        for b in (1, -1):
            planes.append(((a, 0, b), (width + length) * 0.84 / np.sqrt(2)))
            planes.append(((a, 1.2, b), ((width + length) * 0.74 + 0.2) / np.sqrt(3.44)))
            planes.append(((a, -1.0, b), ((width + length) * 0.78 + 0.05) / np.sqrt(3.0)))
    for axis, reach in (((1, 0, 0), width), ((0, 0, 1), length)):
        planes += [(axis, reach), (tuple(-x for x in axis), reach)]
    return cut(planes)


def ring(radius=1.0, width=0.17, thickness=0.09):
    """A plain ring about the z axis, round on the outside."""
    u, v = np.meshgrid(np.arange(240) / 240 * TURN, np.arange(40) / 40 * TURN, indexing="ij")
    z, across = np.sign(np.sin(v)) * np.abs(np.sin(v)) ** 0.7 * width, np.cos(v)
    out = radius + thickness * np.where(across > 0, across, 0.35 * across)
    return grid(np.stack([out * np.cos(u), out * np.sin(u), z], axis=2), wrap_u=True, wrap_v=True)


def jewels():
    write("brilliant", brilliant(), smooth=False)
    write("step-cut", step_cut(), smooth=False)
    write("ring", ring())


# -- a bottle, a ball to show materials, furniture -----------------------------------------------------------------------

def bottle():
    body = cushion((2.6, 3.2, 1.25), (7, 9, 5), steps=64)
    write("bottle", body)
    write("bottle-inside", cushion((2.15, 2.62, 0.82), (6, 8, 4), steps=48))
    knurls = lambda r, y, a: r * (1 + 0.018 * np.clip(3 * np.cos(48 * a), -1, 1) * (r > 0.8) * (y > 0.15) * (y < 1.75))
    cap = [(0, 0), (0.86, 0), (0.86, 0.12), (0.9, 0.16), *[(0.9, 0.16 + 1.6 * i / 30) for i in range(31)],
           (0.9, 1.78), (0.84, 1.86), (0.6, 1.9), (0, 1.9)]
    write("cap", lathe(cap, 288, knurls))
    write("collar", lathe([(0, 0), (0.62, 0), (0.62, 0.06), (0.5, 0.12), (0.5, 0.34), (0, 0.34)], 96))


def show_ball():
    """A ball with a groove around it, on a foot: curves of every kind for light to run along."""
    foot = curve((0, 0), (0, 0), (0.62, 0), (0.66, 0.02), (0.66, 0.06), (0.60, 0.09), (0.40, 0.13), (0.30, 0.22), (0.30, 0.30),
                 steps=5)
    lower = [(np.cos(a), 1.12 + np.sin(a)) for a in np.linspace(-1.2, -0.10, 40)]
    groove = [(0.93, 1.12 - 0.085), (0.90, 1.12 - 0.06), (0.90, 1.12 + 0.06), (0.93, 1.12 + 0.085)]
    upper = [(np.cos(a), 1.12 + np.sin(a)) for a in np.linspace(0.10, np.pi / 2, 50)]
    profile = np.array([*foot, *lower, *groove, *upper])
    angles = np.linspace(0, TURN, 129)
    radius, height = profile[:, :1], profile[:, 1:] + 0 * angles
    points = np.stack([radius * np.cos(angles), height, -radius * np.sin(angles)], axis=2)
    v, u = np.meshgrid(np.arange(len(profile)) / len(profile), angles / TURN, indexing="ij")
    write("show-ball", grid(points), uvs=np.stack([u, v], axis=2).reshape(-1, 2))


def stage():
    """A floor that bends up behind."""
    bend = [(-9 - 8 * np.sin(a), 8 - 8 * np.cos(a)) for a in np.linspace(0, np.pi / 2, 40)]
    line = [(40, 0), (10, 0), *bend, (-17, 40)]
    write("stage", grid(np.array([[(x, y, z) for x in (-60, 0, 60)] for z, y in line])))


def strip(center, width, lift, steps=12):
    """A leaf: along a curve, as wide as `width` says, bent by `lift` across."""
    center = np.asarray(center, float)
    ways = np.gradient(center, axis=0)
    side = np.cross(ways, (0, 1, 0))
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)
    rows = [center + side * (s * np.asarray(width))[:, None] + np.array((0, 1, 0)) * (abs(s) * lift * np.asarray(width))[:, None]
            for s in (-1, -0.5, 0, 0.5, 1)]
    return grid(np.array(rows))


def house_plant(random):
    leaves = []
    for i in range(17):
        angle, length = i * 2.4, 0.55 + 0.4 * random.random()
        t = np.linspace(0, 1, 16)
        rise = 0.35 + 0.75 * random.random()
        out = length * t * (0.35 + 0.4 * rise)
        up = rise * t - 0.45 * t ** 3 * length
        center = np.stack([out * np.cos(angle), up, out * np.sin(angle)], axis=1)
        width = 0.085 * np.sin(np.pi * np.clip((t - 0.25) / 0.75, 0, 1)) ** 0.7 + 0.006
        leaves.append(strip(center, width, 0.5))
    write("plant", joined(*leaves))
    pot = curve((0, 0), (0, 0), (0.15, 0), (0.15, 0), (0.19, 0.2), (0.22, 0.36), (0.22, 0.36), (0.20, 0.36), (0.20, 0.36), (0.18, 0.30), (0.18, 0.30), (0, 0.30))
    write("pot", lathe(pot, 64))


def facets_all(size):
    """A bud: a cube with its corners cut."""
    ways = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)]
    return [(way, size) for way in ways]


def furniture(random):
    write("seat", cushion((0.42, 0.11, 0.42), (8, 3, 8), steps=32))
    write("pillow", cushion((0.25, 0.25, 0.10), (3.2, 3.2, 1.25), steps=32))
    write("shade", joined(lathe([(0.24, 0), (0.17, 0.30)], 96)))
    write("pendant", lathe(curve((0.30, 0), (0.29, 0.05), (0.24, 0.14), (0.13, 0.22), (0.04, 0.25), (0.03, 0.30)), 96))
    vase = curve((0, 0), (0, 0), (0.07, 0), (0.09, 0.02), (0.13, 0.12), (0.12, 0.22), (0.06, 0.32), (0.045, 0.37), (0.06, 0.40),
                 (0.06, 0.40), (0.052, 0.40), (0.052, 0.40), (0.038, 0.36), (0.05, 0.31), (0.10, 0.2), (0, 0.06))
    write("vase", lathe(vase, 64))
    bowl = curve((0, 0), (0, 0), (0.08, 0), (0.08, 0), (0.09, 0.012), (0.17, 0.05), (0.22, 0.11), (0.222, 0.115), (0.214, 0.115),
                 (0.16, 0.06), (0.08, 0.025), (0, 0.02))
    write("bowl", lathe(bowl, 96))
    u, v = np.meshgrid(np.linspace(0, 1, 240), np.linspace(0, 1, 24))
    wave = (0.5 + 0.5 * v) * 0.045 * np.sin(u * TURN * 9 + 0.9 * np.sin(u * 17) + 0.25 * v)
    write("curtain", grid(np.stack([u, v, wave], axis=2)))
    branch = []
    for i in range(5):
        t = np.linspace(0, 1, 14)
        angle = i * 1.3 + 0.2
        lean = 0.12 + 0.22 * random.random()
        bend = np.cumsum(random.normal(0, 0.012, (14, 3)), axis=0)
        center = np.stack([lean * t ** 1.3 * np.cos(angle), 0.9 * t * (0.8 + 0.3 * random.random()), lean * t ** 1.3 * np.sin(angle)], axis=1) + bend
        branch.append(tube_along(center, 0.006 * (1.1 - t), 6))
        for k in range(4, 14):
            for _ in range(2):
                at = center[k] + random.normal(0, 0.022, 3)
                branch.append(moved(cut(facets_all(0.015)), at))
    write("twigs", joined(*branch))


def books(random):
    """A shelf's row of books, 1 long: groups by color."""
    covers = ["book red", "book blue", "book green", "book sand", "book black", "book white"]
    out, x = [], 0.0
    while x < 0.94:
        thick, height, deep = 0.018 + 0.03 * random.random(), 0.2 + 0.09 * random.random(), 0.15 + 0.04 * random.random()
        out.append({"shape": {"cuboid": {"min": [round(x, 4), 0, round(0.2 - deep, 4)], "max": [round(x + thick, 4), round(height, 4), 0.2]}},
                    "material": covers[random.integers(len(covers))]})
        x += thick + 0.002
    return out


# -- fields and trees -------------------------------------------------------------------------------------------------

def lavender(random):
    stems, flowers = [], []
    for _ in range(70):
        angle, lean = random.random() * TURN, 0.62 * random.random() ** 0.6
        t = np.linspace(0, 1, 4)
        length = 0.46 + 0.12 * random.random()
        center = np.stack([np.sin(lean) * length * t ** 1.2 * np.cos(angle), np.cos(lean) * length * t,
                           np.sin(lean) * length * t ** 1.2 * np.sin(angle)], axis=1)
        center[:, [0, 2]] += random.normal(0, 0.05, 2)
        stems.append(tube_along(center, 0.0035, 3))
        way = center[-1] - center[-2]
        way /= np.linalg.norm(way)
        spike = center[-1] + way * np.linspace(-0.02, 0.11, 7)[:, None]
        flowers.append(tube_along(spike, [0.003, 0.013, 0.010, 0.015, 0.011, 0.010, 0.001], 5))
    for _ in range(60):
        angle, lean = random.random() * TURN, 0.35 + 0.8 * random.random()
        t = np.linspace(0, 1, 3)
        length = 0.2 + 0.14 * random.random()
        center = np.stack([np.sin(lean) * length * t * np.cos(angle), np.cos(lean) * length * t, np.sin(lean) * length * t * np.sin(angle)], axis=1)
        stems.append(tube_along(center, [0.006, 0.008, 0.001], 3))
    write("lavender-stems", joined(*stems), smooth=False)
    write("lavender-flowers", joined(*flowers), smooth=False)


def plants_of(random, group, count, place, scale, also=()):
    out = []
    for i in range(count):
        x, y, z = place(i)
        out.append({"group": group, "transform": [
            {"rotate": {"axis": [0, 1, 0], "degrees": int(random.integers(360))}}, {"scale": round(scale * (0.8 + 0.4 * random.random()), 3)},
            {"translate": [round(x, 3), round(y, 3), round(z, 3)]}]})
    return out


def tree(random):
    """Branches fork and bend towards the light; twigs of leaves stand on the last ones."""
    tubes, tips = [], []

    def grow(start, way, length, radius, level):
        steps = 6
        points = [start]
        for _ in range(steps):
            way = way + random.normal(0, 0.13, 3) + np.array((0, 0.03, 0))
            way /= np.linalg.norm(way)
            points.append(points[-1] + way * length / steps)
        tubes.append(tube_along(points, np.linspace(radius, radius * 0.68, steps + 1), 10 if level < 2 else 6))
        if level >= 3:
            tips.extend((point, way) for point in points[2:])
        if level == 5:
            return
        for i in range(3 if level < 4 else 2):
            turn = about(way, i * TURN / 3 + random.random())
            side = np.cross(way, (0.3, 0.2, 0.9))
            side /= np.linalg.norm(side)
            lean = 0.45 + 0.35 * random.random()
            grow(points[-1], turn @ (way * np.cos(lean) + side * np.sin(lean)), length * (0.68 + 0.12 * random.random()), radius * 0.6, level + 1)

    grow(np.zeros(3), np.array((0.04, 1.0, 0.02)), 2.0, 0.3, 0)
    write("tree", joined(*tubes))
    leaves = []
    for i in range(26):
        way = random.normal(0, 1, 3)
        way /= np.linalg.norm(way)
        t = np.linspace(0, 1, 4)
        size = 0.10 + 0.05 * random.random()
        center = way * 0.16 * random.random() + np.outer(t * size, way + np.array((0, -0.25, 0)))
        leaves.append(strip(center, 0.03 * np.array((0.3, 1, 0.85, 0.05)), 0.35))
    write("twig", joined(*leaves), smooth=False)
    out = []
    for point, _ in tips:
        x, y, z = np.asarray(point) + random.normal(0, 0.05, 3)
        out.append({"shape": {"mesh": {"file": "twig.ply"}}, "transform": [
            {"rotate": {"axis": [round(float(a), 2) for a in random.normal(0, 1, 3)], "degrees": int(random.integers(360))}},
            {"scale": round(0.9 + 0.8 * random.random(), 2)}, {"translate": [round(float(x), 3), round(float(y), 3), round(float(z), 3)]}]})
    print(f"tree: {len(out)} twigs")
    return out


def hills():
    """Nearly level ground, and hills behind it."""
    x, z = np.meshgrid(np.linspace(-420, 420, 150), np.linspace(-900, 30, 150))
    far = np.clip((-z - 90) / 400, 0, 1)
    y = far * far * (3 - 2 * far) * (34 + 22 * np.sin(x * 0.011 + 1.2) + 12 * np.sin(x * 0.027 + z * 0.013) + 5 * np.sin(x * 0.063 - z * 0.02))
    y += 0.55 * np.sin(x * 0.045) * np.clip(-z / 60, 0, 1) - 1.6 * np.exp(-((z + 60) / 40) ** 2)
    write("hills", grid(np.stack([x, y, z], axis=2)[::-1]))


# -- a hall -----------------------------------------------------------------------------------------------------------

def hall():
    flutes = lambda r, y, a: r - 0.035 * np.maximum(0, np.cos(20 * a)) ** 0.6 * ((y > 0.45) & (y < 5.2))
    shaft = [(0.62, 0), (0.62, 0.16), (0.56, 0.2), (0.60, 0.26), (0.60, 0.32), (0.52, 0.36), (0.46, 0.42), *[(0.45 - 0.06 * t, 0.45 + 4.75 * t) for t in np.linspace(0, 1, 24)],
             (0.44, 5.24), (0.44, 5.30), (0.50, 5.36), (0.64, 5.50), (0.64, 5.62), (0, 5.62)]
    write("column", lathe(shaft, 160, flutes))
    # A piece of wall, 3 wide, with a window of 1.3 by 4.2 that ends in half a circle; its middle is the origin, its depth -z.
    half, sill, spring, top, depth = 0.55, 2.2, 5.4, 8.0, 0.6
    arch = [(half * np.cos(a), spring + half * np.sin(a)) for a in np.linspace(0, np.pi, 33)]
    outline = [(half, sill), *arch, (-half, sill)]
    sides = [(1.5, sill), *[(1.5, spring + (top - spring) * min(1, t / 8)) if t <= 8 else (1.5 - 3 * (t - 8) / 16, top) if t <= 24 else (-1.5, top - (top - spring) * (t - 24) / 8) for t in range(33)], (-1.5, sill)]
    front = np.array([[(x, y, 0) for x, y in outline], [(x, y, 0) for x, y in sides]])
    back = front + np.array((0, 0, -depth))
    reveal = np.array([[(x, y, 0) for x, y in outline], [(x, y, -depth) for x, y in outline]])
    write("window", joined(grid(front), grid(back[::-1]), grid(reveal[::-1]), box((-1.5, 0, -depth), (1.5, sill, 0))))


def put(name, groups):
    with open(os.path.join(FOLDER, name + ".json"), "w") as file:
        lines = ",\n".join(f'    {json.dumps(group)}: [\n' + ",\n".join("      " + json.dumps(entry) for entry in entries) + "\n    ]"
                           for group, entries in groups.items())
        file.write('// Made by make.py.\n{\n  "version": 1,\n  "groups": {\n' + lines + "\n  }\n}\n")


def main():
    random = np.random.default_rng(1986)
    jewels()
    bottle()
    show_ball()
    stage()
    house_plant(random)
    furniture(random)
    put("books", {f"books {i}": books(random) for i in range(1, 5)})
    lavender(random)
    hills()
    rows = {}
    for kind in range(4):
        def place(i):
            return (random.normal(0, 0.07), 0, -0.42 * i + random.normal(0, 0.05))
        rows[f"lavender row {kind + 1}"] = plants_of(random, "lavender", 60, place, 1.15)
    put("lavender-rows", {**rows, "twigs": tree(random)})
    hall()


if __name__ == "__main__":
    main()
