"""Checks that the parameters of a rocking structure are physically possible."""

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import all_positive, finite, finite_vector, instance, positive
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex.modal._devices import BaseElement
from rockflex.modal._floors import FloorModes
from rockflex.modal._pivot import pivot_inertia

SLACK = 1e-9  # relative tolerance for rounding of sums that are equal if all modes are kept
PRINTED = 1e-5  # of I_θ: tolerance for values printed to six digits


def checked_modes(
    omega: ArrayLike, effective_mass: ArrayLike, effective_height: ArrayLike, top_ordinate: ArrayLike
) -> dict[str, Array]:
    modes = {
        "omega": finite_vector("omega", omega, "rad/s"),
        "effective_mass": finite_vector("effective_mass", effective_mass, "kg"),
        "effective_height": finite_vector("effective_height", effective_height, "m"),
        "top_ordinate": finite_vector("top_ordinate", top_ordinate, "m/m"),
    }
    omega, effective_mass = modes["omega"], modes["effective_mass"]
    for name, values in modes.items():
        if values.size != omega.size:
            raise InputError(
                f"{name} must contain one value per mode, as omega does ({omega.size}), but {values.size} were given.",
                field=name,
            )
    for name, values, unit in (("omega", omega, "rad/s"), ("effective_mass", effective_mass, "kg")):
        all_positive(name, values, unit, "Leave out modes that do not participate.")
    falls = np.flatnonzero(omega[1:] < omega[:-1])
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"omega must be in ascending order, but omega[{i + 1}] = {omega[i + 1]:g} rad/s is below "
            f"omega[{i}] = {omega[i]:g} rad/s. Sort the modes by frequency.",
            field="omega",
        )
    return modes


def checked_scalars(i_theta: float, l0r: float, m_tot: float, half_width: float) -> dict[str, float]:
    return {
        "i_theta": positive("i_theta", i_theta, "kg m²"),
        "l0r": positive("l0r", l0r, "kg m"),
        "m_tot": positive("m_tot", m_tot, "kg"),
        "half_width": positive("half_width", half_width, "m"),
    }


def checked_floors(floors: FloorModes | None, n_modes: int) -> FloorModes | None:
    if floors is not None and instance("floors", floors, FloorModes).n_modes != n_modes:
        raise InputError(
            f"floors must hold the same {n_modes} modes as omega, but it holds {floors.n_modes}.", field="floors"
        )
    return floors


@computable("The inertia of the structure on this eccentric base")
def checked_eccentricity(modes: dict[str, Array], scalars: dict[str, float], inertia: float, given: float) -> float:
    e, b = finite("eccentricity", given, "m") + 0.0, scalars["half_width"]  # + 0.0 takes the sign from -0.0
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


def elements_within(
    elements: tuple[BaseElement, ...], half_width: float, eccentricity: float
) -> tuple[BaseElement, ...]:
    limit = half_width + abs(eccentricity)  # on an eccentric base, outriggers may reach as far on the shorter side
    for element in elements:
        if abs(element.position) > limit * (1.0 + SLACK):
            what = "half_width" if eccentricity == 0.0 else "half_width + |eccentricity|"
            raise InputError(
                f"Elements must act within {what} = {limit:g} m to each side of the axis of the masses, but a "
                f"{type(element).__name__} is at {element.position:g} m.",
                field="elements",
            )
    return elements


def checked_top_height(floors: FloorModes | None, given: float | None) -> float | None:
    if given is not None:
        return positive("top_height", given, "m")
    return None if floors is None else float(floors.heights.max())


def checked_base_mass(modes: dict[str, Array], m_tot: float, inertia: float, given: float | None) -> float | None:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    if given is not None:
        base = positive("base_mass", given, "kg", zero=True)
        if m_tot - base < modal_mass - SLACK * m_tot:
            raise InputError(
                f"base_mass must leave the effective mass of the modes, {modal_mass:.9g} kg, but {base:.9g} kg of "
                f"m_tot = {m_tot:.9g} kg was given.",
                field="base_mass",
            )
        return base
    complete = mass.size > 0 and float(mass @ modes["effective_height"] ** 2) >= (1.0 - SLACK) * inertia
    return max(m_tot - modal_mass, 0.0) if complete else None


@computable("The inertia of the modes, from effective_mass and effective_height,")
def checked_inertia(modes: dict[str, Array], scalars: dict[str, float], given: float | None) -> float:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    modal_inertia = float(mass @ modes["effective_height"] ** 2)
    i_theta, m_tot = scalars["i_theta"], scalars["m_tot"]
    if m_tot < modal_mass * (1.0 - SLACK):
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
    if given is None:
        inertia = i_theta - m_tot * scalars["half_width"] ** 2
    else:
        inertia = positive("translational_inertia", given, "kg m²")
    if not modal_inertia * (1.0 - SLACK) <= inertia < i_theta:
        raise InputError(
            "translational_inertia must be at least the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², and below i_theta, {i_theta:.9g} kg m², but {source} is "
            f"{inertia:.9g} kg m². Give the sum of m_i h_i² over the masses above the base.",
            field="translational_inertia",
        )
    least = inertia + m_tot * scalars["half_width"] ** 2
    if i_theta < least * (1.0 - PRINTED):
        raise InputError(
            "i_theta must be at least translational_inertia + m_tot * half_width**2, "
            f"{least:.9g} kg m², but {i_theta:.9g} kg m² was given. It refers to a pivot, so it changes with the "
            "base: properties.with_half_width(B) gives the same structure on another base.",
            field="i_theta",
        )
    return max(inertia, modal_inertia)
