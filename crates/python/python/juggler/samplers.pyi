# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of samplers."""

from typing import Any, Self

from . import typing as t
from ._node import Node

__all__ = [
    "Sobol",
    "Stratified",
    "Independent",
    "BlueNoise",
]

class Sobol(Node):
    """Owen-scrambled Sobol points: a low-discrepancy sequence with low noise at any number of
    samples, best at powers of two.

    Example:
        samplers.Sobol()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...

class Stratified(Node):
    """One random point in each cell of an n × n grid.

    Args:
        side (whole number from 0 to 4096; default 0): Cells along an edge of the grid, n, 0 to
            4096. n² samples fill one grid; further samples start another. The default, 0, uses the
            largest grid that the number of samples fills.

    Example:
        samplers.Stratified(side=4)
    """
    __match_args__ = ("side",)
    side: int | Any
    def __init__(
        self,
        *,
        side: t.Integer | None = None,
    ) -> None: ...
    def replace(
        self,
        *,
        side: t.Integer | None = ...,
    ) -> Self: ...

class Independent(Node):
    """Independent random numbers: plain Monte Carlo. The noise is higher than that of the other
    samplers.

    Example:
        samplers.Independent()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...

class BlueNoise(Node):
    """Sobol points whose error is distributed over the picture as blue noise, which is less
    visible. Use it for pictures of few samples, best with a power of two.

    Example:
        samplers.BlueNoise()
    """
    __match_args__ = ()
    def __init__(
        self,
    ) -> None: ...
    def replace(
        self,
    ) -> Self: ...
