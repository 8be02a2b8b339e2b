from typing import Literal

class Progress:
    """Progress of a render: `stage` ("build" or "render"), `share` (0 to 1), `seconds` so far,
    `seconds_left` (`None` if unknown), and `samples` of all pixels so far.
    """

    stage: Literal["build", "render"]
    share: float
    seconds: float
    seconds_left: float | None
    samples: float
