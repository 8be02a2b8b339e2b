"""Checks that the built-in denoiser keeps the mean of the picture and leaves no bright pixels.

    python3 tests/denoising/conservation.py [JUGGLER] [FOLDER] [SEEDS]

JUGGLER is the program (target/release/juggler), SEEDS is the number of seeds (32). FOLDER keeps the
references and the partial renders that the filter reads, so that an interrupted run continues and
another filter needs no new renders. The scenes are those of table.py at half their size. The script
fails if

- the denoised mean of any seed and channel differs from the mean of the filter's input by more than
  0.5 %. `juggler render --denoise -o PART.jfilm --stats` reports the mean of that input, and
  `juggler merge PART.jfilm` denoises it;
- a denoised pixel is brighter than 3 times the brightest of the 48 pixels around it, and neither
  this pixel of the reference nor one of its neighbors is.
"""
import array
import json
import os
import sys

from table import ROOT, SCENES, run

SAMPLES = (4, 16, 64)
SEEDS = 32
# Maximum relative deviation of the mean.
MEAN = 0.005
# Maximum ratio of a pixel to the brightest pixel around it, and the radius of that neighborhood.
BRIGHT, REACH = 3, 3


def brightness(file):
    """Returns the width of a PFM and the sum of the channels of each pixel, row by row."""
    data = open(file, "rb").read()
    _, size, _, pixels = data.split(b"\n", 3)
    numbers = array.array("f", pixels)
    return int(size.split()[0]), [sum(numbers[i : i + 3]) for i in range(0, len(numbers), 3)]


def bright(width, pixels):
    """Returns the pixels that are much brighter than their surroundings."""
    found, height = set(), len(pixels) // width
    for y in range(height):
        for x in range(width):
            own = pixels[y * width + x]
            # Most pixels have a neighbor of similar brightness, so test the nearest ones first.
            near = [(y, x - 1), (y, x + 1), (y - 1, x), (y + 1, x)]
            if any(0 <= v < height and 0 <= u < width and own <= BRIGHT * pixels[v * width + u] for v, u in near):
                continue
            rows = range(max(0, y - REACH), min(height, y + REACH + 1))
            columns = range(max(0, x - REACH), min(width, x + REACH + 1))
            around = [pixels[v * width + u] for v in rows for u in columns if (u, v) != (x, y)]
            if own > BRIGHT * max(around):
                found.add((x, y))
    return found


def picture(program, folder, scene, samples, seed, flags, name):
    """Renders to a file of this name and returns it with its mean per channel; keeps both."""
    output = os.path.join(folder, name)
    figures = output + ".json"
    if not os.path.exists(figures):
        width, height = (int(length) // 2 for length in SCENES[scene][0].split("x"))
        file = os.path.join(ROOT, "scenes", scene + ".json")
        shot = ["--size", f"{width}x{height}", "--samples", str(samples), "--seed", str(seed), "--quiet"]
        mean = run(program, "render", file, *shot, *flags, "-o", output)["film"]["mean"]
        with open(figures, "w") as kept:
            json.dump(mean, kept)
    with open(figures) as kept:
        return output, json.load(kept)


def reference(program, folder, scene):
    """Returns the bright pixels of a picture of many samples, with their neighbors, since noise may
    move them by a pixel."""
    file, _ = picture(program, folder, scene, SCENES[scene][1], 99, [], f"reference-{scene}.pfm")
    return {(x + u, y + v) for x, y in bright(*brightness(file)) for u in (-1, 0, 1) for v in (-1, 0, 1)}


def measure(program, folder, scene, samples, seed):
    """Returns the means per channel of the filter's input and of the denoised picture, and the
    bright pixels of the denoised picture."""
    part, before = picture(program, folder, scene, samples, seed, ["--denoise"], f"{scene}-{samples}-{seed}.jfilm")
    denoised = os.path.join(folder, "denoised.pfm")
    after = run(program, "merge", part, "-o", denoised, "--quiet")["film"]["mean"]
    return before, after, bright(*brightness(denoised))


def main():
    arguments = dict(enumerate(sys.argv))
    program = arguments.get(1, os.path.join(ROOT, "target/release/juggler"))
    folder, seeds = arguments.get(2, "denoising"), int(arguments.get(3, SEEDS))
    os.makedirs(folder, exist_ok=True)
    print("| scene | samples | mean, denoised / input | largest deviation of a seed | single bright pixels |")
    print("|---|---|---|---|---|")
    failed = False
    for scene in SCENES:
        allowed = reference(program, folder, scene)
        for samples in SAMPLES:
            results = [measure(program, folder, scene, samples, seed) for seed in range(1, seeds + 1)]
            before, after = ([means[k] for means in results] for k in (0, 1))
            total = [sum(map(sum, means)) for means in (before, after)]
            pairs = [pair for means in zip(before, after) for pair in zip(*means)]
            largest = max(abs(after / before - 1) for before, after in pairs if before > 0)
            count = sum(place not in allowed for *_, places in results for place in places)
            failed |= largest > MEAN or count > 0
            row = f"{total[1] / total[0]:.6f} | {100 * largest:.5f} % | {count}"
            print(f"| {scene} | {samples} | {row} |", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
