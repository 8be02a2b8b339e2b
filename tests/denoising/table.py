"""Error before and after denoising, as the table of docs/denoising.md.

    python3 tests/denoising/table.py [JUGGLER] [FOLDER]

JUGGLER is the program (target/release/juggler). FOLDER keeps pictures, figures and the films that the filters start from, so that an
interrupted run continues and another filter is tried without rendering anew. Where JUGGLER_OIDN names the folder of Open Image
Denoise, it takes part. References are rendered with another seed. Errors and FLIP are those of `juggler compare`, seconds those of
`--stats`: of rendering, and with a denoiser of `juggler merge` too, which reads and writes files besides.
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
# What a denoised picture of 16 samples is measured by.
GOAL = 128
WAYS = {"input": [], "own": ["--denoise"], "oidn": ["--denoise", "oidn"]}


def run(program, *arguments):
    """The statistics that the program writes; status 1 is a comparison that says no."""
    done = subprocess.run([program, *arguments, "--stats", "-"], capture_output=True, text=True)
    if done.returncode > 1:
        raise SystemExit(f"{' '.join(arguments)}: {done.stderr}")
    return json.loads(done.stdout)


def render(program, folder, scene, samples, seed, flags):
    """A picture or, with flags of a denoiser, the film that it starts from, and the seconds of rendering; both are kept."""
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


def measure(program, folder, scene, samples, way):
    """relMSE, FLIP and seconds of a picture, denoised or not."""
    picture, seconds = render(program, folder, scene, samples, 0, WAYS[way])
    if WAYS[way]:
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
    ways = [way for way in WAYS if way != "oidn" or "JUGGLER_OIDN" in os.environ]
    print("| scene | samples |" + "".join(f" {way}: relMSE | FLIP | seconds |" for way in ways))
    print("|---|---|" + "---|" * (3 * len(ways)))
    for scene in SCENES:
        for samples in SAMPLES:
            found = [measure(program, folder, scene, samples, way) for way in ways]
            print(f"| {scene} | {samples} | " + " | ".join(cells(one) for one in found) + " |", flush=True)
            if samples == 16:
                denoised = found[1:]
        goal = measure(program, folder, scene, GOAL, "input")
        met = ["yes" if one[0] <= goal[0] else "no" for one in denoised]
        print(f"| {scene} | {GOAL} | {cells(goal)} | as good with 16, denoised: {', '.join(met)} |", flush=True)


if __name__ == "__main__":
    main()
