"""Mesh files (OBJ with MTL, PLY, STL) beside trimesh: triangles, bounds and materials in use."""

import json
from pathlib import Path

ENDINGS = {".obj", ".ply", ".stl"}


def meshes_of(folder):
    """All mesh files below a folder, except in folders of defective files."""
    found = sorted(path for path in folder.rglob("*") if path.suffix.lower() in ENDINGS)
    return [path for path in found if "malformed" not in path.parts]


def defined(path):
    """Names of the materials that the libraries of an OBJ define."""
    files = [path.parent / name for name in names(path, "mtllib")]
    return {name for file in files if file.is_file() for name in names(file, "newmtl")}


def names(path, word):
    """Names in the statements of a word."""
    statements = [line.split(maxsplit=1) for line in lines(path)]
    return [rest[0].strip() for first, *rest in statements if first == word and rest]


def used(path):
    """Names of the materials that faces of an OBJ use; None for faces without one."""
    current, found = None, set()
    for line in lines(path):
        word, *rest = line.split(maxsplit=1)
        if word == "usemtl":
            current = rest[0].strip() if rest else None
        elif word == "f":
            found.add(current)
    return found


def lines(path):
    """Stripped lines of a text that are not empty."""
    return [line.strip() for line in path.read_text(errors="replace").splitlines() if line.strip()]


def positive(path, scratch):
    """The file, or for an OBJ a copy whose faces count positions from the start: trimesh reads negative
    indices in another way."""
    if path.suffix.lower() != ".obj":
        return path
    positions, written = 0, []
    for line in lines(path):
        word, *corners = line.split()
        positions += word == "v"
        if word == "f":
            firsts = [int(corner.split("/")[0]) for corner in corners]
            written.append(" ".join(["f", *(str(i if i > 0 else positions + 1 + i) for i in firsts)]))
        elif word == "v":
            written.append(" ".join(line.split()[:4]))
    copy = Path(scratch) / "positive.obj"
    copy.write_text("\n".join(written) + "\n")
    return copy


def check(program, folder, scratch, bounds_of, run, report):
    """A17."""
    import numpy as np
    import trimesh
    for path in meshes_of(folder):
        name = path.relative_to(folder)
        is_model = path.suffix.lower() == ".obj" and bool(names(path, "mtllib"))
        mesh = {"model": {"file": str(path)}} if is_model else {"shape": {"mesh": {"file": str(path)}}}
        scene = Path(scratch) / "mesh.json"
        scene.write_text(json.dumps({"version": 1, "objects": [mesh]}))
        missing = run(program, "check", scene, check=False).stderr
        if "no such file" in missing:
            print(f"     {name} names files that are missing")
            continue
        ours, triangles = bounds_of(program, scene)
        try:
            theirs = trimesh.load(positive(path, scratch), force="mesh", process=False)
        except ValueError as reason:
            print(f"     trimesh cannot read {name}: {reason}")
            continue
        report(f"triangles of {name}", triangles == len(theirs.faces), f"{triangles} {len(theirs.faces)}")
        error = np.abs(np.array(ours) - theirs.bounds).max() / np.linalg.norm(theirs.extents)
        report(f"bounds of {name}", error < 1e-5, f"{error:.1e}")
        if is_model:
            known = defined(path)
            expected = {material if material in known else "default material" for material in used(path)}
            models = json.loads(run(program, "info", path, "--json").stdout)["models"]
            found = set(models[0]["materials"])
            report(f"materials of {name}", found == expected, f"{sorted(found)} {sorted(expected)}")
        run(program, "render", path, "--size", "64x48", "--samples", 1, "-o", Path(scratch) / "picture.png")
