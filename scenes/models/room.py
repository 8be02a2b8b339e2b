"""A sunlit room: textures, a sun through a window, a floor light, instances of books and leaves."""
import png
import textures
from furniture import armchair, chair, curtain, flat, floor_light, picture, plant, put, shelf, table, vase
from gltf import Document, rounded, srgb, transformed
from mesh import joined
from shapes import box, superellipsoid, tube
from vec import look_at, rotation

WIDTH, HEIGHT, BACK, FRONT = 4.8, 2.7, -2.2, 3.0
# Opening of the window in the back wall.
LEFT, RIGHT, SILL, HEAD = -1.5, 0.1, 0.88, 2.28
# Thickness of the walls.
THICK = 0.24


def wood(document, look):
    """Add the floor and the timber materials; all timbers share one texture, turned and scaled."""
    color, height, rough = textures.planks()
    surface = document.texture(png.roughness(rough, 16), "Plank roughness")
    bumps = document.texture(png.normals(height, 2.5, 24), "Plank normals")
    planks = document.texture(png.ramp(color, textures.OAK, 48), "Planks")
    scale = (0.85, 0.85)
    look["floor"] = document.material(
        "Oak planks", (0.95, 0.9, 0.85), 0.9, texture=transformed(planks, scale), surface=transformed(surface, scale),
        normalTexture=transformed(bumps, scale) | {"scale": 0.8})
    timber = document.texture(png.ramp(textures.timber(), textures.OAK, 32), "Timber")
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 0.35, "clearcoatRoughnessFactor": 0.25}}
    look["walnut"] = document.material("Walnut", (0.5, 0.36, 0.28), 0.45, extensions=coat,
                                       texture=transformed(timber, (0.9, 1.4), (0.3, 0.1)))
    look["oak"] = document.material("Oak", (1, 0.94, 0.86), 0.5, texture=transformed(timber, (0.7, 1.1), (0, 0.4), 0.02))


def fabrics(document, look):
    weave = document.texture(png.normals(textures.weave(), 2.0, 24), "Weave normals")
    look["velvet"] = document.material(
        "Ocher velvet", srgb("b5792a"), 0.85, normalTexture=transformed(weave, (4, 4)) | {"scale": 0.4},
        extensions={"KHR_materials_sheen": {"sheenColorFactor": srgb("e0b070"), "sheenRoughnessFactor": 0.4}})
    look["rug"] = document.material(
        "Rug", (1, 1, 1), 0.95, texture={"index": document.texture(png.indexed(*textures.rug()), "Rug")},
        normalTexture={"index": weave, "texCoord": 1, "scale": 0.7},
        extensions={"KHR_materials_sheen": {"sheenColorFactor": [0.12, 0.1, 0.09], "sheenRoughnessFactor": 0.6}})
    look["linen"] = document.material(
        "Linen", srgb("f1ebdf"), 0.9, doubleSided=True,
        extensions={"KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.55, "diffuseTransmissionColorFactor": srgb("f6ecd8")}})
    look["shade"] = document.material(
        "Light shade", srgb("f3e3c3"), 0.9, doubleSided=True, emissiveFactor=srgb("ffc98a"),
        extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 1.6}})


def plain(document, look):
    """Add the materials without textures of their own."""
    look["paint"] = document.material("White paint", srgb("f2f0ea"), 0.35)
    look["ceiling"] = document.material("Ceiling", srgb("f4f2ee"), 0.9)
    look["leather"] = document.material("Leather", srgb("8a5430"), 0.42)
    look["brass"] = document.material("Brass", (0.91, 0.72, 0.38), 0.22, 1.0)
    look["glaze"] = document.material("Celadon glaze", srgb("8fb3a5"), 0.35, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.04}})
    look["clay"] = document.material("Terracotta", srgb("b8694a"), 0.8)
    look["soil"] = document.material("Soil", srgb("3a2a20"), 1.0)
    look["stem"] = document.material("Stem", srgb("5b5a38"), 0.6)
    look["leaf"] = document.material("Leaf", srgb("4f8f3c"), 0.38, doubleSided=True, extensions={
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.35, "diffuseTransmissionColorFactor": srgb("9fcf4a")}})
    look["petal"] = document.material("Petal", srgb("f7d9dc"), 0.6, doubleSided=True, extensions={
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.4, "diffuseTransmissionColorFactor": srgb("fbd5da")}})
    look["books"] = [document.material(f"Binding {i + 1}", srgb(code), 0.55)
                     for i, code in enumerate(("7d2f2b", "24425c", "d8c8a4", "3f5b45", "c08a3e"))]
    look["fruit"] = document.material("Lemon", srgb("efc23a"), 0.42)


