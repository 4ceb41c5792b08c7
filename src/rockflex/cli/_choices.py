"""What a run of the command line is to assume: models, impact law, hysteresis and start."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Restitution, VVELComplete, parse_model
from rockflex.study import WORK_LIMIT, InitialState
from rockflex.study.assumed import LAWS, impact_law

USUAL = ("2DOF-S", "MDOF-S", "fixed")
RIGID = ("rigid", "rigid-C")
YIELDING = ("2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW")


@dataclass(frozen=True)
class Assumptions:
    """What models have beside their labels."""

    law: ImpactLaw | None = None
    bouc_wen: BoucWen | None = None
    initial: InitialState | None = None

    def describe(self) -> dict[str, Any]:
        """Return what was given, for a document."""
        described: dict[str, Any] = {}
        if self.law is not None:
            values = asdict(self.law) if isinstance(self.law, Restitution) else {}
            described["impact"] = {"law": _name(self.law), **values}
        if self.bouc_wen is not None:
            described["bouc_wen"] = asdict(self.bouc_wen)
        if self.initial is not None:
            described["initial_rotation"] = self.initial.rotation
        return described

    def remarks(self) -> list[str]:
        """The same in lines for the head of a table."""
        lines: list[str] = []
        if self.law is not None:
            e = f", e = {self.law.e:g}" if isinstance(self.law, Restitution) else ""
            lines.append(f"Impact: {_name(self.law)}{e}")
        if self.bouc_wen is not None:
            b = self.bouc_wen
            lines.append(
                f"Hysteresis of -BW: D_y = {b.yield_displacement:g} m, α = {b.post_yield_ratio:g}, γ = {b.gamma:g}, "
                f"β = {b.beta:g}, n = {b.exponent:g}"
            )
        if self.initial is not None:
            lines.append(f"At rest at θ = {self.initial.rotation:g} rad at t = 0")
        return lines


def make_assumptions(
    file: Path | None, in_file: dict[str, Any], flags: dict[str, Any], rotation: float | None
) -> Assumptions:
    """Put the flags of a line before what the structure's file says.

    Parameters
    ----------
    file, in_file
        The structure's file, and its `impact`, `restitution` and `bouc_wen` as far as it has them.
    flags
        The same from the command line (None where not given), the hysteresis by the names of `BoucWen`'s arguments.
    rotation
        θ at the start, in rad, or None.

    Raises
    ------
    InputError
        If they contradict each other, or a value is out of range.
    """
    given = {name: value for name, value in flags.items() if value is not None}
    impact = {name: in_file[name] for name in ("impact", "restitution") if name in in_file}
    if "impact" in given:
        impact = {}
    impact |= {name: given.pop(name) for name in ("impact", "restitution") if name in given}
    initial = None if rotation is None else InitialState(rotation=rotation)
    return Assumptions(_law(**impact), _bouc_wen(file, in_file.get("bouc_wen", {}), given), initial)


def choose_models(
    given: Sequence[str] | None, properties: RockingProperties, assumptions: Assumptions, *, by_flag: bool
) -> list[str]:
    """Split the labels at commas, or choose the usual ones, and check that the structure and the rest go with each.

    `by_flag` says that the hysteresis was asked for on the command line, so that a model has to have it.

    Raises
    ------
    InputError
        If a label is unknown, needs more modes than there are, or does not go with the assumptions.
    """
    if given is None:
        usual = USUAL if properties.n_modes else RIGID
        labels = list(usual if assumptions.bouc_wen is None else YIELDING)
        if assumptions.initial is not None:
            labels = [label for label in labels if parse_model(label).lifts]
    else:
        labels = [label.strip() for item in given for label in item.split(",") if label.strip()]
    if not labels:
        raise InputError("No model was given. Expected labels such as 2DOF-S,MDOF-S,fixed.")
    models = {label: parse_model(label) for label in labels}
    for label, model in models.items():
        if model.yields and assumptions.bouc_wen is None:
            raise InputError(
                f"{label} needs its hysteresis. Give --yield-displacement, or [bouc_wen] in the structure's file."
            )
        if model.yields and model.n_modes is None and properties.n_modes != 1:
            one = "2DOF-S-BW" if model.lifts else "1DOF-fixed-BW"
            raise InputError(f"{label} would have {properties.n_modes} modes, and what yields has one. Use {one}.")
        tied = model.of(properties, assumptions.law, assumptions.bouc_wen if model.yields else None)
        if assumptions.initial is not None:
            assumptions.initial.state(tied)
    if by_flag and not any(model.yields for model in models.values()):
        raise InputError(
            f"A hysteresis was given, but {', '.join(models)} do not yield. Models whose label ends in -BW do, such as "
            "2DOF-S-BW, 2DOF-C-BW or 1DOF-fixed-BW: add one, or leave --yield-displacement out."
        )
    return list(models)


def parse_free_vibration(given: str, models: Sequence[str]) -> float | Literal["settle"]:
    """Read seconds, or "settle".

    Raises
    ------
    InputError
        If the text is neither, or a model cannot settle.
    """
    if given == "settle":
        restless = [label for label in models if parse_model(label).yields]
        if restless:
            raise InputError(
                f"--free-vibration settle cannot tell when the hysteretic spring of {', '.join(restless)} is at rest. "
                "Give seconds, or leave such models out."
            )
        return "settle"
    try:
        seconds = float(given)
    except ValueError:
        seconds = math.nan
    if not (seconds >= 0.0 and math.isfinite(seconds)):
        raise InputError(f"--free-vibration must be zero or more seconds, or settle, but {shown(given)} was given.")
    return seconds


def parse_work_limit(given: str | None) -> float | None:
    """Read seconds of computing, or "none" for no limit; the usual limit where nothing is given.

    Raises
    ------
    InputError
        If the text is neither.
    """
    if given is None:
        return WORK_LIMIT
    if given == "none":
        return None
    try:
        seconds = float(given)
    except ValueError:
        seconds = math.nan
    if not seconds > 0.0:
        raise InputError(f"--work-limit must be a positive number of seconds, or none, but {given!r} was given.")
    return seconds


def parse_scales(given: Sequence[float]) -> list[float]:
    """Return the factors, each once.

    Raises
    ------
    InputError
        If one is not finite.
    """
    for scale in given:
        if not math.isfinite(scale):
            raise InputError(f"--scale must be a finite factor on the acceleration, but {scale} was given.")
    return list(dict.fromkeys(given))


def parse_coefficient(mu: float | None) -> float | None:
    """Return a coefficient of friction as it is.

    Raises
    ------
    InputError
        If it is not a positive number.
    """
    if mu is not None and not 0.0 < mu < math.inf:
        raise InputError(f"--friction must be a coefficient above zero, such as 0.5, but {mu} was given.")
    return mu


def _law(impact: str | None = None, restitution: float | None = None) -> ImpactLaw | None:
    if impact is not None and impact not in LAWS:
        raise InputError(f"--impact must be one of {', '.join(LAWS)}, but {shown(impact)} was given.")
    if impact == "restitution" and restitution is None:
        raise InputError("--impact restitution needs its coefficient. Give --restitution E, from 0 to 1.")
    if restitution is not None and impact != "restitution":
        raise InputError(
            f"A restitution of {restitution:g} was given, but the impact law is {impact or 'the one of each model'}. "
            "Add --impact restitution, or leave --restitution out."
        )
    return impact_law(impact, restitution)


def _bouc_wen(file: Path | None, in_file: dict[str, float], flags: dict[str, float]) -> BoucWen | None:
    values = {**in_file, **flags}
    if not values:
        return None
    if "yield_displacement" not in values:
        raise InputError("The hysteresis needs its yield displacement. Give --yield-displacement DY in m.")
    try:
        return BoucWen(**values)
    except InputError as error:
        if flags:
            raise
        raise InputError(f"{file}, [bouc_wen]: {error}") from error


def _name(law: ImpactLaw) -> str:
    if isinstance(law, Restitution):
        return "restitution"
    return "complete" if isinstance(law, VVELComplete) else "simplified"
