"""The models that yield: those whose label ends in -BW, or all of them where no label does."""

from collections.abc import Iterable, Sequence

from rockflex.models import BoucWen, Model, parse_model


def yielding(models: Iterable[str | Model]) -> list[str]:
    """Return the labels of the models that end in -BW."""
    return [model.label for model in map(parse_model, models) if model.yields]


def labelled_hysteresis(models: Sequence[Model], bouc_wen: BoucWen | None) -> list[BoucWen | None]:
    """Return the hysteresis of each model on the command line and the page, where only the labels decide."""
    return [bouc_wen if model.yields else None for model in models]


def hysteresis_of(models: Sequence[Model], bouc_wen: BoucWen | None) -> list[BoucWen | None]:
    """Return the hysteresis of each model: by their labels, but of all models where no label ends in -BW."""
    return labelled_hysteresis(models, bouc_wen) if yielding(models) else [bouc_wen] * len(models)
