"""A still life whose objects show the material extensions of glTF, one or two each."""
import math

import png
import textures
from furniture import flat, put
from gltf import Document, rounded, srgb, transformed
from mesh import grid, joined
from noise import octave
from shapes import (box, brilliant, cylinder, lathe, profile, smooth_profile, superellipsoid, torus_knot, tube,
                    turned)
from vec import euler, look_at, mix, rotation, smoothstep

WHITE = (1, 1, 1)


def volume(thickness, distance=None, color=WHITE):
    part = {"thicknessFactor": thickness}
    if distance:
        part |= {"attenuationDistance": distance, "attenuationColor": list(color)}
    return {"KHR_materials_volume": part}


def glass(document, name, ior=1.5, inside=None, dispersion=0.0, roughness=0.0):
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": ior}}
    extensions |= inside or volume(0.01)
    if dispersion:
        extensions["KHR_materials_dispersion"] = {"dispersion": dispersion}
    return document.material(name, WHITE, roughness, extensions=extensions)


def stage(document):
    """Add the marble table and the soft backdrop behind it."""
    tone = textures.marble()
    stone = document.texture(png.ramp(tone, [(0, (62, 66, 74)), (0.5, (168, 166, 164)), (1, (240, 237, 231))], 40), "Marble")
    polish = document.texture(png.roughness(textures.grain(), 16), "Marble roughness")
    marble = document.material(
        "Marble", WHITE, 0.5, texture=transformed(stone, (1.1, 1.1), (0.2, 0.45)), surface=transformed(polish, (1.5, 1.5)),
        extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.12}})
    top = box((1.7, 0.05, 0.8), 0.012, 4)
    top = top.with_uvs(lambda p, n: (p[0], p[2] + 0.5 - p[1]))
    put(document, "Table", top, marble, None, (0, -0.025, -0.05))
    sweep = profile([(-1.2, -0.6, 0), (1.3, -0.6, 0.7), (1.3, 2.6, 0)], 16)

    def backdrop(u, v):
        k = v * (len(sweep) - 1)
        i = min(int(k), len(sweep) - 2)
        depth, y = mix(sweep[i][:2], sweep[i + 1][:2], k - i)
        return ((u - 0.5) * 7, y, -depth)

    cloth = document.material("Backdrop", srgb("8d8f8c"), 0.95)
    put(document, "Backdrop", grid(backdrop, 1, len(sweep) - 1), cloth)


def carafe(document, at):
    """Add a decanter of green glass with a stopper and, beside it, a goblet of clear glass."""
    green = glass(document, "Green glass", 1.52, volume(0.02, 0.035, srgb("5fb08a")))
    outer = smooth_profile([(0, 0), (0.05, 0), (0.062, 0.012), (0.068, 0.06), (0.058, 0.13), (0.026, 0.19),
                            (0.019, 0.24), (0.022, 0.268), (0.03, 0.282)], 5)
    inner = smooth_profile([(0.026, 0.281), (0.018, 0.266), (0.0145, 0.24), (0.0215, 0.188), (0.0535, 0.128),
                            (0.0635, 0.06), (0.058, 0.018), (0.046, 0.0105), (0, 0.0105)], 5)
    node = document.node("Decanter", translation=rounded(at))
    put(document, "Bottle", lathe(outer + inner, 56), green, node)
    drop = smooth_profile([(0, 0.262), (0.0105, 0.264), (0.0145, 0.284), (0.012, 0.292), (0.027, 0.315),
                           (0.022, 0.343), (0.0, 0.352)], 6)
    put(document, "Stopper", lathe(drop, 48), green, node)


def goblet(document, at):
    """Add a stemmed glass of dispersive crystal."""
    crystal = glass(document, "Crystal", 1.6, volume(0.01), 0.4)
    outer = smooth_profile([(0, 0), (0.036, 0.0), (0.038, 0.003), (0.012, 0.009), (0.0055, 0.03), (0.0055, 0.075),
                            (0.012, 0.09), (0.037, 0.115), (0.043, 0.15), (0.037, 0.195)], 5)
    inner = smooth_profile([(0.0355, 0.1955), (0.0412, 0.15), (0.035, 0.1165), (0.012, 0.096), (0, 0.094)], 5)
    put(document, "Goblet", lathe(outer + inner, 56), crystal, None, at)


