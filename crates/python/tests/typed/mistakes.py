"""Mistakes that type checkers find. A comment that hides no mistake is an error, too."""

import juggler as jg
from juggler import Object, cameras, materials, shapes

shapes.Sphere(raduis=1)  # pyright: ignore[reportCallIssue]
shapes.Sphere(1)  # pyright: ignore[reportCallIssue]
shapes.Triangle()  # pyright: ignore[reportCallIssue]
shapes.Sphere().replace(raduis=1)  # pyright: ignore[reportCallIssue]
materials.Conductor(metal="goold")  # pyright: ignore[reportArgumentType]
cameras.Perspective(eye=True)  # pyright: ignore[reportArgumentType]
Object(materials.Phong())  # pyright: ignore[reportArgumentType]
Object({"sphere": {"raduis": 1}})  # pyright: ignore[reportArgumentType]
jg.render("juggler", sampels=4)  # pyright: ignore[reportCallIssue]
jg.render("juggler", samples="many")  # pyright: ignore[reportArgumentType]
jg.Renderer(3)  # pyright: ignore[reportArgumentType]
