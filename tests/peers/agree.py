"""Compares pictures of the neutral scenes by Juggler, Mitsuba and Cycles over many seeds.

    OURS_BIN=target/release/juggler PYTHON tests/peers/agree.py PACK SCENES OUT [--seeds 10] [--threads 2]
        [--only cornell,mesh-env] [--peers mitsuba-llvm,cycles] [--scale 1] [--worst 10]

PACK is the comparison pack (render_peer.py and adapters/), SCENES is the folder of its
make_scenes.py, PYTHON is one with numpy and Pillow, and PEERS_HOME is that of the pack. OUT keeps
all pictures: a second run renders only missing ones and repeats the comparison.

Each program renders each scene once per seed. For each pixel, each block of 4x4 and 8x8 pixels and
each channel, two programs then have means and variances over the seeds. Welch's t of their
difference is converted to the normal deviate z of equal probability, whose distribution is normal
if the pictures differ by noise only. The script prints the fractions of |z| beyond 2, 3 and 4
(4.55 %, 0.27 % and 0.006 % for a normal distribution), the mean of z^2 (1 for a normal distribution;
the chi-squared of all blocks divided by their number), and the difference of the mean colors in
percent with its standard deviation.

Noise is not normal: where few paths carry most of the light, the mean of few samples is too low
more often than too high, and so is its variance. Blocks therefore decide, pixels show details, and
each program is also compared with itself, one half of its seeds with the other. Two means count as
equal if they differ by much less than FLOOR of their value, whatever their noise, since rounding is
not noise.

OUT/SCENE.A.B.png shows z of the pixels and, beside it, of the blocks: red where A is brighter, blue
where B is, black where both are equal, full color at 5. --worst 10 prints the ten small blocks that
differ most, with their means.
"""
import argparse
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
FLOOR = 2e-4
BLOCKS = (4, 8)
# Size, and number of samples of each program per seed.
SCENES = {
    "cornell": ((128, 128), {"juggler": 64, "mitsuba-llvm": 256, "cycles": 64}),
    "mesh-env": ((160, 90), {"juggler": 64, "mitsuba-llvm": 256, "cycles": 64}),
    "many-lights": ((160, 90), {"juggler": 32, "mitsuba-llvm": 128, "cycles": 32}),
    "whitted-spheres": ((160, 90), {"juggler": 64, "mitsuba-llvm": 256, "cycles": 64}),
}


def render(arguments, scene, program, seed):
    """Renders one picture, or reads it from scene.program.seed.npy."""
    kept = os.path.join(arguments.out, f"{scene}.{program}.{seed}.npy")
    if os.path.exists(kept):
        return np.load(kept)
    (width, height), samples = SCENES[scene]
    width, height, spp = int(width * arguments.scale), int(height * arguments.scale), samples[program]
    folder = os.path.join(arguments.scenes, scene)
    if program == "juggler":
        import juggler_peer

        # Different programs may use the same seeds, since their noise is independent.
        how = SimpleNamespace(scene=folder, width=width, height=height, spp=spp, threads=arguments.threads, seed=seed)
        picture, _ = juggler_peer.run(how)
    else:
        from common import read_exr

        exr = kept[:-4] + ".exr"
        command = [sys.executable, os.path.join(arguments.pack, "render_peer.py"), program, folder, "--width", width, "--height", height]
        command += ["--spp", spp, "--threads", arguments.threads, "--seed", seed, "--float", "--out", exr, "--json", kept[:-4] + ".json"]
        subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
        picture = read_exr(exr)
        os.remove(exr)
    np.save(kept, picture.astype("f4"))
    return picture


def blocks(pictures, edge):
    """Returns means over blocks of edge x edge pixels, without incomplete blocks."""
    n, h, w, c = pictures.shape
    h, w = h // edge, w // edge
    return pictures[:, : h * edge, : w * edge].reshape(n, h, edge, w, edge, c).mean((2, 4), dtype="f8")


def normal_of(t, freedom):
    """Converts Student's t to the normal deviate of equal probability (Wallace 1959; within 1 %
    from 5 degrees of freedom on)."""
    return np.sign(t) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t * t / freedom))


