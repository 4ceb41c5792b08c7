"""The options of a run besides its structure, record and model: one definition for Python, files, flags and forms."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal, Self

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Model, RockingModel, parse_model
from rockflex.study._arguments import (
    WORK_LIMIT,
    GroundChoice,
    check_options,
    free_vibration_time,
    ground_under,
    work_limit_of,
)
from rockflex.study._case import Case
from rockflex.study._initial import InitialState


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """The options of a run.

    Attributes
    ----------
    free_vibration
        Seconds of free vibration after the record; None until settled.
    impact
        Impact law in place of each model's own, if not None.
    bouc_wen
        Hysteresis of the models whose label ends in -BW, or of every model if `all_yield`.
    ground
        The ground, or a function that returns the ground of each structure; None: rigid, without sliding.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Limit of the work of a run in s; None for no limit.
    """

    free_vibration: float | None = 0.0
    impact: ImpactLaw | None = None
    bouc_wen: BoucWen | None = None
    all_yield: bool = False
    ground: GroundChoice = None
    initial: InitialState | None = None
    work_limit: float | None = WORK_LIMIT

    @classmethod
    def of(
        cls,
        free_vibration: float | Literal["settle"] = 0.0,
        *,
        impact: ImpactLaw | None = None,
        bouc_wen: BoucWen | None = None,
        ground: GroundChoice = None,
        initial: InitialState | None = None,
        work_limit: float | Literal["none"] | None = WORK_LIMIT,
    ) -> Self:
        """Return the options that a function was called with.

        Raises
        ------
        InputError
            If one of them is out of range or of the wrong kind.
        """
        if not isinstance(initial, InitialState | None):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"initial must be an InitialState or None, but {shown(initial)} was given. "
                "Write InitialState(rotation=...)."
            )
        free, limit = free_vibration_time(free_vibration), work_limit_of(work_limit)
        check_options(bouc_wen, impact, ground)
        return cls(
            free_vibration=free, impact=impact, bouc_wen=bouc_wen, ground=ground, initial=initial, work_limit=limit
        )

    def among(self, models: Iterable[Model]) -> Self:
        """Return the options for a set of models: if no label ends in -BW, all of them have the hysteresis."""
        return replace(self, all_yield=not yielding(models))

    def tied(self, model: Model, properties: RockingProperties) -> RockingModel:
        """Return a model of a structure.

        Raises
        ------
        InputError
            If the structure cannot have the model, or the model these options.
        """
        bouc_wen = self.bouc_wen if self.all_yield or model.yields else None
        return model.of(properties, self.impact, bouc_wen, ground_under(properties, self.ground))

    def case(self, model: Model, properties: RockingProperties, *, history: bool = False, floors: bool = False) -> Case:
        """Return the runs of a model of a structure.

        Raises
        ------
        InputError
            As `tied`, or as `Case`.
        """
        tied = self.tied(model, properties)
        return Case(tied, self.free_vibration, self.initial, self.work_limit, history=history, floors=floors)


def yielding(models: Iterable[str | Model]) -> list[str]:
    """Return the labels of the models that end in -BW."""
    return [model.label for model in map(parse_model, models) if model.yields]
