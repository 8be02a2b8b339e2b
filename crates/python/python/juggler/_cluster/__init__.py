"""Renders on several workers: what `juggler.cluster` is made of.

`package` has what workers need of a scene, `worker` runs on them, `dealer` decides which units of
work they get, `driver` runs where the image is made, and `executor` and `ray` submit its work.
"""
