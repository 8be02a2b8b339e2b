"""Random numbers and tileable noise from integer hashes, equal on every machine."""


def hashed(*keys):
    """Return a number in [0, 1) that depends on the integers `keys` alone."""
    h = 0x9E3779B9
    for key in keys:
        h = ((h ^ (key & 0xFFFFFFFF)) * 0x85EBCA6B) & 0xFFFFFFFF
        h ^= h >> 13
        h = (h * 0xC2B2AE35) & 0xFFFFFFFF
        h ^= h >> 16
    return h / 4294967296


def between(low, high, *keys):
    return low + (high - low) * hashed(*keys)


def _steps(size, cells):
    """Return, for each pixel, its two lattice points and the weight of the second one."""
    steps = []
    for i in range(size):
        x = i * cells / size
        cell = int(x)
        t = x - cell
        steps.append((cell % cells, (cell + 1) % cells, t * t * (3 - 2 * t)))
    return steps


def octave(width, height, cells_x, cells_y, seed):
    """Return rows of value noise in [0, 1] with a lattice of `cells_x` by `cells_y` cells."""
    lattice = [[hashed(seed, x, y) for x in range(cells_x)] for y in range(cells_y)]
    columns = _steps(width, cells_x)
    rows = []
    for y0, y1, t in _steps(height, cells_y):
        line = [a + (b - a) * t for a, b in zip(lattice[y0], lattice[y1])]
        rows.append([line[x0] + (line[x1] - line[x0]) * s for x0, x1, s in columns])
    return rows


def fractal(width, height, cells_x, cells_y, seed, octaves=4, gain=0.5):
    """Return rows of the weighted sum of octaves of value noise, in [0, 1]; the result tiles."""
    total = [[0.0] * width for _ in range(height)]
    weight, whole = 1.0, 0.0
    for i in range(octaves):
        noise = octave(width, height, cells_x << i, cells_y << i, seed + 101 * i)
        total = [[a + b * weight for a, b in zip(p, q)] for p, q in zip(total, noise)]
        whole += weight
        weight *= gain
    return [[a / whole for a in row] for row in total]
