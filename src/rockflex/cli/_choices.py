"""The models and assumptions of ``rockflex run``, from its flags and the structure file."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from rockflex._errors import InputError
from rockflex._schema import BoucWenKeys, ImpactKeys, InitialKeys
from rockflex.cli._flags import flags_of, naming
from rockflex.cli._ground import ground_remarks, make_ground
from rockflex.modal import Ground, RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Restitution, parse_model
from rockflex.structure.file import checked
from rockflex.study import WORK_LIMIT, InitialState
from rockflex.study._arguments import work_limit_of
from rockflex.study._yielding import labelled_hysteresis, yielding
from rockflex.study.assumed import Assumed, name_of

USUAL = ("2DOF-S", "MDOF-S", "fixed")
RIGID = ("rigid", "rigid-C")
YIELDING = ("2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW")


@dataclass(frozen=True)
class Assumptions:
    """What runs assume besides their models; None of each is the model's own, or none."""

    law: ImpactLaw | None = None
    bouc_wen: BoucWen | None = None
    initial: InitialState | None = None
    ground: Ground | None = None
    ground_values: dict[str, Any] = field(default_factory=dict[str, Any])
    """The ground as given."""

    def describe(self) -> dict[str, Any]:
        """Return the given assumptions, for a document."""
        described: dict[str, Any] = {}
        if self.law is not None:
            values = asdict(self.law) if isinstance(self.law, Restitution) else {}
            described["impact"] = {"law": name_of(self.law), **values}
        if self.bouc_wen is not None:
            described["bouc_wen"] = asdict(self.bouc_wen)
        if self.initial is not None:
            described["initial_rotation"] = self.initial.rotation
        if self.ground is not None:
            described["ground"] = self.ground_values
        return described

    def remarks(self, properties: RockingProperties) -> list[str]:
        """Return the same in lines, for the head of a table of runs of a structure."""
        lines: list[str] = []
        if self.law is not None:
            e = f", e = {self.law.e:g}" if isinstance(self.law, Restitution) else ""
            lines.append(f"Impact: {name_of(self.law)}{e}")
        if self.bouc_wen is not None:
            b = self.bouc_wen
            lines.append(
                f"Hysteresis of -BW: D_y = {b.yield_displacement:g} m, α = {b.post_yield_ratio:g}, γ = {b.gamma:g}, "
                f"β = {b.beta:g}, n = {b.exponent:g}"
            )
        if self.initial is not None:
            lines.append(f"At rest at θ = {self.initial.rotation:g} rad at t = 0")
        if self.ground is not None:
            lines += ground_remarks(self.ground, properties)
        return lines


def make_assumptions(
    file: Path | None,
    in_file: dict[str, Any],
    law: dict[str, Any],
    bouc_wen: dict[str, Any],
    initial: dict[str, Any],
    ground: dict[str, Any],
    properties: RockingProperties,
) -> Assumptions:
    """Combine the assumptions of a structure file with those given by flags, which take precedence.

    Parameters
    ----------
    file, in_file
        The structure file, and its `impact`, `restitution`, `bouc_wen` and `ground` as far as it has them.
    law, bouc_wen, initial, ground
        Values by flags, named as in `ImpactKeys`, `BoucWenKeys`, `InitialKeys`, and in `GroundKeys` and `BedKeys`.
    properties
        The structure, whose base the ground is under.

    Raises
    ------
    InputError
        If they contradict each other, or a value is out of range.
    """
    below = {} if "impact" in law else {name: in_file[name] for name in flags_of(ImpactKeys) if name in in_file}
    with naming(flags_of(ImpactKeys)):
        chosen = checked(Assumed, {**below, **law}).law()
    with naming(flags_of(InitialKeys) | {"rotation": "--initial-rotation"}):
        start = InitialState(rotation=initial["initial_rotation"]) if initial else None
    hysteresis = _bouc_wen(file, in_file.get("bouc_wen", {}), bouc_wen)
    return Assumptions(chosen, hysteresis, start, *make_ground(file, in_file.get("ground", {}), ground, properties))


def choose_models(
    given: Sequence[str] | None, properties: RockingProperties, assumptions: Assumptions, *, by_flag: bool
) -> list[str]:
    """Return the given labels, split at commas, or the usual ones, after checking that they suit the rest.

    `by_flag` tells that the hysteresis was given on the command line, where a model must use it.

    Raises
    ------
    InputError
        If a label is unknown, needs more modes than there are, or contradicts the assumptions.
    """
    if given is None:
        usual = USUAL if properties.n_modes else RIGID
        labels: list[str] = [*(usual if assumptions.bouc_wen is None else YIELDING)]
        if assumptions.ground is not None and not assumptions.ground.rigid:
            labels = [label for label in labels if (each := parse_model(label)).lifts and not each.complete]
            labels = [label for label in labels if not parse_model(label).yields]
        if assumptions.initial is not None:
            labels = [label for label in labels if parse_model(label).lifts]
    else:
        labels = list(dict.fromkeys(label.strip() for item in given for label in item.split(",") if label.strip()))
    if not labels:
        raise InputError("No model was given. Expected labels such as 2DOF-S,MDOF-S,fixed.")
    models, yields = list(map(parse_model, labels)), yielding(labels)
    if yields and assumptions.bouc_wen is None:
        raise InputError(
            f"{yields[0]} needs its hysteresis. Give --yield-displacement, or [bouc_wen] in the structure file."
        )
    for model, bouc_wen in zip(models, labelled_hysteresis(models, assumptions.bouc_wen), strict=True):
        tied = model.of(properties, assumptions.law, bouc_wen, assumptions.ground)
        if assumptions.initial is not None:
            assumptions.initial.state(tied)
    if by_flag and not yields:
        raise InputError(
            f"A hysteresis was given, but {', '.join(labels)} do not yield. Models whose label ends in -BW do, such as "
            "2DOF-S-BW, 2DOF-C-BW or 1DOF-fixed-BW: add one, or leave --yield-displacement out."
        )
    return labels


def number_or_word(text: str) -> Any:
    """Return a number where the text is one, and otherwise the text."""
    try:
        return float(text)
    except ValueError:
        return text


def parse_work_limit(given: str | None) -> float | None:
    """Return the limit of computing time in s, None for no limit, or the usual limit if none is given.

    Raises
    ------
    InputError
        If the text is neither a positive number nor "none".
    """
    with naming({"work_limit": "--work-limit"}):
        return WORK_LIMIT if given is None else work_limit_of(number_or_word(given))


def _bouc_wen(file: Path | None, in_file: dict[str, float], flags: dict[str, float]) -> BoucWen | None:
    values = {**in_file, **flags}
    if not values:
        return None
    if "yield_displacement" not in values:
        raise InputError("The hysteresis needs its yield displacement. Give --yield-displacement DY in m.")
    try:
        with naming({name: flag for name, flag in flags_of(BoucWenKeys).items() if name in flags}):
            return BoucWen(**values)
    except InputError as error:
        if flags:
            raise
        raise InputError(f"{file}, [bouc_wen]: {error}") from error
