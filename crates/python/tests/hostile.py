"""Random scenes and settings, most of them wrong. Each must give an image or an exception of the
kinds below: no crash, no panic, no hang.

    python crates/python/tests/hostile.py FIRST COUNT

The number of an input determines it. A failure prints the number and the input. `test_hostile.py`
runs this program, since a crash ends it.
"""

import copy
import faulthandler
import inspect
import random
import resource
import sys
import warnings

import juggler as jg
from support import numpy, small_scene

ALLOWED = (ValueError, TypeError, KeyError, OSError, MemoryError)
# Seconds after which an input counts as a hang.
PATIENCE = 120
# Address space of the process, in bytes: a machine survives an input that asks for everything.
MEMORY = 8 << 30


def fragments():
    """The examples of all typed classes, in the form of JSON."""
    names = {name: getattr(jg, name) for name in jg.__all__}
    for module in map(jg.__getattr__, jg._MODULES):
        for name in module.__all__:
            cls = getattr(module, name)
            node = eval(inspect.getdoc(cls).rpartition("Example:\n")[2].strip(), names)
            yield module.__name__.rpartition(".")[2], node.to_dict()


FRAGMENTS = list(fragments())
# Names that the examples use.
MATERIALS = ["black", "green", "paint", "rust", "steel", "stone", "white"]
TEXTURES = ["flow", "height", "leaf", "moss", "normals", "rock", "scratches", "stone", "tiles"]


def numbers(rng):
    """A hostile or plain number."""
    return rng.choice(
        [0, -0.0, 1, -1, 0.5, 2, 3, 100, 1e-45, 1e-300, 1e30, -1e38, 1e300, 2**31, 2**63, -(2**63), 2**70]
        + [float("nan"), float("inf"), float("-inf"), rng.uniform(-5, 5), rng.randrange(-5, 50)]
    )


def words(rng):
    """A hostile or plain string."""
    return rng.choice(
        [
            "",
            " ",
            "=",
            "=1/0",
            "=frame",
            "=sqrt(-1)",
            "=(((((",
            "=1e999",
            "=a.b",
            "a" * 5000,
            "\0",
            "\ud800",
            "é",
        ]
        + [
            "#fff",
            "#12345",
            "gold",
            "floor",
            "ground",
            "sphere",
            "none.ply",
            "/",
            "..",
            "http://a",
            "juggler",
        ]
    )


def oddities(rng):
    """A value that JSON does not have, or that is deep or long."""
    deep = []
    for _ in range(rng.choice([3, 60, 600, 3000])):
        deep = [deep]
    circle = {}
    circle["a"] = circle
    return rng.choice(
        [None, True, False, object(), b"bytes", {1}, 1j, range(3), deep, circle, {1: 2}, {}, [], [[]]]
    )


def arrays(rng):
    """An array of NumPy of any type, order and size; of no use without NumPy."""
    if numpy is None:
        return oddities(rng)
    shape = rng.choice(
        [(), (0,), (3,), (0, 3), (1, 3), (4, 3), (3, 4), (2, 2, 2), (1000, 3), (5, 3, 4), (2, 4, 4)]
    )
    kind = rng.choice(
        ["<f4", ">f4", "<f8", ">f8", "<f2", "i1", "<i4", ">i4", "<i8", "u1", ">u2", "<u8", "?", "O", "c8"]
    )
    count = 1
    for length in shape:
        count *= length
    values = [rng.choice([0, 1, 2, 3, -1]) for _ in range(count)]
    array = numpy.array(values).astype(kind).reshape(shape)
    if array.dtype.kind == "f" and rng.random() < 0.3 and array.size:
        array.flat[rng.randrange(array.size)] = rng.choice([numpy.nan, numpy.inf, -numpy.inf])
    view = rng.randrange(6)
    if view == 0 and array.ndim:
        return array[::-1]
    if view == 1 and array.ndim:
        return array[::2]
    if view == 2:
        return array.T
    if view == 3 and array.ndim and array.size:
        return numpy.broadcast_to(array[:1], (rng.choice([1, 7, 20_000]), *array.shape[1:]))
    if view == 4:
        array.flags.writeable = False
    return array


