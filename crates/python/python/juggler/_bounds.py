"""Bounding boxes of objects."""


def bounds(made):
    """Least and greatest corner of an object, whatever its material."""
    from ._scene import native_scene

    low, high = native_scene({"version": 1, "objects": [_plain(made)]}).bounds()
    return tuple(low), tuple(high)


def _plain(made):
    """The object without materials, which may be names of those of a scene."""
    from ._node import Node

    if not isinstance(made, Node):
        members = {key: value for key, value in made.items() if key not in ("material", "light_group")}
        children = members.get("objects")
        return members if children is None else {**members, "objects": [_plain(child) for child in children]}
    children = made.objects
    if isinstance(children, (list, tuple)):
        children = [_plain(child) for child in children]
    return made.replace(material=None, objects=children)
