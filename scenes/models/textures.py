"""Procedural textures: planks, rug, plaster, painting, view from a window, marble, weave."""
import math

from noise import between, fractal, hashed, octave
from vec import smoothstep


def planks(size=512, boards=6):
    """Return rows of color, height and roughness of floor boards that run along u; they tile.

    Each board has a tone of its own, joints at hashed places, and grain that is stretched along u.
    """
    fine = fractal(size, size, 6, 64, 11, 3, 0.6)
    wide = fractal(size, size, 3, 10, 12, 3)
    worn = fractal(size, size, 5, 5, 13, 3)
    color, height, rough = [], [], []
    board = size / boards
    for y in range(size):
        k = int(y / board)
        across = (y - k * board) / board
        gap = min(across, 1 - across) * board
        joints = [int(size * between(0.02, 0.45, 21, k)), int(size * between(0.52, 0.95, 22, k))]
        shift = int(size * hashed(23, k))
        line_c, line_h, line_r = [], [], []
        for x in range(size):
            part = 0 if joints[0] <= x < joints[1] else 1
            end = min(abs(x - j) for j in joints)
            seam = smoothstep(0.3, 2.6, min(gap, end))
            source = (x + shift + 137 * part) % size
            rings = 0.5 + 0.5 * math.sin(34 * wide[y][source] + 5 * across)
            tone = between(0.3, 0.7, 31, k, part)
            c = tone + 0.26 * (fine[y][source] - 0.5) + 0.16 * (rings - 0.5)
            line_c.append(c * (0.25 + 0.75 * seam))
            line_h.append(seam * (0.8 + 0.2 * fine[y][source]))
            line_r.append(0.36 + 0.3 * (worn[y][x] - 0.5) + 0.12 * (1 - rings) + 0.3 * (1 - seam))
        color.append(line_c)
        height.append(line_h)
        rough.append(line_r)
    return color, height, rough


OAK = [(0.0, (38, 24, 15)), (0.25, (96, 62, 38)), (0.5, (150, 104, 66)), (0.75, (186, 140, 95)), (1.0, (214, 174, 128))]


def plaster(size=256):
    """Return rows of the height of troweled plaster."""
    low = fractal(size, size, 4, 4, 41, 3)
    return [[0.5 + 0.5 * math.sin(9 * v) for v in row] for row in low]


