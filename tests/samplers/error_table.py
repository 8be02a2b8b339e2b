"""Prints errors by number of samples for each sampler and four scenes, as in docs/samplers.md.

    python3 tests/samplers/error_table.py [JUGGLER] [FOLDER]

JUGGLER is the program (target/release/juggler). FOLDER keeps the pictures. The script needs numpy.
"""
import os
import subprocess
import sys

import numpy

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SIZE = (160, 120)
# Number of pictures per error, by samples per pixel.
SAMPLES = {1: 4, 4: 4, 16: 4, 64: 2, 256: 1}
REFERENCE = 2048
SAMPLERS = ("independent", "stratified", "sobol", "blue_noise")
SCENES = {
    "soft shadows": ("scenes/cornell-box.json", ["--integrator", "direct"]),
    "indirect light": ("scenes/cornell-box.json", []),
    "lens": ("scenes/depth-of-field.json", []),
    "many lights": ("tests/peers/scenes/many-lights.json", []),
}
# Standard deviation, in pixels, of the blur that models an eye.
BLUR = 1.5


def render(program, folder, scene, sampler, samples, seed):
    name = f"{scene.replace(' ', '-')}-{sampler}-{samples}" + (f"-{seed}" if seed else "")
    picture = os.path.join(folder, name + ".pfm")
    if not os.path.exists(picture):
        file, flags = SCENES[scene]
        text = open(os.path.join(ROOT, file)).read()
        variant = os.path.join(folder, name + ".json")
        open(variant, "w").write(text.replace('"render": {', f'"render": {{"sampler": "{sampler}", "filter": "box", ', 1))
        command = [program, "render", variant, "--size", f"{SIZE[0]}x{SIZE[1]}", "--samples", str(samples)]
        subprocess.run(command + ["--seed", str(seed), "--quiet", "-o", picture] + flags, check=True)
        os.remove(variant)
    return read_pfm(picture)


def read_pfm(path):
    with open(path, "rb") as file:
        assert file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        pixels = numpy.frombuffer(file.read(), order + "f4").reshape(height, width, 3)
        return pixels[::-1].astype(numpy.float64)


def blurred(image):
    reach = int(3 * BLUR + 0.5)
    weights = numpy.exp(-0.5 * (numpy.arange(-reach, reach + 1) / BLUR) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        padded = numpy.pad(image, [(reach, reach) if axis == a else (0, 0) for a in range(3)], mode="edge")
        length = image.shape[axis]
        image = sum(w * padded.take(range(i, i + length), axis) for i, w in enumerate(weights))
    return image


def shown(picture):
    """Clips to white, as a screen does; otherwise the edges of lights would dominate the error."""
    return numpy.minimum(picture, 1)


def relative_mse(picture, reference):
    """Relative error as --noise defines it: divided by the square of the mean plus 0.01."""
    gray = reference.mean(axis=2)
    return (((picture - reference) ** 2).mean(axis=2) / (gray**2 + 0.01)).mean()


def number(error):
    """Formats a number in thousandths, with two digits."""
    return f"{1000 * error:.2g}" if error < 0.0995 else str(round(100 * error) * 10)


def table(title, rows):
    print(f"\n{title}\n")
    print("| scene | sampler | " + " | ".join(map(str, SAMPLES)) + " |")
    print("|---|---|" + "---|" * len(SAMPLES))
    for scene, sampler, errors, best in rows:
        cells = [f"**{number(e)}**" if e <= 1.02 * b else number(e) for e, b in zip(errors, best)]
        print(f"| {scene} | {sampler} | " + " | ".join(cells) + " |")


def main():
    program = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target/release/juggler"))
    folder = os.path.abspath(sys.argv[2] if len(sys.argv) > 2 else os.path.join(ROOT, "target/samplers"))
    os.makedirs(folder, exist_ok=True)
    rows = {"pixels": [], "blurred": []}
    for scene in SCENES:
        reference = shown(render(program, folder, scene, "sobol", REFERENCE, seed=99))
        errors = {kind: {} for kind in rows}
        for sampler in SAMPLERS:
            for kind, look in (("pixels", lambda picture: picture), ("blurred", blurred)):
                errors[kind][sampler] = []
                for n, seeds in SAMPLES.items():
                    pictures = [shown(render(program, folder, scene, sampler, n, seed)) for seed in range(seeds)]
                    all_errors = [relative_mse(look(picture), look(reference)) for picture in pictures]
                    errors[kind][sampler].append(numpy.mean(all_errors))
        for kind, by_sampler in errors.items():
            best = [min(column) for column in zip(*by_sampler.values())]
            rows[kind] += [(scene, sampler, by_sampler[sampler], best) for sampler in SAMPLERS]
    table("Relative mean square error, in thousandths", rows["pixels"])
    table(f"The same after a blur of {BLUR} pixels", rows["blurred"])


if __name__ == "__main__":
    main()
