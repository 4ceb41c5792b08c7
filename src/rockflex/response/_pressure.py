"""The pressure of the ground under a base."""

from rockflex._arrays import Array
from rockflex.modal import Springs
from rockflex.response._missing import MissingQuantityError


def pressure_of(force: Array, springs: Springs | None) -> Array:
    """Return the pressure at each spring in Pa from its force in N, shape (n, S).

    Raises
    ------
    MissingQuantityError
        If there are no springs, or they have no `area`.
    """
    if springs is None or springs.area is None:
        raise no_area()
    return force / springs.area


def no_area() -> MissingQuantityError:
    """Return the error of a pressure without areas."""
    return MissingQuantityError(
        "The springs under the base have no area, so there is no soil pressure. Give Springs the area that each "
        "supports, in m², or use winkler_bed."
    )