def welch(a, b):
    """Returns z of the difference of two sets of pictures for each pixel (Welch 1947); the first
    axis is that of the seeds."""
    mean = a.mean(0), b.mean(0)
    share = a.var(0, ddof=1) / len(a), b.var(0, ddof=1) / len(b)
    # Values without noise may still be rounded differently.
    floor = (FLOOR * (0.5 * (mean[0] + mean[1]) + 1e-3)) ** 2
    sum_of_shares = share[0] + share[1]
    # Treat rounding as noise of known variance.
    squares = share[0] ** 2 / (len(a) - 1) + share[1] ** 2 / (len(b) - 1)
    freedom = (sum_of_shares + floor) ** 2 / (squares + 1e-3 * floor**2)
    return normal_of((mean[0] - mean[1]) / np.sqrt(sum_of_shares + floor), freedom)


def color_difference(a, b):
    """Returns the difference of the mean colors in percent and its deviation, per channel."""
    a, b = a.mean((1, 2), dtype="f8"), b.mean((1, 2), dtype="f8")
    spread = np.sqrt(a.var(0, ddof=1) / len(a) + b.var(0, ddof=1) / len(b))
    return 100 * (a.mean(0) / b.mean(0) - 1), 100 * spread / b.mean(0)


def statistics(z):
    size = np.abs(z)
    beyond = " ".join(f"{100 * (size > limit).mean():6.3f}" for limit in (2, 3, 4))
    return f"{beyond}  z2 {np.mean(z * z):6.3f} median z2 {np.median(z * z) / 0.4549:6.3f}  worst {size.max():5.1f}"


def compare(arguments, scene, names, a, b):
    difference, spread = color_difference(a, b)
    colors = " ".join(f"{d:+.3f}({s:.3f})" for d, s in zip(difference, spread))
    z = {edge: welch(blocks(a, edge), blocks(b, edge)) for edge in (1, *BLOCKS)}
    print(f"{scene:15} {names[0]:>12} - {names[1]:12} color % {colors}")
    for edge, of in z.items():
        print(f"{'':15} {edge:2} x {edge:2} {statistics(of)}", flush=True)
    if names[0] != names[1]:
        paint(os.path.join(arguments.out, f"{scene}.{names[0]}.{names[1]}.png"), z)
        if arguments.worst:
            worst(arguments.worst, z[BLOCKS[0]], blocks(a, BLOCKS[0]).mean(0), blocks(b, BLOCKS[0]).mean(0))


def worst(count, z, a, b):
    size, edge = np.abs(z).max(2), BLOCKS[0]
    for place in np.argsort(-size, axis=None)[:count]:
        y, x = np.unravel_index(place, size.shape)
        row = [" ".join(f"{v:9.5f}" for v in of[y, x]) for of in (a, b)]
        print(f"{'':17} pixel {x * edge:4},{y * edge:4}: z {' '.join(f'{v:+5.1f}' for v in z[y, x])}   {row[0]} | {row[1]}")


def paint(path, z):
    from PIL import Image

    def shown(z, zoom):
        z = np.clip(z.mean(2) / 5, -1, 1)
        picture = np.stack([np.maximum(z, 0), np.zeros_like(z), np.maximum(-z, 0)], 2)
        return np.kron((255 * np.sqrt(picture)).astype("u1"), np.ones((zoom, zoom, 1), "u1"))

    pictures = [shown(of, 4 * edge) for edge, of in z.items()]
    height = max(picture.shape[0] for picture in pictures)
    pictures = [np.pad(picture, ((0, height - picture.shape[0]), (0, 8), (0, 0))) for picture in pictures]
    Image.fromarray(np.concatenate(pictures, 1)).save(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("pack", "scenes", "out"):
        parser.add_argument(name)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--scale", type=float, default=1)
    parser.add_argument("--worst", type=int, default=0, help="print so many blocks that differ most")
    parser.add_argument("--only", default=",".join(SCENES))
    parser.add_argument("--peers", default="mitsuba-llvm,cycles")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    sys.path[:0] = [HERE, os.path.join(arguments.pack, "adapters")]
    for scene in arguments.only.split(","):
        programs = ["juggler"] + arguments.peers.split(",")
        pictures = {p: np.stack([render(arguments, scene, p, seed) for seed in range(arguments.seeds)]) for p in programs}
        for at, name in enumerate(programs):
            half = arguments.seeds // 2
            compare(arguments, scene, (name, name), pictures[name][:half], pictures[name][half:])
            for other in programs[at + 1 :]:
                compare(arguments, scene, (name, other), pictures[name], pictures[other])


if __name__ == "__main__":
    main()
