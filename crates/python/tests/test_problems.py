"""Wrong scenes have the same problems as typed classes, as dicts and as files."""

import json
import unittest

import juggler as jg
from juggler import backgrounds as background_kinds
from juggler import cameras, lights, materials, shapes, textures
from juggler._scene import native_scene
from support import Folder

LIMB = {"lengths": [2, 3], "radii": [1, 1, 1], "from": [0, 0, 0]}
TRACK = {"keys": [[0, 1], [2, 3], [1, 2]]}


def one(shape, **more):
    """A scene with one object."""
    return {"version": 1, "objects": [{"shape": shape, **more}]}


def ball(**more):
    """A scene with one sphere, with these fields of its object."""
    return one({"sphere": {"radius": 1}}, **more)


def scene(**more):
    """A scene with one sphere, with these fields of its own."""
    return {**ball(), **more}


def moved(*steps):
    return ball(transform=list(steps))


def keyed(**track):
    return one({"sphere": {"radius": {"animate": track}}})


WRONG = {
    "misspelled field": one({"sphere": {"raduis": 2}}),
    "misspelled section": {"version": 1, "object": []},
    "misspelled object field": {"version": 1, "objects": [{"shap": {"sphere": {}}}]},
    "word for a number": one({"sphere": {"radius": "big"}}),
    "expression without its sign": one({"sphere": {"radius": "2 * 3"}}),
    "unknown kind": one({"spere": {}}),
    "unknown kind far off": one({"teapot": {}}),
    "kind of another program": one({"box": {"size": 2}}),
    "object of another program": {"version": 1, "objects": [{"type": "cube", "position": [0, 1, 0]}]},
    "material of another program": ball(material={"glass": {}}),
    "material by a foreign name": ball(material="glass"),
    "camera of another program": scene(camera={"perspective": {"position": [0, 1, 5], "fov": 40}}),
    "settings of another program": scene(render={"width": 640, "spp": 16}),
    "light of another program": scene(lights=[{"spot": {"angle": 30, "location": [0, 4, 0]}}]),
    "two steps in one": ball(transform={"scale": 2, "translate": [0, 1, 0]}),
    "step by zero": ball(transform={"scale": [1, 0, 1]}),
    "levels for colors": scene(
        background={"solid": {"radiance": [255, 128, 0]}},
        materials={"red": {"phong": {"diffuse": [255, 0, 0]}}},
    ),
    "levels for a reflectance": ball(material={"plastic": {"reflectance": [200, 40, 40]}}),
    "polygon without vertices": one({"polygon": {"vertices": []}}),
    "unknown material": scene(
        materials={"gold": {"phong": {}}}, objects=[{"shape": {"sphere": {}}, "material": "glod"}]
    ),
    "unknown metal": ball(material={"conductor": {"metal": "alumnium"}}),
    "unknown texture": scene(materials={"red": {"phong": {"diffuse": "marble"}}}),
    "circle of textures": scene(
        textures={"a": {"mix": {"b": "b"}}, "b": {"ramp": {"stops": [{"position": 0, "color": "a"}]}}}
    ),
    "wide mortar": scene(textures={"wall": {"brick": {"width": 0.2, "mortar_width": 0.3}}}),
    "texture without scale": scene(textures={"wall": {"noise": {"scale": [1, 0, 1]}}}),
    "unknown group": {"version": 1, "objects": [{"group": "pawn"}]},
    "unknown camera": scene(render={"camera": "mian"}, cameras={"main": {"perspective": {"eye": [0, 0, 9]}}}),
    "no number by expression": one({"sphere": {"radius": "=sqrt(1 - frames*2)"}}),
    "infinity by expression": moved({"translate": [0, "=1/frame", 0]}),
    "unknown variable": scene(variables={"phi": "2*pi*fram/frames"}),
    "open parenthesis": one({"sphere": {"radius": "=2 * (1 + frame"}}),
    "variable that is taken": scene(variables={"sin": 1}),
    "variable before its definition": scene(variables={"a": "b + 1", "b": 2}),
    "negative radius": one({"sphere": {"radius": -1}}),
    "tiny radius": one({"sphere": {"radius": 1e-60}}),
    "huge number": moved({"translate": [1e300, 0, 0]}),
    "vector of two numbers": moved({"translate": [1, 2]}),
    "circle of groups": {
        "version": 1,
        "groups": {"a": [{"group": "b"}], "b": [{"group": "a"}]},
        "objects": [{"group": "a"}],
    },
    "circle of materials": scene(materials={"a": {"checkerboard": {"even": "a", "odd": "a"}}}),
    "mesh from nothing": one({"mesh": {}}),
    "wrong version": {"version": 2, "objects": []},
    "shape and group": {
        "version": 1,
        "groups": {"a": []},
        "objects": [{"shape": {"sphere": {}}, "group": "a"}],
    },
    "two kinds": one({"sphere": {}, "cuboid": {}}),
    "no kind": one({}),
    "spot wider than its edge": scene(lights=[{"spot": {"beam_degrees": 50, "cutoff_degrees": 20}}]),
    "dome without radius": scene(background={"dome": {"radius": 0}}),
    "endless light": scene(lights=[{"point": {"attenuation": {"constant": 0, "quadratic": 0}}}]),
    "light without direction": scene(lights=[{"directional": {"direction": [0, 0, 0]}}]),
    "neither shape nor group": {"version": 1, "objects": [{"name": "nothing"}]},
    "camera that looks at its eye": scene(camera={"perspective": {"eye": [1, 2, 3], "look_at": [1, 2, 3]}}),
    "two fields of view": scene(
        camera={"perspective": {"vertical_fov_degrees": 40, "horizontal_fov_degrees": 60}}
    ),
    "camera and cameras": scene(camera={"perspective": {}}, cameras={"main": {"perspective": {}}}),
    "bent polygon": one({"polygon": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 1, 1]]}}),
    "axis of length 0": moved({"rotate": {"axis": [0, 0, 0], "degrees": 9}}),
    "singular matrix": moved({"matrix": [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0]}),
    "matrix of 13 numbers": moved({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5]}),
    "wrong color": scene(background={"solid": {"radiance": "#12345g"}}),
    "color by name": scene(lights=[{"point": {"color": "tomatoe"}}]),
    "limb out of reach": {
        "version": 1,
        "objects": [{"limb": {**LIMB, "to": [0, 9, 0], "plane_normal": [0, 0, 1]}}],
    },
    "limb along its normal": {
        "version": 1,
        "objects": [{"limb": {**LIMB, "to": [0, 4, 0], "plane_normal": [0, 1, 0]}}],
    },
    "image without pixels": scene(render={"size": [0, 0]}),
    "huge image": scene(render={"size": [65536, 65536]}),
    "half a sample": scene(render={"samples": 0.5}),
    "unknown integrator": scene(render={"integrator": "classical"}),
    "filter as a dict of nothing": scene(render={"filter": {"box": {"radius": 1}}}),
    "number for a material": ball(material=7),
    "number for an object": {"version": 1, "objects": [5]},
    "track without keys": keyed(kyes=[[0, 1]]),
    "track out of order": keyed(**TRACK),
    "track of words": keyed(keys=[[0, "small"], [1, "large"]]),
    "unknown interpolation": keyed(keys=[[0, 1], [1, 2]], interpolation="liner", repeat="bounce"),
    "unknown path": scene(
        paths={"flight": {"points": [[0, 0, 0], [1, 2, 3]]}},
        objects=[
            {"shape": {"sphere": {}}, "transform": [{"translate": {"along": {"path": "fligth", "at": 0}}}]}
        ],
    ),
    "vector for a number": {**one({"sphere": {"radius": "=2 * ball"}}), "variables": {"ball": [1, 2, 3]}},
    "several mistakes": scene(
        lights=[{"point": {"intensity": -1}}, {"pont": {}}],
        materials={"red": {"phong": {"diffuse": "none", "shininess": "high"}}},
    ),
}


