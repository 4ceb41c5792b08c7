"""Example structures."""

import math
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


PIER: dict[str, Any] = {
    "height": 24.0,
    "tip_mass": 900e3,
    "mass_per_length": 14e3,
    "bending_stiffness": 1.8e11,
    "tip_inertia": 2.0e7,
    "base_mass": 350e3,
    "half_width": 3.5,
    "damping_ratio": 0.03,
    "n_modes": 4,
}

PRESETS: list[dict[str, Any]] = [
    _frame(1, 1.0, 10.0, math.inf),
    _frame(2, 1.0, 10.0, 0.0),
    _frame(3, 0.5, 10.0, math.inf),
    _frame(4, 0.5, 10.0, 0.0),
    _frame(5, 1.0, 5.0, math.inf),
    _frame(6, 1.0, 5.0, 0.0),
    {
        "title": "Chimney, 200 m",
        "structure": {
            "name": "Chimney",
            "tapered_tower": {
                "height": 200.0,
                "base_radius": 8.0,
                "top_radius": 4.0,
                "wall": 1.0,
                "density": 2400.0,
                "elastic_modulus": 25e9,
                "damping_ratio": 0.02,
                "method": "ritz",
                "n_modes": 5,
            },
        },
    },
    {"title": "Bridge pier on a footing, 24 m", "structure": {"name": "Bridge pier", "cantilever": PIER}},
    {
        "title": "Bridge pier held down by tendons, 12 m",
        "structure": {
            "name": "Restrained pier",
            "cantilever": {
                "height": 12.0,
                "tip_mass": 500e3,
                "mass_per_length": 10e3,
                "bending_stiffness": 4.0e10,
                "base_mass": 120e3,
                "half_width": 1.5,
                "damping_ratio": 0.03,
                "n_modes": 3,
            },
            "tendons": [
                {"position": 0.0, "initial_force": 2.0e6, "stiffness": 25e6, "yield_force": 4.2e6},
                {"position": -0.6, "initial_force": 0.8e6, "stiffness": 10e6},
                {"position": 0.6, "initial_force": 0.8e6, "stiffness": 10e6},
            ],
        },
    },
    {
        "title": "Wall and frame, 32 m",
        "structure": {
            "name": "Wall and frame",
            "wall_frame": {
                "height": 32.0,
                "mass": 3.2e6,
                "stiffness_parameter": 2.5,
                "base_mass": 400e3,
                "period": 0.8,
                "aspect_ratio": 6.0,
                "damping_ratio": 0.03,
                "n_modes": 8,
            },
        },
    },
    {
        "title": "Water tower, two masses",
        "structure": {
            "name": "Water tower",
            "lumped": {
                "masses": [20e3, 90e3],
                "stiffness": [[34e6, -10.5e6], [-10.5e6, 4.2e6]],
                "heights": [8.0, 16.0],
                "base_mass": 60e3,
                "half_width": 1.8,
                "damping_ratio": 0.02,
            },
        },
    },
    {
        "title": "Bridge pier beside the middle of its footing, with a tendon to one side",
        "structure": {
            "name": "Eccentric pier",
            "cantilever": {
                "height": 14.0,
                "tip_mass": 420e3,
                "mass_per_length": 9e3,
                "bending_stiffness": 5.0e10,
                "base_mass": 150e3,
                "half_width": 1.9,
                "damping_ratio": 0.03,
                "n_modes": 3,
            },
            "eccentricity": 0.3,
            "tendons": [{"position": 0.9, "initial_force": 0.9e6, "stiffness": 9e6, "yield_force": 2.2e6}],
        },
    },
]
"""Title and structure of each preset: Table 1 of Silva & Stojadinović 2024, its chimney, and others."""
