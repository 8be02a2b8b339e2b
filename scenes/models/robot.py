"""A small robot that waves: skin, clips, morph targets, material variants."""
import math

from gltf import Document, rounded, srgb
from mesh import curve, joined
from rig import Clip, Rig
from shapes import bent, lathe, profile, smooth_profile, superellipsoid, tube, turned
from vec import euler, look_at, mix, rotation

JOINTS = [
    ("Hips", None, (0, 0.34, 0)),
    ("Chest", "Hips", (0, 0.47, 0)),
    ("Neck", "Chest", (0, 0.665, 0)),
    ("Head", "Neck", (0, 0.72, 0)),
    ("Antenna", "Head", (0, 1.0, 0)),
    ("AntennaTip", "Antenna", (0, 1.07, 0)),
]
for side, x in (("Left", 1), ("Right", -1)):
    JOINTS += [
        (f"{side}Arm", "Chest", (x * 0.19, 0.585, 0)),
        (f"{side}Elbow", f"{side}Arm", (x * 0.29, 0.49, 0)),
        (f"{side}Hand", f"{side}Elbow", (x * 0.36, 0.375, 0)),
        (f"{side}Leg", "Hips", (x * 0.095, 0.3, 0)),
        (f"{side}Knee", f"{side}Leg", (x * 0.105, 0.19, 0.005)),
        (f"{side}Foot", f"{side}Knee", (x * 0.11, 0.085, 0)),
    ]
HEAD = (0, 0.85, 0)


def body(rig):
    """Return the painted shell, the white belly plate and the metal rings of the trunk."""
    shell = lathe(smooth_profile([(0.0, 0.275), (0.09, 0.283), (0.165, 0.33), (0.2, 0.42), (0.197, 0.5),
                                  (0.17, 0.59), (0.115, 0.65), (0.06, 0.668), (0.0, 0.67)], 5), 48)
    shell = shell.moved(scale=(1, 1, 0.9))
    weights = rig.along("Hips", "Chest", "Neck", blend=0.9)
    band = turned([(0.196, 0.392, 0), (0.206, 0.392, 0.004), (0.206, 0.412, 0.004), (0.196, 0.412, 0)], 56)
    collar = turned([(0.06, 0.655, 0), (0.1, 0.655, 0.008), (0.085, 0.685, 0.008), (0.05, 0.685, 0)], 40)
    metal = joined(band.moved(scale=(1, 1, 0.9)).bound(weights), collar.bound(rig.rigid("Chest")))
    ring = turned([(0, 0, 0), (0.058, 0, 0.004), (0.055, 0.016, 0.006), (0.046, 0.016, 0.003), (0.043, 0.01, 0),
                   (0, 0.01, 0)], 40)
    facing = rotation((1, 0, 0), 84)
    badge = ring.moved((0, 0.525, 0.162), facing)
    metal = joined(metal, badge.bound(weights))
    light = lathe(profile([(0.044, 0.008, 0), (0.04, 0.015, 0.004), (0, 0.019, 0)]), 32)
    light = light.moved((0, 0.525, 0.162), facing).bound(weights)
    return shell.bound(weights), metal, light


def head(rig):
    """Return shell, visor and metal ears of the head."""
    shell = superellipsoid((0.225, 0.16, 0.175), 0.62, 48, 28).moved(HEAD)
    visor = superellipsoid((0.178, 0.113, 0.15), 0.6, 48, 24).moved((0, HEAD[1] - 0.005, 0.048))
    cup = turned([(0, 0, 0), (0.06, 0, 0.006), (0.06, 0.026, 0.01), (0.03, 0.034, 0.004), (0.03, 0.028, 0.002),
                  (0, 0.028, 0)], 40)
    ears = [cup.moved((x * 0.216, HEAD[1], 0), rotation((0, 0, 1), -90 * x)) for x in (1, -1)]
    socket = turned([(0, 1.0, 0), (0.034, 1.0, 0.005), (0.022, 1.022, 0.005), (0, 1.022, 0)], 32)
    stem = tube([(0, 1.01 + 0.012 * i, 0) for i in range(8)], 0.0065, 12)
    metal = joined(*ears, socket).bound(rig.rigid("Head"))
    metal = joined(metal, stem.bound(rig.along("Head", "Antenna", "AntennaTip", blend=0.8)))
    bulb = superellipsoid((0.026, 0.026, 0.026), 1, 24, 14).moved((0, 1.112, 0)).bound(rig.rigid("AntennaTip"))
    return shell.bound(rig.rigid("Head")), visor.bound(rig.rigid("Head")), metal, bulb