def shell(document, look):
    """Add walls, floor, ceiling, skirting and the rug."""
    tall, middle = FRONT - BACK, (FRONT + BACK) / 2
    put(document, "Floor", box((WIDTH, 0.1, tall)), look["floor"], None, (0, -0.05, middle))
    put(document, "Ceiling", box((WIDTH + 0.4, 0.1, tall + 0.8)), look["ceiling"], None, (0, HEIGHT + 0.05, middle))
    z = BACK - THICK / 2
    back = [box((WIDTH, SILL, THICK)).moved((0, SILL / 2, z)),
            box((WIDTH, HEIGHT - HEAD, THICK)).moved((0, (HEIGHT + HEAD) / 2, z)),
            box((LEFT + WIDTH / 2, HEAD - SILL, THICK)).moved(((LEFT - WIDTH / 2) / 2, (HEAD + SILL) / 2, z)),
            box((WIDTH / 2 - RIGHT, HEAD - SILL, THICK)).moved(((RIGHT + WIDTH / 2) / 2, (HEAD + SILL) / 2, z))]
    front = box((WIDTH, HEIGHT, 0.1)).moved((0, HEIGHT / 2, FRONT + 0.05))
    sides = [box((0.1, HEIGHT, tall + 0.8)).moved((x * (WIDTH / 2 + 0.05), HEIGHT / 2, middle)) for x in (-1, 1)]
    walls = [mesh.with_uvs(lambda p, n: (p[0] + p[2], -p[1])) for mesh in (*back, front, *sides)]
    put(document, "Walls", joined(*walls), look["plaster"])
    skirting = [box((WIDTH, 0.1, 0.016), 0.005).moved((0, 0.05, BACK + 0.008))]
    skirting += [box((0.016, 0.1, tall), 0.005).moved((x * (WIDTH / 2 - 0.008), 0.05, middle)) for x in (-1, 1)]
    put(document, "Skirting", joined(*skirting), look["paint"])
    carpet = box((1.95, 0.014, 1.3), 0.006)
    carpet = carpet.with_uvs(lambda p, n: (p[0] / 1.95 + 0.5, p[2] / 1.3 + 0.5))
    carpet = carpet.with_uvs(lambda p, n: (p[0] * 24, p[2] * 24), second=True)
    put(document, "Rug", carpet, look["rug"], None, (0.3, 0.007, 0.05), rotation((0, 1, 0), 4))


def window(document, look):
    """Add frame, bars, sill, curtains and what is seen outside."""
    x, y, z = (LEFT + RIGHT) / 2, (SILL + HEAD) / 2, BACK - 0.13
    wide, high, bar = RIGHT - LEFT, HEAD - SILL, 0.055
    parts = [box((wide, bar, 0.07), 0.006).moved((x, y + s * (high - bar) / 2, z)) for s in (-1, 1)]
    parts += [box((bar, high, 0.07), 0.006).moved((x + s * (wide - bar) / 2, y, z)) for s in (-1, 1)]
    parts.append(box((0.07, high - 0.02, 0.06), 0.006).moved((x, y, z)))
    parts += [box((wide / 2 - 0.03, 0.03, 0.04), 0.006).moved((x + s * wide / 4, y + 0.28, z)) for s in (-1, 1)]
    parts.append(box((wide + 0.14, 0.035, 0.2), 0.01, 3).moved((x, SILL - 0.0175 + 0.012, BACK - 0.02)))
    put(document, "Window frame", joined(*parts), look["paint"])
    for name, side, seed in (("Left curtain", -1, 1), ("Right curtain", 1, 4)):
        curtain(document, look, name, (x + side * (wide / 2 + 0.13), 0.03, BACK + 0.085), 0.44, 2.4, seed)
    rail = tube([(x + t * 0.1, 2.44, BACK + 0.085) for t in range(-13, 14)], 0.011, 16)
    knobs = [superellipsoid((0.024, 0.024, 0.024), 1, 20, 12).moved((x + s * 1.31, 2.44, BACK + 0.085)) for s in (-1, 1)]
    put(document, "Curtain rail", joined(rail, *knobs), look["brass"])
    view = document.texture(png.rgb(textures.outdoors()), "Outdoors", repeat=False)
    sky = document.material("Outdoors", (0, 0, 0), 1.0, emissiveFactor=[1, 1, 1], emissiveTexture={"index": view},
                            extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 8}})
    put(document, "Outdoors", flat(2.8, 2.4), sky, None, (-1.25, 1.7, -4.5))


def fill(document):
    """Add the light of a large window behind the viewer."""
    panel = document.material("Window behind", (0, 0, 0), 1.0, emissiveFactor=srgb("dfe9ff"),
                              extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 2.5}})
    put(document, "Window behind", flat(3, 1.7), panel, None, (0, 1.7, FRONT - 0.01), rotation((0, 1, 0), 180))


def make():
    document, look = Document("Room"), {}
    wood(document, look)
    fabrics(document, look)
    plain(document, look)
    bumps = document.texture(png.normals(textures.plaster(), 3.0, 24), "Plaster normals")
    look["plaster"] = document.material("Plaster", srgb("e9dfcf"), 0.92,
                                        normalTexture=transformed(bumps, (0.8, 0.8)) | {"scale": 0.35})
    art = document.texture(png.rgb(textures.painting()), "Painting", repeat=False)
    look["canvas"] = document.material("Canvas", (1, 1, 1), 0.6, texture={"index": art})
    shell(document, look)
    window(document, look)
    fill(document)
    table(document, look, (-0.72, 0, -1.5))
    chair(document, look, (-0.62, 0, -0.98), 14)
    vase(document, look, (-1.02, 0.75, -1.55))
    lemons = [superellipsoid((0.034, 0.03, 0.03), 1, 24, 14).moved((0.08 * i, 0.03, 0.05 * (i % 2))) for i in range(3)]
    put(document, "Lemons", joined(*lemons), look["fruit"], None, (-0.5, 0.75, -1.4))
    shelf(document, look, (1.58, 0, BACK + 0.16))
    floor_light(document, look, (0.62, 0, -1.78))
    armchair(document, look, (1.5, 0, -0.75), -48)
    plant(document, look, (-1.98, 0, -1.35))
    picture(document, look, "Large picture", (-WIDTH / 2, 1.62, -1.0), 0.8, 0.6, 90)
    picture(document, look, "Small picture", (0.64, 1.92, BACK), 0.36, 0.27, 0)
    sun = document.light(type="directional", name="Sun", color=[1, 0.9, 0.76], intensity=70)
    document.node("Sun", rotation=rounded(look_at((0, 0, 0), (0.42, -0.8, 1))), extensions=sun)
    eye, target = (0.5, 1.4, 2.85), (-0.08, 0.93, -1.5)
    document.camera("View", eye, target, 45, look_at(eye, target))
    return document.glb()
