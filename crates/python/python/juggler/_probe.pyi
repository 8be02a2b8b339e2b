from typing import Any

class Probe:
    """Explanation of a pixel; `print` shows the report of `juggler probe`.

    `mean` is the pixel's linear color, `first_hit` the surface at its center, `lights`, `groups`,
    `kinds` and `segments` are the shares of its light, `paths` is the tree of the paths that bring
    it, and `brightest` lists its brightest samples.
    """

    mean: list[float]
    first_hit: Any
    lights: list[Any]
    groups: list[Any]
    kinds: list[Any]
    segments: list[Any]
    paths: Any
    brightest: list[Any]
    def to_dict(self) -> dict[str, Any]:
        """Returns the report as a dict, with the keys of `juggler probe --stats`."""
