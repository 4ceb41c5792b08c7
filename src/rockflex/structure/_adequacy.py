"""How many modes a rocking structure needs."""

import math
from dataclasses import dataclass, field, fields, replace

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_instance, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.values import Value
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._rocking_checks import SUM_TOLERANCE
from rockflex.structure._uplifted import lowest_uplifted_frequencies


@dataclass(frozen=True)
class AdequacyTolerance:
    """The fractions that a surrogate model may leave out; infinity disables a criterion.

    The defaults separate the models that Silva & Stojadinović 2024 consider sufficient from those that they do not.

    Attributes
    ----------
    base_moment : float
        Fraction of the base moment L_0^r left out. Sufficient: 0.11 (one mode of 15 stories in flexure, Section 3.4)
        and 0.06 (two of the chimney, Section 4.1.1). Insufficient: 0.13 (one of specimen S1, Section 3.1) and 0.18 (one
        of the chimney).
    first_frequency : float
        Relative error by which the first uplifted frequency is too high. Sufficient: 0.166 (2DOF-S, 15 stories in
        flexure, h*_1/B = 10: "quite good", Section 3.4). Insufficient: 1.15 (the same in shear: "poor"). The paper also
        finds 2DOF-S likely satisfactory in shear below h*_1/B = 5, where the error reaches 0.44; use 0.45 to agree.
    second_frequency : float
        The same for the second frequency, with two modes or more. Sufficient: 0.20 (3DOF-S, chimney) and 0.03 (15
        stories in flexure). Insufficient: 0.79 (15 stories in shear: "quite inaccurate").
    base_shear : float
        Fraction of the mass left out. Sufficient: 0.08 (specimen 2Hz-Long Base). Insufficient: 0.29 (two modes of the
        chimney, with 19 % of the base shear missing). EN 1998-1:2004, 4.3.3.3.1, also requires 0.1.

    Raises
    ------
    InputError
        If a value is negative or not a number.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> strict = rf.AdequacyTolerance(first_frequency=0.02, second_frequency=0.02)
    >>> rf.adequacy(frame.rocking(), strict).model
    '4DOF-S'
    """

    base_moment: float = 0.12
    first_frequency: float = 0.17
    second_frequency: float = 0.25
    base_shear: float = 0.10

    def __post_init__(self) -> None:
        for each in fields(self):
            value = checked_positive(
                each.name, getattr(self, each.name), "fractions (5 % is 0.05)", zero=True, infinite=True
            )
            vars(self)[each.name] = value


def mode_truncation_errors(p: RockingProperties, missing: float) -> tuple[Array, Array]:
    """Return `Adequacy.frequency_error` (N, 2) and `reference_error` (2,), the larger values of the two pivots.

    Parameters
    ----------
    p : RockingProperties
        Properties with N modes, at least one.
    missing : float
        Inertia in kg m² that no available mode represents; zero if no mode is missing.
    """
    errors = [_pivot_truncation_errors(p, missing, pivot.side) for pivot in p.pivots]
    largest, reference = (np.maximum.reduce(each) for each in zip(*errors, strict=True))
    return largest, reference


def _pivot_truncation_errors(p: RockingProperties, missing: float, side: int) -> tuple[Array, Array]:
    found = np.full((p.n_modes, 2), np.nan)
    for k in range(1, p.n_modes + 1):
        found[k - 1, :k] = lowest_uplifted_frequencies(p.truncated(k), 2, side)
    reference = np.zeros(2)
    if missing:
        reference = np.maximum(found[-1] / _uplifted_with_missing_inertia(p, missing, side) - 1.0, 0.0)
    return np.maximum(found / found[-1] - 1.0, 0.0), reference


