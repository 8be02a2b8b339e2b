def trace_nodes(on: bool = True) -> None:
    """Lets the parts of scenes that are made from now on remember the line of code that made them.

    Mistakes of a scene of such parts name that line: `Problem.made_at`. Tracing takes time, so it is
    off at first; `trace_nodes(False)` ends it.
    """
