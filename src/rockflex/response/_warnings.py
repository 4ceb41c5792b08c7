"""Warnings about forces that the ground or the tendons cannot provide."""

from collections.abc import Mapping
from typing import Any


def warnings_of(model: str, peaks: Mapping[str, Any]) -> tuple[str, ...]:
    """Return one text per warning; `peaks` are those of a `Response` by name."""
    found: list[str] = []
    if peaks["min_vertical_reaction"] < 0.0:
        found.append(
            f"The vertical reaction falls to {peaks['min_vertical_reaction']:.4g} N at "
            f"{peaks['time_of_min_vertical_reaction']:.4g} s: {model} pulls the base down there, which no ground "
            "can. The pivot would lift, and what follows is to be read with care."
        )
    if peaks["tendon_utilisation"] > 1.0:
        found.append(
            f"A tendon carries {peaks['tendon_utilisation']:.4g} times its yield force. Tendons stay elastic in the "
            "model, so the results are not valid."
        )
    return tuple(found)
