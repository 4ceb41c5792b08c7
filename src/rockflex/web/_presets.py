"""Example structures."""

import math
import tomllib
from pathlib import Path
from typing import Any


def _frame(number: int, period: float, aspect_ratio: float, stiffness_ratio: float) -> dict[str, Any]:
    kind = "shear" if stiffness_ratio else "flexure"
    return {
        "title": f"Frame #{number}: {kind}, {period:g} s, h*/B = {aspect_ratio:g}",
        "structure": {
            "name": f"Structure #{number} of Table 1",
            "frame": {
                "n_stories": 5,
                "story_height": 3.0,
                "story_mass": 40e3,
                "base_mass": 40e3,
                "stiffness_ratio": stiffness_ratio,
                "period": period,
                "aspect_ratio": aspect_ratio,
                "damping_ratio": 0.02,
            },
        },
    }


PRESETS: list[dict[str, Any]] = [
    _frame(1, 1.0, 10.0, math.inf),
    _frame(2, 1.0, 10.0, 0.0),
    _frame(3, 0.5, 10.0, math.inf),
    _frame(4, 0.5, 10.0, 0.0),
    _frame(5, 1.0, 5.0, math.inf),
    _frame(6, 1.0, 5.0, 0.0),
    *tomllib.loads((Path(__file__).parent / "presets.toml").read_text("utf-8"))["presets"],
]
"""Title and structure of each preset: Table 1 of Silva & Stojadinović 2024, its chimney, and others."""
