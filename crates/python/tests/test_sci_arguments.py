"""Wrong arguments of the functions for scientific pictures."""

import math
import unittest

import juggler as jg
from juggler import sci
from support import needs_numpy, numpy as np
from test_sci import CORNERS, FACES


@needs_numpy
class Arguments(unittest.TestCase):
    def test_wrong_arguments_are_named(self):
        line, box = CORNERS[:3], ((0, 0, 0), (1, 1, 1))
        values = {"values": [1, 2, 3, 4]}

        def surface(**options):
            return sci.surface(CORNERS, FACES, **options)

        for call, message in (
            (lambda: sci.tubes(line, -1), "line 0: its radius must be 0 or more"),
            (lambda: sci.tubes(line, "x"), "line 0: its radius must be an array of real numbers"),
            (lambda: sci.tubes(line, [1, 2]), "line 0 has 3 points, but its radii have the shape"),
            (lambda: sci.tubes(line, values=["a"] * 3), "line 0: its values must be numbers"),
            (lambda: sci.tubes([line, line], values=3), "`values` of sci.tubes is an array, or a list"),
            *((lambda n=n: sci.tubes(line, sides=n), "whole number from 3, not") for n in (2, 3.5, "8")),
            *((lambda c=c: surface(**values, clim=c), "`clim` of sci.surface") for c in (5, (0, 1, 2), "ab")),
            *((lambda c=c: surface(**values, cmap=c), "`cmap` is the name of") for c in (3, None, [1, 2])),
            *(
                (
                    lambda c=c: sci.ColorMap(cmap="gray", clim=c).to_dict(),
                    "`clim` of sci.ColorMap must be two",
                )
                for c in (5, None)
            ),
            (lambda: surface(values=3), r"`values` of sci.surface must be an array of shape \(n,\)"),
            (lambda: sci.surface(CORNERS, 3), "`faces` of sci.surface must be an array of shape"),
            (lambda: sci.surface(CORNERS, np.ma.masked_equal(FACES, 3)), "`faces` .* has masked numbers"),
            *(
                (lambda r=r: sci.spheres(line, r), "`radii` of .* a finite number")
                for r in ("x", None, math.nan)
            ),
            (lambda: sci.arrows(line, line, values=3), r"must have 3 numbers, not the shape \(\)"),
            (lambda: sci.arrows(line, line, scale="x"), "`scale` of sci.arrows must be a finite number"),
            (lambda: sci.camera(((0, 0, 0), (1, math.inf, 1))), "`bounds` must be finite"),
            *(
                (lambda v=v: sci.camera(box, v), "`view` as a direction")
                for v in (5, "abc".split(), (1, 0, math.inf))
            ),
            (lambda: sci.camera(box, margin="x"), "`margin` must be a finite number"),
            (lambda: sci.camera(box, fov_degrees=None), "`fov_degrees` must be a finite number"),
            (lambda: sci.axes(box, colors=("#ff0000",)), "`colors` of sci.axes is three colors"),
        ):
            with self.subTest(message), self.assertRaisesRegex(jg.SceneError, message):
                call()


if __name__ == "__main__":
    unittest.main()
