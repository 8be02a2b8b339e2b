"""Explanation of a pixel."""


class Probe:
    """Explanation of a pixel; `print` shows the report of `juggler probe`.

    `mean` is the pixel's linear color, `first_hit` the surface at its center, `lights`, `groups`,
    `kinds` and `segments` are the shares of its light, `paths` is the tree of the paths that bring
    it, and `brightest` lists its brightest samples.
    """

    __slots__ = ("_json", "_text")

    def __init__(self, text, json):
        self._text = text
        self._json = json

    def __str__(self):
        return self._text

    def __repr__(self):
        return f"<juggler.Probe {self._text.splitlines()[0]}>"

    def __reduce__(self):
        return Probe, (self._text, self._json)

    def to_dict(self):
        """Returns the report as a dict, with the keys of `juggler probe --stats`."""
        import json

        return json.loads(self._json)

    def __getattr__(self, name):
        import json
        from types import SimpleNamespace

        if name.startswith("__"):
            raise AttributeError(name)
        probe = json.loads(self._json, object_hook=lambda values: SimpleNamespace(**values))
        light = probe.light
        places = {
            "first_hit": (probe, "seen"),
            "lights": (light, "lights"),
            "groups": (light, "groups"),
            "kinds": (light, "ways"),
            "segments": (light, "stretches"),
            "paths": (light, "paths"),
            "brightest": (light, "brightest"),
        }
        place, key = places.get(name, (probe, name))
        if place is None:
            return None
        if not hasattr(place, key):
            raise AttributeError(f"a probe has no {name!r}")
        return getattr(place, key)


Probe.__module__ = "juggler"