def vase(document, at):
    """Add a fluted vase of red lacquer under a clear coat."""
    lacquer = document.material("Red lacquer", srgb("8c1420"), 0.4, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.02},
        "KHR_materials_specular": {"specularFactor": 0.6, "specularColorFactor": [1.0, 0.75, 0.7]}})
    outline = smooth_profile([(0, 0), (0.045, 0), (0.054, 0.008), (0.09, 0.09), (0.098, 0.15), (0.075, 0.225),
                              (0.036, 0.275), (0.034, 0.3), (0.05, 0.33)], 4)
    outline += [(r - 0.006, y - 0.001, n) for r, y, n in outline[-10:][::-1]]

    def point(u, v):
        k = v * (len(outline) - 1)
        i = min(int(k), len(outline) - 2)
        r, y = mix(outline[i][:2], outline[i + 1][:2], k - i)
        flute = smoothstep(0.01, 0.06, y) * smoothstep(0.28, 0.2, y) if k < len(outline) - 10 else 0.0
        r *= 1 + 0.028 * flute * math.cos(2 * math.pi * 14 * u + 9 * y)
        a = 2 * math.pi * u
        return (r * math.sin(a), y, r * math.cos(a))

    put(document, "Lacquer vase", grid(point, 126, len(outline) - 1), lacquer, None, at)


def drapery(document, at):
    """Add a block under a draped velvet cloth; on it stands an iridescent torus knot."""
    velvet = document.material("Blue velvet", srgb("1f2f5c"), 0.9, doubleSided=True, extensions={
        "KHR_materials_sheen": {"sheenColorFactor": srgb("93a9e6"), "sheenRoughnessFactor": 0.32}})
    radius, height = 0.115, 0.12

    def point(u, v):
        a, s = 2 * math.pi * u, v * 0.315
        folds = 0.75 * math.cos(11 * a + 0.9 * math.sin(2 * a)) + 0.4 * math.cos(6 * a + 1)
        fall = s - radius
        if fall < -0.02:
            return (s * math.sin(a), height, s * math.cos(a))
        # Follow a rounded edge, the hanging part with growing folds, then the part on the table.
        edge = min((fall + 0.02) / 0.05, 1.0) * math.pi / 2
        r, y = radius - 0.02 + 0.032 * math.sin(edge), height - 0.032 * (1 - math.cos(edge))
        hang = min(max(fall - 0.03, 0.0), height - 0.034)
        lying = max(fall - 0.03 - hang, 0.0)
        soft = smoothstep(0.0, 0.09, hang)
        r += 0.016 * soft + 0.017 * folds * soft + lying * (0.75 + 0.12 * folds)
        y -= hang
        y += (0.006 + 0.006 * folds) * smoothstep(0.0, 0.03, lying) * smoothstep(0.085, 0.03, lying)
        return (r * math.sin(a), max(y, 0.0025), r * math.cos(a))

    cloth = grid(lambda u, v: point(u % 1, v), 132, 52)
    node = document.node("Drapery", translation=rounded(at))
    put(document, "Velvet", cloth, velvet, node)
    film = document.material("Soap-film metal", srgb("c9c4c0"), 0.16, 1.0, extensions={
        "KHR_materials_iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.45,
                                      "iridescenceThicknessMaximum": 430.0}})
    knot = torus_knot(2, 3, 0.052, 0.024, 0.0155, 18, 150)
    put(document, "Torus knot", knot, film, node, (0, height + 0.083, 0), euler(x=68, y=24))


def candle(document, at):
    """Add a wax candle with its flame on a dish of brushed brass."""
    node = document.node("Candle", translation=rounded(at))
    brass = document.material("Brushed brass", (0.9, 0.7, 0.36), 0.32, 1.0, extensions={
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.75}})
    dish = turned([(0, 0, 0), (0.04, 0, 0.004), (0.078, 0.016, 0.004), (0.08, 0.02, 0.0015), (0.074, 0.019, 0.004),
                   (0.038, 0.006, 0.003), (0, 0.006, 0)], 72, 5)
    put(document, "Dish", dish, brass, node)
    wax = document.material("Wax", srgb("f2e3c6"), 0.5, extensions={
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.65, "diffuseTransmissionColorFactor": srgb("ffdca6")},
        "KHR_materials_ior": {"ior": 1.44}} | volume(0.05, 0.03, srgb("ffd9a0")))
    body = turned([(0, 0.006, 0), (0.031, 0.006, 0.002), (0.031, 0.13, 0.007), (0.022, 0.124, 0.006), (0, 0.121, 0)], 56, 5)
    drips = [tube([(0, 0.128 - k * long / 5, 0) for k in range(6)], lambda t: 0.0035 + 0.003 * t, 12)
             .moved((0.0305 * math.sin(a), 0, 0.0305 * math.cos(a))) for a, long in ((0.4, 0.05), (1.1, 0.028), (-0.5, 0.035))]
    put(document, "Wax body", joined(body, *drips), wax, node)
    wick = document.material("Wick", (0.01, 0.009, 0.008), 0.9)
    put(document, "Wick", tube([(0, 0.12, 0), (0, 0.13, 0), (0.002, 0.138, 0)], 0.0015, 8), wick, node)
    flame = document.material("Flame", (0, 0, 0), 1.0, emissiveFactor=srgb("ffb45a"), extensions={
        "KHR_materials_emissive_strength": {"emissiveStrength": 4.0}})
    drop = smooth_profile([(0, 0.131), (0.0055, 0.137), (0.0075, 0.147), (0.0045, 0.162), (0.0, 0.178)], 6)
    put(document, "Flame", lathe(drop, 28), flame, node)


