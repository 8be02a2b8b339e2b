"""Compares pictures of models by Juggler with pictures of the same files by Blender's Cycles.

    python3.13 -m venv blender && blender/bin/pip install bpy==5.2.3 numpy
    blender/bin/python tests/gltf/cycles.py PROGRAM ASSETS FOLDER [OPTION...] [MODEL...]

PROGRAM is the `juggler` program, ASSETS a folder with `gltf`, `obj` and `env/studio.hdr`, FOLDER
receives the pictures, and each MODEL is a name of MODELS. Without a MODEL all are compared.

--size N      pixels of a side, 512 by default
--samples N   samples per pixel of both programs, 128 by default
--causes      render each model with the changes of CAUSES too, which prove what makes it differ
--noise       compare two pictures of Juggler with different seeds instead, for the share of noise

Both programs show the rest pose with the same camera, in front of and lit by the same environment,
as linear radiance without denoising, clamping or tone curve. FLIP compares 8-bit sRGB pictures of
both, which the same function makes: radiance times 2^EXPOSURE, clipped to 0..1. The column `ratio`
is the mean radiance of Juggler's picture divided by that of Cycles, each clipped to 0..1.

FOLDER/NAME.png shows Juggler, Cycles and FLIP side by side. Pictures whose job did not change are
not rendered again. The exit status is 1 if the median of FLIP is above 0.05, or if no change
brings a model that is above 0.08 below it (without --causes, if a model is above 0.08).
"""

import argparse
import json
import statistics
import subprocess
import sys
from pathlib import Path

import numpy as np

import png

HERE = Path(__file__).resolve().parent
EXPOSURE = -2
MAX_DEPTH = 34
FIELD_OF_VIEW = 40
MEDIAN, LIMIT = 0.05, 0.08
EXPLAINED = set()  # Models that a change of CAUSES brings below LIMIT.
MODELS = ["AlphaBlendModeTest", "AnimatedMorphCube", "Avocado", "BoxVertexColors", "ClearCoatCarPaint",
          "EmissiveStrengthTest", "Fox", "GlassVaseFlowers", "LightsPunctualLamp", "MetalRoughSpheresNoTextures",
          "NormalTangentTest", "OrientationTest", "TextureCoordinateTest", "TextureTransformTest",
          "TransmissionRoughnessTest", "shaderball", "spot", "fuze"]
# Models that are not named after their folder, and the texture of an OBJ file without materials.
FILES = {"shaderball": "gltf/shaderball.glb", "spot": "obj/spot/spot_triangulated.obj", "fuze": "obj/fuze/fuze.obj"}
TEXTURES = {"spot": "obj/spot/spot_texture.png"}
# Changes that prove a cause: functions of blender.py, settings of kinds of materials in Juggler.
SINGLE = {"what": "single scattering between microfacets in both",
          "cycles": ["single_scattering"], "juggler": {"principled": {"energy_compensation": False}}}
CULLED = {"what": "no backs of one-sided surfaces in Cycles", "cycles": ["cull_backs"]}
BARE = {"what": "no coats and normal maps in both", "cycles": ["without_coat", "without_normal_maps"],
        "juggler": {"principled": {"clearcoat": 0}, "normal_map": {"strength": 0}}}
METAL = {"what": "and metal of one layer instead of a dielectric in both",
         "cycles": [*BARE["cycles"], *SINGLE["cycles"], "metal"],
         "juggler": BARE["juggler"] | {"principled": {"clearcoat": 0, "metallic": 1, "energy_compensation": False}}}
CAUSES = {
    "BoxVertexColors": [{"what": "the default material of the specification in Cycles", "cycles": ["default_material"]},
                        SINGLE | {"what": "and single scattering between microfacets in both",
                                  "cycles": ["default_material", "single_scattering"]}],
    "ClearCoatCarPaint": [BARE, METAL],
    "GlassVaseFlowers": [CULLED],
    "LightsPunctualLamp": [{"what": "candela not divided by 683 in Cycles", "cycles": ["radiometric"]},
                          {"what": "and glass without volume as thin walls", "cycles": ["radiometric", "thin_walls"]}],
    "NormalTangentTest": [BARE],
    "OrientationTest": [SINGLE],
    "TextureTransformTest": [CULLED],
    "TransmissionRoughnessTest": [{"what": "base color at each interface in Cycles", "cycles": ["tint_interfaces"]}],
    "fuze": [{"what": "half the specular level in Cycles", "cycles": ["half_specular"]}],
}


