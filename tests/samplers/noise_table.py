"""Prints the cost of `--noise` relative to equal samples per pixel, at equal error.

    python3 tests/samplers/noise_table.py [JUGGLER] [FOLDER]

The table is that of docs/samplers.md. JUGGLER is the program (target/release/juggler). FOLDER keeps
pictures and figures, so that an interrupted run continues.

The script renders each scene until its noise is LEVEL, then with equal samples per pixel, from
fewer to more than the mean of the first render. It interpolates the cost at equal error between two of
these, linearly in logarithms. Errors are the relMSE of `juggler compare`, against a reference with
another seed. Costs are CPU time and the number of rays, which is the same in every run.
"""
import json
import math
import os
import resource
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Size, noise level, maximum number of samples.
SCENES = {
    "cornell-box": ("300x300", 0.035, 1024),
    "furnace": ("360x300", 0.025, 1024),
    "glass-caustics": ("400x250", 0.03, 1024),
    "juggler-daylight": ("400x225", 0.02, 1024),
    "material-balls": ("400x225", 0.05, 1024),
    "depth-of-field": ("300x225", 0.02, 1024),
}
REFERENCE = 1024
STEPS = (0.9, 1.4, 2.2)


def run(program, *arguments):
    """Returns the statistics that the program writes, and its CPU seconds; status 1 means that
    compared pictures differ."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([program, *arguments, "--stats", "-"], capture_output=True, text=True)
    if done.returncode > 1:
        raise SystemExit(f"{' '.join(arguments)}: {done.stderr}")
    stats = json.loads(done.stdout)
    stats["processor"] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return stats


def render(program, folder, scene, samples, seed, flags=()):
    size = SCENES[scene][0]
    name = "-".join([scene, str(samples), str(seed), *(flag.strip("-") for flag in flags)])
    picture, figures = (os.path.join(folder, name + ending) for ending in (".pfm", ".json"))
    if not os.path.exists(figures):
        file = os.path.join(ROOT, "scenes", scene + ".json")
        shot = ["--size", size, "--samples", str(samples), "--seed", str(seed), "--quiet", *flags, "-o", picture]
        json.dump(run(program, "render", file, *shot), open(figures, "w"))
    return picture, json.load(open(figures))


def measure(program, folder, scene, samples, flags=()):
    """Returns error, millions of rays, seconds, and samples per pixel."""
    picture, stats = render(program, folder, scene, samples, 0, flags)
    reference, _ = render(program, folder, scene, REFERENCE, 9)
    width, height = stats["size"]
    found = run(program, "compare", picture, reference)["relative_mse"]
    return found, stats["rays"]["total"] / 1e6, stats["processor"], stats["rays"]["camera"] / (width * height)


def at_error(error, evens):
    """Returns rays, seconds and samples of a picture of this error with equal samples per pixel."""
    evens = sorted(evens)
    for low, high in zip(evens, evens[1:]):
        if low[0] <= error <= high[0]:
            share = math.log(error / low[0]) / math.log(high[0] / low[0])
            return [math.exp(math.log(a) + share * math.log(b / a)) for a, b in zip(low[1:], high[1:])]
    return [math.nan] * 3


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target/release/juggler")
    folder = sys.argv[2] if len(sys.argv) > 2 else "noise"
    os.makedirs(folder, exist_ok=True)
    print("| scene | `--noise` | relMSE | mean samples | million rays | seconds | uniform samples for this error | million rays | seconds | rays saved | time saved |")
    print("|" + "---|" * 11)
    for scene, (_, level, most) in SCENES.items():
        error, rays, seconds, samples = measure(program, folder, scene, most, ["--noise", str(level)])
        evens = [measure(program, folder, scene, max(1, round(samples * step))) for step in STEPS]
        even_rays, even_seconds, even_samples = at_error(error, evens)
        print(f"| {scene} | {level} | {error:.6f} | {samples:.0f} | {rays:.0f} | {seconds:.1f} | {even_samples:.0f} | {even_rays:.0f} | {even_seconds:.1f} "
              f"| {1 - rays / even_rays:.0%} | {1 - seconds / even_seconds:.0%} |", flush=True)


if __name__ == "__main__":
    main()
