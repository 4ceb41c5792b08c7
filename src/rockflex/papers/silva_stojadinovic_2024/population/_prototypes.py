"""The random structures of Section 3.3."""

import math
from dataclasses import dataclass

import numpy as np

from rockflex._checks import whole_number
from rockflex.structure import Frame

STORIES = (2, 15)
ASPECT_RATIOS = (5, 10)
BASE_MASSES = (1.0, 1.5, 2.0, 2.5, 3.0)  # times the mass of a story
SHEAR_COEFFICIENTS = (0.06, 0.095)  # a1 in T = a1 H^0.85
FLEXURE_COEFFICIENTS = (0.0125, 0.05)  # a2 in T = a2 H
STORY_HEIGHT, STORY_MASS, DAMPING_RATIO = 3.0, 40e3, 0.02  # m, kg


@dataclass(frozen=True)
class Prototype:
    """A random frame and its record (Silva & Stojadinović 2024, Section 3.3).

    Attributes
    ----------
    n_stories
        2 to 15.
    aspect_ratio
        h*_1/B, a whole number from 5 to 10.
    base_mass_ratio
        Mass of the base over the mass of a story: 1, 1.5, 2, 2.5 or 3.
    stiffness_ratio
        ρ: infinite for a shear building, 0 for a flexural one.
    coefficient
        a1 in T_1 = a1 H^0.85 of a shear building, from 0.06 to 0.095, or a2 in T_1 = a2 H of a flexural one, from
        0.0125 to 0.05; s and m.
    record
        Index of the record in its suite.
    """

    n_stories: int
    aspect_ratio: int
    base_mass_ratio: float
    stiffness_ratio: float
    coefficient: float
    record: int

    @property
    def height(self) -> float:
        """H in m."""
        return self.n_stories * STORY_HEIGHT

    @property
    def period(self) -> float:
        """T_1 in s."""
        return self.coefficient * (self.height**0.85 if math.isinf(self.stiffness_ratio) else self.height)

    def frame(self) -> Frame:
        """Return the structure: stories of 3 m and 40 t, with 2 % of critical damping."""
        return Frame(
            n_stories=self.n_stories,
            story_height=STORY_HEIGHT,
            story_mass=STORY_MASS,
            base_mass=self.base_mass_ratio * STORY_MASS,
            stiffness_ratio=self.stiffness_ratio,
            period=self.period,
            aspect_ratio=float(self.aspect_ratio),
            damping_ratio=DAMPING_RATIO,
        )


def draw_prototype(seed: int, number: int, n_records: int) -> Prototype:
    """Draw the prototype of a number. It depends only on the seed, the number and the count of records.

    Every property is uniformly distributed and independent of the others.

    Raises
    ------
    InputError
        If an argument is not an integer in its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> drawn = rf.draw_prototype(seed=0, number=3, n_records=44)
    >>> drawn.n_stories, drawn.aspect_ratio, drawn.record
    (14, 10, 35)
    """
    start, place = whole_number("seed", seed, 0), whole_number("number", number, 0, 2**32 - 1)
    records = whole_number("n_records", n_records, 1, 10**9)
    bits = np.random.Philox(np.random.SeedSequence(start, spawn_key=(place,)))
    draws = np.random.Generator(bits).random(6).tolist()
    shear = draws[3] < 0.5
    low, high = SHEAR_COEFFICIENTS if shear else FLEXURE_COEFFICIENTS
    return Prototype(
        n_stories=_whole(draws[0], *STORIES),
        aspect_ratio=_whole(draws[1], *ASPECT_RATIOS),
        base_mass_ratio=BASE_MASSES[_whole(draws[2], 0, len(BASE_MASSES) - 1)],
        stiffness_ratio=math.inf if shear else 0.0,
        coefficient=low + (high - low) * draws[4],
        record=_whole(draws[5], 0, records - 1),
    )


def _whole(draw: float, low: int, high: int) -> int:
    """The whole number from `low` to `high` for a draw from [0, 1)."""
    return low + int(draw * (high - low + 1))
