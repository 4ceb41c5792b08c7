"""Checks that the parameters of a rocking structure are physically possible together."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_finite_vector,
    checked_instance,
    checked_instances,
    is_one_of,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.structure._analysis import FloorModes
from rockflex.structure._attachment import Attachment, YieldingStory
from rockflex.structure._base_element import BaseElement
from rockflex.structure._pivot import OnColumns, pivot_inertia

SUM_TOLERANCE = 1e-9  # relative tolerance for rounding of sums that are equal if all modes are kept
PRINTED_TOLERANCE = 1e-5  # of I_θ: tolerance for values printed to six digits


def checked_modal_values(
    omega: ArrayLike, effective_mass: ArrayLike, effective_height: ArrayLike, top_ordinate: ArrayLike
) -> dict[str, Array]:
    modes = {
        "omega": checked_finite_vector("omega", omega, "rad/s"),
        "effective_mass": checked_finite_vector("effective_mass", effective_mass, "kg"),
        "effective_height": checked_finite_vector("effective_height", effective_height, "m"),
        "top_ordinate": checked_finite_vector("top_ordinate", top_ordinate, "m/m"),
    }
    omega, effective_mass = modes["omega"], modes["effective_mass"]
    for name, values in modes.items():
        if values.size != omega.size:
            raise InputError(
                f"{name} must contain one value per mode, as omega does ({omega.size}), but {values.size} were given.",
                field=name,
            )
    for name, values, unit in (("omega", omega, "rad/s"), ("effective_mass", effective_mass, "kg")):
        check_all_positive(name, values, unit, "Leave out modes that do not participate.")
    falls = np.flatnonzero(omega[1:] < omega[:-1])
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"omega must be in ascending order, but omega[{i + 1}] = {omega[i + 1]:g} rad/s is below "
            f"omega[{i}] = {omega[i]:g} rad/s. Sort the modes by frequency.",
            field="omega",
        )
    return modes


def checked_floor_modes(floors: FloorModes | None, n_modes: int) -> FloorModes | None:
    if floors is not None and checked_instance("floors", floors, FloorModes).n_modes != n_modes:
        raise InputError(
            f"floors must hold the same {n_modes} modes as omega, but it holds {floors.n_modes}.", field="floors"
        )
    return floors


@explaining_overflow("The inertia of the structure on this eccentric base")
def checked_eccentricity(modes: dict[str, Array], scalars: dict[str, float], inertia: float, given: float) -> float:
    e, b = given + 0.0, scalars["half_width"]  # + 0.0 takes the sign from -0.0
    if not abs(e) < b:
        raise InputError(
            f"eccentricity must be smaller than half_width, {b:g} m, to either side, but {e:g} m was given. It is the "
            "distance of the axis of the masses to the right of the middle of the base; check the units too.",
            field="eccentricity",
        )
    modal_inertia = float(modes["effective_mass"] @ modes["effective_height"] ** 2)
    nearer = pivot_inertia(abs(e), b, scalars["i_theta"], inertia, scalars["m_tot"])
    if nearer <= modal_inertia:
        raise InputError(
            f"eccentricity must leave rotational inertia about the nearer pivot, but with {e:.9g} m and half_width = "
            f"{b:.9g} m only the {modal_inertia:.9g} kg m² of the modes are left. Move the axis of the masses further "
            "from the edge of the base.",
            field="eccentricity",
        )
    return e


def elements_in_place(
    elements: tuple[BaseElement, ...], half_width: float, eccentricity: float, floors: FloorModes | None, n_modes: int
) -> tuple[BaseElement, ...]:
    limit = half_width + abs(eccentricity)  # on an eccentric base, outriggers may reach as far on the shorter side
    for element in elements:
        if element.attached:
            check_floors_of(element, floors, n_modes)
        if abs(element.position) > limit * (1.0 + SUM_TOLERANCE):
            what = "half_width" if eccentricity == 0.0 else "half_width + |eccentricity|"
            raise InputError(
                f"Elements must act within {what} = {limit:g} m to each side of the axis of the masses, but a "
                f"{type(element).__name__} is at {element.position:g} m.",
                field="elements",
            )
    return elements


def check_floors_of(element: Attachment, floors: FloorModes | None, n_modes: int) -> None:
    """Check that a structure has the floors to which an element is attached; a rigid block has any."""
    name, field_ = type(element).__name__, "between" if element.between else "height"
    if n_modes == 0:
        return
    if floors is None:
        raise InputError(
            f"A {name} with {field_} = {getattr(element, field_)} needs floors, but this structure has none. Give "
            "RockingProperties the floors (FloorModes), or use a structure with floors, such as a Frame.",
            field=field_,
        )
    count, top = floors.heights.size, float(floors.heights.max())
    if element.between is not None and max(element.between) > count:
        raise InputError(
            f"between must be floors from 0, the base, to {count}, but a {name} is between {element.between}.",
            field="between",
        )
    if element.height is not None and element.height > top * (1.0 + SUM_TOLERANCE):
        raise InputError(
            f"height must be at most that of the top, {top:g} m, but a {name} is at {element.height:g} m.",
            field="height",
        )


def checked_stories(
    given: Iterable[YieldingStory], floors: FloorModes | None, n_modes: int
) -> tuple[YieldingStory, ...]:
    stories = checked_instances("stories", given, YieldingStory) if n_modes else ()
    for each in stories:
        floor = each.floor
        if floors is None or floor > floors.heights.size:
            known = "none" if floors is None else f"{floors.heights.size}"
            raise InputError(
                f"stories: story {floor} yields, but the structure has {known}. Give RockingProperties the floors "
                "(FloorModes) with it.",
                field="stories",
            )
    return stories


def checked_restitution(given: float | None, opens: str, n_modes: int, columns: OnColumns | None) -> float | None:
    if not is_one_of(opens, ("both", "right", "left")):
        raise InputError(f'opens must be "both", "right" or "left", but {shown(opens)} was given.', field="opens")
    if given is not None and given > 1.0:
        raise InputError(
            f"restitution must be at most 1, but {given:g} was given. It is the ratio of the rotation's velocities "
            "after and before an impact; more than 1 would gain energy.",
            field="restitution",
        )
    if given is not None and n_modes and opens == "both" and columns is None:
        raise InputError(
            f"restitution is that of a rigid body, or of what opens to one side, but the structure has {n_modes} modes "
            "and opens to both. Give an impact law to the run: impact=Restitution(e).",
            field="restitution",
        )
    return given


def checked_top_height(floors: FloorModes | None, given: float | None) -> float | None:
    if given is not None:
        return given
    return None if floors is None else float(floors.heights.max())


def checked_base_mass(modes: dict[str, Array], moved: float, inertia: float, given: float | None) -> float | None:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    if given is not None:
        if moved - given < modal_mass - SUM_TOLERANCE * moved:
            raise InputError(
                f"base_mass must leave the effective mass of the modes, {modal_mass:.9g} kg, but {given:.9g} kg of "
                f"m_tot = {moved:.9g} kg was given.",
                field="base_mass",
            )
        return given
    complete = mass.size > 0 and float(mass @ modes["effective_height"] ** 2) >= (1.0 - SUM_TOLERANCE) * inertia
    return max(moved - modal_mass, 0.0) if complete else None


@explaining_overflow("The inertia of the modes, from effective_mass and effective_height,")
def checked_translational_inertia(
    modes: dict[str, Array], scalars: dict[str, float], leaning_mass: float, given: float | None
) -> float:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    modal_inertia = float(mass @ modes["effective_height"] ** 2)
    i_theta, m_tot = scalars["i_theta"], scalars["m_tot"]
    if m_tot + leaning_mass < modal_mass * (1.0 - SUM_TOLERANCE):
        raise InputError(
            f"m_tot must be at least the sum of effective_mass, {modal_mass:.9g} kg, but {m_tot:.9g} kg was "
            "given. It is the mass of the whole structure including its base; check the units too.",
            field="m_tot",
        )
    if i_theta <= modal_inertia:
        raise InputError(
            "i_theta must exceed the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², but {i_theta:.9g} kg m² was given: no inertia is left for the rotation. "
            "It refers to a pivot and includes the base; check the units too.",
            field="i_theta",
        )
    source = "i_theta - m_tot * half_width**2, its default," if given is None else "the given value"
    inertia = i_theta - m_tot * scalars["half_width"] ** 2 if given is None else given
    if not modal_inertia * (1.0 - SUM_TOLERANCE) <= inertia < i_theta:
        raise InputError(
            "translational_inertia must be at least the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², and below i_theta, {i_theta:.9g} kg m², but {source} is "
            f"{inertia:.9g} kg m². Give the sum of m_i h_i² over the masses above the base.",
            field="translational_inertia",
        )
    least = inertia + m_tot * scalars["half_width"] ** 2
    if i_theta < least * (1.0 - PRINTED_TOLERANCE):
        raise InputError(
            "i_theta must be at least translational_inertia + m_tot * half_width**2, "
            f"{least:.9g} kg m², but {i_theta:.9g} kg m² was given. It refers to a pivot, so it changes with the "
            "base: properties.with_half_width(B) gives the same structure on another base.",
            field="i_theta",
        )
    return max(inertia, modal_inertia)
