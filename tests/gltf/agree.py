"""Checks of the glTF importer against other programs and against itself. See docs/gltf.md.

    python3 -m venv checks && checks/bin/pip install -r tests/gltf/requirements.txt
    npm install --prefix tests/gltf
    checks/bin/python tests/gltf/agree.py PROGRAM MODELS [PART...]

PROGRAM is the `juggler` program and MODELS a folder of models. Where a part needs certain models, it
takes those of the Khronos sample assets by name, or all models of a folder that has none of these,
such as scenes/models. Each PART is one of

models     every model: `check`, `info` and a small render; pictures on 1, 2 and 4 threads
           are equal in every byte
encodings  rewrites by gltf-transform: the same numbers give pictures equal in every byte, lossy
           ones nearly the same picture (FLIP, which needs `juggler compare`)
numbers    triangles and bounds against trimesh, poses at seven times against three.js
tangents   tangents of meshes with normal maps against the package mikktspace
meshes     OBJ with MTL, PLY and STL files in the folder above MODELS beside trimesh: triangles,
           bounds, materials
movie      a movie that is killed and resumed, or rendered in shards, is the same file
extensions models of each extension: the same picture as the scene format's own material or nodes
malformed  500 defective files: no panic, status 2, and the place of the defect in the message
speed      times of large models

Without a PART all run. The exit status is 1 if a check fails.
"""

import json
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
FAILURES = []


def run(program, *args, check=True):
    """Runs a program and returns the finished process."""
    done = subprocess.run(list(map(str, (program, *args))), capture_output=True, text=True)
    if check and done.returncode != 0:
        raise SystemExit(f"{args}: status {done.returncode}\n{done.stderr}")
    return done


def report(what, holds, value=""):
    """Prints one result; returns whether it holds."""
    print(f"{'ok  ' if holds else 'FAIL'} {what} {value}", flush=True)
    if not holds:
        FAILURES.append(what)
    return holds


def models_of(folder):
    """All models below a folder."""
    return sorted(path for kind in ("*.glb", "*.gltf") for path in folder.rglob(kind))


def named(models, names):
    """The sample models of these names, or all models of a folder that has none of them."""
    return [models / name for name in names if (models / name).is_file()] or models_of(models)


def picture(program, scene, folder, *args, samples=1):
    """Bytes of a small picture."""
    path = Path(folder) / "picture.pfm"
    run(program, "render", scene, "-o", path, "--size", "64x64", "--samples", samples, *args)
    return path.read_bytes()


def check_models(program, models, folder):
    """A1."""
    for model in models_of(models):
        name = model.relative_to(models)
        for command in ("check", "info"):
            done = run(program, command, model, check=False)
            report(f"{command} {name}", done.returncode == 0, done.stderr.strip()[:200])
        one = picture(program, model, folder, "--threads", 1)
        others = [picture(program, model, folder, "--threads", threads) for threads in (2, 4)]
        report(f"render {name}", all(other == one for other in others))


# gltf-transform writes matrices of nodes as rounded rotations, so models with matrices are left out.
ENCODED = ["Fox/glTF-Binary/Fox.glb", "Box/glTF-Binary/Box.glb", "BoxInterleaved/glTF-Binary/BoxInterleaved.glb",
           "BoxVertexColors/glTF-Binary/BoxVertexColors.glb", "AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb",
           "TextureCoordinateTest/glTF-Binary/TextureCoordinateTest.glb", "SimpleSkin/glTF/SimpleSkin.gltf",
           "ClearCoatCarPaint/glTF-Binary/ClearCoatCarPaint.glb", "GlassVaseFlowers/glTF-Binary/GlassVaseFlowers.glb",
           "TextureTransformTest/glTF/TextureTransformTest.gltf",
           # Of scenes/models, without those whose pictures with few samples differ by noise alone.
           "robot.glb"]