def run(*command):
    """Runs a program and returns its output."""
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{command}: status {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def file_of(assets, model):
    """File of a model."""
    if model in FILES:
        return assets / FILES[model]
    found = sorted(path for kind in ("*.glb", "*.gltf") for path in (assets / "gltf" / model).rglob(kind))
    return found[0]


def camera_of(options, model):
    """Juggler's default camera for a model in a square picture, from the bounds that `info` reports."""
    file = options.folder / f"{model}.bounds.json"
    scene = scene_of(options, model, {})
    del scene["cameras"]
    file.write_text(json.dumps(scene))
    lower, upper = np.array(json.loads(run(options.program, "info", file, "--json"))["bounds"])
    center, radius = (lower + upper) / 2, np.linalg.norm(upper - lower) / 2
    towards = np.array([0.35, 0.35, 1]) / np.linalg.norm([0.35, 0.35, 1])
    eye = center + towards * radius * 1.05 / np.sin(np.radians(FIELD_OF_VIEW / 2))
    return {"eye": eye.round(9).tolist(), "look_at": center.round(9).tolist(), "vertical_fov_degrees": FIELD_OF_VIEW}


def scene_of(options, model, camera, seed=0):
    """Juggler's scene of a model."""
    file = str(file_of(options.assets, model))
    shown = {"model": {"file": file, "animation": "none"}}
    scene = {"version": 1, "cameras": {"main": {"perspective": camera}}, "objects": [shown],
             "background": {"environment": {"file": str(options.assets / "env/studio.hdr")}},
             "render": {"size": [options.size] * 2, "samples": options.samples, "seed": seed,
                        "integrator": {"path": {"max_depth": MAX_DEPTH}}}}
    if model in TEXTURES:
        image = {"file": str(options.assets / TEXTURES[model])}
        scene["textures"] = {"image": {"image": image}}
        scene["materials"] = {"textured": {"principled": {"base_color": {"texture": "image"}, "roughness": 0.5}}}
        scene["objects"] = [{"shape": {"mesh": {"file": file}}, "material": "textured"}]
    return scene


def rendered(options, name, job, command):
    """File of the picture of a job, which is rendered unless it was before."""
    picture, written = options.folder / f"{name}.pfm", options.folder / f"{name}.json"
    text = json.dumps(job, indent=1)
    if not (picture.exists() and written.exists() and written.read_text() == text):
        picture.unlink(missing_ok=True)
        written.write_text(text)
        command(written, picture)
    return picture


def with_materials(options, model, scene, change):
    """The scene with settings of all its materials changed; its model becomes objects and materials."""
    folder = options.folder / f"{model}.parts"
    packed = options.folder / f"{model}.packed.json"
    packed.write_text(json.dumps(scene))
    unpacked = Path(run(options.program, "convert", packed, "--force", "--unpack", folder).strip())
    return changed(json.loads(unpacked.read_text()), change, folder)


def changed(value, change, folder):
    """A scene with settings of materials of some kinds changed, whose files have absolute paths."""
    if isinstance(value, list):
        return [changed(item, change, folder) for item in value]
    if not isinstance(value, dict):
        return value
    result = {key: str(folder / item) if key == "file" else changed(item, change, folder)
              for key, item in value.items()}
    for kind in change.keys() & result.keys():
        result[kind] |= change[kind]
    return result


def by_juggler(options, model, camera, change, label="", seed=0):
    """Picture by Juggler."""
    scene = scene_of(options, model, camera, seed)
    if change:
        scene = with_materials(options, model, scene, change)
    return rendered(options, f"{model}{label}.juggler", scene,
                    lambda scene, picture: run(options.program, "render", scene, "-o", picture))


def by_cycles(options, model, camera, changes, label=""):
    """Picture by Cycles."""
    job = {"model": str(file_of(options.assets, model)), "environment": str(options.assets / "env/studio.hdr"),
           "camera": {"eye": camera["eye"], "target": camera["look_at"], "up": [0, 1, 0],
                      "vertical_fov_degrees": camera["vertical_fov_degrees"]},
           "size": [options.size] * 2, "samples": options.samples, "max_depth": MAX_DEPTH, "seed": 0,
           "output": str(options.folder / f"{model}{label}.cycles.pfm"), "changes": changes}
    if model in TEXTURES:
        job["texture"] = str(options.assets / TEXTURES[model])
    return rendered(options, f"{model}{label}.cycles", job,
                    lambda file, picture: run(sys.executable, HERE / "blender.py", file))


def read_pfm(path):
    """Pixels of a PFM file, the upper row first."""
    _, size, _, data = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1]


