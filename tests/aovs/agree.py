"""Checks that other programs read the AOVs of an EXR file as Juggler defines them.

    python3 -m venv aovs && aovs/bin/pip install -r tests/aovs/requirements.txt
    aovs/bin/python tests/aovs/agree.py target/release/juggler

The script renders tests/aovs/scene.json with all AOVs, twice: in the primaries of sRGB and in
ACEScg. OpenEXR's own reader and OpenImageIO must find the same parts, channels and numbers. From
these alone, the script checks that AOVs agree with each other: positions projected by worldToNDC
lie in their pixels, and worldToNDC of the next frame projects them to where the motion vectors end;
names hashed by mmh3 are those of the Cryptomatte manifests, whose mattes agree with ids and alpha;
the AOVs of light add up to the picture. Each check prints its result; the exit status is 1 if any
fails.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import mmh3
import numpy as np
import OpenEXR
import OpenImageIO as oiio

HERE = Path(__file__).resolve().parent
PARTS = {
    "beauty": "BGR", "alpha": "A", "albedo": "BGR", "normal": "XYZ", "geometric_normal": "XYZ", "depth": "Z", "planar_depth": "Z", "position": "XYZ",
    "uv": "UV", "motion": "XY", "motion_back": "XY", "emission": "BGR", "direct": "BGR", "indirect": "BGR",
    "light_group_rest": "BGR", "light_group_key": "BGR", "light_group_light": "BGR", "light_group_sky": "BGR",
    "object_id": "Y", "material_id": "Y", "instance_id": "Y",
    **{f"Crypto{kind}{i:02}": "ABGR" for kind in ("Object", "Material") for i in range(3)},
    "samples": "Y", "variance": "BGR", "not_finite": "Y", "clamped": "Y",
}
failures = 0


def check(what, holds, found=""):
    global failures
    failures += not holds
    print(f"{'ok  ' if holds else 'FAIL'} {what}{': ' if found else ''}{found}")


def render(program, folder, name, *flags):
    path = str(Path(folder) / name)
    subprocess.run([program, "render", str(HERE / "scene.json"), "-q", "-o", path, *flags], check=True)
    return path


def by_openexr(path):
    """Returns headers and channels by part."""
    file = OpenEXR.File(path, separate_channels=True)
    return {
        part.header.get("name", ""): (part.header, {name: channel.pixels for name, channel in part.channels.items()})
        for part in file.parts
    }


def by_oiio(path):
    source, parts = oiio.ImageInput.open(path), {}
    while source.seek_subimage(len(parts), 0):
        spec, pixels = source.spec(), source.read_image(oiio.FLOAT)
        parts[spec.getattribute("oiio:subimagename")] = (
            spec, {name: pixels[:, :, i] for i, name in enumerate(spec.channelnames)})
    source.close()
    return parts


def full(part, channel):
    return channel if part == "beauty" else f"{part}.{channel}"


def layer(parts, name, channels):
    return np.stack([parts[name][1][full(name, c)] for c in channels], axis=-1).astype(np.float64)


def projected(points, matrix):
    """Returns points (rows) times a matrix, in pixels."""
    rows = np.concatenate([points, np.ones_like(points[..., :1])], axis=-1) @ np.asarray(matrix, dtype=np.float64)
    height, width = points.shape[:2]
    return rows[..., :2] / rows[..., 3:] * (width, height), rows[..., 3]


def readers(path):
    ours, others = by_openexr(path), by_oiio(path)
    check("the parts are those that are documented", list(ours) == list(PARTS), f"{len(ours)} of OpenEXR")
    check("OpenImageIO finds the same", list(others) == list(ours), f"{len(others)}")
    names = all(sorted(ours[part][1]) == sorted(full(part, c) for c in PARTS[part]) for part in PARTS)
    check("channels are called as documented", names and all(set(ours[p][1]) == set(others[p][1]) for p in PARTS))
    same = all(np.array_equal(values, others[part][1][name], equal_nan=True)
               for part in PARTS for name, values in ours[part][1].items())
    check("all numbers are the same in both", same)
    return ours, others


def camera(ours, others, next_frame):
    header = ours["beauty"][0]
    matrix = np.array(header["worldToNDC"], dtype=np.float64)
    to_camera = np.array(header["worldToCamera"], dtype=np.float64)
    check("every part has both matrices", all("worldToNDC" in h and "worldToCamera" in h for h, _ in ours.values()))
    read = others["beauty"][0].getattribute("worldtocamera")
    check("OpenImageIO knows worldToCamera", read is not None and np.allclose(np.array(read).reshape(4, 4), to_camera))
    eye = np.array([0.2, 2, 7, 1]) @ to_camera
    check("the eye is at the origin of camera space", np.abs(eye[:3]).max() < 1e-5)
    position, alpha = layer(ours, "position", "XYZ"), layer(ours, "alpha", "A")[..., 0]
    film, ahead = projected(position, matrix)
    rows, columns = np.indices(alpha.shape)
    off = np.abs(film - np.stack([columns + 0.5, rows + 0.5], axis=-1)).max(axis=-1)
    seen = alpha > 0
    check("positions lie in their pixels", seen.sum() > 3000 and off[seen].max() < 0.51, f"at most {off[seen].max():.3f} off their centers")
    depth = layer(ours, "depth", "Z")[..., 0]
    z = np.concatenate([position, np.ones_like(position[..., :1])], axis=-1) @ to_camera
    plain = (alpha == 1) & (np.abs(z[..., 2] - ahead) < 1e-3 * ahead)
    check("distance along the view is both matrices' last word", plain.sum() == (alpha == 1).sum())
    # Compare only pixels that one object fills.
    solid = layer(ours, "CryptoObject00", "G")[..., 0] > 0.9999
    far = np.linalg.norm(z[..., :3], axis=-1)
    apart = np.abs(depth - far)[solid] / far[solid]
    check("depth is how far positions are", apart.max() < 1e-3, f"within {apart.max():.1e}")
    way, expected = layer(ours, "motion", "XY"), projected(position, next_frame)[0] - film
    apart = np.abs(way - expected).max(axis=-1)[solid]
    size = np.abs(expected[solid]).max()
    check("motion ends where the next frame has the position", apart.max() < 0.05 and size > 1,
          f"within {apart.max():.4f} of up to {size:.1f} pixels")
    sky = alpha == 0
    check("the background goes where the camera turns", np.abs(way[sky]).max() > 0.5 if sky.any() else False)


def name_hash(name):
    number = mmh3.hash(name, 0, signed=False)
    return number ^ 1 << 23 if number >> 23 & 255 in (0, 255) else number


def cryptomatte(ours, kind, names, ids):
    layers = [f"{kind}{i:02}" for i in range(3)]
    key = f"cryptomatte/{name_hash(kind):08x}"[:19]
    header = ours[layers[0]][0]
    check(f"{kind}: every part carries the texts under {key}", all(ours[p][0].get(f"{key}/name") == kind for p in layers))
    known = (header[f"{key}/hash"], header[f"{key}/conversion"]) == ("MurmurHash3_32", "uint32_to_float32")
    manifest = json.loads(header[f"{key}/manifest"])
    check(f"{kind}: the manifest", known and manifest == {name: f"{name_hash(name):08x}" for name in names}, ", ".join(manifest))
    ranks = [(ours[p][1][f"{p}.{i}"].view(np.uint32), ours[p][1][f"{p}.{c}"]) for p in layers for i, c in (("R", "G"), ("B", "A"))]
    mattes = {name: sum(np.where(rank == name_hash(name), share, 0) for rank, share in ranks) for name in names}
    total, alpha = sum(mattes.values()), layer(ours, "alpha", "A")[..., 0]
    check(f"{kind}: mattes add up to alpha", np.abs(total - alpha).max() < 1e-5, f"within {np.abs(total - alpha).max():.1e}")
    stacked = np.stack(list(mattes.values()))
    most, number = stacked.max(axis=0), layer(ours, ids, "Y")[..., 0].astype(int)
    chosen = np.take_along_axis(stacked, np.maximum(number - 1, 0)[None], axis=0)[0]
    check(f"{kind}: {ids} is what covers most", np.array_equal(number == 0, most == 0) and np.array_equal(chosen, most))


def light(parts, tolerance=1e-4):
    beauty = layer(parts, "beauty", "RGB")
    for names in (["emission", "direct", "indirect"], [f"light_group_{g}" for g in ("rest", "key", "light", "sky")]):
        apart = np.abs(sum(layer(parts, name, "RGB") for name in names) - beauty) / np.maximum(1, beauty)
        check(f"{' + '.join(names)} is the picture", apart.max() < tolerance, f"within {apart.max():.1e}")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        path = render(program, folder, "all.exr", "--aov", "all", "--frame", "1")
        after = by_openexr(render(program, folder, "next.exr", "--frame", "2"))
        wide = render(program, folder, "wide.exr", "--aov", "all", "--frame", "1", "--primaries", "acescg")
        ours, others = readers(path)
        (next_header, _), = after.values()
        camera(ours, others, next_header["worldToNDC"])
        objects = ["floor", "ball", "glass ball", "light", "veil", "objects[5]"]
        cryptomatte(ours, "CryptoObject", objects, "object_id")
        header = ours["CryptoMaterial00"][0]
        materials = json.loads(next(v for k, v in header.items() if k.endswith("/manifest")))
        check("CryptoMaterial: the scene's materials are named", {"clay", "glass", "lace", "emissive"} <= set(materials), ", ".join(materials))
        light(ours)
        counts = layer(ours, "samples", "Y"), layer(ours, "not_finite", "Y"), layer(ours, "clamped", "Y")
        check("counts of samples", (counts[0] == 32).all() and (counts[1] == 0).all() and 0 < counts[2].max() <= 32,
              f"{int(counts[2].sum())} clamped")
        ours, _ = readers(wide)
        light(ours)
        ap1 = [0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767]
        check("ACEScg is named in every part", all(np.allclose(np.array(h["chromaticities"]).ravel(), ap1) for h, _ in ours.values()))
    print("all hold" if failures == 0 else f"{failures} fail")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
