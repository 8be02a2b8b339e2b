"""Prints errors before and after denoising, as in the table of docs/denoising.md.

    python3 tests/denoising/table.py [JUGGLER] [FOLDER]

JUGGLER is the program (target/release/juggler). FOLDER keeps pictures, figures and the partial
renders that the filters read, so that an interrupted run continues and another filter needs no new
renders. If JUGGLER_OIDN names the folder of Open Image Denoise, the table includes it. References
have another seed. Errors and FLIP are those of `juggler compare`. Seconds are those of `--stats`:
of rendering, plus, with a denoiser, those of `juggler merge`, which also reads and writes files.
"""
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENES = {
    "cornell-box": ("300x300", 1024),
    "furnace": ("360x300", 1024),
    "glass-caustics": ("400x250", 1024),
    "juggler-daylight": ("400x225", 1024),
    "many-lights-room": ("400x225", 512),
    "material-balls": ("400x225", 1024),
}
SAMPLES = (4, 16, 64, 256)
# Number of samples whose error a denoised picture of 16 samples should reach.
GOAL = 128
FILTERS = {"input": [], "own": ["--denoise"], "oidn": ["--denoise", "oidn"]}


def run(program, *arguments):
    """Returns the statistics that the program writes; status 1 means that compared pictures
    differ."""
    done = subprocess.run([program, *arguments, "--stats", "-"], capture_output=True, text=True)
    if done.returncode > 1:
        raise SystemExit(f"{' '.join(arguments)}: {done.stderr}")
    return json.loads(done.stdout)


def render(program, folder, scene, samples, seed, flags):
    """Renders a picture or, with flags of a denoiser, the partial render that the denoiser reads.
    Returns the file and the seconds; keeps both."""
    name = "-".join([scene, str(samples), str(seed), *(flag.strip("-") for flag in flags)])
    picture, figures = (os.path.join(folder, name + ending) for ending in (".jfilm" if flags else ".pfm", ".json"))
    if not os.path.exists(figures):
        file = os.path.join(ROOT, "scenes", scene + ".json")
        shot = ["--size", SCENES[scene][0], "--samples", str(samples), "--seed", str(seed), "--quiet"]
        stats = run(program, "render", file, *shot, *flags, "-o", picture)
        with open(figures, "w") as kept:
            json.dump(stats["seconds"]["render"], kept)
    with open(figures) as kept:
        return picture, json.load(kept)


def measure(program, folder, scene, samples, filter_name):
    """Returns relMSE, FLIP and seconds of a picture, denoised or not."""
    picture, seconds = render(program, folder, scene, samples, 0, FILTERS[filter_name])
    if FILTERS[filter_name]:
        denoised = picture.removesuffix("jfilm") + "pfm"
        seconds += run(program, "merge", picture, "-o", denoised, "--quiet")["seconds"]["total"]
        picture = denoised
    reference, _ = render(program, folder, scene, SCENES[scene][1], 9, [])
    found = run(program, "compare", picture, reference)
    return found["relative_mse"], found["flip"]["mean"], seconds


def cells(found):
    error, flip, seconds = found
    return f"{error:.5f} | {flip:.4f} | {seconds:.2f}"


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target/release/juggler")
    folder = sys.argv[2] if len(sys.argv) > 2 else "denoising"
    os.makedirs(folder, exist_ok=True)
    filters = [filter_name for filter_name in FILTERS if filter_name != "oidn" or "JUGGLER_OIDN" in os.environ]
    print("| scene | samples |" + "".join(f" {filter_name}: relMSE | FLIP | seconds |" for filter_name in filters))
    print("|---|---|" + "---|" * (3 * len(filters)))
    for scene in SCENES:
        for samples in SAMPLES:
            found = [measure(program, folder, scene, samples, filter_name) for filter_name in filters]
            print(f"| {scene} | {samples} | " + " | ".join(cells(one) for one in found) + " |", flush=True)
            if samples == 16:
                denoised = found[1:]
        goal = measure(program, folder, scene, GOAL, "input")
        reached = ["yes" if one[0] <= goal[0] else "no" for one in denoised]
        print(f"| {scene} | {GOAL} | {cells(goal)} | as good with 16, denoised: {', '.join(reached)} |", flush=True)


if __name__ == "__main__":
    main()
