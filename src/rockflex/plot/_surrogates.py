"""Colours and line styles of simplified models in figures, by their number of modes."""

from collections.abc import Iterable

from rockflex._errors import InputError
from rockflex.plot._style import BLACK, GREEN, LOOKS, RED, Look, recoloured

_OWN = {"2DOF-S": Look(RED, "-."), "3DOF-S": Look(GREEN, "--"), "MDOF-S": Look(BLACK, "-", 2.0)}


def surrogate_looks(models: Iterable[str]) -> dict[str, Look]:
    """Give each model its own look, in order of appearance; fewer modes are drawn over more.

    Raises
    ------
    InputError
        If there are too many models to distinguish.
    """
    names = list(dict.fromkeys(models))
    others = [name for name in names if name not in _OWN]
    if len(others) > len(LOOKS):
        raise InputError(f"{len(names)} models are too many to distinguish in one figure. Plot fewer at a time.")
    looks = _OWN | dict(zip(others, LOOKS, strict=False))
    return dict(zip(names, recoloured(looks[name] for name in names), strict=True))
