from typing import Literal

class Progress:
    """Progress of a render: `stage` ("reading", "preparing", "building" or "rendering"), `share` of
    this stage (0 to 1), `seconds` so far, `seconds_left` (`None` if unknown), and `samples` of all
    pixels so far.

    Meshes and pictures are prepared; then the world is built. The share may decrease while a stage
    finds more work. The last progress of a complete render has the share 1.
    """

    stage: Literal["reading", "preparing", "building", "rendering"]
    share: float
    seconds: float
    seconds_left: float | None
    samples: float
