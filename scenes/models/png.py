"""Writes PNG images: gray, RGB and palette images of 8 bits."""
import struct
import zlib

from vec import mix


def _chunk(kind, data):
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


def _filtered(rows, step, kind):
    """Return the rows behind PNG filter `kind` (0 none, 1 sub, 2 up) for pixels of `step` bytes."""
    lines, above = [], bytes(len(rows[0]))
    for row in rows:
        before = {0: None, 1: bytes(step) + row[:-step], 2: above}[kind]
        line = row if before is None else bytes([(a - b) & 255 for a, b in zip(row, before)])
        lines.append(bytes([kind]) + line)
        above = row
    return b"".join(lines)


def _file(rows, width, color_type, step, palette=None):
    filters = (0,) if color_type == 3 else (0, 1, 2)
    best = min((zlib.compress(_filtered(rows, step, kind), 9) for kind in filters), key=len)
    head = struct.pack(">IIBBBBB", width, len(rows), 8, color_type, 0, 0, 0)
    parts = [_chunk(b"IHDR", head)]
    if palette:
        parts.append(_chunk(b"PLTE", bytes(c for color in palette for c in color)))
    parts += [_chunk(b"IDAT", best), _chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def byte(x):
    return min(max(int(x * 255 + 0.5), 0), 255)


def rgb(rows):
    """Return a PNG of rows of (r, g, b) in 0 to 1."""
    data = [bytes(byte(c) for pixel in row for c in pixel) for row in rows]
    return _file(data, len(rows[0]), 2, 3)


def ramp(rows, stops, colors=64):
    """Return a palette PNG of rows of numbers in 0 to 1, colored by a gradient.

    `stops` are pairs of a number and an sRGB color of three bytes.
    """
    def color(t):
        for (a, left), (b, right) in zip(stops, stops[1:]):
            if t <= b:
                return tuple(int(c + 0.5) for c in mix(left, right, (t - a) / (b - a)))
        return tuple(stops[-1][1])

    palette = [color(i / (colors - 1)) for i in range(colors)]
    top = colors - 1
    data = [bytes(min(max(int(x * top + 0.5), 0), top) for x in row) for row in rows]
    return _file(data, len(rows[0]), 3, 1, palette)


def indexed(rows, palette):
    """Return a palette PNG of rows of indices; `palette` lists sRGB colors of three bytes."""
    return _file([bytes(row) for row in rows], len(rows[0]), 3, 1, palette)


def roughness(rows, levels=24):
    """Return a palette PNG of a metallic-roughness texture: G is roughness, R and B are 255."""
    return ramp(rows, [(0, (255, 0, 255)), (1, (255, 255, 255))], levels)


def normals(heights, depth, levels=32):
    """Return a PNG of the normals of tileable `heights` (0 to 1); `depth` is their scale in pixels.

    Green points up (+V in a picture whose rows run down), as glTF requires. Rounding to `levels`
    on each side of zero keeps the file small.
    """
    height, width = len(heights), len(heights[0])
    rows = []
    for y in range(height):
        above, row, below = heights[y - 1], heights[y], heights[(y + 1) % height]
        line = bytearray()
        for x in range(width):
            dx = (row[x - 1] - row[(x + 1) % width]) * depth / 2
            dy = (below[x] - above[x]) * depth / 2
            scale = 1 / (dx * dx + dy * dy + 1) ** 0.5
            dx, dy = round(dx * scale * levels) / levels, round(dy * scale * levels) / levels
            z = max(0.0, 1 - dx * dx - dy * dy) ** 0.5
            line += bytes([int(dx * 127 + 127.5), int(dy * 127 + 127.5), int(z * 127 + 127.5)])
        rows.append(bytes(line))
    return _file(rows, width, 2, 3)