def _uplifted_with_missing_inertia(p: RockingProperties, inertia: float, side: int) -> Array:
    """Return the first two uplifted frequencies if the missing `inertia` in kg m² moves with the last mode."""
    # Two modes with the same frequency: one has the inertia of both, and the rotation does not excite the other.
    if p.n_modes == 1:  # the latter is the lowest
        return np.append(p.omega, np.nan)
    height = p.effective_height.copy()
    height[-1] = math.sqrt(height[-1] ** 2 + inertia / p.effective_mass[-1])
    both = lowest_uplifted_frequencies(replace(p, effective_height=height), 2, side)
    return np.sort(np.append(both, p.omega[-1]))[:2]


@dataclass(frozen=True, eq=False)
class Adequacy(Value):
    """The contributions of the modes of a structure, and how many modes are enough. The arrays are read-only.

    Row k - 1 of an array with N rows belongs to the first k of the N available modes.

    Attributes
    ----------
    base_moment : ndarray, shape (N,)
        m*_n h*_n/L_0^r of each mode; negative for a mode that opposes the first.
    base_shear : ndarray, shape (N,)
        m*_n/`mass` of each mode.
    base_moment_left, base_shear_left : ndarray, shape (N,)
        Fraction that k modes leave out; contributions of opposite sign do not cancel.
    frequency_error : ndarray, shape (N, 2)
        ω*_1 and ω*_2 with k modes divided by those with all N, minus 1; NaN for a frequency that k modes do not
        have.
    reference_error : ndarray, shape (2,)
        Upper bound of the error of the N modes relative to the whole structure; zero if no mode is missing.
    mass : float
        Mass in kg that the base shear is compared with: the mass above the base or, if unknown, the total mass.
    base_known : bool
        Whether `mass` is the mass above the base.
    enough : int or None
        Smallest number of modes within the tolerance for uplift, rotation, top displacement and base moment; None if
        all N are not enough.
    enough_for_shear : int or None
        The same for the base shear.
    tolerance : AdequacyTolerance
        The tolerance used.
    reason : str
        Recommendation and the numbers behind it, in sentences.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> found = rf.adequacy(frame.rocking())
    >>> found.enough
    3
    >>> found.base_moment_left.round(3)
    array([0.043, 0.008, 0.002, 0.   , 0.   ])
    """

    base_moment: Array
    base_shear: Array
    base_moment_left: Array
    base_shear_left: Array
    frequency_error: Array
    reference_error: Array
    mass: float
    base_known: bool
    enough: int | None
    enough_for_shear: int | None
    tolerance: AdequacyTolerance
    reason: str = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        vars(self)["reason"] = f"{_reason_for_rotation(self)} {_reason_for_shear(self)}"

    @property
    def n_modes(self) -> int:
        """Number N of available modes."""
        return self.base_moment.size

    @property
    def model(self) -> str | None:
        """Label of the smallest simplified model for everything except the base shear, such as "2DOF-S"."""
        return None if self.enough is None else _adequate_model_label(self.enough)

    @property
    def model_for_shear(self) -> str | None:
        """Label of the smallest simplified model for the base shear."""
        return None if self.enough_for_shear is None else _adequate_model_label(self.enough_for_shear)

    @property
    def frequency_bound(self) -> Array:
        """Upper bound (N, 2) of the error of ω*_1 and ω*_2 with k modes, relative to the whole structure."""
        return (1.0 + self.frequency_error) * (1.0 + self.reference_error) - 1.0


