"""Furniture of the room; every function adds nodes to a document and returns nothing."""
import math

from gltf import rounded
from mesh import Mesh, curve, grid, joined
from noise import between, hashed
from shapes import bent, box, cylinder, lathe, smooth_profile, tube, turned
from vec import euler, rotation, smoothstep


def put(document, name, mesh, material, parent=None, at=None, rotation=None):
    """Add a node with one mesh of one material."""
    index = document.mesh(name, document.primitive(mesh, material))
    return document.node(name, parent, mesh=index, translation=rounded(at) if at else None,
                         rotation=rounded(rotation) if rotation else None)


def leg(height, top, foot):
    """Return a round tapered leg that stands on the floor."""
    return turned([(0, 0, 0), (foot, 0, 0.004), (top, height, 0)], 24)


def table(document, look, at):
    node = document.node("Table", translation=rounded(at))
    put(document, "Table top", box((1.4, 0.036, 0.72), 0.009, 3, 1.0), look["walnut"], node, (0, 0.732, 0))
    legs = [leg(0.72, 0.026, 0.015).moved((x * 0.58, 0, z * 0.26), euler(x=z * -4, z=x * 4))
            for x in (-1, 1) for z in (-1, 1)]
    rails = [box((1.12, 0.07, 0.022), 0.004).moved((0, 0.68, z * 0.25)) for z in (-1, 1)]
    rails += [box((0.022, 0.07, 0.5), 0.004).moved((x * 0.555, 0.68, 0)) for x in (-1, 1)]
    put(document, "Table frame", joined(*legs, *rails), look["walnut"], node)


def chair(document, look, at, degrees):
    """Add a chair whose back is on its +Z side."""
    node = document.node("Chair", translation=rounded(at), rotation=rounded(rotation((0, 1, 0), degrees)))
    parts = [leg(0.45, 0.02, 0.013).moved((x * 0.175, 0, -0.17), euler(x=3, z=x * 4)) for x in (-1, 1)]
    for x in (-1, 1):
        post = [(x * 0.2, 0, 0.225), (x * 0.185, 0.45, 0.19), (x * 0.19, 0.66, 0.215), (x * 0.2, 0.86, 0.27)]
        parts.append(tube(curve(post, 6), 0.0165, 16))
    for height, z in ((0.82, 0.262), (0.7, 0.232), (0.585, 0.212)):
        def slat(u, v, height=height, z=z):
            a = (u - 0.5) * 2
            return (a * 0.192, height + (v - 0.5) * 0.07, z + 0.035 * (1 - a * a))
        front = grid(slat, 16, 3)
        rear = grid(lambda u, v: slat(1 - u, v), 16, 3).moved((0, 0, -0.012))
        parts += [front, rear]
        edge = [slat(i / 12, 1) for i in range(13)], [slat(i / 12, 0) for i in range(13)]
        parts += [tube([(p[0], p[1], p[2] - 0.006) for p in line], 0.0075, 10) for line in edge]
    parts.append(box((0.36, 0.03, 0.02), 0.006).moved((0, 0.3, 0.2)))
    put(document, "Chair frame", joined(*parts), look["walnut"], node)
    seat = box((0.42, 0.05, 0.42), 0.022, 4, 1).moved((0, 0.465, 0.0))
    put(document, "Chair seat", seat, look["leather"], node)


def armchair(document, look, at, degrees):
    """Add an upholstered armchair that faces +Z."""
    node = document.node("Armchair", translation=rounded(at), rotation=rounded(rotation((0, 1, 0), degrees)))
    cloth = [box((0.62, 0.2, 0.66), 0.05, 4, 6).moved((0, 0.29, 0)),
             box((0.56, 0.16, 0.6), 0.07, 5, 6).moved((0, 0.44, 0.05)),
             box((0.6, 0.62, 0.2), 0.085, 5, 6).moved((0, 0.66, -0.27), euler(x=-10))]
    cloth += [box((0.15, 0.36, 0.72), 0.07, 5, 6).moved((x * 0.36, 0.4, 0)) for x in (-1, 1)]
    cloth.append(box((0.42, 0.3, 0.13), 0.06, 5, 6).moved((0.02, 0.65, -0.1), euler(x=-22, z=6)))
    put(document, "Armchair cushions", joined(*cloth), look["velvet"], node)
    legs = [leg(0.2, 0.024, 0.014).moved((x * 0.3, 0, z * 0.27), euler(x=z * -9, z=x * 9))
            for x in (-1, 1) for z in (-1, 1)]
    put(document, "Armchair legs", joined(*legs), look["walnut"], node)