def rug(width=384, height=256):
    """Return index rows and the palette of a woven rug with borders and diamonds."""
    palette = [(126, 42, 38), (226, 209, 178), (34, 54, 78), (196, 138, 66), (92, 30, 30), (206, 186, 152),
               (26, 42, 62), (170, 116, 52)]
    rows = []
    for y in range(height):
        row = []
        for x in range(width):
            edge = min(x, y, width - 1 - x, height - 1 - y)
            thread = 4 if (x // 2 + y // 2) % 2 and hashed(51, x // 2, y // 2) > 0.35 else 0
            row.append(_motif(x, y, edge, width, height) + thread)
        rows.append(row)
    return rows, palette


def _motif(x, y, edge, width, height):
    if edge < 8 or 34 <= edge < 38:
        return 2
    if edge < 12 or 30 <= edge < 34:
        return 1
    if edge < 30:
        step = abs((x + y) % 24 - 12) + abs((x - y) % 24 - 12)
        return 3 if step < 9 else (1 if step < 12 else 0)
    cell = 52
    u, v = (x - width / 2 + cell / 2) % cell - cell / 2, (y - height / 2 + cell / 2) % cell - cell / 2
    distance = abs(u) + abs(v) * 1.15
    if distance < 5:
        return 3
    if distance < 10:
        return 2
    if distance < 19:
        return 1
    return 2 if 21 <= distance < 24 else 0


def painting(width=256, height=192):
    """Return rows of color of a small landscape: sun, hills in layers, water."""
    mist = fractal(width, height, 4, 6, 61, 3)
    ridges = [fractal(width, 1, 3 + i, 1, 70 + i, 4)[0] for i in range(4)]
    tones = [(0.62, 0.52, 0.56), (0.46, 0.42, 0.52), (0.28, 0.32, 0.44), (0.14, 0.2, 0.28)]
    rows = []
    for y in range(height):
        v = y / height
        row = []
        for x in range(width):
            sky = (0.97 - 0.14 * v, 0.62 + 0.26 * v, 0.42 + 0.3 * v)
            sun = math.hypot(x - 0.64 * width, y - 0.34 * height) / height
            color = (1.0, 0.93, 0.78) if sun < 0.09 else sky
            for i, ridge in enumerate(ridges):
                if v > 0.36 + 0.13 * i + 0.22 * (0.5 - ridge[x]):
                    color = tones[i]
            if v > 0.86:
                color = (0.5, 0.44, 0.46) if mist[y][x] > 0.55 else (0.2, 0.24, 0.32)
            shade = 0.94 + 0.12 * mist[y][x]
            row.append(tuple(int(c * shade * 32 + 0.5) / 32 for c in color))
        rows.append(row)
    return rows


def outdoors(width=256, height=192):
    """Return rows of color of sky, clouds, far hills and trees, blurred as at a distance."""
    clouds = fractal(width, height, 3, 5, 81, 4)
    far, near = fractal(width, 1, 4, 1, 82, 3)[0], fractal(width, 1, 9, 1, 83, 4)[0]
    rows = []
    for y in range(height):
        v = y / height
        row = []
        for x in range(width):
            cloud = smoothstep(0.5, 0.75, clouds[y][x]) * smoothstep(0.75, 0.3, v) if v < 0.75 else 0.0
            color = [0.45 + 0.35 * v, 0.66 + 0.22 * v, 0.93]
            color = [c + (1 - c) * cloud for c in color]
            hill = smoothstep(-0.01, 0.01, v - (0.72 - 0.1 * far[x]))
            color = [c + (d - c) * hill for c, d in zip(color, (0.46, 0.58, 0.55))]
            tree = smoothstep(-0.02, 0.02, v - (0.84 - 0.14 * near[x]))
            color = [c + (d - c) * tree for c, d in zip(color, (0.24, 0.36, 0.2))]
            row.append(tuple(int(c * 48 + 0.5) / 48 for c in color))
        rows.append(row)
    return rows


def marble(size=512):
    """Return rows of the tone of veined stone, 0 dark to 1 light; they tile."""
    bend = fractal(size, size, 2, 2, 91, 4, 0.42)
    cloud = fractal(size, size, 4, 4, 92, 4)
    other = fractal(size, size, 3, 3, 98, 4, 0.45)
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            vein = abs(math.sin(math.pi * (2 * (x + y) / size + 2.2 * bend[y][x])))
            thin = abs(math.sin(math.pi * (3 * (x - y) / size + 3 * other[y][x])))
            strong = cloud[y][x]
            tone = 0.66 + 0.5 * (cloud[y][x] - 0.5)
            tone -= 0.4 * strong * (1 - smoothstep(0.0, 0.3, vein)) + 0.16 * (1 - smoothstep(0.0, 0.07, thin))
            row.append(tone)
        rows.append(row)
    return rows


def timber(size=256):
    """Return rows of the tone of plain-sawn wood whose grain runs along u; they tile."""
    fine = fractal(size, size, 4, 48, 14, 3, 0.6)
    wide = fractal(size, size, 2, 5, 15, 3)
    rows = []
    for y in range(size):
        rings = [0.5 + 0.5 * math.sin(30 * w) for w in wide[y]]
        rows.append([0.5 + 0.5 * (f - 0.5) + 0.3 * (r - 0.5) for f, r in zip(fine[y], rings)])
    return rows


def weave(size=64, threads=8):
    """Return rows of the height of a plain weave."""
    rows = []
    for y in range(size):
        row = []
        for x in range(size):
            u, v = x * threads / size, y * threads / size
            over = (int(u) + int(v)) % 2
            a, b = math.sin(math.pi * (u % 1)), math.sin(math.pi * (v % 1))
            row.append(a * (0.5 + 0.5 * b) if over else b * (0.5 + 0.5 * a))
        rows.append(row)
    return rows


def grain(size=256):
    """Return rows of the roughness of a hard polished surface with faint traces of wiping."""
    fine = octave(size, size, 8, 96, 95)
    low = fractal(size, size, 4, 4, 96, 3)
    return [[0.5 + 0.7 * (low[y][x] - 0.5) + 0.15 * (fine[y][x] - 0.5) for x in range(size)] for y in range(size)]
