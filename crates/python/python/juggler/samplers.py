# Generated from schema/scene.schema.json by crates/python-types. Do not edit.
"""Kinds of samplers."""

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

    __slots__ = ()
    _kind = "sobol"


class Stratified(Node):
    """One random point in each cell of an n × n grid.

    Args:
        side (whole number from 0 to 4096; default 0): Cells along an edge of the grid, n, 0 to
            4096. n² samples fill one grid; further samples start another. The default, 0, uses the
            largest grid that the number of samples fills.

    Example:
        samplers.Stratified(side=4)
    """

    __slots__ = ("side",)
    _kind = "stratified"


class Independent(Node):
    """Independent random numbers: plain Monte Carlo. The noise is higher than that of the other
    samplers.

    Example:
        samplers.Independent()
    """

    __slots__ = ()
    _kind = "independent"


class BlueNoise(Node):
    """Sobol points whose error is distributed over the picture as blue noise, which is less
    visible. Use it for pictures of few samples, best with a power of two.

    Example:
        samplers.BlueNoise()
    """

    __slots__ = ()
    _kind = "blue_noise"