def node(family, value):
    """The typed form of a kind, or the value itself where there is no class or field for it."""
    if not isinstance(value, dict) or len(value) != 1:
        return value
    ((kind, fields),) = value.items()
    for name in family.__all__:
        cls = getattr(family, name)
        if cls._kind == kind:
            return construct(cls, fields)
    return value


def construct(cls, fields):
    """A typed object, or the dict itself if the class refuses its fields."""
    try:
        return cls(**{f"{name}_" if name == "from" else name: value for name, value in fields.items()})
    except TypeError:
        return fields if cls._kind is None else {cls._kind: fields}


def typed_object(value):
    if not isinstance(value, dict):
        return value
    value = dict(value)
    for name, family in (("shape", shapes), ("material", materials)):
        if name in value:
            value[name] = node(family, value[name])
    if "limb" in value:
        value["limb"] = construct(jg.scene_types.Limb, value["limb"])
    return construct(jg.Object, value)


def typed(wrong):
    """The scene as typed classes."""
    value = {name: part for name, part in wrong.items() if name != "version"}
    for name, family in (("materials", materials), ("textures", textures), ("cameras", cameras)):
        if name in value:
            value[name] = {key: node(family, part) for key, part in value[name].items()}
    for name, family in (("camera", cameras), ("background", background_kinds)):
        if name in value:
            value[name] = node(family, value[name])
    if "lights" in value:
        value["lights"] = [node(lights, light) for light in value["lights"]]
    if "objects" in value:
        value["objects"] = [typed_object(part) for part in value["objects"]]
    if "render" in value:
        value["render"] = construct(jg.RenderSettings, value["render"])
    return construct(jg.Scene, value)


def problems(scene):
    """Path, message, help and severity of each problem of a scene."""
    try:
        native_scene(scene).check()
    except jg.SceneError as error:
        return sorted((each.path, each.message, each.help or "", each.severity) for each in error.problems)
    return []


class Problems(Folder):
    def test_typed_scenes_dicts_and_files_have_the_same_problems(self):
        self.assertGreaterEqual(len(WRONG), 60)
        count = 0
        for name, wrong in WRONG.items():
            with self.subTest(name):
                expected = problems(wrong)
                self.assertTrue(expected, "the scene has no problem")
                path = self.folder / "scene.json"
                path.write_text(json.dumps(wrong))
                self.assertEqual(problems(path), expected)
                scene = typed(wrong)
                if isinstance(scene, jg.Scene) and wrong["version"] == 1:
                    self.assertEqual(problems(scene), expected)
                    count += 1
        self.assertGreaterEqual(count, 60)


if __name__ == "__main__":
    unittest.main()