def numeric(rng, shape, whole=False):
    """An array of this shape of any type and order, whose numbers are in range."""
    generator = numpy.random.default_rng(rng.getrandbits(32))
    if whole:
        found = generator.integers(0, max(shape[0], 1), shape)
        found = found.astype(rng.choice(["u4", ">u4", "i4", "i8", ">i8", "u8", "u2", "f4"]))
    else:
        found = generator.uniform(-1, 1, shape).astype(rng.choice(["f4", ">f4", "f8", ">f8", "f2"]))
    view = rng.randrange(5)
    if view == 0:
        return found[::-1]
    if view == 1:
        return numpy.repeat(found, 2, axis=0)[::2]
    return numpy.asfortranarray(found) if view == 2 else found


def arrayed(rng):
    """An object with arrays, one of which may be wrong."""
    count = rng.choice([1, 3, 30, 300, 3000])
    fields = {"positions": numeric(rng, (count, 3))}
    if rng.random() < 0.5:
        others = {"triangles": ((count, 3), True), "normals": ((count, 3), False), "uvs": ((count, 2), False)}
    else:
        others = {"rotations": ((count, 4), False), "scales": ((count,), False)}
    is_mesh = "triangles" in others
    for name, (shape, whole) in others.items():
        if name == "triangles" or rng.random() < 0.3:
            fields[name] = numeric(rng, shape, whole)
    if rng.random() < 0.3:
        wrap = jg.PerFace if is_mesh and rng.random() < 0.5 else lambda values: values
        fields["attributes"] = {rng.choice(["color", "part", words(rng)]): wrap(arrays(rng))}
    if rng.random() < 0.3:
        fields[rng.choice([*fields])] = rng.choice([arrays, value])(rng)
    if is_mesh:
        return jg.Object(jg.shapes.Mesh(**fields), material="gold")
    return jg.Object(jg.shapes.Sphere(radius=0.01), instances=jg.Instances(**fields))


def picture(rng):
    """A texture from an array, which may be wrong."""
    shape = rng.choice([(4, 4), (3, 5, 1), (2, 2, 3), (7, 1, 4), (0, 3), (2, 2, 5), (1,)])
    pixels = numpy.ones(shape, rng.choice(["u1", "u2", ">u2", "f2", "f4", ">f4", "f8", "i4", "?"]))
    return jg.textures.Image(array=rng.choice([pixels, pixels[::-1], arrays(rng)]), color_space=words(rng))


def value(rng):
    """A value of any kind."""
    make = rng.choice([numbers, numbers, words, oddities, arrays, fragment, row])
    return make(rng)


def row(rng):
    return [rng.choice([numbers, words])(rng) for _ in range(rng.choice([1, 2, 3, 3, 3, 4, 12, 16]))]


def fragment(rng):
    return copy.deepcopy(rng.choice(FRAGMENTS)[1])


def of(rng, family):
    return copy.deepcopy(rng.choice([node for name, node in FRAGMENTS if name == family]))


def base(rng):
    """A scene of known parts."""
    scene = small_scene()
    scene["objects"][1]["shape"] = of(rng, "shapes")
    scene["materials"].update({name: {"diffuse": {}} for name in MATERIALS}, gold=of(rng, "materials"))
    scene["textures"] = {name: {"checker": {}} for name in TEXTURES}
    if rng.random() < 0.5:
        scene["lights"] = [of(rng, "lights")]
        scene["background"] = of(rng, "backgrounds")
        scene["textures"].update(scratches=of(rng, "textures"), tiles=of(rng, "textures"))
    if numpy is not None and rng.random() < 0.4:
        scene["objects"].append(arrayed(rng))
    if numpy is not None and rng.random() < 0.1:
        scene["textures"]["scratches"] = picture(rng)
    if rng.random() < 0.3:
        scene["camera"] = of(rng, "cameras")
        scene["render"]["integrator"] = of(rng, "integrators")
        scene["render"]["sampler"] = of(rng, "samplers")
        scene["render"]["filter"] = of(rng, "filters")
    return scene


