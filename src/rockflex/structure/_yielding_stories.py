"""Structures whose stories yield."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import masked_count, real_or_nan
from rockflex.foundation.descriptions import PLAIN, Described, described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._attachment import YieldingStory
from rockflex.structure._frames import LumpedStructure
from rockflex.structure._leaning import Leaning, lumped_structure_of
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import InFile, ModifiedStructure, Structure

COUPLED = 1e-9  # relative: stiffness between drifts that is attributed to rounding


@described
@dataclass(frozen=True, eq=False, init=False)
class YieldingStories(ModifiedStructure, Value):
    """A shear structure whose stories yield: F = α k u + (1 - α) z of the drift u, z elastic up to the strength.

    The modes are those of the elastic structure, and so is the damping, which is overestimated while stories yield.
    Base shear, base moment and story shears are those of the stories as they are.

    Raises
    ------
    InputError
        If `structure` is none of these or no shear structure, or a value is outside its range.

    Notes
    -----
    The strength and stiffness of a story are those of all its columns. P-Δ of the drifts is neglected, as in the paper.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=0.6, aspect_ratio=6.0, damping_ratio=0.03,
    ... )
    >>> yields = rf.YieldingStories(frame, strengths=[300e3, 250e3, 140e3],
    ...     post_yield_ratio=0.05)
    >>> pulse = rf.one_sine_pulse(amplitude=4.0, period=0.8)
    >>> rf.simulate(yields, pulse, free_vibration=5.0).ductility.round(2)
    array([2.35, 1.83, 3.26])
    """

    in_file = InFile(
        key="stories",
        words=Described("a table", label="Stories that yield", form=PLAIN, page="the shear at which they yield"),
        floors=True,
    )

    structure: Annotated[
        Structure,
        Described(
            "a shear structure",
            in_file=False,
            note="A `Frame` or a `FishBone` whose beams are rigid, a `LumpedStructure` with such a stiffness, or one "
            "of them with `Leaning` mass. Elements and an eccentricity come afterwards.",
        ),
    ]
    strengths: Annotated[
        Array,
        Described(
            "the shear at which a story yields first",
            "N",
            form=one_for_each("story"),
            in_file=float | list[float],
            note="Of each story from the bottom to the top, shape (N,), or one number for all; infinite for a story "
            "that stays elastic.",
        ),
    ]
    post_yield_ratio: Annotated[
        Array,
        Described(
            "the stiffness after yielding over the elastic one",
            form=one_for_each("story"),
            in_file=float | list[float],
            note="From 0 to below 1, of each story or one number for all.",
        ),
    ]

    def __init__(self, structure: Structure, strengths: ArrayLike, post_yield_ratio: ArrayLike = 0.0) -> None:
        lumped = lumped_structure_of(structure.structure if isinstance(structure, Leaning) else structure)
        stiffness = story_stiffness(lumped)
        count = stiffness.size
        found = _one_value_per_story("strengths", strengths, count)
        if not (found > 0.0).all():
            raise InputError(
                f"strengths must be positive story shears in N from the bottom to the top, but {shown(strengths)} was "
                "given. An infinite one keeps a story elastic.",
                field="strengths",
            )
        ratio = _one_value_per_story("post_yield_ratio", post_yield_ratio, count)
        if not ((ratio >= 0.0) & (ratio < 1.0)).all():
            raise InputError(
                f"post_yield_ratio must be from 0 to below 1, but {shown(post_yield_ratio)} was given: the stiffness "
                "of a story after yielding over its elastic stiffness.",
                field="post_yield_ratio",
            )
        vars(self).update(structure=structure, strengths=found, post_yield_ratio=ratio)

    @cached_property
    def stiffness(self) -> Array:
        """Elastic stiffness of each story in N/m, bottom to top, shape (N,)."""
        inner = self.structure.structure if isinstance(self.structure, Leaning) else self.structure
        return story_stiffness(lumped_structure_of(inner))

    @property
    def yield_drift(self) -> Array:
        """Drift of each story at first yield in m, shape (N,)."""
        return self.strengths / self.stiffness

    def __getstate__(self) -> dict[str, object]:
        return {name: getattr(self, name) for name in ("structure", "strengths", "post_yield_ratio")}

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        del base
        values = zip(self.stiffness.tolist(), self.strengths.tolist(), self.post_yield_ratio.tolist(), strict=True)
        return {"stories": tuple(YieldingStory(k, *each) for k, each in enumerate(values, 1) if np.isfinite(each[1]))}


def story_stiffness(lumped: LumpedStructure) -> Array:
    """Return the stiffness of each story of a shear structure in N/m, bottom to top.

    Raises
    ------
    InputError
        If a story is coupled with others: the structure bends as a whole.
    """
    count = lumped.heights.size
    order = np.argsort(lumped.heights)
    below = np.tril(np.ones((count, count)))  # displacements of the floors from drifts
    of_drifts = below.T @ lumped.stiffness[np.ix_(order, order)] @ below
    found = np.diag(of_drifts).copy()
    rest = np.abs(of_drifts - np.diag(found)).max(initial=0.0)
    if (order != np.arange(count)).any() or rest > COUPLED * found.max():
        raise InputError(
            "structure must be a shear structure, whose story shears depend only on their own drifts, with its floors "
            "from the bottom to the top: a Frame with stiffness_ratio = inf, for example. With flexible beams a story "
            "that yields can take more stiffness than there is.",
            field="structure",
        )
    return found


def _one_value_per_story(name: str, given: ArrayLike, count: int) -> Array:
    found = np.array([real_or_nan(each) for each in np.atleast_1d(np.asarray(given, dtype=object)).ravel()])
    if found.size == 1:
        found = np.full(count, found[0])
    if found.size != count or np.isnan(found).any() or masked_count(given):
        raise InputError(
            f"{name} must be one number, or one for each of the {count} stories from the bottom to the top, but "
            f"{shown(given)} was given.",
            field=name,
        )
    found.setflags(write=False)
    return found
