"""Warnings: forces that ground or tendons cannot provide, rotations beyond a model's range, unbalanced energies."""

from collections.abc import Mapping
from typing import Any

FALLEN = 1.57  # rad: an overturned run has a status of its own
BALANCED = 1e-6  # closing error of the energy balance up to which only rounding is at work


def warnings_of(model: str, peaks: Mapping[str, Any]) -> tuple[str, ...]:
    """Return one text per warning; `peaks` are those of a `Response` by name."""
    found: list[str] = []
    if peaks["min_vertical_reaction"] < 0.0:
        found.append(
            f"The vertical reaction falls to {peaks['min_vertical_reaction']:.4g} N at "
            f"{peaks['time_of_min_vertical_reaction']:.4g} s: {model} pulls the base down there, which no ground "
            "can. The pivot would lift, and what follows is to be read with care. Give simulate a Ground with springs, "
            "on which the base can leave the ground."
        )
    if peaks["tendon_overload"]:
        found.append(
            f"A tendon carries more than its yield force, up to {peaks['tendon_utilisation']:.4g} times it. It stays "
            "elastic in the model, so the results are not valid. Give it a post_yield_ratio."
        )
    if leaves_range(model, peaks["balance_ratio"], peaks["max_rotation"]):
        found.append(
            f"θ reaches {peaks['max_rotation']:.4g} rad, {peaks['balance_ratio']:.3g} times the rotation α at which "
            f"the static moment vanishes. {model} is for small rotations: whether the structure overturns is to be "
            f"decided by a complete model on rigid ground, such as {complete_of(model)}."
        )
    return tuple(found)


def warnings_of_energy(closing_error: float) -> tuple[str, ...]:
    """Return a text if the energy balance of a run does not close."""
    if closing_error <= BALANCED:
        return ()
    return (
        f"The energy balance closes only to {closing_error:.2g} of the largest input. Rounding explains at most "
        f"{BALANCED:g}, unless springs give way by far less than a micrometre: otherwise an event was missed, or the "
        "motion of an element or of the ground was misread. Do not use the run then, and report it as an error of the "
        "program.",
    )


def complete_of(model: str) -> str:
    """Return the label of a complete model of the same structure."""
    return "rigid-C" if model == "rigid" else "MDOF-C"


def leaves_range(model: Any, balance_ratio: Any, rotation: Any) -> Any:
    """Return whether a run of a simplified model, or of many, went beyond α without overturning."""
    small = "-C" not in model if isinstance(model, str) else ~model.astype(str).str.contains("-C", regex=False)
    return small & (balance_ratio > 1.0) & (rotation < FALLEN)