def check_encodings(program, models, folder):
    """A2 and A3."""
    twins = [models / "Box" / name for name in ("glTF-Binary/Box.glb", "glTF-Embedded/Box.gltf")]
    if all(twin.is_file() for twin in twins):
        report("Box.glb and Box.gltf", len({picture(program, twin, folder) for twin in twins}) == 1)
    for path in named(models, ENCODED):
        model, target = path.relative_to(models), Path(folder) / path.stem
        names = json.loads(run("node", HERE / "rewrites.mjs", path, target).stdout.splitlines()[-1])
        original = picture(program, path, folder)
        for name in names["plain"]:
            report(f"{model} as {name}", picture(program, target / name, folder) == original)
        for name, decoded in names["decoded"].items():
            ours, theirs = (arrays(program, target / file, target / f"{file}-unpacked") for file in (name, decoded))
            report(f"{model} as {name}: arrays of the other decoder", ours == theirs and len(ours) > 0)
        check_lossy(program, path, [target / name for name in names["lossy"]], folder)


def arrays(program, model, folder):
    """Contents of the mesh files of an unpacked model."""
    run(program, "convert", model, "--force", "--unpack", folder)
    return sorted(path.read_bytes() for path in folder.glob("**/*.ply"))


def check_lossy(program, model, encodings, folder):
    """FLIP and silhouettes of encodings that round numbers; both pictures have the same random numbers."""
    import numpy as np

    def render(scene, path):
        run(program, "render", scene, "-o", path, "--size", "128x128", "--samples", 16, "--aov", "depth",
            "--aov-output", Path(folder) / "{}.npy")
        return path, np.isfinite(np.load(Path(folder) / "depth.npy"))
    original, covered = render(model, Path(folder) / "original.exr")
    for encoding in encodings:
        other, covers = render(encoding, Path(folder) / "encoded.exr")
        flip = json.loads(run(program, "compare", other, original, "--stats", "-", check=False).stdout)["flip"]["mean"]
        overlap = (covers & covered).sum() / (covers | covered).sum()
        report(f"{model.stem} as {encoding.name}: FLIP, overlap of silhouettes", flip <= 0.01 and overlap >= 0.99,
               f"{flip:.4f} {overlap:.4f}")


def bounds_of(program, scene):
    """Bounds and number of triangles that `info` reports."""
    info = json.loads(run(program, "info", scene, "--json").stdout)
    return info["bounds"], info["geometry"]["triangles"]


POSES = {"Fox/glTF-Binary/Fox.glb": "Run", "BoxAnimated/glTF-Binary/BoxAnimated.glb": "0",
         "SimpleSkin/glTF/SimpleSkin.gltf": "0"}


# Models whose bounds three.js gives: trimesh does not read sparse accessors.
NOT_BY_TRIMESH = {"SimpleSparseAccessor"}


def check_numbers(program, models, folder):
    """A6."""
    import numpy as np
    import trimesh
    for model in models_of(models):
        name = model.relative_to(models)
        if b"EXT_mesh_gpu_instancing" in model.read_bytes():
            print(f"     {name}: trimesh does not read instances")
            continue
        scene = Path(folder) / "rest.json"
        scene.write_text(json.dumps({"version": 1, "objects": [{"model": {"file": str(model), "animation": "none"}}]}))
        ours, triangles = bounds_of(program, scene)
        theirs = trimesh.load_scene(model)
        drawn = sum(len(theirs.geometry[theirs.graph[node][1]].faces) for node in theirs.graph.nodes_geometry
                    if hasattr(theirs.geometry[theirs.graph[node][1]], "faces"))
        report(f"triangles of {name}", triangles == drawn, f"{triangles} {drawn}")
        expected = theirs.bounds
        if name.stem in NOT_BY_TRIMESH:
            expected = np.array(json.loads(run("node", HERE / "poses.mjs", model, "none", 0).stdout)["bounds"][0])
        error = np.abs(np.array(ours) - expected).max() / np.linalg.norm(theirs.extents)
        report(f"bounds of {name}", error < 1e-5, f"{error:.1e}")
    for model, clip in POSES.items():
        if (models / model).is_file():
            check_poses(program, models / model, clip, folder)