def places(node, found, depth=0):
    """All containers in a value with their keys, but for those that are deep inside."""
    pairs = node.items() if isinstance(node, dict) else enumerate(node)
    for key, part in pairs:
        found.append((node, key))
        if isinstance(part, (dict, list)) and depth < 20:
            places(part, found, depth + 1)
    return found


def mutate(rng, scene):
    """Replaces, removes, adds or moves a part."""
    node, key = rng.choice(places(scene, []))
    way = rng.randrange(8)
    if way == 0:
        del node[key]
    elif way == 1 and isinstance(node, dict):
        node[str(words(rng))] = node.pop(key)
    elif way == 2 and isinstance(node, list):
        node.append(value(rng))
    elif way == 3:
        other, its_key = rng.choice(places(scene, []))
        try:
            node[key] = copy.deepcopy(other[its_key])
        except RecursionError:
            node[key] = other[its_key]
    else:
        node[key] = value(rng)


def settings(rng):
    """Settings of a small render, of which some are wrong."""
    found = {"size": (8, 5), "samples": 1, "threads": 1, "max_memory": "500M", "progress": False}
    choices = {
        "size": lambda: rng.choice(
            [(1, 1), (0, 1), (16, 9), [7, 7], (2**40, 1), (70_000, 70_000), value(rng)]
        ),
        "seed": lambda: value(rng),
        "noise": lambda: value(rng),
        "integrator": lambda: rng.choice(["path", "direct", "classic", value(rng)]),
        "sampler": lambda: rng.choice(["sobol", value(rng)]),
        "max_depth": lambda: rng.choice([1, 2, value(rng)]),
        "camera": lambda: rng.choice([of(rng, "cameras"), value(rng)]),
        "frame": lambda: value(rng),
        "shutter": lambda: rng.choice([(0, 0.5), row(rng)]),
        "crop": lambda: rng.choice([(0, 0, 2, 2), row(rng)]),
        "aovs": lambda: rng.choice([["depth"], ["normal", "object_id"], value(rng)]),
        "denoise": lambda: rng.choice([True, "own", value(rng)]),
        "exposure": lambda: value(rng),
        "tone": lambda: value(rng),
        "white_balance": lambda: value(rng),
        "max_memory": lambda: rng.choice(["1M", "500M", "", "-1", words(rng)]),
        "samples": lambda: rng.choice([1, 2, "1", -1, 0.5]),
        "sampels": lambda: 1,
    }
    for name in rng.sample(list(choices), rng.choice([0, 0, 0, 0, 1, 2])):
        found[name] = choices[name]()
    return found


def attempt(number):
    """Renders an input; returns whether it gave an image."""
    rng = random.Random(number)
    try:
        scene = base(rng)
    except ALLOWED:
        return False
    for _ in range(rng.choice([0, 0, 1, 1, 1, 2, 3])):
        mutate(rng, scene)
    chosen = settings(rng)
    try:
        jg.render(scene, **chosen)._repr_png_()
        return True
    except ALLOWED:
        return False
    except BaseException:
        print(f"input {number}: {chosen}\n{scene}", file=sys.stderr)
        raise


def main(first, count):
    """Prints the number of each input before it, and at the end how many of them gave an image."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    faulthandler.enable()
    warnings.simplefilter("ignore")
    images = 0
    for number in range(first, first + count):
        faulthandler.dump_traceback_later(PATIENCE, exit=True)
        print(number, flush=True)
        images += attempt(number)
    faulthandler.cancel_dump_traceback_later()
    print(images)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
