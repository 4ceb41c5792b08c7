"""Limit states of a run, and the observed fractions of runs beyond them."""

import math
from collections.abc import Callable, Container, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.registry import Catalogue
from rockflex.foundation.shown import shown

OVERTURNED = 0.5 * math.pi  # rad
ROCKED = 1e-4  # rad; uplift with a smaller rotation does not count as rocking


@dataclass(frozen=True, kw_only=True)
class LimitState:
    """A limit that a run may exceed: its names, its rotation, and which runs exceed it.

    A run that overturns exceeds every limit state.

    Attributes
    ----------
    name : str
        Name in files and function calls.
    label : str
        Name in text.
    symbol : str
        The event of exceeding it, in figures: words, or Matplotlib's mathtext without its dollar signs.
    exceeded : callable
        Returns whether the solved runs of a table, or the run of one row, exceed the limit.
    threshold : float
        Largest rotation |θ| in rad; NaN if the limit depends on the structure or is not on this rotation.
    bound : str
        The rotation in text; empty if the label states it.
    column : str
        Column of the demand; empty if the limit is on none that a table may lack.

    Examples
    --------
    >>> from rockflex.fragility import LIMIT_STATES
    >>> list(LIMIT_STATES)
    ['uplift', 'rocking', 'nominal', 'tendon_yield', 'overturning']
    >>> LIMIT_STATES["overturning"].rotation
    '|θ| = π/2'
    """

    name: str
    label: str
    symbol: str
    exceeded: Callable[[Any], Any]
    threshold: float = math.nan
    bound: str = ""
    column: str = ""

    @property
    def rotation(self) -> str:
        """The rotation in text."""
        return self.bound or self.label


def nominal_rotation_symbol(multiple: float = 1.0) -> str:
    """Return the event of a rotation beyond a multiple of 0.7 atan(B/h*_1), as `LimitState.symbol`."""
    times = "" if math.isclose(multiple, 1.0) else rf"{multiple:g}\cdot"
    return rf"θ_{{\mathrm{{max}}}}>{times}0.7\,\mathrm{{atan}}(B/h^*_1)"


def _overturned_runs(runs: Any) -> Any:
    return runs["status"] == "overturned"


def rotation_limit_state(rotation: float, name: str = "rotation", label: str = "") -> LimitState:
    """Return the limit state of a rotation in rad; an overturned run exceeds every rotation below π/2."""

    def exceeded(runs: Any) -> Any:
        return (runs["max_rotation"] > rotation) | (_overturned_runs(runs) & (rotation < OVERTURNED))

    symbol = rf"θ_{{\mathrm{{max}}}}>{rotation:g}\ \mathrm{{rad}}"
    return LimitState(
        name=name, label=label or f"{rotation:g} rad", symbol=symbol, exceeded=exceeded, threshold=rotation
    )


DEMAND_SYMBOLS = {
    "max_ductility": r"μ_{\mathrm{max}}",
    "max_residual_drift_ratio": r"(Δ_{\mathrm{res}}/h)_{\mathrm{max}}",
}


def demand_limit_state(column: str, bound: float) -> LimitState:
    """Return the limit state of the magnitude of a demand: a number that a table of runs has in a column.

    In files and wherever a limit is a name it is written as ``"max_ductility > 4"``.

    Examples
    --------
    >>> from rockflex.fragility import demand_limit_state
    >>> demand_limit_state("max_ductility", 4.0).label
    'max_ductility > 4'
    >>> bool(demand_limit_state("max_ductility",
    ...     4.0).exceeded({"max_ductility": 5.2, "status": "rocking"}))
    True
    """

    def exceeded(runs: Any) -> Any:
        if column not in runs:
            raise InputError(
                f"The runs have no column {column}. Tables of studies have residual_rotation if a structure has "
                "dissipators, dampers or yielding tendons, and max_ductility and max_residual_drift_ratio if its "
                "stories yield."
            )
        return (abs(runs[column]) > bound) | _overturned_runs(runs)

    text = f"{column} > {bound:g}"
    symbol = (DEMAND_SYMBOLS.get(column) or rf"\mathrm{{{column}}}".replace("_", r"\_")) + f">{bound:g}"
    return LimitState(name=column, label=text, symbol=symbol, exceeded=exceeded, column=column)


def residual_rotation_limit_state(rotation: float) -> LimitState:
    """Return the limit state of a residual rotation in rad, of either sign.

    Examples
    --------
    >>> from rockflex.fragility import residual_rotation_limit_state
    >>> residual_rotation_limit_state(0.005).label
    'residual 0.005 rad'
    >>> bool(residual_rotation_limit_state(0.005).exceeded({
    ...     "residual_rotation": -0.007, "status": "rocking"}))
    True
    """
    symbol = rf"|θ_{{\mathrm{{res}}}}|>{rotation:g}\ \mathrm{{rad}}"
    of_demand = demand_limit_state("residual_rotation", rotation)
    return replace(of_demand, name="residual", label=f"residual {rotation:g} rad", symbol=symbol)


