"""Skeletons, smooth skin weights and animation curves."""
import math

from gltf import rounded
from vec import dot, length, scaled, smoothstep, sub


class Rig:
    """Joints by name with their positions in the bind pose, in which nothing is rotated."""

    def __init__(self, joints):
        """Take triples of name, parent's name or None, and position; parents come first."""
        self.names = [name for name, _, _ in joints]
        self.parents = {name: parent for name, parent, _ in joints}
        self.places = {name: place for name, _, place in joints}
        self.nodes = {}

    def index(self, name):
        return self.names.index(name)

    def add_to(self, document, name):
        """Add nodes and the skin to a document and return the skin."""
        for joint in self.names:
            parent = self.parents[joint]
            origin = self.places[parent] if parent else (0, 0, 0)
            self.nodes[joint] = document.node(
                joint, self.nodes.get(parent), translation=rounded(sub(self.places[joint], origin)))
        matrices = []
        for joint in self.names:
            x, y, z = self.places[joint]
            matrices.append([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1])
        return document.add("skins", {
            "name": name, "joints": [self.nodes[joint] for joint in self.names],
            "skeleton": self.nodes[self.names[0]],
            "inverseBindMatrices": document.accessor(matrices, "MAT4")})

    def rigid(self, joint):
        pair = [(self.index(joint), 1.0)]
        return lambda p: pair

    def along(self, *joints, blend=0.5):
        """Return weights that pass smoothly from joint to joint of a limb.

        Around each joint, the weight changes over the share `blend` of the shorter bone beside it.
        """
        places = [self.places[j] for j in joints]
        bones = [length(sub(b, a)) for a, b in zip(places, places[1:])]
        starts = [sum(bones[:i]) for i in range(len(places))]

        def weights(p):
            s = _along(places, starts, p)
            result, rest = [], 1.0
            for i in range(len(joints) - 1, 0, -1):
                near = min(bones[i - 1], bones[i] if i < len(bones) else bones[i - 1]) * blend / 2
                share = smoothstep(starts[i] - near, starts[i] + near, s)
                result.append((self.index(joints[i]), rest * share))
                rest *= 1 - share
            return result + [(self.index(joints[0]), rest)]

        return weights


def _along(places, starts, p):
    """Return the arc length of the point of a polyline that is nearest to `p`."""
    best = (math.inf, 0.0)
    for i, (a, b) in enumerate(zip(places, places[1:])):
        bone = sub(b, a)
        t = dot(sub(p, a), bone) / dot(bone, bone)
        low, high = (0 if i else -1), (1 if i < len(places) - 2 else 2)
        t = min(max(t, low), high)
        distance = length(sub(p, tuple(x + y for x, y in zip(a, scaled(bone, t)))))
        if distance < best[0]:
            best = (distance, starts[i] + t * length(bone))
    return best[1]


class Clip:
    """Animation of a glTF document."""

    def __init__(self, document, name):
        self.document = document
        self.part = {"name": name, "channels": [], "samplers": []}
        self.inputs = {}
        document.add("animations", self.part)

    def _channel(self, node, path, times, output, interpolation):
        key = tuple(times)
        if key not in self.inputs:
            self.inputs[key] = self.document.accessor(list(times), "SCALAR", bounds=True)
        self.part["samplers"].append(
            {"input": self.inputs[key], "output": output, "interpolation": interpolation})
        self.part["channels"].append(
            {"sampler": len(self.part["samplers"]) - 1, "target": {"node": node, "path": path}})

    def linear(self, node, path, times, values):
        kind = {"rotation": "VEC4", "weights": "SCALAR"}.get(path, "VEC3")
        self._channel(node, path, times, self.document.accessor(values, kind), "LINEAR")

    def spline(self, node, path, times, values):
        """Add a looping CUBICSPLINE channel with Catmull-Rom tangents; first and last are equal."""
        triples = []
        last = len(values) - 1
        for i in range(last + 1):
            j = i % last
            before, after = values[(j - 1) % last], values[(j + 1) % last]
            span = (times[j + 1] - times[j]) + (times[j] - times[j - 1] if j else times[last] - times[last - 1])
            tangent = tuple((b - a) / span for a, b in zip(before, after))
            triples += [tangent, values[i], tangent]
        kind = "VEC4" if path == "rotation" else "VEC3"
        self._channel(node, path, times, self.document.accessor(triples, kind), "CUBICSPLINE")