def shown(linear):
    """8-bit sRGB of linear radiance."""
    light = np.clip(linear * 2.0**EXPOSURE, 0, 1)
    curve = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return (curve * 255 + 0.5).astype(np.uint8)


def compared(options, name, ours, theirs):
    """Mean FLIP of two pictures and the ratio of their mean radiance; writes both beside each other."""
    linear = [read_pfm(path) for path in (ours, theirs)]
    files = [options.folder / f"{name}.{side}.png" for side in ("juggler", "cycles")]
    for file, pixels in zip(files, linear):
        file.write_bytes(png.encode(shown(pixels)))
    difference, stats = options.folder / f"{name}.flip.pfm", options.folder / f"{name}.stats.json"
    subprocess.run(list(map(str, [options.program, "compare", *files, "--difference", difference, "--stats", stats])),
                   capture_output=True, check=False)
    map_of_flip = (np.clip(read_pfm(difference), 0, 1) ** (1 / 2.2) * 255).astype(np.uint8)
    beside = np.concatenate([*map(shown, linear), map_of_flip], 1)
    (options.folder / f"{name}.png").write_bytes(png.encode(beside))
    ratio = np.divide(*(np.clip(pixels * 2.0**EXPOSURE, 0, 1).mean() for pixels in linear))
    return json.loads(stats.read_text())["flip"]["mean"], float(ratio)


def compare_model(options, model):
    """Mean FLIP of a model, without and with the changes of its causes."""
    camera = camera_of(options, model)
    ours = by_juggler(options, model, camera, {})
    if options.noise:
        other = by_juggler(options, model, camera, {}, ".noise", seed=1)
        flip, ratio = compared(options, f"{model}.noise", ours, other)
        print(f"{model:28} {flip:.4f} {ratio:6.3f}", flush=True)
        return flip
    theirs = by_cycles(options, model, camera, [])
    flip, ratio = compared(options, model, ours, theirs)
    print(f"{model:28} {flip:.4f} {ratio:6.3f}", flush=True)
    for index, cause in enumerate(CAUSES.get(model, []) if options.causes else []):
        label = f".{index}"
        ours = by_juggler(options, model, camera, cause.get("juggler", {}), label)
        theirs = by_cycles(options, model, camera, cause.get("cycles", []), label)
        flip_changed, ratio = compared(options, model + label, ours, theirs)
        print(f"{'':28} {flip_changed:.4f} {ratio:6.3f} {cause['what']}", flush=True)
        if flip_changed <= LIMIT:
            EXPLAINED.add(model)
    return flip


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("program", "assets", "folder"):
        parser.add_argument(name, type=lambda path: Path(path).resolve())
    parser.add_argument("models", nargs="*", default=MODELS, metavar="MODEL")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--samples", type=int, default=128)
    parser.add_argument("--causes", action="store_true")
    parser.add_argument("--noise", action="store_true")
    options = parser.parse_intermixed_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    print(f"{'model':28} {'FLIP':6} {'ratio':>6}")
    flips = {model: compare_model(options, model) for model in options.models}
    median = statistics.median(flips.values())
    unknown = [model for model, flip in flips.items() if flip > LIMIT and model not in EXPLAINED]
    print(f"median {median:.4f}; above {LIMIT} without a proved cause: {unknown or 'none'}")
    raise SystemExit(1 if median > MEDIAN or unknown else 0)


if __name__ == "__main__":
    main()