@explaining_overflow("The share of each mode")
def adequacy(
    properties: RockingProperties, tolerance: AdequacyTolerance | None = None, *, base_mass: float | None = None
) -> Adequacy:
    """Return how many modes a structure needs on a base that can rock.

    A simplified model with k modes is enough if it reproduces the fixed-base moment, which decides when the base
    lifts, and the frequencies of the uplifted structure: the first one with one mode, the first two with more.
    The number needed for base shear is reported separately, because it is larger.

    Parameters
    ----------
    properties : RockingProperties
        Properties with all known modes.
    tolerance : AdequacyTolerance, optional
        The fractions that may be left out.
    base_mass : float, optional
        Mass of the base in kg. Default: `RockingProperties.base_mass`; if that is unknown, base shear is compared with
        the total mass, so its shares are too small if the base has mass.

    Returns
    -------
    Adequacy

    Raises
    ------
    InputError
        If there are no modes, or `base_mass` leaves less than the effective mass of the modes.

    Notes
    -----
    The base moment that k modes leave out is the sum of |m*_n h*_n|/L_0^r over the other modes, plus the part that no
    available mode represents. The missing modes are assumed to have higher frequencies than the available ones. The
    uplifted frequencies are then lowest if all missing inertia moves with ω_N, which bounds the error of the N
    available modes. If the two pivots differ, each error is the larger of the two.

    References
    ----------
    Silva & Stojadinović 2024, Sections 3.4 and 4.1.1.

    Examples
    --------
    >>> import rockflex as rf
    >>> tower = rf.TaperedTower(
    ...     height=200.0, base_radius=8.0, top_radius=4.0, wall=1.0,
    ...     density=2400.0, elastic_modulus=25e9,
    ...     damping_ratio=0.02,
    ... )
    >>> found = rf.adequacy(tower.rocking())
    >>> found.model, found.model_for_shear
    ('3DOF-S', None)
    """
    p = checked_instance("properties", properties, RockingProperties)
    if p.n_modes == 0:
        raise InputError(
            "properties must have at least one mode, but a rigid structure was given, which needs none.",
            field="properties",
        )
    limits = AdequacyTolerance() if tolerance is None else checked_instance("tolerance", tolerance, AdequacyTolerance)
    rest = p.translational_inertia - float(p.effective_mass @ p.effective_height**2)
    complete = rest <= SUM_TOLERANCE * p.translational_inertia
    base = p.base_mass if base_mass is None else base_mass
    mass = p.horizontal_mass if base is None else _mass_above_base(p, base)
    moment, shear = p.effective_mass * p.effective_height / p.l0r, p.effective_mass / mass
    others = np.append(np.cumsum(np.abs(moment)[::-1])[-2::-1], 0.0)
    lost = abs(1.0 - float(moment.sum()))
    moment_left = others + (lost if lost > SUM_TOLERANCE else 0.0)
    shear_left = np.maximum(1.0 - np.cumsum(shear), 0.0)
    error, reference = mode_truncation_errors(p, 0.0 if complete else rest)
    bound = (1.0 + error) * (1.0 + reference) - 1.0
    good = (moment_left <= limits.base_moment) & (bound[:, 0] <= limits.first_frequency)
    good[1:] &= bound[1:, 1] <= limits.second_frequency
    return Adequacy(
        base_moment=moment,
        base_shear=shear,
        base_moment_left=moment_left,
        base_shear_left=shear_left,
        frequency_error=error,
        reference_error=reference,
        mass=mass,
        base_known=base is not None,
        enough=_first_adequate_mode_count(good),
        enough_for_shear=_first_adequate_mode_count(shear_left <= limits.base_shear),
        tolerance=limits,
    )


def _mass_above_base(p: RockingProperties, base_mass: float) -> float:
    modal = float(p.effective_mass.sum())
    mass = p.horizontal_mass - checked_positive("base_mass", base_mass, "kg", zero=True)
    if mass < modal * (1.0 - SUM_TOLERANCE):
        raise InputError(
            f"base_mass must leave the effective mass of the modes, {modal:.6g} kg, but {base_mass:g} kg of m_tot = "
            f"{p.m_tot:.6g} kg was given.",
            field="base_mass",
        )
    return mass


def _first_adequate_mode_count(good: Bools) -> int | None:
    return int(np.argmax(good)) + 1 if good.any() else None


def _adequate_model_label(modes: int) -> str:
    return f"{modes + 1}DOF-S"