def jewels(document, at):
    """Add a dispersive brilliant that leans on its pavilion, and three pearls."""
    diamond = glass(document, "Diamond", 2.42, volume(0.05), 0.55)
    size = 0.036
    # The brilliant rests on its girdle and on its culet.
    lean = math.degrees(math.atan2(0.87, 1.0))
    gem = brilliant().moved(rotation=euler(x=90 - lean + 6), scale=size)
    low = min(p[1] for p in gem.positions)
    put(document, "Brilliant", gem, diamond, None, (at[0], -low, at[2]), rotation((0, 1, 0), -22))
    pearl = document.material("Pearl", srgb("efe6dc"), 0.28, extensions={
        "KHR_materials_iridescence": {"iridescenceFactor": 0.8, "iridescenceIor": 1.6,
                                      "iridescenceThicknessMaximum": 320.0},
        "KHR_materials_specular": {"specularFactor": 1.0, "specularColorFactor": [1.0, 0.95, 1.0]}})
    places = ((-0.07, 0.012, 0.03), (-0.1, 0.0135, 0.005), (-0.052, 0.009, 0.058))
    balls = [superellipsoid((r, r, r), 1, 28, 18).moved((at[0] + x, r, at[2] + z)) for x, r, z in places]
    put(document, "Pearls", joined(*balls), pearl)


def pears(document, at):
    """Add two pears with vertex colors and a waxy skin."""
    skin = document.material("Pear skin", WHITE, 0.42, extensions={
        "KHR_materials_specular": {"specularFactor": 0.8}, "KHR_materials_clearcoat": {
            "clearcoatFactor": 0.3, "clearcoatRoughnessFactor": 0.3}})
    stem = document.material("Pear stem", srgb("4a3320"), 0.7)
    outline = smooth_profile([(0, 0.004), (0.012, 0.0), (0.034, 0.014), (0.0415, 0.042), (0.032, 0.075),
                              (0.02, 0.099), (0.011, 0.113), (0, 0.113)], 5)
    freckles = octave(64, 64, 24, 24, 5)

    def tone(p, n):
        blush = smoothstep(-0.6, 0.9, n[0] * 0.8 + n[2] * 0.4) * 0.75
        spot = 0.9 + 0.15 * freckles[int((p[1] * 500) % 64)][int((math.atan2(p[0], p[2]) + 4) * 10 % 64)]
        color = mix(tuple(srgb("c2b84a")), tuple(srgb("b5502c")), blush)
        return tuple(c * spot for c in color)

    fruit = lathe(outline, 48)
    fruit.positions = [(p[0] + 0.004 * math.sin(30 * p[1]), p[1], p[2] + 0.003 * math.cos(26 * p[1])) for p in fruit.positions]
    stalk = tube([(0.0, 0.108, 0.002), (0.001, 0.12, 0.002), (0.006, 0.132, 0.003)], lambda t: 0.0018 + 0.0008 * t, 8)
    for name, place, turn in (("Pear", at, euler(z=-7, y=30)), ("Lying pear", (at[0] + 0.085, 0.04, at[2] + 0.05), euler(x=97, y=62))):
        node = document.node(name, translation=rounded(place), rotation=rounded(turn))
        put(document, f"{name} skin", fruit.colored(tone), skin, node)
        put(document, f"{name} stalk", stalk, stem, node)


def make():
    document = Document("Still life")
    stage(document)
    vase(document, (-0.03, 0, -0.2))
    carafe(document, (-0.24, 0, -0.15))
    goblet(document, (-0.135, 0, -0.01))
    drapery(document, (0.245, 0, -0.12))
    candle(document, (-0.315, 0, 0.06))
    jewels(document, (0.015, 0, 0.19))
    pears(document, (-0.005, 0, 0.045))
    panel = document.material("Soft box", (0, 0, 0), 1.0, emissiveFactor=[1.0, 0.93, 0.84], extensions={
        "KHR_materials_emissive_strength": {"emissiveStrength": 5.0}})
    place = (-1.5, 1.25, 0.9)
    put(document, "Soft box", flat(0.9, 0.9), panel, None, place, look_at((0, 0.1, 0), place))
    eye, target = (0.05, 0.43, 1.55), (-0.015, 0.14, -0.03)
    document.camera("View", eye, target, 22.5, look_at(eye, target))
    return document.glb()