def check_poses(program, model, clip, folder):
    """Bounds of posed vertices at seven times."""
    import numpy as np
    duration = json.loads(run("node", HERE / "poses.mjs", model, clip, 0).stdout)["duration"]
    times = [duration * share for share in (0, 0.1, 0.25, 0.4, 0.6, 0.85, 1)]
    expected = json.loads(run("node", HERE / "poses.mjs", model, clip, *times).stdout)["bounds"]
    worst = 0
    for at, theirs in zip(times, expected):
        scene = Path(folder) / "pose.json"
        clip_name = clip if not clip.isdigit() else int(clip)
        instance = {"file": str(model), "animation": clip_name, "at": at}
        scene.write_text(json.dumps({"version": 1, "objects": [{"model": instance}]}))
        ours, theirs = np.array(bounds_of(program, scene)[0]), np.array(theirs)
        worst = max(worst, np.abs(ours - theirs).max() / np.linalg.norm(theirs[1] - theirs[0]))
    report(f"poses of {model.name}", worst < 1e-5, f"{worst:.1e} of the diagonal")


def ply_tangents(path):
    """Tangents of the corners of a PLY file of triangles that the program wrote."""
    import numpy as np
    head, _, body = path.read_bytes().partition(b"end_header\n")
    lines = [line.split() for line in head.decode().splitlines()]
    counts = [int(line[2]) for line in lines if line[0] == "element"]
    columns = [line[2] for line in lines if line[:2] == ["property", "float"]]
    vertices = np.frombuffer(body, "<f4", counts[0] * len(columns)).reshape(counts[0], -1)
    faces = np.frombuffer(body, np.dtype([("count", "u1"), ("corners", "<u4", 3)]), counts[1], vertices.nbytes)
    return vertices[:, [columns.index(name) for name in ("tx", "ty", "tz", "tw")]][faces["corners"]].reshape(-1, 4)


# Corners whose tangents the package mikktspace rounds by more than 1e-5, by mesh: sums in double
# precision agree with the program there to 2e-7.
ROUNDED_TANGENTS = {"room.glb: Rug": 18}


def check_tangents(program, models, folder):
    """A7: tangents."""
    import numpy as np
    for found in json.loads(run("node", HERE / "tangents.mjs", folder, *models_of(models)).stdout):
        unpacked = Path(folder) / f"{Path(found['file']).stem}-unpacked"
        run(program, "convert", found["file"], "--force", "--unpack", unpacked)
        meshes = list(unpacked.glob("**/*.ply"))
        ours, theirs = ply_tangents(meshes[0]), np.array(found["tangents"]).reshape(-1, 4)
        name = found["name"].removeprefix(f"{models}/")
        if report(f"corners of {name}", len(meshes) == 1 and ours.shape == theirs.shape, f"{ours.shape} {theirs.shape}"):
            # The package loses digits in corners of nearly 180 degrees: in the 9 corners of 18,000 of
            # LightsPunctualLamp, the same sums in double precision agree with the program to 1.3e-6.
            error = np.abs(ours - theirs).max(1)
            wrong = (error >= 1e-5).sum()
            allowed = max(0.002 * len(error), ROUNDED_TANGENTS.get(name, 0))
            report(f"tangents of {name}", error.max() < 2e-4 and wrong <= allowed, f"{error.max():.1e}, {wrong} corners")


def check_meshes(program, models, folder):
    """A17."""
    from meshes import check
    check(program, models.parent, folder, bounds_of, run, report)


