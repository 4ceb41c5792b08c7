"""A fragility curve given as a fit or as a function, checked whenever it is evaluated."""

from collections.abc import Callable
from typing import Any, Protocol

from rockflex._arrays import Array
from rockflex._checks import float_array
from rockflex._errors import InputError

Curve = Callable[[Array], Array]


class Fragility(Protocol):
    """Any curve that gives a probability of failure at a measure."""

    def probability(self, im: Array, /) -> Array:
        """Probability of failure, of the shape of `im`."""
        ...


def checked_curve(fragility: Fragility | Curve, name: str = "fragility") -> Curve:
    """Return the probability as a function of an array of measures; `name` is for messages.

    Raises
    ------
    InputError
        If it is neither a fit nor a function. The function raises one if a probability is not a number from 0 to 1.
    """
    function: Any = getattr(fragility, "probability", fragility)
    if not callable(function):
        raise InputError(
            f"{name} must have a method probability(im), or be a function of im, but {type(fragility).__name__} was "
            "given."
        )

    def checked(im: Array) -> Array:
        given: Any = function(im)
        p = float_array(given)
        if p is None:
            raise InputError(f"{name} must give an array of probabilities, but it gave something else.")
        if not ((p >= 0.0) & (p <= 1.0)).all():
            raise InputError(
                f"{name} must give probabilities from 0 to 1, but gave {p[~((p >= 0.0) & (p <= 1.0))].flat[0]:g}. "
                "A part that could not be fitted gives NaN."
            )
        return p

    return checked