def _reason_for_rotation(a: Adequacy) -> str:
    if a.enough is None:
        return translated(
            "One mode is not enough: {errors}. Give more modes."
            if a.n_modes == 1
            else "The {n} available modes are not enough: {errors}. Give more modes.",
            n=a.n_modes,
            errors=_describe_truncation_errors(a, a.n_modes),
        )
    errors = _describe_truncation_errors(a, a.enough)
    if a.enough == 1:
        return translated("2DOF-S is enough: with one mode, {errors}.", errors=errors)
    return translated(
        "Use {model}: with {fewer}, {before}; with {n}, {errors}.",
        model=a.model,
        fewer=_mode_count_text(a.enough - 1),
        before=_describe_truncation_errors(a, a.enough - 1, short=True),
        n=a.enough,
        errors=errors,
    )


def _describe_truncation_errors(a: Adequacy, k: int, *, short: bool = False) -> str:
    """Describe the fractions that k modes leave out and their errors; with `short`, only errors above the tolerance."""
    t, bound = a.tolerance, a.frequency_bound[k - 1]

    def error_text(value: float) -> str:
        share = _percent_text(value)
        return translated("at most {share}", share=share) if np.nanmax(a.reference_error) > 5e-4 else share

    said: list[str] = []
    left = a.base_moment_left[k - 1]
    if not short or left > t.base_moment:
        said.append(
            translated(
                "{share} of the base moment is left out (allowed: {limit})",
                share=_percent_text(left),
                limit=_percent_text(t.base_moment),
            )
        )
    if not short or bound[0] > t.first_frequency:
        said.append(
            translated(
                "the first uplifted frequency is {share} too high (allowed: {limit})",
                share=error_text(bound[0]),
                limit=_percent_text(t.first_frequency),
            )
        )
    if k > 1 and (not short or bound[1] > t.second_frequency):
        said.append(
            translated(
                "the second is {share} too high (allowed: {limit})"
                if said
                else "the second uplifted frequency is {share} too high (allowed: {limit})",
                share=error_text(bound[1]),
                limit=_percent_text(t.second_frequency),
            )
        )
    *others, last = said
    return translated("{others} and {last}", others=", ".join(others), last=last) if others else last


def _reason_for_shear(a: Adequacy) -> str:
    whole = translated("the mass above the base" if a.base_known else "the total mass including the base")
    needed = _percent_text(1.0 - a.tolerance.base_shear)
    carried = [_percent_text(1.0 - left) for left in a.base_shear_left]
    note = translated(
        "The horizontal ground reaction ΣF_x leaves no mass out: the mass of missing modes moves with the base, as it "
        "does in the base shear of models that end in -R."
    )
    if a.enough_for_shear is None:
        told = translated(
            "For the base shear give more modes: only {share} of {whole} participates with {modes} (required: "
            "{needed})."
            if a.base_known
            else "For the base shear give more modes, or the mass of the base: only {share} of {whole} participates "
            "with {modes} (required: {needed}).",
            share=carried[-1],
            whole=whole,
            modes=_mode_count_text(a.n_modes),
            needed=needed,
        )
        return f"{told} {note}"
    if a.enough is not None and a.enough_for_shear <= a.enough:
        return translated(
            "This is also enough for the base shear: {share} of {whole} participates (required: {needed}).",
            share=carried[a.enough - 1],
            whole=whole,
            needed=needed,
        )
    told = translated(
        "For the base shear use {model}: {share} of {whole} participates with {modes} (required: {needed})."
        if a.enough is None
        else "For the base shear use {model}: {share} of {whole} participates with {modes}, only {less} with {fewer} "
        "(required: {needed}).",
        model=a.model_for_shear,
        share=carried[a.enough_for_shear - 1],
        whole=whole,
        modes=_mode_count_text(a.enough_for_shear),
        less=carried[(a.enough or 1) - 1],
        fewer=_mode_count_text(a.enough or 1),
        needed=needed,
    )
    return f"{told} {note}"


def _mode_count_text(count: int) -> str:
    return translated("one mode" if count == 1 else "{n} modes", n=count)


def _percent_text(value: float) -> str:
    return f"{100.0 * value:.3g} %" if value >= 1e-3 else translated("less than 0.1 %")