def check_movie(program, models, folder):
    """A12."""
    model, clip = models / "Fox/glTF-Binary/Fox.glb", ["--animation", "Run"]
    if not model.is_file():
        model, clip = models / "robot.glb", []
    options = [*clip, "--size", "320x240", "--samples", 64]
    whole, resumed = (Path(folder) / name for name in ("whole.mp4", "resumed.mp4"))
    run(program, "render", model, "-o", whole, *options)
    command = list(map(str, [program, "render", model, "-o", resumed, *options]))
    for seconds in (1, 2):
        started = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(seconds)
        report("the movie was not complete when it was killed", started.poll() is None)
        started.send_signal(signal.SIGKILL)
        started.wait()
    run(program, "render", model, "-o", resumed, *options)
    report("killed and resumed movie", resumed.read_bytes() == whole.read_bytes())
    shards = Path(folder) / "shards.mp4"
    for shard in (["--shard", "1/2"], ["--shard", "0/2"], []):
        run(program, "render", model, "-o", shards, *options, *shard)
    report("movie in shards", shards.read_bytes() == whole.read_bytes())


def check_extensions(program, models, folder):
    """A4b."""
    from extensions import cases
    for name, *scenes in cases(folder):
        one, other = (picture(program, scene, folder, samples=4) for scene in scenes)
        report(f"extension {name}", one == other and len(set(one)) > 16)


def check_malformed(program, models, folder):
    """A13."""
    from malformed import defects
    sources = ["Fox/glTF-Binary/Fox.glb", "AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb",
               "OrientationTest/glTF-Binary/OrientationTest.glb", "BoxAnimated/glTF-Binary/BoxAnimated.glb"]
    found = named(models, sources)
    files = [defect for seed, model in enumerate(found) for defect in defects(model.read_bytes(), 125, seed)]
    files += [(path.name, path.read_bytes()) for path in sorted((models.parent / "malformed").glob("*.gl*"))]
    unnamed, accepted = [], []
    for what, data in files:
        path = Path(folder) / "defective.glb"
        path.write_bytes(data)
        done = run(program, "check", path, check=False)
        if "panicked" in done.stderr or done.returncode not in (0, 2):
            report(f"{what}: status {done.returncode}", False, done.stderr[:200])
        elif done.returncode == 0:
            accepted.append(what)
        elif not re.search(r"/\w+/\d|/\w+|byte \d+", done.stderr.replace(str(path), "")):
            unnamed.append(what)
    report(f"places of {len(files)} defects", len(unnamed) <= 0.05 * len(files), f"{len(unnamed)} without: {unnamed}")
    report("defective files are refused", not accepted, f"{len(accepted)} accepted: {accepted}")


def check_speed(program, models, folder):
    """A10 and A11: `check` reads the whole file and builds the scene, without tracing."""
    for name, path in json.loads(run(sys.executable, HERE / "large.py", folder).stdout).items():
        seconds = []
        for _ in range(5):
            start = time.perf_counter()
            run(program, "info", path)
            seconds.append(time.perf_counter() - start)
        print(f"     {name}: {min(seconds):.2f} s, median {sorted(seconds)[2]:.2f} s")


PARTS = {"models": check_models, "encodings": check_encodings, "numbers": check_numbers,
         "tangents": check_tangents, "meshes": check_meshes, "movie": check_movie,
         "extensions": check_extensions, "malformed": check_malformed, "speed": check_speed}


def main():
    """Runs the parts that the command line names."""
    if len(sys.argv) < 3 or any(part not in PARTS for part in sys.argv[3:]):
        raise SystemExit(__doc__)
    program, models = (Path(argument).resolve() for argument in sys.argv[1:3])
    for part in sys.argv[3:] or PARTS:
        with tempfile.TemporaryDirectory() as folder:
            PARTS[part](program, models, folder)
    raise SystemExit(f"{len(FAILURES)} failed: {FAILURES}" if FAILURES else 0)


if __name__ == "__main__":
    sys.path.insert(0, str(HERE))
    main()