def floor_light(document, look, at):
    """Add a floor light: brass, an emissive linen shade and a point light inside."""
    node = document.node("Floor light", translation=rounded(at))
    foot = turned([(0, 0, 0), (0.14, 0, 0.006), (0.135, 0.022, 0.012), (0.02, 0.032, 0.008), (0.011, 0.06, 0),
                   (0.011, 1.42, 0.004), (0, 1.42, 0)], 48)
    put(document, "Light stand", foot, look["brass"], node)
    shade = lathe([(0.2, 1.24, (0.96, 0.28)), (0.13, 1.5, (0.96, 0.28))], 64)
    put(document, "Light shade", shade, look["shade"], node)
    rims = [tube([(r * math.sin(a), y, r * math.cos(a)) for a in [2 * math.pi * i / 64 for i in range(49)]],
                 0.004, 6, caps=False) for r, y in ((0.2, 1.24), (0.13, 1.5))]
    put(document, "Light rims", joined(*rims), look["brass"], node)
    light = document.light(type="point", name="Bulb", color=[1, 0.72, 0.42], intensity=0.9)
    document.node("Bulb", node, translation=[0, 1.38, 0], extensions=light)


def shelf(document, look, at):
    """Add a book shelf; its books are instances of one mesh in four bindings."""
    node = document.node("Shelf", translation=rounded(at))
    width, depth, tops = 1.12, 0.27, (0.09, 0.45, 0.81, 1.17, 1.53, 1.86)
    boards = [box((width, 0.024, depth), 0.003, 2).moved((0, y, 0)) for y in tops]
    boards += [box((0.026, 1.872, depth + 0.01), 0.003, 2).moved((x * (width / 2 + 0.012), 0.936, 0)) for x in (-1, 1)]
    boards.append(box((width, 1.8, 0.012)).moved((0, 0.96, -depth / 2 + 0.006)))
    put(document, "Shelf boards", joined(*boards), look["oak"], node)
    rows = [[] for _ in look["books"]]
    for k, y in enumerate(tops[:-1]):
        _shelved(rows, k, y + 0.012, width, between(0.6, 0.95, 7, k))
    for k, (books, material) in enumerate(zip(rows, look["books"])):
        mesh = document.mesh(f"Book {k + 1}", document.primitive(book(), material))
        instance(document, f"Books {k + 1}", mesh, books, node)
    pot = lathe(smooth_profile([(0, 0), (0.05, 0), (0.085, 0.07), (0.06, 0.15), (0.03, 0.19), (0.036, 0.21)], 4), 32)
    put(document, "Jar", pot, look["glaze"], node, (0.36, 1.182, 0.01))