def face(rig):
    """Return eyes and mouth with two morph targets: a blink and a smile."""
    parts = []
    for x in (0.072, -0.072):
        center = (x, HEAD[1] + 0.012, 0.1955)
        eye = superellipsoid((0.029, 0.04, 0.008), 0.85, 28, 16).moved(center)
        blink = [(0, (center[1] - p[1]) * 0.88, 0) for p in eye.positions]
        smile = [(0, 0.012 * max(0.0, (center[1] - p[1]) / 0.04), 0) for p in eye.positions]
        eye.targets = [blink, smile]
        parts.append(eye)
    mouths = [_mouth(width, depth) for width, depth in ((0.028, 0.009), (0.044, 0.02))]
    mouth = mouths[0]
    mouth.targets = [[(0, 0, 0)] * len(mouth.positions),
                     [tuple(round(b - a, 6) for a, b in zip(p, q))
                      for p, q in zip(mouth.positions, mouths[1].positions)]]
    return joined(*parts, mouth).bound(rig.rigid("Head"))


def _mouth(width, depth):
    path = [(width * t, HEAD[1] - 0.052 + depth * (t * t - 0.5), 0.197) for t in
            [i / 8 - 1 for i in range(17)]]
    return tube(path, 0.0058, 10)


def bellows(count, low, high):
    return lambda t: mix(low, high, (0.5 - 0.5 * math.cos(2 * math.pi * count * t)) ** 0.8)


def limbs(rig):
    """Return the rubber, painted and metal parts of arms and legs."""
    rubber, paint, metal, white = [], [], [], []
    neck = tube([(0, 0.66 + 0.004 * i, 0) for i in range(21)], bellows(3, 0.045, 0.056), 28, caps=False)
    rubber.append(neck.bound(rig.along("Chest", "Neck", "Head", blend=0.9)))
    for side, x in (("Left", 1), ("Right", -1)):
        names = [f"{side}{part}" for part in ("Arm", "Elbow", "Hand")]
        places = [rig.places[name] for name in names]
        start = (x * 0.165, 0.6, 0)
        path = bent(curve([start, *places], 10), 64)
        arm = tube(path, bellows(11, 0.027, 0.034), 20, caps=False)
        rubber.append(arm.bound(rig.along(*names, blend=0.9)))
        ball = superellipsoid((0.05, 0.05, 0.05), 1, 28, 18).moved((x * 0.178, 0.592, 0))
        metal.append(ball.bound(rig.rigid("Chest")))
        hand = _hand(x).moved(places[2])
        white.append(hand.bound(rig.rigid(names[2])))
        cuff = turned([(0.03, -0.014, 0), (0.043, -0.014, 0.005), (0.043, 0.014, 0.005), (0.03, 0.014, 0)], 32)
        metal.append(cuff.moved(places[2], rotation((0, 0, 1), x * 31)).bound(rig.rigid(names[2])))
        names = [f"{side}{part}" for part in ("Leg", "Knee", "Foot")]
        places = [rig.places[name] for name in names]
        path = bent(curve([(x * 0.09, 0.33, 0), *places], 10), 56)
        leg = tube(path, bellows(9, 0.037, 0.046), 22, caps=False)
        rubber.append(leg.bound(rig.along(*names, blend=0.9)))
        foot, sole, ankle = _foot()
        at = rig.rigid(names[2])
        paint.append(foot.moved((x * 0.115, 0, 0.03), rotation((0, 1, 0), 9 * x)).bound(at))
        rubber.append(sole.moved((x * 0.115, 0, 0.03), rotation((0, 1, 0), 9 * x)).bound(at))
        metal.append(ankle.moved((x * 0.11, 0.1, 0)).bound(at))
    return joined(*rubber), joined(*paint), joined(*metal), joined(*white)