UPLIFT = LimitState(
    name="uplift", label="uplift", symbol="uplift", exceeded=lambda runs: runs["status"] != "no_uplift", threshold=0.0
)


def rocked_runs(runs: Any, threshold: float = ROCKED) -> Any:
    """Return which runs of a table rocked: the base uplifted, and turned by more than `threshold` in rad.

    A base on springs also turns without uplift, which is no rocking. The threshold follows Silva & Stojadinović
    2024, Section 3.2, for rotations that matter.
    """
    return UPLIFT.exceeded(runs) & (runs["max_rotation"] > threshold)


ROCKING = LimitState(name="rocking", label="uplift with θ_max > 1e-4 rad", symbol="rocking", exceeded=rocked_runs)
NOMINAL = LimitState(
    name="nominal",
    label="0.7 atan(B/h*_1)",
    symbol=nominal_rotation_symbol(),
    exceeded=lambda runs: runs["nominal_overturning"],
)
OVERTURNING = LimitState(
    name="overturning",
    label="overturning",
    symbol="overturning",
    exceeded=_overturned_runs,
    threshold=OVERTURNED,
    bound="|θ| = π/2",
)
TENDON_YIELD = LimitState(
    name="tendon_yield",
    label="tendon yield",
    symbol="tendon yield",
    exceeded=lambda runs: (runs["tendon_utilisation"] >= 1.0) | _overturned_runs(runs),
)
LIMIT_STATES = Catalogue[LimitState]((UPLIFT, ROCKING, NOMINAL, TENDON_YIELD, OVERTURNING), "limit_states")


def bounded_demand(limit: object) -> LimitState | None:
    """Return the limit state of a text such as "max_ductility > 4"; None of anything else.

    Raises
    ------
    InputError
        If the bound is no number, or negative.
    """
    words = limit.split() if isinstance(limit, str) else []
    if len(words) != 3 or words[1] != ">" or not words[0].isidentifier():
        return None
    try:
        bound = float(words[2])
    except ValueError:
        bound = math.nan
    if not (math.isfinite(bound) and bound >= 0.0):
        raise InputError(
            f"limit: the bound of {words[0]} must be zero or a positive number, but {shown(limit)} was given.",
            field="limit",
        )
    return demand_limit_state(words[0], bound)


def limit_state_of(limit: str | float | LimitState) -> LimitState:
    """Return the limit state of a name, also of one that another package registers, of a demand or of a rotation.

    Parameters
    ----------
    limit
        One of `LIMIT_STATES`; a demand with its bound, such as ``"max_ductility > 4"``; or a rotation in rad.

    Raises
    ------
    InputError
        If it is none of these.

    Examples
    --------
    >>> from rockflex.fragility import limit_state_of
    >>> limit_state_of("overturning").rotation
    '|θ| = π/2'
    """
    if isinstance(limit, LimitState):
        return limit
    if not isinstance(limit, str):
        return rotation_limit_state(checked_positive("limit", limit, "rad"))
    state = LIMIT_STATES.get(limit) or bounded_demand(limit)
    if state is None:
        words = ", ".join(f'"{each}"' for each in LIMIT_STATES)
        raise InputError(
            f'limit must be one of {words}, a demand with its bound such as "max_ductility > 4", a LimitState or a '
            f"rotation in rad, but {shown(limit)} was given.",
            field="limit",
        )
    return state


def check_limit_columns(limits: Iterable[LimitState], columns: Container[str]) -> None:
    """Raise an InputError if a limit is on a demand that a study has no column for."""
    for each in limits:
        if each.column and each.column not in columns:
            raise InputError(
                f"limit {each.label}: the study has no column {each.column}. Tables have max_ductility and "
                "max_residual_drift_ratio if stories of a structure yield, and residual_rotation if it has "
                "dissipators, dampers or yielding tendons.",
                field="limit",
            )


def limit_state_label(limit: float | str) -> str:
    """Return the name in text of a limit from a file: a word unchanged, or a rotation in rad."""
    return limit if isinstance(limit, str) else rotation_limit_state(limit).label


def observed_exceedance_fractions(im: Array, exceeded: Bools, groups: int) -> list[tuple[float, float]]:
    """Return the geometric mean of the measures and the fraction of runs beyond a limit, in groups of neighbours.

    The groups are of equal size as far as possible; those without a run are left out.
    """
    parts: list[NDArray[np.intp]] = np.array_split(np.argsort(im, kind="stable"), groups)
    return [(float(np.exp(np.log(im[part]).mean())), float(exceeded[part].mean())) for part in parts if part.size]