def _shelved(rows, k, y, width, share):
    """Fill one shelf with hashed books up to a share of its width, the last one leaning."""
    x, i = -width / 2 + 0.012, 0
    while x < -width / 2 + width * share:
        thick = between(0.018, 0.05, 1, k, i)
        high, deep = between(0.2, 0.29, 2, k, i), between(0.15, 0.2, 3, k, i)
        binding = int(hashed(4, k, i // 2) * len(rows))
        rows[binding].append(((x + thick / 2, y, 0.115 - between(0.0, 0.02, 5, k, i)), (0, 0, 0, 1), (thick, high, deep)))
        x += thick + 0.0015
        i += 1
    tilt = rotation((0, 0, 1), 12)
    rows[k % len(rows)].append(((x + 0.005, y, 0.11), tilt, (0.026, 0.24, 0.17)))


def book():
    """Return a book of width, height and depth 1 whose spine is at z = 0, with vertex colors.

    The vertex colors are white on the binding and the tone of paper on the block of pages.
    """
    cover = box((1, 1, 1), 0.0).moved((0, 0.5, -0.5))
    spine = grid(lambda u, v: (0.5 * math.sin((u - 0.5) * math.pi), v, 0.06 * math.cos((u - 0.5) * math.pi)), 8, 4)
    def tone(p, n):
        return (0.85, 0.78, 0.62) if n[1] > 0.9 else (1, 1, 1)
    def band(p, n):
        return (1, 0.85, 0.5) if abs(p[1] - 0.75) < 0.01 else (1, 1, 1)
    return joined(cover.colored(tone), spine.colored(band))


def instance(document, name, mesh, placed, parent):
    """Add a node that draws instances of a mesh; each is a translation, rotation and scale."""
    attributes = {
        "TRANSLATION": document.accessor([p[0] for p in placed], "VEC3"),
        "ROTATION": document.accessor([p[1] for p in placed], "VEC4"),
        "SCALE": document.accessor([p[2] for p in placed], "VEC3")}
    document.node(name, parent, mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})


def plant(document, look, at):
    """Add a potted plant; its leaves are instances of one mesh with vertex colors."""
    node = document.node("Plant", translation=rounded(at))
    pot = turned([(0, 0, 0), (0.13, 0, 0.015), (0.19, 0.33, 0.008), (0.172, 0.33, 0.006), (0.165, 0.28, 0), (0, 0.28, 0)], 56)
    put(document, "Pot", pot, look["clay"], node)
    put(document, "Soil", cylinder(0.166, 0.27, 0.29, 0.004), look["soil"], node)
    stems, leaves = [], []
    for i in range(26):
        around, lean = 137.5 * i, between(14, 62, 61, i) * (0.55 + 0.45 * (i % 5) / 4)
        size, reach = between(0.2, 0.34, 62, i), between(0.4, 0.95, 63, i) * (1.15 - lean / 110)
        c, s = math.cos(math.radians(around)), math.sin(math.radians(around))
        out = reach * math.sin(math.radians(lean))
        tip = (out * s, 0.3 + reach * math.cos(math.radians(lean)), out * c)
        path = curve([(0.04 * s, 0.27, 0.04 * c), (out * 0.35 * s, 0.3 + 0.6 * (tip[1] - 0.3), out * 0.35 * c), tip], 5)
        stems.append(tube(bent(path, 7), lambda t: 0.006 - 0.003 * t, 7, caps=False))
        turn = euler(x=lean + between(15, 55, 64, i), y=around + between(-20, 20, 65, i))
        leaves.append((tip, turn, (size * 0.9, size, size)))
    put(document, "Stems", joined(*stems), look["stem"], node)
    mesh = document.mesh("Leaf", document.primitive(leaf(), look["leaf"]))
    instance(document, "Leaves", mesh, leaves, node)


def leaf():
    """Return a leaf of length 1 along +Y that faces +Z, folded at its rib and bent back."""
    def point(u, v):
        a = (u - 0.5) * 2
        wide = 0.36 * math.sin(math.pi * v ** 0.8) ** 0.8 * (1 - 0.2 * v)
        return (a * wide, v * (1 - 0.12 * v), 0.1 * abs(a) * wide * 2 - 0.28 * v * v + 0.012 * math.sin(9 * v) * abs(a))
    mesh = grid(point, 10, 16)
    def tone(p, n):
        rib = 1 - smoothstep(0.0, 0.035, abs(p[0]))
        return (0.55 + 0.4 * rib, 0.8 + 0.2 * rib, 0.5 + 0.2 * rib)
    return mesh.colored(tone)


def curtain(document, look, name, at, width, height, seed):
    """Add a hanging curtain with folds that grow from its rail downwards."""
    def point(u, v):
        phase = 2 * math.pi * (6 * u + 0.25 * math.sin(7 * u + seed))
        depth = 0.024 + 0.014 * (1 - v) * math.sin(5 * u + seed)
        spread = 1 + 0.06 * (1 - v) * math.sin(3 * u + seed)
        return ((u - 0.5) * width * spread, v * height, depth * math.sin(phase))
    put(document, name, grid(point, 96, 12), look["linen"], None, at)


def vase(document, look, at):
    """Add a glazed vase with three twigs of blossoms, which are instances."""
    node = document.node("Vase", translation=rounded(at))
    body = smooth_profile([(0, 0), (0.04, 0.0), (0.05, 0.01), (0.085, 0.09), (0.075, 0.16), (0.034, 0.225), (0.042, 0.26)], 4)
    inside = [(r - 0.006, y, (-n[0], -n[1])) for r, y, n in body[::-1] if r > 0.03]
    put(document, "Vase body", joined(lathe(body, 44), lathe(inside, 44)), look["glaze"], node)
    twigs, blossoms = [], []
    for i, (x, z, high) in enumerate(((-0.2, 0.02, 0.62), (0.05, -0.06, 0.74), (0.22, 0.05, 0.55))):
        path = curve([(0, 0.1, 0), (0.2 * x, 0.28, z * 0.2), (x * 0.6, 0.26 + high * 0.5, z), (x, 0.2 + high, z * 1.6)], 8)
        twigs.append(tube(path, lambda t: 0.0042 - 0.0028 * t, 8))
        for k in range(22):
            p = path[8 + k * 16 // 22]
            offset = [between(-0.035, 0.035, 71 + j, i, k) for j in range(3)]
            turn = euler(between(-80, 80, 75, i, k), between(0, 360, 76, i, k))
            size = between(0.016, 0.026, 77, i, k)
            blossoms.append((tuple(a + b for a, b in zip(p, offset)), turn, (size,) * 3))
    put(document, "Twigs", joined(*twigs), look["stem"], node)
    mesh = document.mesh("Blossom", document.primitive(blossom(), look["petal"]))
    instance(document, "Blossoms", mesh, blossoms, node)


def blossom():
    """Return five cupped petals of radius 1 around +Z."""
    def petal(u, v):
        a = (u - 0.5) * 2
        wide = 0.48 * math.sin(math.pi * (0.12 + 0.8 * v)) * (0.4 + 0.6 * v)
        return (a * wide, v, 0.35 * v * v + 0.1 * a * a)
    one = grid(petal, 5, 5)
    return joined(*[one.moved(rotation=rotation((0, 0, 1), 72 * i)) for i in range(5)])


def flat(width, height):
    """Return a rectangle around the origin that faces +Z; its texture fills it once."""
    mesh = Mesh()
    for y in (-1, 1):
        for x in (-1, 1):
            mesh.positions.append((x * width / 2, y * height / 2, 0))
            mesh.normals.append((0, 0, 1))
            mesh.uvs.append(((x + 1) / 2, (1 - y) / 2))
    mesh.triangles = [(0, 1, 3), (0, 3, 2)]
    return mesh


def picture(document, look, name, at, width, height, degrees):
    """Add a framed picture that faces +Z turned by `degrees` around y."""
    node = document.node(name, translation=rounded(at), rotation=rounded(rotation((0, 1, 0), degrees)))
    put(document, f"{name} canvas", flat(width, height), look["canvas"], node, (0, 0, 0.012))
    rim = 0.035
    sides = [box((width + 2 * rim, rim, 0.03), 0.006, 2).moved((0, y * (height + rim) / 2, 0.015)) for y in (-1, 1)]
    sides += [box((rim, height + 2 * rim, 0.03), 0.006, 2).moved((x * (width + rim) / 2, 0, 0.015)) for x in (-1, 1)]
    put(document, f"{name} frame", joined(*sides), look["walnut"], node)
