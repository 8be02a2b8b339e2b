"""Adapter of the peer benchmark pack: converts a neutral scene to Juggler's format and renders it.

Copy it into the pack's adapters/ and set OURS_BIN to the program. OURS_FLAGS adds options;
OURS_INTEGRATOR and OURS_SAMPLER (JSON) replace integrator and sampler. As a program it only
converts: juggler_peer.py SCENE_FOLDER > scene.json
"""
import json
import os
import subprocess
import sys
import tempfile


def material(m):
    kind = m["type"]
    if kind == "diffuse":
        return {"diffuse": {"reflectance": m["reflectance"]}}
    if kind == "mirror":
        return {"conductor": {"reflectance": m["reflectance"], "grazing": m["reflectance"], "roughness": 0}}
    if kind == "rough_conductor":
        return {"conductor": {"eta": m["eta"], "k": m["k"], "roughness": m["alpha"] ** 0.5, "energy_compensation": False}}
    if kind == "glass":
        return {"dielectric": {"ior": m["ior"]}}
    raise SystemExit(f"juggler: no material of type {kind}")


def shape(s, folder):
    if s["type"] == "ply":
        return {"mesh": {"file": os.path.join(folder, s["file"])}}, []
    if s["type"] == "sphere":
        return {"sphere": {"radius": s["radius"]}}, [{"translate": s["center"]}]
    if s["type"] == "box":
        return {"cuboid": {"min": s["min"], "max": s["max"]}}, []
    if s["type"] == "checker_plane":
        edge = 2 * s["size"] * s["half_count"]
        return {"rectangle": {"size": [edge, edge]}}, [{"translate": [0, s["y"], 0]}]
    raise SystemExit(f"juggler: no shape of type {s['type']}")


def placed(s, folder):
    kind, steps = shape(s, folder)
    if "emission" in s:
        made_of = {"emissive": {"radiance": s["emission"]}}
    elif s["type"] == "checker_plane":
        made_of = {"checkerboard": {"size": s["size"], "even": s["materials"][0], "odd": s["materials"][1]}}
    else:
        made_of = s["material"]
    return {"shape": kind, "transform": steps, "material": made_of} if steps else {"shape": kind, "material": made_of}


def integrator(neutral):
    depth = neutral["max_depth"]
    if neutral["type"] == "whitted":
        # The pack counts all surfaces of a path, Juggler those after the first.
        return {"classic": {"max_depth": depth - 1, "min_weight": 0}}
    return {"path": {"max_depth": depth, "roulette_depth": neutral.get("rr_depth")}}


def convert(folder):
    neutral = json.load(open(os.path.join(folder, "scene.json")))
    camera = neutral["camera"]
    view = {"eye": camera["eye"], "look_at": camera["look_at"], "up": camera["up"], "vertical_fov_degrees": camera["vfov"]}
    scene = {
        "version": 1,
        "render": {"integrator": integrator(neutral["integrator"]), "filter": {"box": {}}},
        "camera": {"perspective": view},
        "background": neutral.get("background", [0, 0, 0]),
        "materials": {name: material(m) for name, m in neutral["materials"].items()},
        "lights": [],
        "objects": [placed(s, folder) for s in neutral["shapes"]],
    }
    for light in neutral["lights"]:
        if light["type"] == "point":
            scene["lights"].append({"point": {"position": light["position"], "color": light["intensity"]}})
        elif light["type"] == "constant":
            scene["background"] = light["radiance"]
        elif light["type"] == "envmap":
            image = {"file": os.path.join(folder, light["file"]), "scale": light.get("scale", 1)}
            scene["background"] = {"environment": image}
        else:
            raise SystemExit(f"juggler: no light of type {light['type']}")
    for part in ("integrator", "sampler"):
        if "OURS_" + part.upper() in os.environ:
            scene["render"][part] = json.loads(os.environ["OURS_" + part.upper()])
    return scene


def read_pfm(path):
    import numpy

    with open(path, "rb") as file:
        assert file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        return numpy.frombuffer(file.read(), order + "f4").reshape(height, width, 3)[::-1].copy()


def run(args):
    folder = tempfile.mkdtemp()
    scene, picture, stats = (os.path.join(folder, name) for name in ("scene.json", "o.pfm", "stats.json"))
    json.dump(convert(os.path.abspath(args.scene)), open(scene, "w"))
    command = [os.environ["OURS_BIN"], "render", scene, "-o", picture, "--size", f"{args.width}x{args.height}", "--samples", str(args.spp),
               "--threads", str(args.threads), "--seed", str(args.seed), "--stats", stats, "--quiet"]
    subprocess.run(command + os.environ.get("OURS_FLAGS", "").split(), check=True)
    s = json.load(open(stats))
    seconds = s["seconds"]
    return read_pfm(picture), dict(version="juggler", import_s=0.0, load_s=seconds["load"] + seconds["build"], warmup_s=0.0,
                               render_s=seconds["render"], render_cpu_s=None, spp=s["samples"], child=True)


if __name__ == "__main__":
    json.dump(convert(os.path.abspath(sys.argv[1])), sys.stdout, indent=1)
