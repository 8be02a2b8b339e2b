"""Mistakes that type checkers find. A comment that hides no mistake is an error, too."""

from juggler import Object, cameras, materials, shapes

shapes.Sphere(raduis=1)  # pyright: ignore[reportCallIssue]
shapes.Sphere(1)  # pyright: ignore[reportCallIssue]
shapes.Triangle()  # pyright: ignore[reportCallIssue]
shapes.Sphere().replace(raduis=1)  # pyright: ignore[reportCallIssue]
materials.Conductor(metal="goold")  # pyright: ignore[reportArgumentType]
cameras.Perspective(eye=True)  # pyright: ignore[reportArgumentType]
Object(materials.Phong())  # pyright: ignore[reportArgumentType]
Object({"sphere": {"raduis": 1}})  # pyright: ignore[reportArgumentType]