def _hand(x):
    """Return a mitten whose palm is at the origin and whose fingers point down and outwards."""
    mitt = superellipsoid((0.05, 0.062, 0.036), 0.8, 28, 18).moved((x * 0.024, -0.05, 0))
    thumb = tube([(0, 0, 0), (x * -0.008, -0.02, 0.018), (x * -0.012, -0.045, 0.03)], 0.0165, 14)
    fist = joined(mitt, thumb.moved((x * -0.01, -0.025, 0.02)))
    return fist.moved(rotation=rotation((0, 0, 1), x * 22))


def _foot():
    shoe = superellipsoid((0.075, 0.075, 0.115), 0.75, 36, 22)
    shoe.positions = [(p[0], max(p[1], -0.012) + 0.03 if p[1] < 0 else
                       p[1] * (1.05 - 0.35 * (p[2] / 0.115)) + 0.03, p[2]) for p in shoe.positions]
    sole = superellipsoid((0.079, 0.02, 0.119), 0.55, 36, 12).moved((0, 0.02, 0))
    ankle = turned([(0.035, -0.012, 0), (0.056, -0.012, 0.005), (0.052, 0.014, 0.006), (0.03, 0.014, 0)], 32)
    return shoe, sole, ankle


def materials(document):
    """Add the materials and return them by name; a pair holds the materials of two variants."""
    def paint(name, code):
        return document.material(name, srgb(code), 0.38, 0.0, {
            "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.03}})

    def emitter(name, code, strength):
        return document.material(name, (0.02, 0.02, 0.02), 0.4, emissiveFactor=srgb(code), extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": strength}})

    return {
        "paint": (paint("Tangerine paint", "ee6c1f"), paint("Lagoon paint", "0f8f93")),
        "emitter": (emitter("Ice light", "7fe9ff", 2.2), emitter("Amber light", "ffc26a", 2.2)),
        "white": document.material("Porcelain paint", srgb("ece7dc"), 0.3, 0.0, {
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.06}}),
        "rubber": document.material("Rubber", srgb("2b2d31"), 0.62),
        "metal": document.material("Satin steel", srgb("c4c6c9"), 0.27, 1.0),
        "visor": document.material("Visor", srgb("07090c"), 0.25, 0.0, {
            "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.0}}),
        "plinth": document.material("Plinth", srgb("d9d4cb"), 0.55),
    }


def wave(document, rig, face_node):
    """Add the clip in which the robot waves; it loops after 2 seconds."""
    clip, node = Clip(document, "Wave"), rig.nodes
    times = [i / 4 for i in range(9)]
    swing = [0, 0.75, 1, 0.75, 0, -0.75, -1, -0.75, 0]
    beat = [0, 1, 0, -1, 0, 1, 0, -1, 0]
    clip.linear(node["LeftArm"], "rotation", times, [euler(z=88 + 5 * s, x=-8) for s in beat])
    clip.linear(node["LeftElbow"], "rotation", times, [euler(z=42 + 24 * s) for s in beat])
    clip.linear(node["LeftHand"], "rotation", times, [euler(z=8 + 16 * b) for b in (0, 0.7, 0.4, -0.7, -0.4, 0.7, 0.4, -0.7, 0)])
    clip.spline(node["RightArm"], "rotation", times, [euler(z=20 - 3 * s, x=6) for s in swing])
    clip.spline(node["RightElbow"], "rotation", times, [euler(z=12 + 4 * s, x=-18) for s in swing])
    clip.spline(node["Chest"], "rotation", times, [euler(z=-3 - 2 * s, y=-3) for s in swing])
    clip.spline(node["Head"], "rotation", times, [euler(z=-7 - 4 * s, y=5 + 4 * s, x=-3) for s in swing])
    clip.spline(node["Antenna"], "rotation", times, [euler(z=8 * s) for s in beat])
    clip.linear(node["AntennaTip"], "rotation", times, [euler(z=-14 * b) for b in (0.6, 0, -1, 0, 1, 0, -1, 0, 0.6)])
    hips = rig.places["Hips"]
    clip.spline(node["Hips"], "translation", times,
                [rounded((hips[0] + 0.006 * s, hips[1] - 0.004 + 0.004 * abs(s), hips[2])) for s in swing])
    _planted(clip, rig, times, [(0.006 * s, -0.004 + 0.004 * abs(s)) for s in swing])
    blinks = [0, 1.2, 1.28, 1.34, 1.44, 2]
    weights = [(0, 1), (0, 1), (1, 0.8), (1, 0.8), (0, 1), (0, 1)]
    clip.linear(face_node, "weights", blinks, [w for pair in weights for w in pair])


def _planted(clip, rig, times, shifts):
    """Move the feet against the hips so that they stay on the floor."""
    for side in ("Left", "Right"):
        place = [a - b for a, b in zip(rig.places[f"{side}Foot"], rig.places[f"{side}Knee"])]
        clip.spline(rig.nodes[f"{side}Foot"], "translation", times,
                    [rounded((place[0] - dx, place[1] - dy, place[2])) for dx, dy in shifts])


def idle(document, rig, face_node):
    """Add the clip in which the robot breathes and looks around; it loops after 4 seconds."""
    clip, node = Clip(document, "Idle"), rig.nodes
    times = [0, 1, 2, 3, 4]
    breath = [0, 1, 0, 1, 0]
    clip.spline(node["Chest"], "scale", times, [(1 + 0.012 * b, 1 + 0.006 * b, 1 + 0.015 * b) for b in breath])
    clip.spline(node["Head"], "rotation", times, [euler(y=a, x=b) for a, b in
                                                  ((0, 0), (16, 2), (4, -2), (-15, 2), (0, 0))])
    for side, x in (("Left", 1), ("Right", -1)):
        clip.spline(node[f"{side}Arm"], "rotation", times, [euler(z=x * (-12 - 2.5 * b)) for b in breath])
        clip.linear(node[f"{side}Elbow"], "rotation", times, [euler(z=x * (-6 - b), x=-12) for b in breath])
    clip.linear(node["Antenna"], "rotation", times, [euler(z=a) for a in (0, -5, 0, 5, 0)])
    clip.linear(face_node, "weights", [0, 1.9, 1.97, 2.05, 2.15, 4],
                [0, 0.3, 0, 0.3, 1, 0.3, 1, 0.3, 0, 0.3, 0, 0.3])


def make():
    document = Document("Robot")
    document.json["extensions"] = {"KHR_materials_variants": {
        "variants": [{"name": "Tangerine"}, {"name": "Lagoon"}]}}
    rig = Rig(JOINTS)
    skin = rig.add_to(document, "Skeleton")
    look = materials(document)
    shell, trunk, badge = body(rig)
    cap, visor, ears, bulb = head(rig)
    rubber, shoes, joints, hands = limbs(rig)

    def varied(mesh, name):
        first, second = look[name]
        return document.primitive(mesh, first, [([0], first), ([1], second)])

    def plain(mesh, name):
        return document.primitive(mesh, look[name])

    robot = document.mesh(
        "Robot", varied(joined(shell, shoes), "paint"), plain(joined(cap, hands), "white"),
        plain(joined(trunk, ears, joints), "metal"), plain(rubber, "rubber"), plain(visor, "visor"),
        varied(joined(badge, bulb), "emitter"))
    mesh = document.mesh("Face", varied(face(rig), "emitter"), weights=[0, 1],
                         extras={"targetNames": ["Blink", "Smile"]})
    document.node("Robot", mesh=robot, skin=skin)
    face_node = document.node("Face", mesh=mesh, skin=skin)
    stage = turned([(0, -0.06, 0), (0.56, -0.06, 0.01), (0.56, 0, 0.014), (0, 0, 0)], 96)
    document.node("Plinth", mesh=document.mesh("Plinth", plain(stage, "plinth")))
    wave(document, rig, face_node)
    idle(document, rig, face_node)
    eye, target = (0.62, 0.86, 2.55), (0.06, 0.555, 0)
    document.camera("Portrait", eye, target, 29, look_at(eye, target))
    return document.glb()
